"""Chains of modes with one exponent, as in free fall, against the matrix exponential."""

import numpy as np
import pytest
from flights import plain_record
from scipy.linalg import expm
from scipy.optimize import brentq

from carom.base.outcome import Outcome
from carom.core.block import move_to
from carom.core.events import INSIDE, first_crossing
from carom.core.flow import fly_all, nudge
from carom.core.layout import workspace
from carom.core.settling import levitates
from carom.core.table import flight_table

LENGTHS = [3, 4]


def chained(length, rng, room=1):
    """A chain of modes between free-standing ones, its matrix, and a flight that starts inside the wall."""
    modes = length + 2 * room
    exponents = rng.uniform(-0.5, 0.1, modes) + 1j * rng.uniform(-2.0, 2.0, modes)
    exponents[room : room + length] = 1j * rng.uniform(-2.0, 2.0)
    driven = np.zeros(modes, bool)
    driven[room + 1 : room + length] = True
    arrays = plain_record(
        exponents=exponents,
        driven=driven,
        offsets=0.1 * (rng.normal(size=1) + 1j * rng.normal(size=1)),
        rows=0.3 * (rng.normal(size=(1, modes)) + 1j * rng.normal(size=(1, modes))),
    )
    matrix = np.diag(exponents) + np.diag(driven[1:].astype(complex), -1)
    amplitudes = 0.4 * (rng.normal(size=modes) + 1j * rng.normal(size=modes))
    return arrays, flight_table(exponents, driven), matrix, amplitudes


@pytest.mark.parametrize("length", LENGTHS)
def test_flights_are_those_of_the_matrix(length):
    for seed in range(5):
        arrays, table, matrix, amplitudes = chained(length, np.random.default_rng(seed))
        for time in (1e-9, 1e-3, 0.7, 5.0, 40.0):
            exact = expm(matrix * time) @ amplitudes
            flown = fly_all(arrays, amplitudes[None], np.array([time]))[0]
            np.testing.assert_allclose(flown, exact, rtol=0, atol=2e-13 * np.abs(exact).max())
        work = workspace(len(amplitudes))
        work.current[:] = amplitudes
        for share in (0.0, 0.013, 0.5, 0.999):
            time = share * float(table.durations[0])
            move_to(arrays, table, time, work)
            exact = expm(matrix * time) @ amplitudes
            np.testing.assert_allclose(work.end, exact, rtol=0, atol=1e-14 * np.abs(exact).max())
        nudged, short = amplitudes.copy(), 1e-5
        nudge(arrays, nudged, short)
        np.testing.assert_allclose(nudged, expm(matrix * short) @ amplitudes, rtol=0, atol=1e-15)


@pytest.mark.parametrize("length", LENGTHS)
def test_the_first_crossing_is_that_of_a_dense_search(length):
    crossed = clear = 0
    for seed in range(80):
        arrays, table, matrix, amplitudes = chained(length, np.random.default_rng(100 + seed), room=seed % 2)
        step = 1e-3
        forward, state, levels = expm(matrix * step), amplitudes.copy(), []
        for _ in range(6000):
            levels.append(abs(arrays.offsets[0] + arrays.rows[0] @ state) - 1.0)
            state = forward @ state
        levels = np.array(levels)
        if levels[0] > -1e-2 or (np.abs(levels) < 1e-4).sum() > 20:  # outside, or along the wall
            continue
        work = workspace(len(amplitudes))
        outcome, time = first_crossing(arrays, table, 0, amplitudes, 5.9, INSIDE, work)
        out = np.flatnonzero(levels[:5900] > 0.0)
        if not len(out):
            assert (outcome, time) == (Outcome.CLEAR, 5.9)
            clear += 1
            continue

        def level(time, arrays=arrays, matrix=matrix, amplitudes=amplitudes):
            return abs(arrays.offsets[0] + arrays.rows[0] @ (expm(matrix * time) @ amplitudes)) - 1.0

        exact = brentq(level, (out[0] - 1) * step, out[0] * step, xtol=1e-15)
        assert outcome == Outcome.CONTACT
        assert time == pytest.approx(exact, abs=1e-11)
        np.testing.assert_allclose(work.end, expm(matrix * time) @ amplitudes, rtol=0, atol=1e-12)
        crossed += 1
    assert crossed > 20
    assert clear > 2


def test_free_fall_never_counts_as_levitation():
    arrays, _, _, amplitudes = chained(3, np.random.default_rng(0))
    work = workspace(len(amplitudes))
    assert not levitates(arrays, 1e-9 * amplitudes, work)
