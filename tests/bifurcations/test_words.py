"""Branches of orbits of any word: against the closed form, simulation and thirty digits; switching at period doublings."""

from functools import cache

import numpy as np
import pytest

from carom.bifurcations import Bifurcation, OrbitBranch, continue_orbit, switch
from carom.bifurcations.conditions import TESTS, conditions_at
from carom.models import jeffcott
from carom.motions import State, simulate
from carom.orbits import find_orbits, impact_map, orbit_near, orbit_of_motion
from carom.orbits.orbit import same_orbit
from carom.orbits.shooting import ShootingStart
from tests.machines import PAPER

DOUBLING = 0.0833814175
"""Damping at which B1,d doubles its period."""
pytestmark = pytest.mark.jit_only


@cache
def single() -> OrbitBranch:
    return continue_orbit(find_orbits(PAPER)["B1,d"], "gamma", (0.075, 0.11))


@cache
def doubled() -> OrbitBranch:
    (point,) = [point for point in single().special if point.kind == "period-doubling"]
    return switch(point, (0.078, 0.09))


def located(kind: str, near: float) -> Bifurcation:
    (point,) = [p for p in doubled().special if p.kind == kind and abs(p.value - near) < 1e-4]
    return point


@pytest.mark.parametrize("name", ["B1,b", "B1,d"])
def test_orbits_with_one_impact_and_their_special_points_solve_the_equations_of_the_closed_form(name):
    branch = continue_orbit(find_orbits(PAPER)[name], "gamma", (0.06, 0.2))
    for orbit in branch.closed:
        # Shooting knows the period to rounding divided by the radial speed, which is 2e-5 at one point.
        assert np.abs(conditions_at(*orbit[1:])[:2]).max() < 1e-14 / min(1e-3, abs(orbit.radial_speed))
    for point in branch.special:
        at = point.numbers, point.period, point.radial_speed
        assert conditions_at(*at)[:2] == pytest.approx((0.0, 0.0), abs=1e-11)
        if point.kind != "radius-extremum":
            assert TESTS[point.kind](*at) == pytest.approx(0.0, abs=1e-10)
    expected = {"B1,b": ["fold", "non-smooth-hopf"], "B1,d": ["fold", "grazing", "period-doubling", "radius-extremum"]}
    assert sorted({point.kind for point in branch.special}) == expected[name]


def test_shooting_passes_where_orbits_of_one_impact_shrink_to_a_point_on_the_wall():
    """Levitation meets the wall there, and is an orbit of any period: the equations of shooting are singular in one point."""
    branch = continue_orbit(find_orbits(PAPER)["B1,b"], "gamma", (0.06, 0.11))
    (hopf,) = branch.special
    assert hopf.kind == "non-smooth-hopf"
    assert TESTS["boundary-equilibrium"](hopf.numbers, 1.0, 0.0) == pytest.approx(0.0, abs=1e-11)
    assert branch.radial_speed.min() < 0.0 < branch.radial_speed.max()
    for p, speed in zip(branch.values.tolist(), branch.radial_speed, strict=True):
        assert find_orbits(PAPER.replace(gamma=p))["B1,b"].radial_speed == pytest.approx(speed, abs=1e-9)


def test_what_the_closed_form_tells_of_a_branch_is_what_shooting_tells_of_its_orbits():
    branch = single()
    for i, orbit in enumerate(branch.orbits):
        assert (branch.admissible[i], branch.stable[i]) == (orbit.admissible, orbit.stable)
        assert branch.names[i] == orbit.name
        assert branch.radial_speed[i] == pytest.approx(orbit.radial_speed, abs=1e-13)
        assert branch.angular_speed[i] == pytest.approx(orbit.angular_speed, abs=1e-13)
        assert np.sort(np.abs(branch.multipliers[i])) == pytest.approx(
            np.sort(np.abs(orbit.multipliers.values)), abs=1e-9
        )


def test_the_doubled_branch_begins_at_the_period_doubling():
    branch = doubled()
    assert "period-halving" in branch.stops
    (end,) = [point for point in branch.special if point.kind == "period-halving"]
    assert end.value == pytest.approx(DOUBLING, abs=1e-10)
    assert end.orbit.period == pytest.approx(
        2.0 * find_orbits(PAPER.replace(gamma=end.value))["B1,d"].period, abs=1e-12
    )
    assert (branch.unknowns.shape[1], len(branch.word)) == (10, 2)


def test_every_orbit_of_the_doubled_branch_solves_the_equations():
    assert max(orbit.links.size for orbit in doubled().orbits) < 1e-11
    assert np.abs([orbit.period for orbit in doubled().orbits] - doubled().period).max() < 1e-12


def test_admissible_orbits_of_the_doubled_branch_are_simulated_motions():
    branch, seen = doubled(), 0
    for orbit in branch.orbits[::3]:
        if not orbit.admissible:
            continue
        seen += 1
        at = orbit.section
        for expected in (*orbit.sections[1:], orbit.section):
            at = impact_map(orbit.rotor, at).image
            assert abs(np.exp(1j * at.angle) - np.exp(1j * expected.angle)) < 1e-9
            assert at.radial_speed == pytest.approx(expected.radial_speed, abs=1e-9)
    assert seen > 3


def test_the_stable_doubled_orbits_attract_and_end_where_they_graze():
    """From its birth down to its grazing the orbit of two impacts is stable; there a maximum of its radius meets the wall."""
    branch, grazing = doubled(), located("grazing", 0.08267)
    assert grazing.orbit.margins.radius == pytest.approx(0.0, abs=1e-9)
    real = [orbit for orbit in branch.orbits if orbit.admissible]
    assert all(orbit.stable for orbit in real if orbit.rotor.parameters.gamma < DOUBLING - 1e-5)
    assert min(orbit.rotor.parameters.gamma for orbit in real) > grazing.value
    for shift, inside in ((1e-6, True), (-1e-6, False)):
        rotor = jeffcott(PAPER.replace(gamma=grazing.value + shift))
        near = orbit_near(rotor, branch.word, ShootingStart(grazing.orbit.nodes, grazing.orbit.durations))
        assert near is not None
        assert near.admissible is inside
        if inside:
            motion = simulate(rotor, State(near.position, 1.00001 * near.departure.velocity), settle=True)
            assert same_orbit(orbit_of_motion(motion), near)


def test_beyond_the_grazing_the_branch_turns():
    """It goes on with virtual orbits, through the fold that a square root near grazing announces."""
    fold, grazing = located("fold", 0.08267), located("grazing", 0.08267)
    assert 0.0 < grazing.value - fold.value < 1e-5
    assert not fold.orbit.admissible
    apart = np.abs(fold.orbit.multipliers.values - 1.0).min()
    assert apart < 1e-4  # the square root of the error of its damping
    distances, periods = np.array([4e-6, 8e-6, 1.6e-5]), []
    for distance in distances:
        branch = continue_orbit(grazing.orbit, "gamma", (fold.value - 1e-5, fold.value + distance))
        assert branch.stops == ("parameter limit", "parameter limit")
        periods.append(abs(branch.period[-1] - branch.period[0]))
    slopes = np.diff(np.log(periods)) / np.diff(np.log(distances))
    assert slopes == pytest.approx([0.5, 0.5], abs=0.02)
