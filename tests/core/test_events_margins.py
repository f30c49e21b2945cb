"""How near to the wall, and how slow, a flight may be for the search to say that it crosses, grazes or is clear."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from flights import (
    EPSILON,
    Tally,
    Task,
    at_start,
    by_kernel,
    compare,
    flight_of,
    flights_that_cross,
    inside_task,
    longest_block,
    parameters,
    random_wall_task,
    rotors,
    task_from_state,
    wall_task,
)
from flint import acb, arb
from reference import plane_flight, unit

from carom.base.outcome import Outcome
from carom.core import events
from carom.core.block import load_polynomial, sign_changes
from carom.core.layout import rotor_record
from carom.core.records import record
from carom.core.table import flight_table
from carom.models import jeffcott

ROUNDING = 16 * EPSILON
"""Rounding error of a displacement, in units of the sizes of its terms, as the search takes it."""


# ------------------------------------------------------------------------------------------ roots on the longest block


def search_block(task, error):
    """Outcome and time of a search on one block; the polynomial of the longest errs by this much at its end."""
    work, _, level, spread, _ = at_start(task)
    table = record(**{name: np.array(task.table[name]) for name in task.table.dtype.names})
    table.errors[0] = error / np.abs(work.products).sum()
    remainder = load_polynomial(table, 0, level, work)
    assert remainder == pytest.approx(error, rel=1e-12)
    changes, _ = sign_changes(work.polynomial, level, ROUNDING * spread, remainder)
    return changes, events._search_block(task.arrays, table, task.plane, math.inf, task.start, work)


def test_a_root_on_a_block_is_taken_where_the_bound_of_the_second_derivative_proves_it():
    """At ``f'² = 5 R M₂``; at ``4 R M₂`` the search gets no further than the shorter blocks, which end before it."""
    tried = 0
    for _, _, task, crossing in flights_that_cross(1300, 40):
        if crossing.time < 1.01 * task.table.durations[1]:
            continue
        curvature = at_start(task)[-1][0]
        error = crossing.slope**2 / curvature * longest_block(task) / crossing.time
        (open_, refused), (changes, taken) = search_block(task, error / 4.0), search_block(task, error / 5.0)
        if not open_ == changes == 1:
            continue
        assert refused[0] == Outcome.CLEAR
        assert refused[1] < crossing.time
        assert taken[0] == Outcome.CONTACT
        assert taken[1] == pytest.approx(crossing.time, abs=4 * task.noise(crossing.time) / crossing.slope)
        tried += 1
    assert tried >= 5


# ------------------------------------------------------------------------------------------- rounding along a flight


def by_steps(task, block, *, spread=None, bounds=None):
    """Outcome and time by steps alone, with sizes of terms and bounds that are larger than those of the flight."""
    work, origin, level, own_spread, own_bounds = at_start(task)
    if bounds is not None:
        assert all(given >= own for given, own in zip(bounds[1:], own_bounds[1:], strict=True))
    return events._step_safely(
        task.arrays,
        task.table,
        task.plane,
        origin,
        level,
        task.start,
        own_spread if spread is None else spread,
        block,
        own_bounds if bounds is None else bounds,
        work,
    )


@pytest.mark.parametrize("damping", [1.0, 1e-3])
def test_the_rounding_of_a_start_inside_is_that_of_its_terms_once(damping):
    """Half as much further inside is not called grazing."""
    rotor = jeffcott(parameters(damping, 1.0))
    for direction in np.exp(1j * np.arange(0.0, 6.0, 0.5)):
        spread = at_start(task_from_state(rotor, complex(direction), complex(-direction)))[3]
        for share, expected in ((0.7, Outcome.GRAZING), (1.5, Outcome.CLEAR)):
            start = (1.0 - 0.5 * share * ROUNDING * spread) * direction
            task = task_from_state(rotor, complex(start), complex(-1e-3 * direction))
            assert by_steps(task, 1e-6)[0] == expected


def flights_to_a_peak(seed, count, height):
    """Flights that leave the wall and come back to a peak of ``f`` at ``−height``; that time, and ``f''`` there."""
    found = 0
    for rotor, rng in rotors(seed, 20 * count):
        normal = unit(rng.uniform(0.0, 6.0)) * (1 - arb(height)).sqrt()
        flight = flight_of(rotor.parameters, normal, acb(0, -rng.uniform(0.0, 1.0)) * normal)
        # Back to the wall by bisection.
        times = np.linspace(0.05, 0.95, 19) * float(rotor.system.table.durations[0])
        outside = [bool(flight.level(-time)[0] > 0) for time in times]
        bend = float(flight.level(0.0)[2])
        if bend > -0.1 or outside[0] or True not in outside:
            continue
        late = arb(times[outside.index(True)])
        early = late - arb(times[1] - times[0])
        for _ in range(80):
            middle = ((early + late) / 2).mid()
            early, late = (middle, late) if flight.level(-middle)[0] < 0 else (early, middle)
        position, velocity, _ = flight.state(-late)
        radial = float((position.conjugate() * velocity).real)
        own = flight_of(rotor.parameters, position, velocity)
        amplitudes = rotor.system.amplitudes(complex(position), complex(velocity))
        yield Task(own, rotor.system.arrays, rotor.system.table, amplitudes, radial_speed=radial), float(late), bend
        found += 1
        if found == count:
            return


def test_the_rounding_of_a_start_on_the_wall_grows_with_time_to_that_of_its_terms():
    """A peak further inside than its rounding is passed, one within half of it grazes, in steps that miss neither.

    The rounding of the terms is taken much larger than that of doubles, and so are the bounds, which makes steps short.
    """
    height, tried = 1e-4, 0
    for task, peak, bend in flights_to_a_peak(1310, 5, height):
        _, jerk, speed = at_start(task)[-1]
        for travel in (0.4, 1.0, 4.0):
            bounds = 100.0 * abs(bend) + jerk, 1e3 + jerk, max(speed, travel / peak)
            share = min(1.0, bounds[2] * peak)
            for rounding, expected in ((height / 1.05, Outcome.CLEAR), (2.2 * height, Outcome.GRAZING)):
                outcome, time = by_steps(task, 1.02 * peak, spread=rounding / share / ROUNDING, bounds=bounds)
                assert outcome == expected
                if expected == Outcome.GRAZING:
                    # Where f is within its rounding.
                    assert time == pytest.approx(peak, abs=math.sqrt(2.0 * rounding / -bend))
        tried += 1
    assert tried == 5


def slope_rounding(task):
    """Bound of the rounding error of ``f'`` at the start."""
    return 16 * EPSILON * task.flight.spread(0.0) * (1.0 + task.flight.fastest)


def turned_outward(seed, count, pull=None):
    """Motions along the wall whose ``f'`` at the start is above zero, by the rounding of their velocity; ``f''``, ``f'''``.

    With a pull their angular speed is such that ``f''`` is below zero by that much.
    """
    for rotor, rng in rotors(seed, count):
        angle, spin = rng.uniform(0.0, 6.0), rng.normal()
        if pull is not None:
            # Along the wall f''/2 is s² + 2s and what it is at rest.
            at_rest = 0.5 * float(wall_task(rotor, angle, 0.0, 0.0).flight.level(0.0)[2])
            square = 1.0 - at_rest - 0.5 * pull
            if square < 0.0:
                continue
            spin = -1.0 + rng.choice([-1.0, 1.0]) * math.sqrt(square)
        task = wall_task(rotor, angle, 0.0, spin)
        work, origin, level, _, _ = at_start(task)
        _, slope, bend, jerk = events._measure(task.arrays, task.table, 0, origin, level, 0.0, work)
        if slope > 0.0:
            assert slope < slope_rounding(task)
            yield task, bend, jerk


def test_a_start_that_rounding_turns_outward_and_force_presses_on_does_not_leave():
    tried = 0
    for task, bend, _ in turned_outward(1320, 120):
        if bend > 1e-3:
            assert by_steps(task, longest_block(task)) == by_kernel(task, 1.0) == (Outcome.GRAZING, 0.0)
            tried += 1
    assert tried >= 5


@pytest.mark.parametrize("pull", [1e-6, 3e-9, 1e-10])
def test_a_start_that_force_pulls_off_for_a_moment_only_is_never_clear(pull):
    """It is back after ``3 |f''|/f'''``, or a little later if rounding turns the start inward."""
    tried = 0
    for task, bend, jerk in turned_outward(1325, 200, pull):
        if jerk > 0.1:
            assert bend == pytest.approx(-pull, abs=3e-14)  # the rounding of forces near 1
            outcome, time = by_steps(task, longest_block(task))
            assert outcome != Outcome.CLEAR
            # f ≥ τ (f''' τ²/6 + f'' τ/2 − rounding of f')
            half, rounding = 0.5 * pull, slope_rounding(task)
            assert time <= 1.1 * 3.0 * (half + math.sqrt(half**2 + 2.0 / 3.0 * jerk * rounding)) / jerk
            tried += 1
    assert tried >= 5


@pytest.mark.parametrize("pull", [0.1, 0.01])
def test_a_start_that_rounding_turns_outward_and_force_pulls_off_leaves(pull):
    tally = Tally("along the wall")
    for task, _, _ in turned_outward(1327, 60, pull):
        compare(task, longest_block(task), tally, by_steps)
    tally.check()
    assert tally.grazing == 0
    assert tally.tried >= 5


def test_what_is_at_rest_on_the_wall_does_not_leave():
    resting = replace(inflecting_task(1.0, 0.0, 0.0, 0.0), radial_speed=0.0)
    assert by_steps(resting, 1.0) == by_kernel(resting, 1.0) == (Outcome.GRAZING, 0.0)


# ---------------------------------------------------------------------------------------- slow and short crossings


@pytest.mark.parametrize("rise", [0.2, 0.8, 1.05, 1.3, 3.0])
def test_what_may_turn_back_is_a_contact_only_if_it_rises_beyond_its_rounding(rise):
    """From a start within its rounding and with ``f' ≈ √(2 (1 + rise) R M₂)``, ``f`` rises to its rounding times `rise`.

    The bound of ``f''`` is that of the stretch to the peak, the least that is right.
    """
    tried = 0
    for rotor, rng in rotors(1330, 40):
        rounding = 10.0 ** rng.uniform(-7.0, -5.0)
        direction = complex(np.exp(1j * rng.uniform(0.0, 6.0)))
        at_peak = task_from_state(
            rotor, math.sqrt(1.0 + rise * rounding) * direction, -1j * rng.uniform(0.0, 1.0) * direction
        )
        bend = float(at_peak.flight.level(0.0)[2])
        if bend > -0.1:
            continue
        back = math.sqrt(2.0 * (rise + 0.9) * rounding / -bend)
        position, velocity, _ = at_peak.flight.state(-back)
        task = task_from_state(rotor, complex(position), complex(velocity))
        most = max(-float(task.flight.level(share * back)[2]) for share in np.linspace(0.0, 1.0, 20))
        _, jerk, speed = at_start(task)[-1]
        bounds = 1.01 * most, jerk, speed
        outcome, time = by_steps(task, 1.1 * back, spread=rounding / ROUNDING, bounds=bounds)
        assert outcome == (Outcome.GRAZING if rise < 1.0 else Outcome.CONTACT)
        if outcome == Outcome.GRAZING:
            assert time == pytest.approx(back, rel=2e-2)
        else:
            # Taken at once by f/f', where f'² ≥ 4 R M₂, leaves f'' (R/f')²/2 at most.
            assert time < back
            assert abs(float(task.flight.level(time)[0])) <= rounding / 8.0
        tried += 1
    assert tried >= 10


def inflecting_task(frequency, share, excess, depth):
    """A line ``y = p + a sin λt + b sin 2λt`` whose ``f`` starts at ``−depth``, rises a little and falls.

    With ``b`` the share and ``a = excess − 2b`` it is ``y = p + excess λt − b (λt)³ + …``.
    """
    exponents = 1j * frequency * np.array([1.0, -1.0, 2.0, -2.0])
    first, second = excess - 2.0 * share, share
    amplitudes = np.array([first, -first, second, -second]) / 2j
    offset = math.sqrt(1.0 - depth)
    arrays = rotor_record(
        exponents=exponents,
        driven=np.zeros(4, bool),
        offsets=np.array([offset + 0j]),
        rows=np.ones((1, 4), complex),
        columns=np.zeros((4, 1), complex),
        friction=np.full(1, 0.1),
        restitution=np.full(1, 0.9),
        surface_speed=np.full(1, 5.0),
    )
    flight = plane_flight(offset, np.ones(4), exponents, np.zeros(4, bool), amplitudes)
    return Task(flight, arrays, flight_table(exponents, np.zeros(4, bool)), amplitudes)


@pytest.mark.parametrize("frequency", [0.1, 5.0, 50.0])
def test_a_rise_that_ends_by_the_third_derivative_alone_is_followed_to_its_crossing(frequency):
    """Where ``f''`` is zero only the bound of ``f'''`` says how long a rise lasts: much less than ``f'/M₂`` if fast."""
    for excess in (1e-6, 1e-4):
        # The cubic rises by 2/3 of its slope up to where its slope is zero, at λt = √(excess/3b).
        share = 0.1
        peak = math.sqrt(excess / (3.0 * share))
        height = 2.0 * 2.0 / 3.0 * excess * peak
        for part in (0.05, 0.4):
            task = inflecting_task(frequency, share, excess, 0.5 * part * height)
            assert float(task.flight.level(peak / frequency)[0]) == pytest.approx(height * (1 - 0.5 * part), rel=1e-2)
            work, origin, level, _, bounds = at_start(task)
            outcome, time = events._decide(
                task.arrays, task.table, 0, origin, level, 0.0, longest_block(task), bounds, part * height, work
            )
            assert outcome == Outcome.CONTACT
            assert time < peak / frequency
            before, after = (task.flight.level(time * (1.0 + side * 1e-6))[0] for side in (-1.0, 1.0))
            assert before < 0
            assert after > 0


def test_a_rise_that_is_within_its_rounding_at_the_end_of_a_block_goes_on_in_the_next():
    """It grazes only where it has been followed to its end."""
    task = inflecting_task(5.0, 0.1, 1e-4, 1e-9)
    work, origin, level, _, bounds = at_start(task)
    block = 1e-6
    assert -1e-9 < task.flight.level(block)[0] < 0
    assert events._decide(task.arrays, task.table, 0, origin, level, 0.0, block, bounds, 2e-9, work) == (
        Outcome.CLEAR,
        block,
    )


# -------------------------------------------------------------------------------------------------------- roots of bounds


def lies_on(terms):
    """Whether a polynomial is zero within the rounding of its terms."""
    return abs(sum(terms)) <= 8.0 * EPSILON * max(abs(term) for term in terms)


@pytest.mark.parametrize("bend", [-1.0, -1e-9, 0.0, 1e-9, 1.0])
def test_roots_of_the_bounds_are_exact_to_rounding_however_small_a_term(bend):
    """The time of a rise, of a departure, and the first root of a parabola; a value or slope far below rounding too."""
    for small, jerk in itertools.product(10.0 ** np.arange(-30.0, 1.0, 3.0), (1e-3, 1.0, 1e3)):
        time = events._rising_time(small, bend, jerk)
        assert time > 0.0
        assert lies_on((small, bend * time, -0.5 * jerk * time**2))
        time = events._departure(-small, bend, jerk)
        assert time > 0.0
        assert lies_on((-small, 0.5 * bend * time, jerk * time**2 / 6.0))
        for slope in (-1.0, -1e-9, 1e-9, 1.0):
            time = events._first_root(-small, slope, bend)
            assert time > 0.0
            assert time == math.inf or lies_on((-small, slope * time, 0.5 * bend * time**2))


# ------------------------------------------------------------------------------------------------- steps advance


def test_steps_are_longer_than_the_spacing_of_doubles():
    """From anywhere outside the rounding of the wall, at the largest speed, as proven beside the steps."""
    for rotor, rng in rotors(1340, 20):
        for task in (inside_task(rotor, rng), random_wall_task(rotor, rng, 0)):
            curvature, jerk, speed = at_start(task)[-1]
            for time in longest_block(task) * 10.0 ** rng.uniform(-12.0, 0.0, 5):
                # As if terms had no size: it adds to the rounding.
                rounding = ROUNDING * speed * time
                value = -rounding * (1.0 + 10.0 ** rng.uniform(-15.0, 3.0))
                for bend in (-curvature, 0.0, curvature):
                    step = events._safe_step(value + 0.5 * rounding, 2.0 * speed, bend, curvature, jerk)
                    assert step > 2.0 * EPSILON * time
