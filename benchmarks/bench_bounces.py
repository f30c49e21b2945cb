"""First crossings and sequences of impacts, next to SciPy's and heyoka's events."""

from __future__ import annotations

import os
import subprocess
import time
from pathlib import Path
from statistics import median

import numba
import pytest
from against_peers.bouncing import HeyokaFlights, bounces
from scipy_flights import ScipyFlights
from workload import MOST_IMPACTS, UNTIL, Bounces, amplitudes_of, source_paper_machine

from carom.core.events import INSIDE, first_crossing
from carom.core.layout import workspace

# A busy machine disturbs the processor's time less than the time of day.
pytestmark = pytest.mark.benchmark(timer=time.process_time)

GAMMAS = (0.1, 0.15)
SCIPY, HEYOKA = "SciPy DOP853 events, rtol 1e-10", "heyoka, terminal event, called from Python"
HEYOKA_ALONE = "heyoka, terminal event, its own share"


@numba.njit
def all_crossings(rotor, table, amplitudes, until, work):
    found = 0
    for i in range(amplitudes.shape[0]):
        outcome, _ = first_crossing(rotor, table, 0, amplitudes[i], until, INSIDE, work)
        found += outcome
    return found


def note(benchmark, who, unit, units, **beside):
    benchmark.extra_info.update(who=who, unit=unit, units=units, **beside)


def run_heyoka(benchmark, peer, work, unit):
    """Time a piece of work, and how much of it passes in the integrator itself."""
    units = work()
    benchmark(work)
    peer.seconds = 0.0
    for _ in range(5):
        work()
    note(benchmark, HEYOKA, unit, units, beside={HEYOKA_ALONE: peer.seconds / 5 / units})


def test_flights_carom(benchmark, starts):
    rotor = source_paper_machine(0.1)
    benchmark.group = "first crossing, gamma = 0.1"
    benchmark(all_crossings, rotor.system.arrays, rotor.system.table, amplitudes_of(rotor, starts), UNTIL, workspace(2))
    note(benchmark, "carom", "flight", len(starts))


def test_flights_heyoka(benchmark, starts):
    pytest.importorskip("heyoka")
    peer = HeyokaFlights(source_paper_machine(0.1).parameters)
    benchmark.group = "first crossing, gamma = 0.1"
    run_heyoka(benchmark, peer, lambda: len([peer(*start, UNTIL) for start in starts[:200]]), "flight")


def test_flights_scipy(benchmark, starts):
    peer = ScipyFlights(source_paper_machine(0.1).parameters, 1e-10)
    benchmark.group = "first crossing, gamma = 0.1"
    benchmark(lambda: [peer(*start, UNTIL) for start in starts[:10]])
    note(benchmark, SCIPY, "flight", 10)


@pytest.mark.parametrize("gamma", GAMMAS)
def test_impacts_carom(benchmark, starts, gamma):
    benchmark.group = f"sequence of impacts, gamma = {gamma}"
    impacts = benchmark(Bounces(source_paper_machine(gamma), starts))
    note(benchmark, "carom", "impact", impacts)


def count_impacts(peer, parameters, starts):
    return sum(len(bounces(peer, parameters, *start, UNTIL, MOST_IMPACTS)[0]) for start in starts)


@pytest.mark.parametrize("gamma", GAMMAS)
def test_impacts_heyoka(benchmark, starts, gamma):
    pytest.importorskip("heyoka")
    parameters = source_paper_machine(gamma).parameters
    peer = HeyokaFlights(parameters)
    benchmark.group = f"sequence of impacts, gamma = {gamma}"
    run_heyoka(benchmark, peer, lambda: count_impacts(peer, parameters, starts[:20]), "impact")


@pytest.mark.parametrize("gamma", GAMMAS)
def test_impacts_scipy(benchmark, starts, gamma):
    parameters = source_paper_machine(gamma).parameters
    peer = ScipyFlights(parameters, 1e-10)
    benchmark.group = f"sequence of impacts, gamma = {gamma}"
    impacts = benchmark.pedantic(count_impacts, args=(peer, parameters, starts[:2]), rounds=3)
    note(benchmark, SCIPY, "impact", impacts)


@pytest.mark.benchmark(timer=time.perf_counter)
@pytest.mark.parametrize("gamma", GAMMAS)
def test_impacts_beside_a_hand_written_program(benchmark, starts, gamma):
    """The ceiling: a hand-written C++ program, if CAROM_LIMIT_DIR holds it built (``scalar`` and ``ics.bin``).

    The two take turns, both by the time of day, which is what the program tells: a busy machine slows both.
    """
    folder = Path(os.environ.get("CAROM_LIMIT_DIR", ""))
    if not os.environ.get("CAROM_LIMIT_DIR") or not (folder / "scalar").exists():
        pytest.skip("CAROM_LIMIT_DIR does not name a folder with the program 'scalar'")
    costs = []

    def run_hand_written():
        command = ["./scalar", str(gamma), "1"]
        shown = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True).stdout
        line = next(line for line in shown.splitlines() if "BERN" in line)
        costs.append(1e-9 * float(line.split(" ns/imp")[0].split()[-1]))

    run = Bounces(source_paper_machine(gamma), starts)
    impacts = run()
    benchmark.group = f"sequence of impacts, in turns, gamma = {gamma}"
    benchmark.pedantic(run, setup=run_hand_written, rounds=9)
    note(benchmark, "carom", "impact", impacts, beside={"C++, scalar, by its own clock": median(costs)})
