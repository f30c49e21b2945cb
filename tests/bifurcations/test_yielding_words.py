"""Branches of orbits in walls that give way: special points against the orbits and motions on both sides of them."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from yielding_rotors import Yielding, packed

import carom as cm
from carom.bifurcations import Plane, continue_curve, continue_orbit, switch
from carom.models import HuntCrossley, KelvinVoigt
from carom.orbits import Kind, orbit_near, orbit_of_motion
from tests.orbits.test_yielding_orbits import CROSSLEY, VOIGT, settled

pytestmark = pytest.mark.jit_only


@pytest.fixture(scope="module")
def branch():
    return continue_orbit(settled(VOIGT), "gamma", (0.05, 0.2))


@pytest.fixture(scope="module")
def special(branch):
    return {point.kind: point for point in branch.special}


def test_special_points_of_a_branch(branch, special):
    assert [point.kind for point in branch.special] == ["grazing", "period-doubling", "fold"]
    assert all(point.admissible for point in branch.special)
    assert all(orbit.links.size < 1e-11 for orbit in branch.orbits)
    assert branch.radial_speed.min() > 0.2


def test_where_a_flight_grazes_its_highest_point_is_at_the_wall(special):
    orbit = special["grazing"].orbit
    rotor = dataclasses.replace(VOIGT, gamma=special["grazing"].value)
    (place,) = np.flatnonzero(orbit.word.kinds == Kind.LIFT)
    state, times = packed(*orbit.nodes[place]), np.linspace(0.0, orbit.durations[place], 400)[1:-1]
    radii = [np.hypot(*rotor.follow(state, time)[:2]) for time in times[::8]]
    near = times[::8][int(np.argmax(radii))]
    closer = [np.hypot(*rotor.follow(state, time)[:2]) for time in near + np.linspace(-0.1, 0.1, 41)]
    top = np.polyfit(np.linspace(-0.1, 0.1, 41), closer, 6)
    assert np.polyval(top, np.roots(np.polyder(top)).real).max() == pytest.approx(1.0, abs=1e-8)
    assert special["grazing"].orbit.margins.radius == pytest.approx(0.0, abs=1e-9)


def test_below_the_period_doubling_motions_repeat_after_two_contacts(special):
    point = special["period-doubling"]
    assert np.abs(point.orbit.multipliers.values + 1.0).min() < 1e-7
    doubled = switch(point, (0.07, 0.08))
    assert str(doubled.word) == "slide+ free lift slide+ free lift"
    assert "period-halving" in doubled.stops
    stable = [orbit for orbit in doubled.orbits if orbit.admissible and orbit.stable]
    assert stable
    for orbit in stable[:: max(1, len(stable) // 2)]:
        state = orbit.departure
        motion = cm.simulate(orbit.rotor, cm.State(state.position, 1.0001 * state.velocity), settle=True)
        found = orbit_of_motion(motion)
        assert found.impacts == 2
        assert found.period == pytest.approx(orbit.period, rel=1e-9)


def test_two_orbits_meet_in_the_fold(branch, special):
    point = special["fold"]
    beside = point.value - 2e-4
    pair = branch.starts_at(beside)
    assert len(pair) == 2
    rotor = dataclasses.replace(VOIGT, gamma=beside).model
    orbits = [orbit_near(rotor, branch.word, start) for start in pair]
    assert sorted(orbit.stable for orbit in orbits) == [False, True]
    apart = [abs(orbit.period - point.period) for orbit in orbits]
    assert apart[0] == pytest.approx(apart[1], rel=0.02)  # the root of the distance in γ is 0.014
    beyond = dataclasses.replace(VOIGT, gamma=point.value + 1e-4).model
    assert all(orbit_near(beyond, branch.word, start) is None for start in pair)


def test_beside_the_grazing_there_is_an_orbit_with_one_more_contact(special):
    point = special["grazing"]
    other = switch(point, (point.value - 0.002, point.value + 0.002))
    assert str(other.word) == "slide+ free lift slide+ free lift"
    motions = [orbit for orbit in other.orbits if orbit.admissible]
    assert min(orbit.impact_speeds.min() for orbit in motions) < 0.1 * max(
        orbit.impact_speeds.min() for orbit in motions
    )


def test_flights_vanish_where_contact_becomes_permanent():
    branch = continue_orbit(settled(CROSSLEY), "gamma", (0.09, 0.3))
    assert branch.stops[1] == "permanent-contact"
    point = branch.special[-1]
    assert point.kind == "permanent-contact"
    assert str(point.orbit.word) == "slide+"
    rotor = dataclasses.replace(CROSSLEY, gamma=point.value)
    state = packed(*point.orbit.nodes[0])
    assert np.hypot(*state[:2]) - 1.0 == pytest.approx(0.0, abs=1e-9)
    assert rotor.follow(state, point.orbit.period, "+") == pytest.approx(state, abs=1e-9)


@pytest.mark.parametrize("kind", ["period-doubling", "fold", "grazing"])
def test_curves_of_special_points(special, kind):
    curve = continue_curve(special[kind], Plane("gamma", "mu", (0.04, 0.2), (0.14, 0.155)))
    for first, second in curve.points[[0, len(curve.points) // 2, -1]].tolist():
        start = continue_orbit(settled(VOIGT), "mu", (0.135, 0.16)).starts_at(second)[0]
        orbit = orbit_near(dataclasses.replace(VOIGT, mu=second).model, special[kind].orbit.word, start)
        found = [point.value for point in continue_orbit(orbit, "gamma", (0.04, 0.2)).special if point.kind == kind]
        assert min(abs(value - first) for value in found) < 1e-7


@pytest.mark.parametrize("parameter", ["wall_stiffness", "wall_damping", "mu"])
def test_branches_along_numbers_of_the_wall_pass_through_orbits_found_there(parameter):
    start = settled(VOIGT)
    value = {"wall_stiffness": 1e3, "wall_damping": 2.0, "mu": 0.15}[parameter]
    branch = continue_orbit(start, parameter, (0.8 * value, 1.25 * value))
    assert branch.stops == ("parameter limit", "parameter limit")
    changed = {
        "wall_stiffness": Yielding(KelvinVoigt(1.2e3, 2.0)),
        "wall_damping": Yielding(KelvinVoigt(1e3, 2.4)),
        "mu": Yielding(VOIGT.law, mu=0.18),
    }[parameter]
    there = settled(changed)
    apart = [abs(found.durations.sum() - there.period) for found in branch.starts_at(1.2 * value)]
    assert min(apart) < 1e-11 * there.period


def test_a_branch_in_a_wall_whose_force_is_a_power_of_the_depth():
    rotor = Yielding(HuntCrossley(2e4, 0.05, 1.5))
    branch = continue_orbit(settled(rotor), "gamma", (0.09, 0.12))
    there = settled(dataclasses.replace(rotor, gamma=0.11))
    (found,) = branch.starts_at(0.11)
    assert found.durations.sum() == pytest.approx(there.period, rel=1e-11)
