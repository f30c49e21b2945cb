"""The impact law and its derivative, against the law written in polar coordinates with many digits."""

from __future__ import annotations

import cmath
import math

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from carom.core.impact import set_on_wall, strike, strike_variation, unit
from carom.core.layout import rotor_record

EPSILON = 2.0**-52

angles = st.floats(-math.pi, math.pi)
speeds = st.floats(1e-9, 100.0)
turns = st.floats(-100.0, 100.0)
frictions = st.floats(0.0, 2.0)
restitutions = st.floats(0.0, 1.0)
drives = st.floats(-100.0, 100.0)


def state(angle, radial, angular):
    """Position and velocity on the wall."""
    normal = cmath.rect(1.0, angle)
    return normal, complex(radial, angular) * normal


def polar_law(angle, radial, angular, friction, restitution, drive):
    """Velocity after the impact, with many digits; the law of equations (2.5) and (2.6) of the source paper."""
    impulse = (1 + restitution) * radial
    slip = drive + angular
    loss = min(friction * impulse, abs(slip))
    after = angular - loss * mpmath.sign(slip)
    return mpmath.mpc(-restitution * radial, after) * mpmath.expj(angle)


@given(angles, speeds, turns, frictions, restitutions, drives)
def test_strike_is_the_law(angle, radial, angular, friction, restitution, drive):
    position, velocity = state(angle, radial, angular)
    change, sticks = strike(position, velocity, friction, restitution, drive)
    size = radial + abs(angular) + abs(drive)
    with mpmath.workdps(40):
        expected = complex(polar_law(angle, radial, angular, friction, restitution, drive))
    assert abs(velocity + change - expected) <= 8 * EPSILON * (1.0 + friction) * size
    local = (velocity + change) * position.conjugate()
    slip_before, slip_after = drive + angular, drive + local.imag
    assert local.real == pytest.approx(-restitution * radial, abs=8 * EPSILON * size)
    if sticks:
        assert abs(slip_after) <= 8 * EPSILON * size
    else:
        assert friction * (1.0 + restitution) * radial < abs(slip_before) + 8 * EPSILON * size


@given(angles, speeds, turns, frictions, restitutions, drives)
def test_friction_opposes_slip_and_never_reverses_it(angle, radial, angular, friction, restitution, drive):
    position, velocity = state(angle, radial, angular)
    change, _ = strike(position, velocity, friction, restitution, drive)
    local = change * position.conjugate()
    before = drive + (velocity * position.conjugate()).imag
    after = before + local.imag
    rounding = 8 * EPSILON * (radial + abs(angular) + abs(drive))
    assert local.imag * before <= rounding * abs(before)
    assert before * after >= -rounding * abs(before)
    assert abs(local.imag) <= friction * -local.real + rounding
    # Work on the contact point: mean of the velocities before and after times the impulse.
    work = -0.5 * (1.0 + restitution) * (1.0 - restitution) * radial**2 + 0.5 * local.imag * (before + after)
    assert work <= rounding * (radial + abs(before))


@given(angles, angles, speeds, turns, frictions, restitutions, drives)
def test_the_law_turns_with_the_rotor(angle, turn, radial, angular, friction, restitution, drive):
    position, velocity = state(angle, radial, angular)
    rotation = cmath.rect(1.0, turn)
    change, _ = strike(position, velocity, friction, restitution, drive)
    turned, _ = strike(rotation * position, rotation * velocity, friction, restitution, drive)
    size = (radial + abs(angular) + abs(drive)) * (1.0 + friction)
    assert abs(turned - rotation * change) <= 32 * EPSILON * size


def test_no_slip_no_friction():
    change, sticks = strike(1.0 + 0j, 0.5 - 3.0j, 0.3, 0.8, 3.0)
    assert sticks
    assert change == complex(-0.9, 0.0)


def test_friction_that_just_stops_the_slip_stops_it():
    """At the corner of the law, where all numbers are exact: the flag and the derivative are those of stopped slip."""
    position, velocity, law = 1.0 + 0j, 1.0 - 1.0j, (0.5, 1.0, 2.0)
    change, sticks = strike(position, velocity, *law)
    assert sticks
    assert change == -2.0 - 1.0j
    # Whatever the velocity along the wall, none is left after the impact; slipping on, it would stay as large.
    assert strike_variation(position, velocity, *law, 0j, 1j) == -1j


def test_without_friction_the_tangential_speed_stays():
    change, sticks = strike(1j, 0.5j + 2.0, 0.0, 0.6, 50.0)
    assert not sticks
    assert change == pytest.approx(-0.8j, abs=1e-15)


REGIMES = {
    "forward slip": (0.3, 0.4, -1.2, 0.15, 0.95, 58.0),
    "backward slip": (-2.0, 0.7, -70.0, 0.3, 0.5, 58.0),
    "slip stops": (1.1, 0.7, -57.9, 0.3, 0.5, 58.0),
    "backward slip stops": (1.1, 0.7, -58.1, 0.3, 0.5, 58.0),
    "no friction": (2.9, 0.4, 3.0, 0.0, 1.0, 2.0),
    "no restitution": (2.9, 0.4, 3.0, 0.2, 0.0, 2.0),
}


@pytest.mark.parametrize("regime", REGIMES)
@pytest.mark.parametrize("direction", range(4))
def test_variation_against_many_digits(regime, direction):
    """A difference quotient with a step of 1e-25 in 60 digits: the derivative to the last bit."""
    angle, radial, angular, friction, restitution, drive = REGIMES[regime]
    changes = [(0.3 + 0.1j, 0.0), (1j * cmath.rect(1.0, angle), 0.0), (0.0, 0.7 - 0.2j), (-0.2j, 1.3j)]
    position_change, velocity_change = (complex(part) for part in changes[direction])
    position, velocity = state(angle, radial, angular)
    found = strike_variation(position, velocity, friction, restitution, drive, position_change, velocity_change)
    with mpmath.workdps(60):
        step = mpmath.mpf(10) ** -25

        def change(sign):
            moved = mpmath.mpc(position) + sign * step * mpmath.mpc(position_change)
            speed = mpmath.mpc(velocity) + sign * step * mpmath.mpc(velocity_change)
            heading = mpmath.arg(moved)
            local = speed * mpmath.expj(-heading)
            return polar_law(heading, local.real, local.imag, friction, restitution, drive) - speed

        exact = complex((change(1) - change(-1)) / (2 * step))
    size = radial + abs(angular) + abs(drive)
    assert abs(found - exact) <= 32 * EPSILON * size


@pytest.mark.parametrize("regime", REGIMES)
def test_only_the_direction_of_the_position_counts_and_what_turns_it(regime):
    """Four times as far out a change of the position turns it by a quarter."""
    angle, radial, angular, *law = REGIMES[regime]
    position, velocity = state(angle, radial, angular)
    position_change, velocity_change = 0.3 + 0.7j, -0.2 + 1.3j
    assert strike(4.0 * position, velocity, *law)[0] == pytest.approx(strike(position, velocity, *law)[0], rel=1e-14)
    near = strike_variation(position, velocity, *law, position_change, velocity_change)
    far = strike_variation(4.0 * position, velocity, *law, 4.0 * position_change, velocity_change)
    assert far == pytest.approx(near, rel=1e-12)


@given(st.complex_numbers(min_magnitude=1e-100, max_magnitude=1e100, allow_nan=False, allow_infinity=False))
def test_unit(z):
    assert abs(unit(z) - z / abs(z)) <= 4 * EPSILON


def test_set_on_wall_is_the_smallest_change():
    random = np.random.default_rng(3)
    row = random.normal(size=3) + 1j * random.normal(size=3)
    arrays = rotor_record(
        exponents=np.array([-0.1 + 1j, -0.2, -1j]),
        driven=np.zeros(3, bool),
        offsets=np.array([0.3 - 0.2j]),
        rows=row[None],
        columns=np.ones((3, 1), complex),
        friction=np.zeros(1),
        restitution=np.ones(1),
        drive=np.ones(1),
    )
    start = random.normal(size=3) + 1j * random.normal(size=3)
    amplitudes = start.copy()
    set_on_wall(arrays, 0, amplitudes)
    before, after = arrays.offsets[0] + row @ start, arrays.offsets[0] + row @ amplitudes
    size = abs(arrays.offsets[0]) + np.abs(row * start).sum()
    assert abs(after) == pytest.approx(1.0, abs=4 * EPSILON * size)
    assert abs(after - before / abs(before)) <= 8 * EPSILON * size
    # The smallest change that moves the plane by this much is along the conjugate of its row.
    expected, *_ = np.linalg.lstsq(row[None], np.array([after - before]), rcond=None)
    assert np.allclose(amplitudes - start, expected, rtol=0, atol=1e-14)


@given(
    angles,
    st.floats(1e-3, 10.0),
    turns,
    st.floats(0.01, 1.0),
    st.floats(0.0, 1.0),
    st.floats(1.0, 100.0),
    st.floats(10, 1e3),
)
def test_coefficients_follow_from_velocities_measured_in_the_room(
    angle, radial, angular, friction, restitution, ratio, speed
):
    """The formulas of the page on measured impacts, in mm/s, for a rotor of radius ``ratio`` clearances at ``speed`` rad/s."""
    clearance = 0.4  # mm
    position, velocity = state(angle, radial, angular)
    change, sticks = strike(position, velocity, friction, restitution, ratio + 1.0)
    before, after = (
        clearance * speed * (moving + 1j * position) / position for moving in (velocity, velocity + change)
    )
    size = abs(before) + ratio * clearance * speed
    slip = ratio * clearance * speed + after.imag
    assert -after.real / before.real == pytest.approx(restitution, abs=16 * EPSILON * size / before.real)
    pulled = abs(after.imag - before.imag) / (before.real - after.real)
    error = 16 * EPSILON * size / (before.real - after.real)
    if sticks:
        assert abs(slip) <= 16 * EPSILON * size
        assert pulled <= friction + error
    else:
        assert pulled == pytest.approx(friction, abs=error)
