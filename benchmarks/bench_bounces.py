"""First crossings and sequences of impacts, next to SciPy's and heyoka's events."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import numba
import numpy as np
import pytest
from peers import HeyokaBounces, scipy_bounces
from workload import MOST_IMPACTS, UNTIL, source_paper_machine

from carom.core.advance import INSIDE_ALL, advance
from carom.core.events import INSIDE, first_crossing
from carom.core.fate import memory
from carom.core.layout import rub_workspace, workspace
from carom.outcome import Phase
from carom.trajectories import EventLog

GAMMAS = (0.1, 0.15)
FLYING = int(Phase.FLIGHT)


@numba.njit
def all_crossings(rotor, table, amplitudes, until, work):
    found = 0
    for i in range(amplitudes.shape[0]):
        outcome, _ = first_crossing(rotor, table, 0, amplitudes[i], until, INSIDE, work)
        found += outcome
    return found


@numba.njit
def all_bounces(rotor, table, starts, until, times, phases, planes, before, after, recollection, work, rub):
    impacts = 0
    amplitudes = np.empty_like(starts[0])
    for i in range(starts.shape[0]):
        amplitudes[:] = starts[i]
        _, _, events, _, _ = advance(
            rotor,
            table,
            amplitudes,
            until,
            FLYING,
            INSIDE_ALL,
            times,
            phases,
            planes,
            before,
            after,
            recollection,
            work,
            rub,
        )
        impacts += events
    return impacts


def amplitudes_of(rotor, starts):
    return np.array([rotor.amplitudes(*start) for start in starts])


def note(benchmark, who, unit, units):
    benchmark.extra_info.update(who=who, unit=unit, units=units)


def test_flights_carom(benchmark, starts):
    rotor = source_paper_machine(0.1)
    benchmark.group = "first crossing, gamma = 0.1"
    benchmark(all_crossings, rotor.arrays, rotor.table, amplitudes_of(rotor, starts), UNTIL, workspace(2))
    note(benchmark, "carom", "flight", len(starts))


def test_flights_heyoka(benchmark, starts):
    pytest.importorskip("heyoka")
    peer = HeyokaBounces(source_paper_machine(0.1).parameters)
    some = starts[:200]
    benchmark.group = "first crossing, gamma = 0.1"
    benchmark(lambda: sum(peer(start, UNTIL, 1) for start in some))
    note(benchmark, "heyoka, terminal event", "flight", len(some))


def test_flights_scipy(benchmark, starts):
    parameters = source_paper_machine(0.1).parameters
    some = starts[:10]
    benchmark.group = "first crossing, gamma = 0.1"
    benchmark(lambda: sum(scipy_bounces(parameters, start, UNTIL, 1) for start in some))
    note(benchmark, "SciPy DOP853 events, rtol 1e-10", "flight", len(some))


@pytest.mark.parametrize("gamma", GAMMAS)
def test_impacts_carom(benchmark, starts, gamma):
    rotor = source_paper_machine(gamma)
    log = EventLog.empty(MOST_IMPACTS, 2)
    work = memory(2, stop_at_landing=True), workspace(2), rub_workspace(2)
    begin = amplitudes_of(rotor, starts)
    benchmark.group = f"sequence of impacts, gamma = {gamma}"
    impacts = benchmark(all_bounces, rotor.arrays, rotor.table, begin, UNTIL, *log, *work)
    note(benchmark, "carom", "impact", impacts)


@pytest.mark.parametrize("gamma", GAMMAS)
def test_impacts_heyoka(benchmark, starts, gamma):
    pytest.importorskip("heyoka")
    peer = HeyokaBounces(source_paper_machine(gamma).parameters)
    some = starts[:20]
    benchmark.group = f"sequence of impacts, gamma = {gamma}"
    impacts = benchmark(lambda: sum(peer(start, UNTIL, MOST_IMPACTS) for start in some))
    note(benchmark, "heyoka, terminal event", "impact", impacts)


@pytest.mark.parametrize("gamma", GAMMAS)
def test_impacts_scipy(benchmark, starts, gamma):
    parameters = source_paper_machine(gamma).parameters
    benchmark.group = f"sequence of impacts, gamma = {gamma}"
    impacts = benchmark.pedantic(
        lambda: sum(scipy_bounces(parameters, start, UNTIL, MOST_IMPACTS) for start in starts[:2]), rounds=3
    )
    note(benchmark, "SciPy DOP853 events, rtol 1e-10", "impact", impacts)


@pytest.mark.parametrize("gamma", GAMMAS)
def test_impacts_hand_written(benchmark, gamma):
    """The ceiling: a hand-written C++ program, if CAROM_LIMIT_DIR holds it built (``scalar`` and ``ics.bin``)."""
    folder = Path(os.environ.get("CAROM_LIMIT_DIR", ""))
    if not os.environ.get("CAROM_LIMIT_DIR") or not (folder / "scalar").exists():
        pytest.skip("CAROM_LIMIT_DIR does not name a folder with the program 'scalar'")
    benchmark.group = f"sequence of impacts, gamma = {gamma}"
    told = benchmark.pedantic(
        lambda: subprocess.run(["./scalar", str(gamma), "5"], cwd=folder, capture_output=True, text=True, check=True),
        rounds=1,
    ).stdout
    line = next(line for line in told.splitlines() if "BERN" in line)
    cost = 1e-9 * float(line.split(" ns/imp")[0].split()[-1])
    note(benchmark, "C++, scalar, by its own clock", "impact", benchmark.stats.stats.median / cost)
