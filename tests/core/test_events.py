"""No crossing is missed and none invented: the kernel against the high-precision reference."""

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
    flight_of,
    inside_task,
    longest_block,
    near_grazing_task,
    parameters,
    random_wall_task,
    rotors,
    task_from_state,
    wall_task,
)
from flint import acb
from reference import first_crossing, plane_flight, unit

from carom.base.outcome import Outcome
from carom.core import events
from carom.core.layout import DEGREE, LEVELS, rotor_record, workspace
from carom.core.records import record
from carom.core.table import SHORTENING, flight_table
from carom.models import jeffcott

HORIZON = 15.0
FEW = (0.05, 0.01)
"""Shares of the flights that are tried by day, and without the compiler, where there are thousands in several batches."""


def count(flights: int, by_day: float = 0.1, interpreted: float = 0.03) -> int:
    """How many flights to try: all in a deep run, this share by day, without the compiler every line at least."""
    return sized(math.ceil(by_day * flights), math.ceil(interpreted * flights), flights)


@pytest.mark.parametrize("batch", range(4))
def test_random_flights(batch):
    tally = Tally("random flights")
    for rotor, rng in rotors(100 + batch, count(1_000, *FEW)):
        for _ in range(25):
            compare(inside_task(rotor, rng), HORIZON, tally)
    tally.check()
    assert tally.tried >= count(25_000, *FEW)
    assert min(tally.contact, tally.clear) > 0.2 * tally.tried


@pytest.mark.parametrize("batch", range(2))
def test_near_grazing_flights(batch):
    tally, passes = Tally("near-grazing flights"), 0
    wanted = count(6_000, *FEW)
    for rotor, rng in rotors(200 + batch, 10 * wanted):
        for _ in range(20):
            drawn = near_grazing_task(rotor, rng)
            if drawn is None:
                continue
            task, time = drawn
            expected = compare(task, time + 5.0, tally)
            passes += expected is None or expected.time > time - 0.5
        if passes >= wanted:
            break
    tally.check()
    assert passes >= wanted
    # Peaks stand out by 2e-12 and more; rounding stays below that.
    assert tally.grazing == 0


@pytest.mark.parametrize("kind", range(4), ids=["fast", "late-chatter", "slow", "along-the-wall"])
def test_starts_on_the_wall(kind):
    tally = Tally("starts on the wall")
    wanted = count(3_000)
    for rotor, rng in rotors(300 + kind, wanted):
        for _ in range(30):
            task = random_wall_task(rotor, rng, kind)
            if task is not None:
                compare(task, HORIZON, tally)
        if tally.tried >= wanted:
            break
    tally.check()
    assert tally.tried >= wanted
    assert tally.grazing == 0


def test_near_resonance():
    """An equilibrium far outside the wall costs digits: where they are gone the outcome says so."""
    tally = Tally("near resonance")
    rng = np.random.default_rng(400)
    while tally.tried < count(3_000):
        shift = rng.choice([-1.0, 0.0, 1.0]) * 10.0 ** rng.uniform(-9.0, -3.0)
        rotor = jeffcott(parameters(10.0 ** rng.uniform(-6.0, -2.0), 1.0 + shift, rho=rng.uniform(0.01, 1.0)))
        for k in range(20):
            compare(inside_task(rotor, rng), 5.0, tally)
            compare(random_wall_task(rotor, rng, k % 3), 5.0, tally)
            drawn = near_grazing_task(rotor, rng)
            if drawn is not None:
                compare(drawn[0], drawn[1] + 1.0, tally)
    tally.check()
    assert tally.grazing < 0.1 * tally.tried


def test_high_speeds():
    """The time of contact is as exact, relative to the duration of a flight, at a thousand clearances a turn."""
    tally = Tally("high speeds")
    for rotor, rng in rotors(500, count(100)):
        for _ in range(20):
            position = rng.uniform(0.0, 0.99) * np.exp(2j * math.pi * rng.uniform())
            velocity = 10.0 ** rng.uniform(1.0, 3.0) * np.exp(2j * math.pi * rng.uniform())
            compare(task_from_state(rotor, complex(position), complex(velocity)), 3.0, tally)
    tally.check()


def test_extreme_parameters():
    """Damping and stiffness over six decades, some of the damping negative, starts as fast as the modes."""
    tally = Tally("extreme parameters")
    rng = np.random.default_rng(550)
    while tally.tried < count(5_000):
        omega = 10.0 ** rng.uniform(-3.0, 3.0)
        gamma = 10.0 ** rng.uniform(-3.0, 3.0) * rng.choice([1.0, 1.0, 1.0, -0.05])
        stiffness = abs(complex(omega**2 - 1.0, gamma))
        rotor = jeffcott(parameters(gamma, omega, rho=min(2.0 * rng.uniform() * stiffness, 1e3)))
        fastest = np.abs(rotor.system.exponents).max()
        for _ in range(4):
            position, velocity = math.sqrt(rng.uniform()), fastest * 10.0 ** rng.uniform(-3.0, 1.0)
            turn = np.exp(2j * math.pi * rng.uniform(size=2))
            task = task_from_state(rotor, complex(position * turn[0]), complex(velocity * turn[1]))
            compare(task, 10.0 / fastest, tally)
            leaving = -fastest * 10.0 ** rng.uniform(-6.0, 1.0)
            task = wall_task(rotor, 2.0 * math.pi * rng.uniform(), leaving, fastest * rng.normal())
            compare(task, 10.0 / fastest, tally)
    tally.check()
    assert min(tally.contact, tally.clear) > 0.1 * tally.tried


def general_rotor(rng, kind):
    """Four modes, two planes: free-standing, paired, all but degenerate and degenerate, one growing; one is forcing."""
    exponents = rng.uniform(-1.0, 0.0, 4) + 1j * rng.uniform(-3.0, 3.0, 4)
    driven = np.zeros(4, bool)
    if kind in ("pair", "near pair", "degenerate pair"):
        exponents[:2] = sorted(exponents[:2], key=lambda value: value.real)
        driven[1] = True
        if kind != "pair":
            exponents[1] = exponents[0] + (1e-9 if kind == "near pair" else 0.0)
    if kind == "growing":
        exponents[2] = rng.uniform(0.05, 0.6) + 1j * rng.uniform(-3.0, 3.0)
    exponents[3] = -1j
    columns = complex_normal(rng, 4, 2)
    columns[3] = 0.0
    return rotor_record(
        exponents=exponents,
        driven=driven,
        offsets=0.3 * complex_normal(rng, 2),
        rows=0.5 * complex_normal(rng, 2, 4),
        columns=columns,
        friction=np.full(2, 0.1),
        restitution=np.full(2, 0.9),
        surface_speed=np.full(2, 5.0),
    )


@pytest.mark.parametrize("kind", ["free-standing", "pair", "near pair", "degenerate pair", "growing"])
def test_rotors_with_many_modes_and_planes(kind):
    tally = Tally("general rotors")
    rng = np.random.default_rng([600, len(kind)])
    while tally.tried < count(1_500):
        arrays = general_rotor(rng, kind)
        table = flight_table(arrays.exponents, arrays.driven.astype(bool))
        for plane in (0, 1) * 10:
            amplitudes = complex_normal(rng, 4) * 10.0 ** rng.uniform(-1.5, 0.3)
            flight = plane_flight(
                arrays.offsets[plane], arrays.rows[plane], arrays.exponents, arrays.driven, amplitudes
            )
            if flight.level(0.0)[0] < -1e-3:
                compare(Task(flight, arrays, table, amplitudes, plane), 6.0, tally)
    tally.check()
    assert min(tally.contact, tally.clear) > 0.03 * tally.tried


def test_arrival_is_the_state_at_the_returned_time():
    for rotor, rng in rotors(700, 20):
        for _ in range(5):
            task, work = inside_task(rotor, rng), workspace(2)
            for horizon in (0.3, 3.0, 30.0):
                _, time = events.first_crossing(
                    task.arrays, task.table, 0, task.amplitudes, horizon, events.INSIDE, work
                )
                expected = rotor.system.fly(task.amplitudes, np.array(time))
                scale = np.abs(task.amplitudes).sum() + np.abs(rotor.equilibrium)
                assert np.abs(work.end - expected).max() <= 1e-14 * scale * (1.0 + time)


def test_amplitudes_are_left_alone():
    (rotor, rng), work = rotors(800, 1)[0], workspace(2)
    task = inside_task(rotor, rng)
    before = task.amplitudes.copy()
    events.first_crossing(task.arrays, task.table, 0, task.amplitudes, 10.0, events.INSIDE, work)
    assert np.array_equal(task.amplitudes, before)


def test_whirl_that_hugs_the_wall():
    """Without damping and unbalance a circular whirl stays 1e-12 inside the wall: clear, and in bounded work."""
    rotor = jeffcott(parameters(0.0, 0.5, rho=0.0))
    for gap in (1e-3, 1e-6, 1e-9, 2e-12):
        task = task_from_state(rotor, 1.0 - gap, -0.5j * (1.0 - gap))
        outcome, time = events.first_crossing(
            task.arrays, task.table, 0, task.amplitudes, 2.0, events.INSIDE, workspace(2)
        )
        assert (outcome, time) == (Outcome.CLEAR, 2.0)


def test_whirl_on_the_wall_is_grazing():
    """The same whirl to within rounding of the wall cannot be decided."""
    rotor = jeffcott(parameters(0.0, 0.5, rho=0.0))
    task = task_from_state(rotor, 1.0 - 1e-15, -0.5j * (1.0 - 1e-15))
    outcome, _ = events.first_crossing(task.arrays, task.table, 0, task.amplitudes, 2.0, events.INSIDE, workspace(2))
    assert outcome == Outcome.GRAZING


def test_a_start_that_is_pressed_on_does_not_leave():
    rotor = jeffcott(parameters(0.1, 0.7))
    angle = rotor.parameters.phi
    task = wall_task(rotor, angle, 0.0, 0.0)
    assert task.flight.level(0.0)[2] > 0
    outcome, time = events.first_crossing(
        task.arrays, task.table, 0, task.amplitudes, 2.0, events.LEAVING, workspace(2)
    )
    assert (outcome, time) == (Outcome.GRAZING, 0.0)


@pytest.mark.parametrize("horizon", [0.0, -1e-17, 1e-300, 1e-9])
def test_short_horizons(horizon):
    (rotor, rng) = rotors(900, 1)[0]
    task = inside_task(rotor, rng)
    outcome, time = events.first_crossing(
        task.arrays, task.table, 0, task.amplitudes, horizon, events.INSIDE, workspace(2)
    )
    assert (outcome, time) == (Outcome.CLEAR, horizon)


def run(task, horizon):
    work = workspace(len(task.amplitudes))
    return events.first_crossing(task.arrays, task.table, task.plane, task.amplitudes, horizon, task.start, work)


def test_a_crossing_counts_if_it_is_not_later_than_the_horizon():
    """On the first block and on later ones."""
    blocks, exact = set(), 0
    for rotor, rng in rotors(910, 30):
        for task in (inside_task(rotor, rng), random_wall_task(rotor, rng, 0)):
            crossing = first_crossing(task.flight, HORIZON, task.radial_speed)
            if crossing is None or crossing.slope < 1e-3:
                continue
            blocks.add(min(int(crossing.time / longest_block(task)), 2))
            early, late = crossing.time * (1.0 - 1e-7), crossing.time * (1.0 + 1e-7)
            assert run(task, early) == (Outcome.CLEAR, early)
            outcome, time = run(task, late)
            assert outcome == Outcome.CONTACT
            assert time == pytest.approx(crossing.time, abs=4 * task.noise(time) / crossing.slope)
            if time < longest_block(task) / SHORTENING ** (LEVELS - 1):
                assert run(task, time) == (outcome, time)
                exact += 1
    assert blocks == {0, 1, 2}
    assert exact > 0


def touching_task(rotor, rng):
    """A flight whose distance has a maximum on the wall, but for the rounding of its start; and that time."""
    normal = unit(rng.uniform(0.0, 6.0))
    flight = flight_of(rotor.parameters, normal, acb(0, rng.normal()) * normal)
    back = rng.uniform(0.05, 1.0)
    if not flight.level(0.0)[2] < -1e-2 or not all(flight.level(-share * back)[0] < 0 for share in (0.1, 0.5, 1.0)):
        return None
    start = flight.state(-back)
    return task_from_state(rotor, complex(start[0]), complex(start[1])), back


@pytest.mark.parametrize("steps", [False, True], ids=["search", "steps"])
def test_a_flight_that_touches_the_wall_is_never_clear(steps):
    tried = 0
    for rotor, rng in rotors(920, 30):
        task, time = touching_task(rotor, rng) or (None, None)
        if task is None or time > 0.9 * longest_block(task):
            continue
        search = by_steps if steps else run
        assert search(task, longest_block(task))[0] != Outcome.CLEAR
        before = time - 1e-2 * min(time, 1.0)
        assert search(task, before) == (Outcome.CLEAR, before)
        tried += 1
    assert tried >= 10


@pytest.mark.parametrize("damping", [1.0, 1e-3, 1e-5])
def test_a_start_within_its_rounding_of_the_wall_is_not_called_clear(damping):
    """The rounding of a start is that of the terms of its displacement: the larger, the nearer to resonance."""
    rotor = jeffcott(parameters(damping, 1.0))
    for direction in np.exp(1j * np.arange(0.0, 6.0, 0.5)):
        for inward in (1e-3, 0.5):
            spread = at_start(task_from_state(rotor, complex(direction), complex(-inward * direction)))[3]
            for share, expected in ((0.5, Outcome.GRAZING), (2.0, Outcome.CLEAR)):
                depth = 0.5 * share * 16 * EPSILON * spread
                start = (1.0 - depth) * direction
                task = task_from_state(rotor, complex(start), complex(-inward * direction))
                assert run(task, 1e-3 * inward)[0] == expected


def test_nothing_happens_in_no_time_even_within_rounding_of_the_wall():
    rotor = jeffcott(parameters(0.0, 0.5, rho=0.0))
    task = task_from_state(rotor, 1.0 - 1e-15, -0.5j * (1.0 - 1e-15))
    assert run(task, 0.0) == (Outcome.CLEAR, 0.0)


def with_errors(task, size, signs):
    """The same flight with a table whose polynomials err by up to ``size`` at the end of a block, as their bound says.

    On the first block they err as the signs say: −1 where the distance from the wall is to seem as large as it may be.
    """
    products = at_start(task)[0].products
    error = size / np.abs(products).sum()
    table = record(**{name: np.array(task.table[name]) for name in task.table.dtype.names})
    sides = signs * np.sign(products)
    table.coefficients += error * sides[None, :, None] * np.arange(1, DEGREE + 1) / DEGREE
    table.errors += error
    return replace(task, table=table)


@pytest.mark.parametrize("kind", ["seems-far", "seems-near", "mixed"])
def test_whatever_polynomial_its_error_bound_allows_the_first_crossing_is_found(kind):
    """Not only the polynomials of the tables, which are far closer: what is proven needs no more than their bound."""
    tally = Tally("errors of polynomials")
    for rotor, rng in rotors(930, sized(15, 8, 600)):
        tasks = [inside_task(rotor, rng), random_wall_task(rotor, rng, 0)]
        tasks += [drawn[0] for drawn in (near_grazing_task(rotor, rng) for _ in range(4)) if drawn is not None]
        for task in tasks:
            signs = {"seems-far": -1.0, "seems-near": 1.0}.get(kind, rng.choice([-1.0, 1.0], 8))
            compare(with_errors(task, 10.0 ** rng.uniform(-6.0, 0.0), signs), 5.0, tally)
    tally.check()
    assert tally.grazing == 0
