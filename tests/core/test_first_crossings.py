"""Parts of the search for the first crossing, each on its own: bounds, steps, certified roots, what comes within rounding."""

import math
from dataclasses import replace

import numpy as np
import pytest
from compilation import sized
from flights import (
    EPSILON,
    Tally,
    Task,
    at_start,
    by_steps,
    compare,
    complex_normal,
    flights_that_cross,
    inside_task,
    longest_block,
    near_grazing_task,
    parameters,
    plain_record,
    random_wall_task,
    rotors,
    task_from_state,
    wall_task,
)
from flint import arb
from reference import plane_flight

from carom.base.outcome import Outcome
from carom.core import events
from carom.core.flow import displacement
from carom.core.layout import DEGREE, workspace
from carom.core.records import record
from carom.core.table import flight_table
from carom.models import jeffcott

HORIZON = 15.0


def smallest_positive_root(*coefficients):
    """Of a polynomial, highest power first."""
    roots = np.roots(coefficients)
    real = roots[np.abs(roots.imag) < 1e-9 * (1.0 + np.abs(roots.real))].real
    return min(real[real > 0.0], default=math.inf)


def test_bounds_of_steps_are_first_roots():
    rng = np.random.default_rng(41)
    for _ in range(200):
        value, slope, bend, jerk = -(10.0 ** rng.uniform(-2, 1)), *rng.normal(size=2), 10.0 ** rng.uniform(-1, 1)
        expected = smallest_positive_root(0.5 * bend, slope, value)
        assert events._first_root(value, slope, bend) == pytest.approx(expected, rel=1e-7)
        expected = smallest_positive_root(jerk / 6.0, 0.5 * bend, -abs(slope))
        assert events._departure(-abs(slope), bend, jerk) == pytest.approx(expected, rel=1e-9)
    assert events._first_root(-1.0, 2.0, 0.0) == 0.5
    assert events._first_root(-1.0, 0.0, 2.0) == 1.0
    # The larger root of a parabola that falls first, without cancellation.
    assert events._first_root(-1e-9, -1.0, 1.0) == pytest.approx(1.0 + math.sqrt(1.0 + 2e-9), rel=1e-15)
    assert events._first_root(-1.0, 0.0, 0.0) == events._first_root(-1.0, -1.0, 0.0) == math.inf
    # Double root, and just none.
    assert events._first_root(-1.0, 2.0, -2.0) == 1.0
    assert events._first_root(-1.0, 2.0, -2.1) == math.inf
    # Along the wall: pulled off it stays off for a while.
    assert events._departure(0.0, -2.0, 3.0) == 2.0


def random_bounds(count):
    """Values, slopes, second derivatives and bounds of the third, of all sizes."""
    rng = np.random.default_rng(43)
    for _ in range(count):
        value, jerk = -(10.0 ** rng.uniform(-6, 1)), 10.0 ** rng.uniform(-2, 2)
        slope, bend = rng.choice([-1.0, 1.0], 2) * 10.0 ** rng.uniform(-4, 1, 2)
        yield value, slope, bend, jerk


def test_no_motion_within_the_bounds_crosses_during_a_safe_step():
    """The cubics whose third derivative is the bound all along; where the bound of the step is met it ends there."""
    ends = 0
    for value, slope, bend, jerk in random_bounds(800):
        step = events._safe_step(value, slope, bend, 1e9, jerk)
        crossing = smallest_positive_root(jerk / 6.0, 0.5 * bend, slope, value)
        assert 0.0 < step <= crossing * (1.0 + 1e-6)
        ends += step > 0.999 * crossing
        # The longer of the two steps is taken: with a small bound of f'' that of the parabola.
        curvature = abs(bend) + 1e-3 * jerk
        parabola = smallest_positive_root(0.5 * curvature, slope, value)
        assert events._safe_step(value, slope, bend, curvature, jerk) == pytest.approx(max(step, parabola), rel=1e-6)
    assert ends > 80


def test_a_rise_lasts_as_long_as_the_third_derivative_allows():
    for _, slope, bend, jerk in random_bounds(300):
        expected = smallest_positive_root(-0.5 * jerk, bend, abs(slope))
        assert events._rising_time(abs(slope), bend, jerk) == pytest.approx(expected, rel=1e-6)


def test_a_householder_step_errs_by_the_fourth_power():
    """On ``e^{2t} + t²/2 − 1``, which vanishes at zero, and on its negative."""
    for side in (1.0, -1.0):
        errors = []
        for distance in (1e-2, 1e-3):
            power = math.exp(2.0 * distance)
            derivatives = (power + 0.5 * distance**2 - 1.0, 2.0 * power + distance, 4.0 * power + 1.0, 8.0 * power)
            errors.append(abs(distance + events.householder_step(*(side * value for value in derivatives))))
        assert math.log10(errors[0] / errors[1]) == pytest.approx(
            4.0, abs=0.015
        )  # the next order changes the ratio by 2.5 %


def test_sizes_of_terms_bound_rounding_and_derivatives():
    for rotor, rng in rotors(950, 5):
        task, work = inside_task(rotor, rng), workspace(2)
        terms = np.append(task.arrays.rows[0] * task.amplitudes, task.arrays.offsets[0])
        sizes = np.abs(terms.real).sum() + np.abs(terms.imag).sum()
        assert events._spread(task.arrays, 0, task.amplitudes) == pytest.approx(sizes, rel=1e-14)
        work.amplitudes[:] = rng.normal(size=2) + 1j * rng.normal(size=2)
        speed, second, third = task.table.bounds @ np.abs(work.amplitudes)
        # f'' = 2(|ẏ|² + Re ȳÿ) and f''' = 2 Re(3 conj(ẏ) ÿ + ȳ y⃛), with |y| at most one.
        expected = 2.0 * (speed**2 + second), 2.0 * (3.0 * speed * second + third), speed
        np.testing.assert_allclose(events._bounds(task.table, work), expected, rtol=1e-14)


def test_the_level_and_its_derivatives_at_a_time():
    """Against derivatives of the reference; the third one is that of the second, by differences."""
    for rotor, rng in rotors(1010, 10):
        for task in (inside_task(rotor, rng), random_wall_task(rotor, rng, 0)):
            work, origin, level, _, _ = at_start(task)
            time = rng.uniform(0.0, 1.0) * longest_block(task)
            found = events._measure(task.arrays, task.table, task.plane, origin, level, time, work)
            step = arb(1e-12)
            before, after = task.flight.level(time - step)[2], task.flight.level(time + step)[2]
            expected = [float(value) for value in (*task.flight.level(time), (after - before) / (2 * step))]
            size = task.noise(time, 1.0) * (1.0 + task.flight.fastest) ** np.arange(4)
            assert np.all(np.abs(np.array(found) - expected) <= 64 * EPSILON * size)


@pytest.mark.parametrize("kind", ["inside", "near-grazing", "fast", "late-chatter", "slow", "along-the-wall"])
def test_certified_steps_alone_find_the_first_crossing(kind):
    tally = Tally("steps")
    kinds = ["fast", "late-chatter", "slow", "along-the-wall"]
    for rotor, rng in rotors(1000 + len(kind), sized(10, 5, 200)):
        for _ in range(6):
            if kind == "inside":
                task = inside_task(rotor, rng)
            elif kind == "near-grazing":
                task, _ = near_grazing_task(rotor, rng) or (None, None)
            else:
                task = random_wall_task(rotor, rng, kinds.index(kind))
            if task is not None:
                compare(task, longest_block(task), tally, by_steps)
    tally.check()
    assert tally.tried >= 10
    assert tally.grazing == 0


# ---------------------------------------------------------------------------------------------- certified roots


def polish(task, guess, floor, doubt, curvature=None):
    """Whether the root near a time is certified to be the first, and the root."""
    work, origin, level, _, bounds = at_start(task)
    most = bounds[0] if curvature is None else curvature
    return events._polish(task.arrays, task.table, task.plane, origin, level, guess, most, floor, doubt, work), bounds[
        0
    ]


def test_a_root_is_certified_where_its_slope_proves_it_the_first_and_only_there():
    """Nothing is certified where ``f'² ≤ 4 R M₂``; where it is ``5 R M₂`` the root is, to rounding."""
    tried = 0
    for _, rng, task, crossing in flights_that_cross(1100, 20):
        guess = crossing.time + rng.uniform(-1.0, 1.0) * task.table.spacing
        (certified, time), curvature = polish(task, guess, 0.0, 0.0)
        assert certified
        assert time == pytest.approx(crossing.time, abs=4 * task.noise(time) / crossing.slope)
        for share in (0.0, 0.5, 1.0):
            for factor, expected in ((4.0, False), (4.2, False), (5.0, True), (100.0, True)):
                error = crossing.slope**2 / (factor * curvature)
                floor, doubt = share * error, (1.0 - share) * error / crossing.time
                assert polish(task, guess, floor, doubt)[0][0] == expected
        tried += 1
    assert tried >= 15


def flights_that_turn_back_where_a_step_is_zero(seed, count):
    """Flights to a maximum of ``f`` just below zero that start where ``f f'' = 2f'²``: a Householder step is zero there."""
    for rotor, rng in rotors(seed, count):
        depth, direction = 10.0 ** rng.uniform(-9.0, -4.0), complex(np.exp(1j * rng.uniform(0.0, 6.0)))
        spin = 1j * rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-1.0, 1.0) * direction
        flight = task_from_state(rotor, math.sqrt(1.0 - depth) * direction, spin).flight
        bend = float(flight.level(0.0)[2])
        if bend > -1e-1:
            continue
        early, late = -2.0 * math.sqrt(2.0 * depth / (-3.0 * bend)), 0.0
        for _ in range(80):
            middle = 0.5 * (early + late)
            value, slope, bend = flight.level(middle)
            early, late = (middle, late) if value * bend < 2 * slope * slope else (early, middle)
        position, speed, _ = flight.state(late)
        yield task_from_state(rotor, complex(position), complex(speed))


def test_a_short_step_is_no_root():
    tried = 0
    for task in flights_that_turn_back_where_a_step_is_zero(1103, 60):
        work, origin, level, _, _ = at_start(task)
        measured = events._measure(task.arrays, task.table, task.plane, origin, level, 0.0, work)
        assert abs(events.householder_step(*measured)) < 1e-3 * abs(measured[0] / measured[1])
        assert not polish(task, 0.0, 0.0, 0.0)[0][0]
        tried += 1
    assert tried >= 20


def test_no_impact_is_invented_where_a_step_happens_to_be_zero():
    """The flight on which that was seen, among 1.84 million, and others like it."""
    rotor = jeffcott(parameters(0.0030054630001825683, 2.2353614960095, rho=0.0, phi=0.590663075529207))
    start = 0.6664892755162684 - 0.7428473474126268j, 0.11154170556637309 - 0.06737417390679983j
    tally = Tally("steps of length zero")
    assert compare(task_from_state(rotor, *start), HORIZON, tally) is None
    for task in flights_that_turn_back_where_a_step_is_zero(1104, sized(100, 10, 10_000)):
        compare(task, HORIZON, tally)
    tally.check()


def test_a_root_on_a_block_is_certified_by_the_error_at_its_time():
    """The error grows in proportion to time, to its bound at the end of the block; nothing is certified past that."""
    for _, _, task, crossing in flights_that_cross(1105, 10):
        work, origin, level, _, bounds = at_start(task)
        error = crossing.slope**2 / bounds[0]

        def certified(factor, share, task=task, crossing=crossing, start=(work, origin, level, bounds), error=error):
            work, origin, level, bounds = start
            duration = crossing.time / share
            remainder = error / (factor * share)
            flight = task.arrays, task.table, task.plane, origin, level
            return events._root_on_block(*flight, crossing.time, bounds[0], 0.0, remainder, duration, work)[0]

        for share in (0.1, 0.5, 0.999):
            assert [certified(factor, share) for factor in (4.0, 5.0, 100.0)] == [False, True, True]
        assert not certified(100.0, 1.001)
        assert not certified(1e9, 2.0)


def flights_that_cross_twice(seed, count):
    """Flights that leave the disc at once, come back were there no wall, and leave it again at about a given time."""
    rng, found = np.random.default_rng(seed), 0
    while found < count:
        arrays = plain_record(
            exponents=rng.uniform(-0.2, 0.0, 2) + 1j * rng.uniform(-3.0, 3.0, 2),
            driven=np.zeros(2, bool),
            offsets=0.3 * complex_normal(rng, 1),
            rows=complex_normal(rng, 1, 2),
        )
        table = flight_table(arrays.exponents, arrays.driven.astype(bool))
        times = float(table.durations[0]) * np.linspace(0.0, 0.75, 49)
        turns = np.exp(np.outer(times, arrays.exponents))
        for amplitudes in 0.7 * complex_normal(rng, 50, 2):
            outside = np.abs(arrays.offsets[0] + turns @ (arrays.rows[0] * amplitudes)) > 1.0
            ways_out = np.flatnonzero(outside[1:] & ~outside[:-1])
            if len(ways_out) > 1:
                start = amplitudes * turns[ways_out[0]]
                flight = plane_flight(arrays.offsets[0], arrays.rows[0], arrays.exponents, arrays.driven, start)
                yield Task(flight, arrays, table, start), times[ways_out[1]] - times[ways_out[0]]
                found += 1


def test_a_polynomial_that_leaves_it_open_is_not_used():
    """It is made to point at a later crossing, which would be certified if it were taken for the first."""
    tally = Tally("open polynomials")
    for task, second in flights_that_cross_twice(1107, 10):
        if not polish(task, second, 0.0, 0.0)[0][0]:
            continue
        work, _, level, _, _ = at_start(task)
        place = int(second / longest_block(task) * DEGREE)
        polynomial = np.full(DEGREE, -1.0)
        polynomial[[place, place + 2]] = 1.0
        largest = np.abs(work.products).argmax()
        table = record(**{name: np.array(task.table[name]) for name in task.table.dtype.names})
        table.errors[:], table.coefficients[:] = 0.0, 0.0
        table.coefficients[:, largest] = (polynomial - level) / work.products[largest]
        compare(replace(task, table=table), longest_block(task), tally)
    tally.check()
    assert tally.contact >= 3


def test_no_root_is_certified_where_nothing_bounds_the_second_derivative():
    for _, _, task, crossing in flights_that_cross(1110, 3):
        with np.errstate(invalid="ignore"):
            assert not polish(task, crossing.time, 0.0, 0.0, math.inf)[0][0]


def test_no_root_is_certified_beyond_the_tables():
    """Flights that cross the wall just after the longest block ends, and just before."""
    for rotor, _, task, crossing in flights_that_cross(1120, 10):
        block, spacing = longest_block(task), task.table.spacing
        for late, certified in ((0.2, False), (1e-3, False), (-1e-3, True), (-0.2, True)):
            start = task.flight.state(crossing.time - block - late * spacing)
            moved = task_from_state(rotor, complex(start[0]), complex(start[1]))
            (found, _), curvature = polish(moved, block, 0.0, 0.0)
            assert found == certified or (certified and curvature > 1e3)
        # Nor is one before the start, in a flight that goes on outside.
        start = task.flight.state(crossing.time + 0.2 * spacing)
        assert not polish(task_from_state(rotor, complex(start[0]), complex(start[1])), 0.0, 0.0, 0.0)[0][0]


def test_neither_the_start_on_the_wall_nor_a_way_in_is_certified():
    for rotor, rng in rotors(1130, 10):
        task = wall_task(rotor, rng.uniform(0.0, 6.0), -(10.0 ** rng.uniform(-3.0, 0.0)), rng.normal())
        direction = complex(np.exp(1j * rng.uniform(0.0, 6.0)))
        coming_in = task_from_state(rotor, 1.001 * direction, -0.5 * direction)
        for node in range(4):
            assert_way_out(task, node * float(task.table.spacing))
            assert_way_out(coming_in, node * 1e-3)


def assert_way_out(task, guess):
    """If anything is certified from this guess on, it is a crossing from inside some time after the start."""
    (certified, time), _ = polish(task, guess, 0.0, 0.0)
    if certified:
        value, slope, _ = (float(number) for number in task.flight.level(time))
        assert abs(value) <= task.noise(time)
        assert slope > 0.0
        assert time > 0.0


# -------------------------------------------------------------------------------- what comes within its rounding


def decide(task, time, block, rounding):
    work, origin, level, _, bounds = at_start(task)
    outcome, end = events._decide(
        task.arrays, task.table, task.plane, origin, level, time, block, bounds, rounding, work
    )
    position = complex(task.flight.state(end)[0])
    assert abs(displacement(task.arrays, task.plane, work.end) - position) <= task.noise(end)
    return outcome, end


def test_what_rises_beyond_its_rounding_crosses_where_it_is_zero():
    """A rounding error much larger than that of doubles, to see how it is followed."""
    for _, rng, task, crossing in flights_that_cross(1200, 20):
        curvature = at_start(task)[-1][0]
        rounding = crossing.slope**2 / curvature * 10.0 ** rng.uniform(-9.0, -3.0)
        before = crossing.time - 0.9 * rounding / crossing.slope
        outcome, time = decide(task, before, longest_block(task), rounding)
        assert outcome == Outcome.CONTACT
        assert time == pytest.approx(crossing.time, abs=4 * task.noise(time) / crossing.slope)
        # A block that ends before the rise is beyond doubt is free of a crossing, so far as can be said.
        end = crossing.time + 0.5 * rounding / crossing.slope
        assert decide(task, before, end, rounding) == (Outcome.CLEAR, end)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_what_turns_back_within_its_rounding_grazes_at_its_peak(side):
    tried = 0
    for rotor, rng in rotors(1210, 20):
        height = 10.0 ** rng.uniform(-8.0, -5.0)
        direction = complex(np.exp(1j * rng.uniform(0.0, 6.0)))
        peak = math.sqrt(1.0 + side * height) * direction
        spin = 1j * rng.normal() * direction
        at_peak = task_from_state(rotor, peak, spin)
        bend = float(at_peak.flight.level(0.0)[2])
        if bend > -1e-2:
            continue
        # A start below the wall, and within its rounding.
        back = math.sqrt(2.0 * height / -bend) * (1.3 if side > 0 else 0.5)
        start = at_peak.flight.state(-back)
        task = task_from_state(rotor, complex(start[0]), complex(start[1]))
        outcome, time = decide(task, 0.0, longest_block(task), 2.0 * height)
        assert outcome == Outcome.GRAZING
        assert time == pytest.approx(back, abs=1e-3 * back)
        # Of a rounding error a little smaller than its height it is seen to rise.
        outcome, time = decide(task, 0.0, longest_block(task), 0.99 * height)
        assert outcome == (Outcome.CONTACT if side > 0 else Outcome.GRAZING)
        assert time == pytest.approx(back - (math.sqrt(2.0 * height / -bend) if side > 0 else 0.0), rel=1e-2)
        tried += 1
    assert tried >= 5
