"""Branches of orbits of rotors that weigh something, along gravity and other parameters: folds, period doublings and borders."""

from __future__ import annotations

import math

import numpy as np
import pytest
from heavy_rotors import SOFT, settled

import carom as cm
from carom.bifurcations import Plane, continue_curve, switch
from carom.models import rotor_of
from carom.orbits import orbit_near, orbit_of_motion
from carom.outcome import InputError

pytestmark = pytest.mark.jit_only
HOPPING = cm.load("examples/dropped-rotor.toml").replace(
    gravity=60, unbalance="300 g mm", friction=0.05, damping="1500 N s/m", stiffness="8e5 N/m"
)
ROTOR = rotor_of(HOPPING)


@pytest.fixture(scope="module")
def orbit():
    return settled(ROTOR)


@pytest.fixture(scope="module")
def along_gravity(orbit):
    return cm.continue_orbit(orbit, "gravity", (20.0, 200.0))


@pytest.fixture(scope="module")
def doubling(along_gravity):
    return next(point for point in along_gravity.special if point.kind == "period-doubling" and point.admissible)


def point_of(branch, kind):
    return next(point for point in branch.special if point.kind == kind)


def stroboscopic_multipliers(rotor, orbit, step=1e-6):
    """Of the map over the period, by differences of simulations from the middle of the longest flight."""
    flight = int(np.argmax(orbit.durations))
    middle = float(orbit.durations[:flight].sum() + 0.5 * orbit.durations[flight])
    begin = cm.simulate(rotor, orbit.departure, middle).final
    state = np.array([begin.position, begin.velocity])

    def after(change):
        moved = state + change.view(complex)
        end = cm.simulate(rotor, cm.State(*moved, time=begin.time), orbit.period).final
        return np.array([end.position, end.velocity]).view(float)

    derivative = [(after(step * e) - after(-step * e)) / (2.0 * step) for e in np.eye(4)]
    return np.linalg.eigvals(np.transpose(derivative))


def test_all_orbits_of_a_branch_take_the_same_number_of_turns(along_gravity, orbit):
    assert along_gravity.period == pytest.approx(orbit.period, rel=1e-11)
    assert {each.turns for each in along_gravity.orbits} == {1}
    assert along_gravity.multipliers.shape == (len(along_gravity), 4)
    assert {"fold", "period-doubling", "grazing", "vanishing-impact"} <= {point.kind for point in along_gravity.special}


def test_at_a_period_doubling_the_stroboscopic_map_has_the_multiplier_minus_one(doubling):
    values = stroboscopic_multipliers(doubling.orbit.rotor, doubling.orbit)
    assert np.abs(values + 1.0).min() < 1e-6
    assert doubling.value == pytest.approx(doubling.orbit.rotor.value("gravity"))


def test_beyond_it_motions_settle_on_the_orbit_of_twice_as_many_turns(doubling):
    branch = switch(doubling, (50.0, 70.0))
    assert branch.period == pytest.approx(4.0 * math.pi, rel=1e-11)
    value = doubling.value - 0.15
    rotor = ROTOR.replace(gravity=value)
    (start,) = branch.starts_at(value)
    doubled = orbit_near(rotor, branch.word, start)
    assert (doubled.turns, doubled.impacts, doubled.stable, doubled.admissible) == (2, 4, True, True)
    beside = cm.State(doubled.departure.position, 1.001 * doubled.departure.velocity, time=doubled.time)
    reached = orbit_of_motion(cm.simulate(rotor, beside, settle=True))
    assert reached.turns == 2
    assert reached.nodes == pytest.approx(doubled.nodes, abs=1e-9)


def test_at_a_fold_two_orbits_meet_with_the_multiplier_one(along_gravity):
    fold = point_of(along_gravity, "fold")
    assert np.abs(stroboscopic_multipliers(fold.orbit.rotor, fold.orbit) - 1.0).min() < 1e-4
    below = along_gravity.starts_at(fold.value - 0.01)
    rotor = ROTOR.replace(gravity=fold.value - 0.01)
    pair = [orbit_near(rotor, along_gravity.word, start) for start in below]
    assert sorted(each.stable for each in pair) == [False, True]
    beyond = ROTOR.replace(gravity=fold.value + 0.05)
    assert orbit_near(beyond, along_gravity.word, fold.orbit.start) is None


def test_at_a_grazing_border_the_simulated_orbit_touches_the_wall(along_gravity):
    grazing = point_of(along_gravity, "grazing")
    orbit = grazing.orbit
    # From each impact to the next, by simulation of the flight alone.
    radii = []
    for begin, duration in zip(np.cumsum(orbit.durations) - orbit.durations, orbit.durations, strict=True):
        times = begin + duration * np.linspace(0.02, 0.98, 20_001)
        radii.append(np.abs(orbit.path(times)).max())
    assert max(radii) == pytest.approx(1.0, abs=1e-7)


def test_a_vanishing_impact_is_a_border_to_the_orbit_without_it(along_gravity):
    branch = switch(point_of(along_gravity, "vanishing-impact"))
    assert str(branch.word) == "impact+"
    assert {each.turns for each in branch.orbits} == {1}


@pytest.mark.parametrize(
    ("name", "interval"), [("speed", (850.0, 1000.0)), ("damping", (1400.0, 1600.0)), ("d", (0.48, 0.52))]
)
def test_orbits_are_followed_along_other_parameters_under_the_same_weight(name, interval, orbit):
    branch = cm.continue_orbit(orbit, name, interval)
    for value, start in zip(branch.values[::5].tolist(), branch.orbits[::5], strict=True):
        case = HOPPING.replace(**{name if name != "d" else "restitution": value})
        again = orbit_near(rotor_of(case), branch.word, start.start)
        assert again.nodes == pytest.approx(start.nodes, abs=1e-9)
        assert again.turns == 1


def test_a_period_doubling_is_followed_in_two_parameters(doubling):
    plane = Plane("damping", "friction", (1300.0, 1700.0), (0.0, 0.1))
    curve = continue_curve(doubling, plane)
    assert len(curve.points) > 5
    damping, friction = curve.points[-1].tolist()
    rotor = doubling.orbit.rotor.replace(damping=damping, friction=friction)
    found = orbit_near(rotor, doubling.orbit.word, doubling.orbit.start)
    assert np.abs(found.multipliers.values + 1.0).min() < 1e-6


def test_orbits_in_walls_that_give_way_are_followed():
    rotor, _ = SOFT["bouncing"]
    orbit = settled(rotor)
    branch = cm.continue_orbit(orbit, rotor_parameter(rotor), (0.27, 0.33))
    assert branch.period == pytest.approx(orbit.period, rel=1e-10)
    assert branch.admissible.all()


def rotor_parameter(rotor):
    """A damping of a rotor that is given by matrices."""
    return next(name for name in rotor.varied if "damping" in name or name == "gamma")


def test_gravity_is_a_parameter_of_a_rotor_that_weighs_something_alone():
    with pytest.raises(InputError, match=r"^gravity = to vary: unknown name"):
        cm.models.axis(ROTOR.unforced, "gravity")
    assert cm.models.axis(HOPPING, "gravity").field.unit == "m/s^2"


def test_all_branches_on_an_interval_are_found_and_levitation_reaches_the_wall():
    diagram = cm.find_bifurcations(HOPPING, "gravity", (26.0, 36.0))
    assert diagram.orbits
    for branch in diagram.orbits:
        turns = branch.period / math.tau
        assert turns == pytest.approx(np.round(turns), rel=1e-11)
    levitation, *rubs = diagram.equilibria
    assert [branch.kind for branch in rubs] == ["stable rub", "saddle rub"]
    assert np.isnan([branch.radius for branch in rubs]).all()
    held = levitation.values[levitation.admissible].max()
    assert cm.closed_forms.levitation(HOPPING.replace(gravity=held)).inside
    assert not cm.closed_forms.levitation(HOPPING.replace(gravity=held + 0.06)).inside
