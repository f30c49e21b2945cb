"""The parts of lasting contact that decide how long it lasts, each alone, on series written down for it."""

import cmath
import itertools
import math

import numpy as np
import pytest
from flights import EPSILON, plain_record
from machines import PAPER

from carom.base.outcome import Phase
from carom.core import contact_series, rub, taylor
from carom.core.flow import displacement, fly_all, velocity
from carom.core.layout import ORDER, rub_workspace
from carom.core.records import record
from carom.core.rounding import push_rounding, speed_rounding
from carom.models import jeffcott

FLIGHT, FORWARD, BACKWARD, ROLLING, SEPARATED = (int(phase) for phase in Phase)
FRICTION = 0.25
ARRAYS = jeffcott(PAPER.replace(mu=FRICTION)).system.arrays


def falling(time, height=1.0, order=1):
    """Coefficients of a margin that falls from a height to zero at a time, by one power of time alone."""
    margin = np.zeros(ORDER + 1)
    margin[0], margin[order] = height, -height / time**order
    return margin


def transition(phase, step, *, push, slip=None, grip=None):
    """What comes first of margins that are given."""
    work = rub_workspace(2)
    work.push[:] = push
    if slip is not None:
        work.slip[:] = slip
    if grip is not None:
        work.grip[:] = grip
    return rub.first_transition(ARRAYS, 0, int(phase), step, work)


# ---------------------------------------------------------------------------------------------------- transitions


@pytest.mark.parametrize(("phase", "sign"), [(FORWARD, 1.0), (BACKWARD, -1.0)])
def test_sliding_ends_with_the_first_of_push_and_slip(phase, sign):
    lasts = np.full(ORDER + 1, 0.0)
    lasts[0] = 1.0
    assert transition(phase, 0.5, push=lasts, slip=sign * lasts) == (0.5, phase, False)
    assert transition(phase, 0.5, push=falling(0.3), slip=sign * lasts) == (pytest.approx(0.3), FLIGHT, False)
    assert transition(phase, 0.5, push=lasts, slip=sign * falling(0.3)) == (pytest.approx(0.3), phase, True)
    assert transition(phase, 0.5, push=falling(0.3), slip=sign * falling(0.2)) == (pytest.approx(0.2), phase, True)
    assert transition(phase, 0.5, push=falling(0.2), slip=sign * falling(0.3)) == (pytest.approx(0.2), FLIGHT, False)
    assert transition(phase, 0.5, push=falling(0.6), slip=sign * falling(0.7)) == (0.5, phase, False)
    # Slip of the other sign has ended.
    assert transition(phase, 0.5, push=lasts, slip=-sign * lasts) == (0.0, phase, True)


def test_rolling_ends_with_the_first_of_push_and_the_sides_of_the_cone():
    def rolls(push, forward, backward, step=0.5):
        """The friction it needs leaves the cone on each side at a given time, or never."""
        work = rub_workspace(2)
        work.push[:] = push
        sides = {1.0: forward, -1.0: backward}
        for side, time in sides.items():
            if time is not None:
                # The margin μN + side·G falls where G does as much more than μN.
                work.grip[:] = side * (falling(time) - FRICTION * push)
        return rub.first_transition(ARRAYS, 0, ROLLING, step, work)

    lasts = np.zeros(ORDER + 1)
    lasts[0] = 8.0
    assert rolls(lasts, None, None) == (0.5, ROLLING, False)
    assert rolls(falling(0.3, 8.0), None, None) == (pytest.approx(0.3), FLIGHT, False)
    assert rolls(lasts, 0.3, None) == (pytest.approx(0.3), FORWARD, False)
    assert rolls(lasts, None, 0.3) == (pytest.approx(0.3), BACKWARD, False)
    assert rolls(falling(0.4, 8.0), 0.3, None) == (pytest.approx(0.3), FORWARD, False)
    assert rolls(falling(0.4, 8.0), None, 0.3) == (pytest.approx(0.3), BACKWARD, False)
    assert rolls(lasts, 0.6, None) == rolls(lasts, None, 0.6) == (0.5, ROLLING, False)


def test_margins_within_their_rounding_do_not_end_a_phase():
    """The push may fall below zero by its rounding error, the room in the cone by that of both its terms."""
    amplitudes = np.array([0.3 + 0.1j, -0.2j])
    rounding = push_rounding(ARRAYS, 0, amplitudes)
    lasts = np.zeros(ORDER + 1)
    lasts[0] = 1.0
    for share, ends in ((0.9, False), (1.1, True)):
        work = rub_workspace(2)
        work.series[0] = amplitudes
        work.push[0, 0], slip = 1.0, share * speed_rounding(ARRAYS, 0, amplitudes) * lasts
        for side, phase in ((-1.0, FORWARD), (1.0, BACKWARD)):
            work.slip[:] = side * slip
            assert rub.first_transition(ARRAYS, 0, phase, 0.5, work) == ((0.0 if ends else 0.5), phase, ends)
        work.slip[:], work.push[0, 0] = lasts, -share * rounding
        assert rub.first_transition(ARRAYS, 0, FORWARD, 0.5, work) == (
            (0.0, FLIGHT, False) if ends else (0.5, FORWARD, False)
        )
        for side, phase in ((1.0, BACKWARD), (-1.0, FORWARD)):
            work.push[0, 0] = 1.0
            work.grip[0, 0] = side * (FRICTION + share * (1.0 + FRICTION) * rounding)
            expected = (0.0, phase, False) if ends else (0.5, ROLLING, False)
            assert rub.first_transition(ARRAYS, 0, ROLLING, 0.5, work) == expected


@pytest.mark.parametrize("order", [ORDER - 1, ORDER])
def test_all_coefficients_of_a_margin_count(order):
    """Margins that fall by their highest powers alone."""
    time = pytest.approx(0.3, abs=1e-12)
    lasts = falling(1e9, 8.0)
    late = falling(0.3, order=order)
    assert transition(FORWARD, 0.5, push=late, slip=lasts) == (time, FLIGHT, False)
    assert transition(FORWARD, 0.5, push=lasts, slip=late) == (time, FORWARD, True)
    for side, phase in ((1.0, FORWARD), (-1.0, BACKWARD)):
        grip = side * (late - FRICTION * lasts)
        assert transition(ROLLING, 0.5, push=lasts, grip=grip) == (time, phase, False)
    work = rub_workspace(2)
    work.position[:] = -1j * late
    assert rub.turn_ahead(0, 1.0 + 0j, 1.0, 0.5, work) == time


def test_rest_on_the_wall_keeps_the_angle_and_the_speed_along_it():
    """From well off the wall, moving across it: the nearest place, and no radial speed; rolling, no slip either."""
    random = np.random.default_rng(4)
    for rolling in (False, True):
        for _ in range(5):
            amplitudes = random.normal(size=2) + 1j * random.normal(size=2)
            angle = cmath.phase(displacement(ARRAYS, 0, amplitudes))
            rub.set_on_wall(ARRAYS, 0, amplitudes)
            before = displacement(ARRAYS, 0, amplitudes).conjugate() * velocity(ARRAYS, 0, amplitudes)
            rub.rest_on_wall(ARRAYS, 0, amplitudes, rolling)
            position = displacement(ARRAYS, 0, amplitudes)
            local = position.conjugate() * velocity(ARRAYS, 0, amplitudes)
            assert position == pytest.approx(cmath.rect(1.0, angle), abs=1e-13)
            assert local.real == pytest.approx(0.0, abs=1e-12)
            assert local.imag == pytest.approx(-ARRAYS.surface_speed[0] if rolling else before.imag, abs=1e-12)


def test_motions_in_different_phases_are_moved_each_in_its_own():
    random = np.random.default_rng(8)
    amplitudes = random.normal(size=(4, 2)) + 1j * random.normal(size=(4, 2))
    for row in amplitudes:
        rub.rest_on_wall(ARRAYS, 0, row, True)
    times, phases = np.array([2e-3, 3.0, 3e-3, 4e-3]), np.array([FORWARD, FLIGHT, ROLLING, BACKWARD])
    moved = rub.fly_or_rub_all(
        ARRAYS, amplitudes, phases[:, None], np.zeros((len(times), 0), np.int64), times, times, rub_workspace(2)
    )
    for i, phase in enumerate(phases):
        if phase == FLIGHT:
            expected = fly_all(ARRAYS, amplitudes[i : i + 1], times[i : i + 1])[0]
        else:
            work, expected = rub_workspace(2), np.empty(2, complex)
            contact_series.rub_series(ARRAYS, np.array([int(phase)]), amplitudes[i], work)
            taylor.sum_series(work, times[i], expected)
        assert moved[i] == pytest.approx(expected, rel=1e-14)
        assert (abs(abs(displacement(ARRAYS, 0, moved[i])) - 1.0) < 1e-13) == (phase != FLIGHT)


def pressed_rotor(friction, acceleration):
    """A rotor at ``y = 1`` with this acceleration, whose amplitudes are displacement and velocity themselves."""
    fields = {name: np.array(ARRAYS[name]) for name in ARRAYS.dtype.names}
    fields["offsets"][:], fields["weights"][:], fields["surface_speed"][:], fields["friction"][:] = (
        0.0,
        1.0,
        1.0,
        friction,
    )
    fields["rows"][:], fields["rate_rows"][:], fields["acceleration_rows"][:] = (
        (1.0, 0.0),
        (0.0, 1.0),
        (acceleration, 0.0),
    )
    return record(**fields)


def test_what_goes_on_without_slip_is_decided_by_the_cone_of_friction_and_its_rounding():
    """A normal force below zero, by rounding alone, counts as zero, however large the friction."""
    motion = np.array([1.0, -1j])
    for friction, push, side, share in itertools.product((0.1, 5.0), (0.5, 0.0, None), (1.0, -1.0), (0.9, 1.1)):
        acceleration = complex((push or 0.0) - 1.0, side * friction * (push or 0.0))
        rounding = push_rounding(pressed_rotor(friction, acceleration), 0, motion)
        acceleration += complex(-0.9 * rounding if push is None else 0.0, side * share * rounding)
        slips = FORWARD if side > 0.0 else BACKWARD
        following = rub.next_phase(
            pressed_rotor(friction, acceleration), np.array([ROLLING]), 0, motion, rub_workspace(2)
        )
        assert following == (ROLLING if share < 1.0 else slips)


# ----------------------------------------------------------------------------------------------- length of a step


def geometric(work, mode, start, radius):
    """Coefficients of ``start/(1 − t/radius)``."""
    work.series[:, mode] = start / radius ** np.arange(ORDER + 1.0)


def test_a_step_is_the_same_share_of_the_radius_of_convergence_at_any_scale():
    for start, radius in ((1.0, 0.5), (40.0, 0.02), (40.0, 3.0)):
        work = rub_workspace(2)
        geometric(work, 0, start, radius)
        assert taylor.series_step(work) == pytest.approx(taylor.STEP_FRACTION * radius, rel=1e-12)
        geometric(work, 1, 0.5j * start, 0.5 * radius)
        assert taylor.series_step(work) < taylor.STEP_FRACTION * radius
        # What is left out, summed up, is below the rounding of the sum.
        left_out = start * taylor.STEP_FRACTION ** (ORDER + 1) / (1.0 - taylor.STEP_FRACTION)
        assert left_out < EPSILON * start
    # Amplitudes below one are measured by one.
    geometric(work, 0, 1e-3, 0.5)
    geometric(work, 1, 0.0, 1.0)
    assert taylor.series_step(work) == pytest.approx(taylor.STEP_FRACTION * 0.5 * 1e3 ** (1.0 / ORDER), rel=1e-12)


def test_either_of_the_last_two_coefficients_decides_where_the_other_is_zero():
    for order in (ORDER, ORDER - 1):
        work = rub_workspace(2)
        work.series[0, 0], work.series[order, 1] = 2.0, 2.0j * 5.0**order
        assert taylor.series_step(work) == pytest.approx(taylor.STEP_FRACTION / 5.0, rel=1e-12)
        work.series[order, 1] = 2.0j * 0.5**order
        assert taylor.series_step(work) == pytest.approx(taylor.STEP_FRACTION * 2.0, rel=1e-12)
        work.series[order, 1] = 2.0j * 5.0**order
    work.series[ORDER, 0] = 2.0 * 4.0**ORDER
    assert taylor.series_step(work) == pytest.approx(taylor.STEP_FRACTION / 5.0, rel=1e-12)
    work.series[ORDER, 0] = 2.0 * 6.0**ORDER
    assert taylor.series_step(work) == pytest.approx(taylor.STEP_FRACTION / 6.0, rel=1e-12)


def test_a_step_of_a_rotor_at_rest_ends_at_one():
    assert taylor.series_step(rub_workspace(2)) == 1.0
    work = rub_workspace(2)
    geometric(work, 0, 1.0, 100.0)
    assert taylor.series_step(work) == 1.0


def test_a_sum_is_that_of_the_series():
    random = np.random.default_rng(5)
    work, moved = rub_workspace(3), np.empty(3, complex)
    work.series[:] = random.normal(size=(ORDER + 1, 3)) + 1j * random.normal(size=(ORDER + 1, 3))
    for time in (0.0, 0.3, 1.1):
        taylor.sum_series(work, time, moved)
        assert moved == pytest.approx(time ** np.arange(ORDER + 1.0) @ work.series, rel=1e-14)


# ---------------------------------------------------------------------------------------------------------- rounding


def sizes(terms):
    return np.abs(terms.real) + np.abs(terms.imag)


def test_rounding_errors_are_the_sums_of_the_sizes_of_their_terms():
    random = np.random.default_rng(6)
    for _ in range(20):
        arrays = plain_record(
            exponents=random.normal(size=2) + 1j * random.normal(size=2),
            driven=np.zeros(2, bool),
            offsets=random.normal(size=1) + 1j * random.normal(size=1),
            rows=random.normal(size=(1, 2)) + 1j * random.normal(size=(1, 2)),
        )
        amplitudes = random.normal(size=2) + 1j * random.normal(size=2)
        spread = sizes(arrays.offsets)[0] + sizes(arrays.rows[0] * amplitudes).sum()
        rates, speed = 1.0 + sizes(arrays.rate_rows[0] * amplitudes).sum(), sizes(arrays.rate_rows[0] @ amplitudes)
        assert speed_rounding(arrays, 0, amplitudes) == pytest.approx(
            64 * EPSILON * (rates + spread * speed), rel=1e-12, abs=0.0
        )
        row = arrays.acceleration_rows[0]
        lever = sizes(row * arrays.rows[0]).sum() / (np.abs(arrays.rows[0]) ** 2).sum()
        force = sizes(row * amplitudes).sum() + 2 * speed * (rates - 1.0) + spread * (sizes(row @ amplitudes) + lever)
        assert push_rounding(arrays, 0, amplitudes) == pytest.approx(64 * EPSILON * force, rel=1e-12, abs=0.0)


# ------------------------------------------------------------------------------------------------------- first falls


def polynomial(*roots, lead=1.0):
    """Coefficients of a margin with these zeros, from the lowest power on."""
    margin = np.zeros(ORDER + 1)
    coefficients = lead * np.poly(roots).real[::-1]
    margin[: len(coefficients)] = coefficients
    return margin


def test_the_first_fall_of_polynomials_with_known_zeros():
    """A fall at each zero that is passed downward; double zeros are no falls; nothing beyond the step."""
    for first, second in ((0.2, 0.7), (1e-3, 0.9), (0.45, 0.46)):
        assert taylor.first_fall(polynomial(first, second), 1.0, 1e-14) == pytest.approx(first, abs=1e-12)
        assert taylor.first_fall(polynomial(-first, second, lead=-1.0), 1.0, 1e-14) == pytest.approx(second, abs=1e-12)
        assert taylor.first_fall(polynomial(-first, second, lead=-1.0), 0.999 * second, 1e-14) == 0.999 * second
        # It rises from a negative start: that is a fall at the start.
        assert taylor.first_fall(polynomial(first, second, lead=-1.0), 1.0, 1e-14) == 0.0
        # From zero up, and down again.
        assert taylor.first_fall(polynomial(0.0, second, lead=-1.0), 1.0, 1e-14) == pytest.approx(second, abs=1e-12)
    assert taylor.first_fall(polynomial(0.4, 0.4, 0.8, lead=-1.0), 1.0, 1e-14) == pytest.approx(0.8, abs=1e-12)
    assert taylor.first_fall(polynomial(0.4, 0.4), 1.0, 1e-14) == 1.0


@pytest.mark.parametrize("rounding", [1e-14, 1e-20, 1e-30])
def test_a_fall_after_a_rise_is_not_passed_over_just_before_the_end(rounding):
    """The curvature of a parabola is the same everywhere: the steps that it allows lead to the zero and not beyond."""
    for first, second in ((0.2, 0.7), (0.45, 0.46), (0.0, 0.46), (0.0, 1e-3), (0.0, 500.0)):
        rising = polynomial(-first, second, lead=-1.0)
        assert taylor.first_fall(rising, 1.001 * second, rounding) == pytest.approx(second, rel=1e-9)


@pytest.mark.parametrize("step", [0.1, 0.4, 2.0])
def test_no_dip_within_a_step_is_passed_over(step):
    """A dip of any depth below the rounding, however narrow, and a fall just before the end, in short and long steps."""
    for depth in (1e-9, 1e-6, 1e-3):
        dip = polynomial(0.7 * step, 0.7 * step)
        dip[0] -= depth * step**2
        expected = 0.7 * step - math.sqrt(depth) * step
        assert taylor.first_fall(dip, step, 1e-14) == pytest.approx(expected, abs=1e-8 * step)
        dip[0] += 2.0 * depth * step**2
        assert taylor.first_fall(dip, step, 1e-14) == step
    for order in (1, 2, ORDER):
        assert taylor.first_fall(falling(0.75 * step, order=order), step, 1e-14) == pytest.approx(
            0.75 * step, rel=1e-12
        )
        assert taylor.first_fall(falling(1.01 * step, order=order), step, 1e-14) == step


@pytest.mark.parametrize("step", [1e-3, 1.0])
def test_a_dip_after_a_summit_is_not_passed_over(step):
    """A wave that dips below zero once, halfway; it starts level, where a step by its slope would be endless."""
    orders = np.arange(ORDER + 1)
    factorials = np.array([math.factorial(k) for k in orders], float)
    wave = (2.0 * math.pi / step) ** orders / factorials * np.array([1.0, 0.0, -1.0, 0.0] * 6)[: ORDER + 1]
    for depth in (1e-9, 1e-4, 0.3):
        margin = wave.copy()
        lowest = np.polynomial.polynomial.polyval(np.linspace(0.45, 0.55, 20001) * step, wave).min()
        margin[0] -= lowest + depth
        time = taylor.first_fall(margin, step, 1e-14)
        assert time < 0.5 * step
        assert abs(np.polynomial.polynomial.polyval(time, margin)) < 1e-12
        margin[0] += 2.0 * depth
        assert taylor.first_fall(margin, 0.6 * step, 1e-14) == 0.6 * step


def test_the_value_and_slope_of_a_margin():
    margin = np.random.default_rng(7).normal(size=ORDER + 1)
    derivative = margin[1:] * np.arange(1, ORDER + 1)
    for time in (0.0, 0.4, 1.3):
        value, slope = taylor._value_and_slope(margin, time)
        assert value == pytest.approx(np.polynomial.polynomial.polyval(time, margin), rel=1e-12)
        assert slope == pytest.approx(np.polynomial.polynomial.polyval(time, derivative), rel=1e-12)


def test_a_zero_is_looked_for_from_later_times_on_and_never_left_of_the_start():
    margin = polynomial(0.3, lead=-1.0) + polynomial(0.3, 0.3, lead=-5.0)
    for time in (0.30001, 0.31, 0.5, 1.0):
        assert taylor._zero_before(margin, time) == pytest.approx(0.3, abs=1e-14)
    below = falling(1.0)
    below[0] = -1.0
    assert taylor._zero_before(below, 0.5) == 0.0
    # Where it does not fall there is no zero to look for.
    assert taylor._zero_before(-0.5 * below, 0.5) == 0.5
    # A summit below zero at the start, to which one step leads.
    assert taylor._zero_before(-polynomial(-0.5j, 0.5j) + 0.0, 0.5) == 0.0


def test_a_turn_is_passed_in_its_direction_only():
    """A rotation at unit rate either way past a reference half a radian ahead, or behind."""
    for direction in (1.0, -1.0):
        work = rub_workspace(2)
        orders = np.array([math.factorial(k) for k in range(ORDER + 1)], float)
        work.position[:] = (1j * direction) ** np.arange(ORDER + 1) / orders
        for reference in (1.0, 1j, np.exp(0.2j)):
            turned = work.position * 1.0
            ahead = complex(np.exp(0.5j * direction))
            assert rub.turn_ahead(0, ahead, direction, 0.9, work) == pytest.approx(0.5, abs=1e-14)
            assert rub.turn_ahead(0, ahead, direction, 0.4, work) == 0.4
            work.position[:] = turned * reference
            assert rub.turn_ahead(0, ahead * reference, direction, 0.9, work) == pytest.approx(0.5, abs=1e-14)
            work.position[:] = turned
