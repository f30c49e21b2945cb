"""The first crossing by the search that was taken and by those that were not, on the flights of the same motions."""

from __future__ import annotations

import time

import candidates
import numba
import numpy as np
import pytest
from workload import UNTIL, Bounces, source_paper_machine

from carom.core.events import INSIDE, LEAVING, first_crossing
from carom.core.layout import workspace

# A busy machine disturbs the processor's time less than the time of day.
pytestmark = pytest.mark.benchmark(timer=time.process_time)

MOTIONS = 2_000
SHORTEST = 1e-4
"""Flights that are shorter, late in a chatter, are left out: the candidates' ``f`` has lost its digits there."""
AGREEMENT = 1e-13
"""Largest ``f`` at one time seen from the other: some hundred times the rounding of ``f``."""


@pytest.fixture(scope="module", params=(0.1, 0.15))
def flights(request, starts):
    """Rotor, amplitudes at the start of flights, whether it is on the wall, horizon, time and slope of the crossing."""
    rotor = source_paper_machine(request.param)
    collected = []
    for start in starts[:MOTIONS]:
        run = Bounces(rotor, start[None])
        impacts = run()
        times = np.concatenate([[0.0], run.log.times[:impacts]])
        ends = np.append(times[1:], UNTIL)
        last = impacts if impacts < len(run.log.times) else impacts - 1
        for k in range(last + 1):
            amplitudes = run.starts[0] if k == 0 else run.log.after[k - 1]
            if ends[k] - times[k] > SHORTEST:
                collected.append((amplitudes.copy(), k > 0, UNTIL - times[k]))
    amplitudes, on_wall, horizons = (np.array(column) for column in zip(*collected, strict=True))
    return request.param, rotor, amplitudes, on_wall, horizons


@numba.njit
def by_blocks(rotor, table, amplitudes, on_wall, horizons, work, times):
    for i in range(len(horizons)):
        start = LEAVING if on_wall[i] else INSIDE
        _, times[i] = first_crossing(rotor, table, 0, amplitudes[i], horizons[i], start, work)


def by_candidate(search):
    @numba.njit
    def run(rest, first, second, terms, on_wall, horizons, times):
        for i in range(len(horizons)):
            times[i] = search(rest, first, second, terms[i, 0], terms[i, 1], on_wall[i], horizons[i])

    return run


def blocks_run(flights):
    _, rotor, amplitudes, on_wall, horizons = flights
    times = np.empty(len(horizons))
    work = workspace(2)

    def run():
        by_blocks(rotor.system.arrays, rotor.system.table, amplitudes, on_wall, horizons, work, times)
        return times

    return run


def candidate_run(flights, search):
    _, rotor, amplitudes, on_wall, horizons = flights
    second, first = rotor.system.exponents
    driving = amplitudes[:, 0] / (first - second)
    terms = np.stack([amplitudes[:, 1] + driving, -driving], axis=1)
    times, loop = np.empty(len(horizons)), by_candidate(search)

    def run():
        loop(rotor.equilibrium, first, second, terms, on_wall, horizons, times)
        return times

    return run


def measure(benchmark, flights, run, who):
    found = run().copy()
    gamma, rotor, amplitudes, _, horizons = flights
    expected = blocks_run(flights)()
    position, velocity = rotor.system.state(rotor.system.fly(amplitudes, np.minimum(found, expected)))
    slope = 2.0 * np.abs((position.conj() * velocity).real)
    assert np.array_equal(found < horizons, expected < horizons)
    assert (np.abs(found - expected) * slope).max() < AGREEMENT
    benchmark.group = f"first crossing of the same flights, gamma = {gamma}"
    benchmark(run)
    benchmark.extra_info.update(who=who, unit="flight", units=len(horizons))


def test_blocks(benchmark, flights):
    measure(benchmark, flights, blocks_run(flights), "carom")


def test_safe_steps(benchmark, flights):
    measure(benchmark, flights, candidate_run(flights, candidates.safe_steps), "safe steps alone")


def test_fixed_steps(benchmark, flights):
    measure(benchmark, flights, candidate_run(flights, candidates.fixed_steps), "fixed steps, Hermite and Bernstein")
