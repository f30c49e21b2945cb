"""No crossing is missed and none invented: the kernel against the high-precision reference."""

from __future__ import annotations

import math

import numpy as np
import pytest
from compilation import sized
from flights import (
    Tally,
    Task,
    compare,
    inside_task,
    near_grazing_task,
    parameters,
    random_wall_task,
    rotors,
    task_from_state,
    wall_task,
)
from reference import plane_flight

from carom.core import events
from carom.core.layout import rotor_record, workspace
from carom.core.table import flight_table
from carom.outcome import Outcome
from carom.rotors import jeffcott

HORIZON = 15.0


def count(flights: int) -> int:
    """How many flights to try: all in a deep run, every tenth by day, without the compiler every line at least."""
    return sized(math.ceil(0.1 * flights), math.ceil(0.03 * flights), flights)


@pytest.mark.parametrize("batch", range(4))
def test_random_flights(batch, record_property):
    tally = Tally("random flights")
    for rotor, rng in rotors(100 + batch, count(1_000)):
        for _ in range(25):
            compare(inside_task(rotor, rng), HORIZON, tally)
    record_property("flights", tally.as_property())
    tally.check()
    assert tally.tried >= count(25_000)
    assert min(tally.contact, tally.clear) > 0.2 * tally.tried


@pytest.mark.parametrize("batch", range(2))
def test_near_grazing_flights(batch, record_property):
    tally, passes = Tally("near-grazing flights"), 0
    wanted = count(6_000)
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
    record_property("flights", tally.as_property())
    tally.check()
    assert passes >= wanted
    # Peaks stand out by 2e-12 and more; rounding stays below that.
    assert tally.grazing == 0


@pytest.mark.parametrize("kind", range(4), ids=["fast", "late-chatter", "slow", "along-the-wall"])
def test_starts_on_the_wall(kind, record_property):
    tally = Tally("starts on the wall")
    wanted = count(3_000)
    for rotor, rng in rotors(300 + kind, wanted):
        for _ in range(30):
            task = random_wall_task(rotor, rng, kind)
            if task is not None:
                compare(task, HORIZON, tally)
        if tally.tried >= wanted:
            break
    record_property("flights", tally.as_property())
    tally.check()
    assert tally.tried >= wanted
    assert tally.grazing == 0


def test_near_resonance(record_property):
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
    record_property("flights", tally.as_property())
    tally.check()
    assert tally.grazing < 0.1 * tally.tried


def test_high_speeds(record_property):
    """The time of contact is as exact, relative to the duration of a flight, at a thousand clearances a turn."""
    tally = Tally("high speeds")
    for rotor, rng in rotors(500, count(100)):
        for _ in range(20):
            position = rng.uniform(0.0, 0.99) * np.exp(2j * math.pi * rng.uniform())
            velocity = 10.0 ** rng.uniform(1.0, 3.0) * np.exp(2j * math.pi * rng.uniform())
            compare(task_from_state(rotor, complex(position), complex(velocity)), 3.0, tally)
    record_property("flights", tally.as_property())
    tally.check()


def test_extreme_parameters(record_property):
    """Damping and stiffness over six decades, some of the damping negative, starts as fast as the modes."""
    tally = Tally("extreme parameters")
    rng = np.random.default_rng(550)
    while tally.tried < count(5_000):
        omega = 10.0 ** rng.uniform(-3.0, 3.0)
        gamma = 10.0 ** rng.uniform(-3.0, 3.0) * rng.choice([1.0, 1.0, 1.0, -0.05])
        stiffness = abs(complex(omega**2 - 1.0, gamma))
        rotor = jeffcott(parameters(gamma, omega, rho=min(2.0 * rng.uniform() * stiffness, 1e3)))
        fastest = np.abs(rotor.eigenvalues).max()
        for _ in range(4):
            position, velocity = math.sqrt(rng.uniform()), fastest * 10.0 ** rng.uniform(-3.0, 1.0)
            turn = np.exp(2j * math.pi * rng.uniform(size=2))
            task = task_from_state(rotor, complex(position * turn[0]), complex(velocity * turn[1]))
            compare(task, 10.0 / fastest, tally)
            leaving = -fastest * 10.0 ** rng.uniform(-6.0, 1.0)
            task = wall_task(rotor, 2.0 * math.pi * rng.uniform(), leaving, fastest * rng.normal())
            compare(task, 10.0 / fastest, tally)
    record_property("flights", tally.as_property())
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
        drive=np.full(2, 5.0),
    )


def complex_normal(rng, *shape):
    return rng.normal(size=shape) + 1j * rng.normal(size=shape)


@pytest.mark.parametrize("kind", ["free-standing", "pair", "near pair", "degenerate pair", "growing"])
def test_rotors_with_many_modes_and_planes(kind, record_property):
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
    record_property("flights", tally.as_property())
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
                expected = rotor.fly(task.amplitudes, np.array(time))
                scale = np.abs(task.amplitudes).sum() + np.abs(rotor.equilibrium)
                assert np.abs(work.arrival - expected).max() <= 1e-14 * scale * (1.0 + time)


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


# ------------------------------------------------------------------------------------------------ its parts


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
    assert events._first_root(-1.0, 0.0, 0.0) == events._first_root(-1.0, -1.0, 0.0) == math.inf
    # Double root, and just none.
    assert events._first_root(-1.0, 2.0, -2.0) == 1.0
    assert events._first_root(-1.0, 2.0, -2.1) == math.inf
    # Along the wall: pulled off it stays off for a while, pressed on or free nothing can be said.
    assert events._departure(0.0, -2.0, 3.0) == 2.0
    assert events._departure(0.0, 0.0, 3.0) == events._departure(0.0, 1.0, 3.0) == 0.0


def test_a_householder_step_errs_by_the_fourth_power():
    """On ``e^t + t²/2 − 1``, which vanishes at zero, and on its negative."""
    for side in (1.0, -1.0):
        errors = []
        for distance in (1e-1, 1e-2):
            power = math.exp(distance)
            derivatives = (power + 0.5 * distance**2 - 1.0, power + distance, power + 1.0, power)
            errors.append(abs(distance + events.householder_step(*(side * value for value in derivatives))))
        assert math.log10(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.3)


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
