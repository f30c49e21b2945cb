"""Branches of orbits and their special points, each looked at again by another route."""

import numpy as np
import pytest
from compilation import sized
from machines import PAPER, SCALES, machine_of, random_parameters

from carom import find_orbits
from carom.bifurcations import OrbitBranch, continue_orbit
from carom.closed_forms.periods import PeriodCondition
from carom.continuation import Steps
from carom.models import jeffcott


@pytest.fixture(scope="module")
def upper() -> OrbitBranch:
    """B1,d and beyond its fold B1,c."""
    return continue_orbit(find_orbits(jeffcott(PAPER))["B1,d"], "gamma", (0.02, 0.3))


@pytest.fixture(scope="module")
def lower() -> OrbitBranch:
    """B1,a and beyond its fold B1,b."""
    return continue_orbit(find_orbits(jeffcott(PAPER))["B1,a"], "gamma", (0.02, 0.3))


def value(branch: OrbitBranch, kind: str) -> list[float]:
    return sorted(point.value for point in branch.special if point.kind == kind)


def test_special_points_of_the_source_papers_machine(upper, lower):
    assert value(upper, "fold") == pytest.approx([0.1780277257], abs=5e-11)
    assert value(upper, "period-doubling") == pytest.approx([0.0833814175], abs=5e-11)
    assert value(upper, "grazing") == pytest.approx([0.0636105609], abs=5e-11)
    assert value(upper, "radius-extremum") == pytest.approx([0.0785], abs=5e-5)
    assert value(upper, "neimark-sacker") == []
    assert value(lower, "fold") == pytest.approx([0.1780277257], abs=5e-11)
    assert value(lower, "non-smooth-hopf") == pytest.approx([0.0724686787] * 2, abs=5e-11)
    (fold,) = [point for point in upper.special if point.kind == "fold"]
    # From F₁ = ∂F₁/∂T = 0 with 40 digits.
    assert fold.value == pytest.approx(0.17802772567072037, abs=2e-14)
    assert fold.period == pytest.approx(1.6408219835236660, abs=1e-12)


def test_orbits_of_a_branch_are_those_found_at_each_parameter(upper, lower):
    for branch in (upper, lower):
        for index in range(2, len(branch) - 2, 9):
            orbits = find_orbits(jeffcott(PAPER.replace(gamma=branch.values[index])))
            orbit = orbits[branch.names[index]]
            assert branch.period[index] == pytest.approx(orbit.period, abs=1e-10)
            assert branch.radial_speed[index] == pytest.approx(orbit.radial_speed, abs=1e-10)
            assert branch.angular_speed[index] == pytest.approx(orbit.angular_speed, abs=1e-10)
            assert branch.admissible[index] == orbit.admissible
            assert branch.stable[index] == orbit.stable
            certified = branch.orbits[index]
            assert (certified.name, certified.admissible) == (orbit.name, orbit.admissible)
            assert abs(certified.position - orbit.position) < 1e-9
            assert np.abs(np.abs(certified.multipliers.values) - np.abs(orbit.multipliers.values)).max() < 1e-8


def test_physical_parameters_pass_the_same_points():
    machine = machine_of(PAPER, SCALES)
    orbit = find_orbits(jeffcott(machine.parameters))["B1,d"]
    damping = continue_orbit(orbit, "damping", (500.0, 2500.0))
    unit = 50.0 * 184.2
    assert value(damping, "period-doubling") == pytest.approx([0.0833814175 * unit], rel=1e-9)
    speed = continue_orbit(orbit, "speed", (150.0, 260.0))
    for point in speed.special:
        assert point.numbers.rho == PAPER.rho
        assert point.numbers.gamma == pytest.approx(PAPER.gamma * 184.2 / point.value, rel=1e-13)
        if point.kind == "fold":
            roots = [
                len(
                    PeriodCondition.of(jeffcott(machine.replace(speed=point.value + shift).parameters).system)
                    .roots()
                    .periods
                )
                for shift in (-1e-6, 1e-6)
            ]
            assert abs(roots[0] - roots[1]) == 2


def test_random_machines_end_with_a_stated_reason():
    random = np.random.default_rng(40)
    steps = Steps(first=0.02, largest=0.2, sharpest_turn=0.3, most_points=150)
    followed = 0
    for _ in range(sized(15, 10, 50)):
        parameters = random_parameters(random)
        orbits = [orbit for orbit in find_orbits(jeffcott(parameters), 30.0) if orbit.slip > 0]
        parameter = str(random.choice(["gamma", "omega", "rho", "mu", "d"]))
        present = getattr(parameters, parameter)
        interval = (0.0, 1.0) if parameter == "d" else (0.5 * present, 2.0 * present + 0.1)
        for orbit in orbits[:2]:
            branch = continue_orbit(orbit, parameter, interval, steps)
            followed += 1
            assert set(branch.stops) <= {
                "parameter limit",
                "end of domain",
                "closed loop",
                "step too small",
                "most points",
                "radial speed without bound",
            }
            assert ((interval[0] <= branch.values) & (branch.values <= interval[1])).all()
            assert np.isfinite(branch.period).all()
    assert followed > sized(8, 3, 30)
