"""Arrivals at a rigid wall and their derivatives, against the law written with many digits; the same for one motion and for lanes."""

import math

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from carom.core.compiling.decorators import kernel
from carom.core.friction import (
    BACKWARD,
    FORWARD,
    STOPPED,
    friction_margin,
    landing,
    margin_of_slip,
    rolling_margin,
    sense_of,
    slip_of,
    velocity_change,
    velocity_change_by_law,
    velocity_change_by_speed,
    velocity_change_in_sense,
)
from carom.core.layout import WIDTH
from carom.core.vector import join, load, store
from carom.core.wall import Wall

EPSILON = 2.0**-52

speeds = st.floats(1e-9, 100.0)
turns = st.floats(-100.0, 100.0)
walls = st.builds(Wall, st.floats(0.0, 2.0), st.floats(0.0, 1.0), st.floats(-100.0, 100.0))


def exact_law(radial, angular, friction, restitution, surface_speed):
    """Velocity after the impact, with many digits; the law of equations (2.5) and (2.6) of the source paper."""
    impulse = (1 + restitution) * radial
    slip = surface_speed + angular
    loss = min(friction * impulse, abs(slip))
    after = angular - loss * mpmath.sign(slip)
    return mpmath.mpc(-restitution * radial, after)


@given(speeds, turns, walls)
def test_arrival_is_the_law(radial, angular, wall):
    local = complex(radial, angular)
    after = local + velocity_change(local, wall)
    size = radial + abs(angular) + abs(wall.surface_speed)
    with mpmath.workdps(40):
        expected = complex(exact_law(radial, angular, *wall[:3]))
    assert abs(after - expected) <= 8 * EPSILON * (1.0 + wall.friction) * size
    if sense_of(local, wall) == STOPPED:
        assert abs(slip_of(after, wall)) <= 8 * EPSILON * size
    else:
        assert math.copysign(1.0, slip_of(after, wall)) == sense_of(local, wall)
    assert velocity_change_in_sense(local, sense_of(local, wall), wall) == pytest.approx(
        velocity_change(local, wall), abs=4 * EPSILON * size
    )


@given(speeds, turns, walls)
def test_friction_opposes_slip_and_never_reverses_it(radial, angular, wall):
    local = complex(radial, angular)
    change, before = velocity_change(local, wall), slip_of(local, wall)
    after = slip_of(local + change, wall)
    rounding = 8 * EPSILON * (radial + abs(angular) + abs(wall.surface_speed))
    assert change.imag * before <= rounding * abs(before)
    assert before * after >= -rounding * abs(before)
    assert abs(change.imag) <= wall.friction * -change.real + rounding
    # Work on the contact point: mean of the velocities before and after times the impulse.
    work = -0.5 * (1.0 + wall.restitution) * (1.0 - wall.restitution) * radial**2 + 0.5 * change.imag * (before + after)
    assert work <= rounding * (radial + abs(before))


@kernel
def _arrivals(radial, angular, wall, changes):
    change = velocity_change(join(load(radial, 0), load(angular, 0)), wall)
    store(changes[0], 0, change.real)
    store(changes[1], 0, change.imag)


@kernel
def _arrival(local, wall):
    return velocity_change(local, wall)


@pytest.mark.parametrize("wall", [Wall(0.2, 0.9, 40.0), Wall(0.4, 0.0, -3.0), Wall(0.0, 1.0, 2.0)])
def test_it_is_one_law_for_python_one_motion_and_lanes(wall):
    radial, angular = np.random.default_rng(5).normal(size=(2, WIDTH)) * [[1.0], [40.0]]
    changes = np.empty((2, WIDTH))
    _arrivals(radial, angular, wall, changes)
    locals_ = radial + 1j * angular
    one_by_one = np.array([_arrival(local, wall) for local in locals_])
    np.testing.assert_allclose(changes[0] + 1j * changes[1], one_by_one, rtol=4 * EPSILON)
    np.testing.assert_allclose(velocity_change(locals_, wall), one_by_one, rtol=4 * EPSILON)


def test_no_slip_no_friction():
    wall = Wall(0.3, 0.8, 3.0)
    assert sense_of(0.5 - 3.0j, wall) == STOPPED
    assert velocity_change(0.5 - 3.0j, wall) == complex(-0.9, 0.0)


def test_friction_that_just_stops_the_slip_stops_it():
    """At the corner of the law, where all numbers are exact: the sense and the derivative are those of stopped slip."""
    wall = Wall(0.5, 1.0, 2.0)
    assert friction_margin(1.0 - 1.0j, wall) == 0.0
    assert sense_of(1.0 - 1.0j, wall) == STOPPED
    assert velocity_change(1.0 - 1.0j, wall) == -2.0 - 1.0j
    # Whatever the velocity along the wall, none is left after the impact; slipping on, it would stay as large.
    assert velocity_change_by_speed(1.0 - 1.0j, STOPPED, wall, 1j) == -1j


def test_without_friction_the_tangential_speed_stays():
    wall = Wall(0.0, 0.6, 50.0)
    assert sense_of(0.5 - 2.0j, wall) == FORWARD
    assert velocity_change(0.5 - 2.0j, wall) == pytest.approx(-0.8, abs=1e-15)


@pytest.mark.parametrize(("rebound", "change"), [(-0.5, 0.5 + 0.1j), (-9.0, 9.0 + 1.5j), (0.0, 0.0)])
def test_a_landing_takes_the_rebound_away_and_its_friction_no_more_than_the_slip(rebound, change):
    assert landing(complex(rebound, -1.5), Wall(0.2, 0.9, 3.0)) == pytest.approx(change, rel=1e-15)


REGIMES = {
    "forward slip": (0.4, -1.2, 0.15, 0.95, 58.0),
    "backward slip": (0.7, -70.0, 0.3, 0.5, 58.0),
    "slip stops": (0.7, -57.9, 0.3, 0.5, 58.0),
    "backward slip stops": (0.7, -58.1, 0.3, 0.5, 58.0),
    "no friction": (0.4, 3.0, 0.0, 1.0, 2.0),
    "no restitution": (0.4, 3.0, 0.2, 0.0, 2.0),
}


@pytest.mark.parametrize("regime", REGIMES)
@pytest.mark.parametrize("number", range(5))
def test_derivatives_against_many_digits(regime, number):
    """By both speeds, friction, restitution and surface speed: a difference quotient with a step of 1e-25 in 60 digits."""
    radial, angular, *numbers = REGIMES[regime]
    local, wall = complex(radial, angular), Wall(*numbers)
    sense = sense_of(local, wall)
    if number < 2:
        found = velocity_change_by_speed(local, sense, wall, (1.0, 1j)[number])
    else:
        found = velocity_change_by_law(
            local, sense, wall, Wall(*np.eye(3)[number - 2].tolist(), law=wall.law, law_number=wall.law_number)
        )
    with mpmath.workdps(60):
        step = mpmath.mpf(10) ** -25

        def change(sign):
            moved = [mpmath.mpf(each) + sign * step * (place == number) for place, each in enumerate(REGIMES[regime])]
            return exact_law(*moved) - mpmath.mpc(*moved[:2])

        # Friction is not negative: from zero on it can only grow.
        low = 0 if regime == "no friction" and number == 2 else -1
        exact = complex((change(1) - change(low)) / ((1 - low) * step))
    assert abs(found - exact) <= 32 * EPSILON * (radial + abs(angular) + abs(wall.surface_speed))


@pytest.mark.parametrize("regime", REGIMES)
def test_margins_vanish_where_the_sense_changes(regime):
    """Each number moved until its margin is gone: there the impulse is the same in both senses."""
    radial, _, friction, restitution, surface_speed = REGIMES[regime]
    if not friction:
        return
    most = friction * (1.0 + restitution) * radial
    for sense in (FORWARD, BACKWARD):
        local, wall = complex(radial, sense * most - surface_speed), Wall(friction, restitution, surface_speed)
        size = 1.0 + abs(surface_speed)
        assert margin_of_slip(local, sense, wall) == pytest.approx(0.0, abs=8 * EPSILON * size)
        assert margin_of_slip(local, STOPPED, wall) == pytest.approx(0.0, abs=8 * EPSILON * size)
        there = velocity_change_in_sense(local, sense, wall)
        assert there == pytest.approx(velocity_change_in_sense(local, STOPPED, wall), abs=8 * EPSILON * size)


def test_the_margin_of_an_impact_that_slips_is_the_slip_it_leaves():
    assert margin_of_slip(1.0 - 9.0j, BACKWARD, Wall(0.2, 0.5, 3.0)) == pytest.approx(5.7, rel=1e-15)
    assert margin_of_slip(1.0 + 0.0j, FORWARD, Wall(0.2, 0.5, 3.0)) == pytest.approx(2.7, rel=1e-15)


def test_the_cone_is_left_where_friction_would_have_to_pull_more():
    wall = Wall(0.25, 0.9, 3.0)
    assert (
        rolling_margin(4.0, 1.0, BACKWARD, wall) == 0.0
    )  # friction along growing angle is at its limit: backward slip
    assert rolling_margin(4.0, -1.0, FORWARD, wall) == 0.0
    assert rolling_margin(4.0, 0.5, FORWARD, wall) == 1.5


@given(
    st.floats(1e-3, 10.0),
    turns,
    st.floats(0.01, 1.0),
    st.floats(0.0, 1.0),
    st.floats(1.0, 100.0),
    st.floats(10, 1e3),
)
def test_coefficients_follow_from_velocities_measured_in_the_room(radial, angular, friction, restitution, ratio, speed):
    """The formulas of the page on measured impacts, in mm/s, for a rotor of radius ``ratio`` clearances at ``speed`` rad/s."""
    clearance = 0.4  # mm
    local, wall = complex(radial, angular), Wall(friction, restitution, ratio + 1.0)
    before, after = (clearance * speed * (moving + 1j) for moving in (local, local + velocity_change(local, wall)))
    size = abs(before) + ratio * clearance * speed
    slip = ratio * clearance * speed + after.imag
    assert -after.real / before.real == pytest.approx(restitution, abs=16 * EPSILON * size / before.real)
    pulled = abs(after.imag - before.imag) / (before.real - after.real)
    error = 16 * EPSILON * size / (before.real - after.real)
    if sense_of(local, wall) == STOPPED:
        assert abs(slip) <= 16 * EPSILON * size
        assert pulled <= friction + error
    else:
        assert pulled == pytest.approx(friction, abs=error)
