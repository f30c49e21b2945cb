"""Ensembles of motions, next to hand-written vector code, heyoka and SciPy; and with every contact, to where they settle."""

from __future__ import annotations

import os
import re
import subprocess
import time
from pathlib import Path
from statistics import median

import pytest
from against_peers.bouncing import HeyokaFlights, bounces
from scipy_flights import ScipyFlights
from workload import MOST_IMPACTS, UNTIL, source_paper_machine

from carom.core.processors import available_cores
from carom.motions.ensembles import settle
from carom.motions.starts import State

GAMMAS = (0.1, 0.15)
PROGRAMS = {"simd": "C++, AVX-512, by its own clock", "scalar": "C++, scalar, by its own clock"}
LANE_BLOCKS = ("3", "0.8", "1")
"""Block lengths and number of runs the vector program is stated."""


def follow(rotor, starts, threads=1, **limits):
    endings = settle(rotor, State(starts[:, 0], starts[:, 1]), threads=threads, **limits)
    return int(endings.impacts.sum())


def bounce(rotor, starts, threads=1):
    return follow(rotor, starts, threads, patience=0, until=UNTIL, max_events=MOST_IMPACTS)


def hand_written(program, gamma):
    """Seconds an impact costs the hand-written program in one run, or nothing if CAROM_LIMIT_DIR does not hold it."""
    folder = os.environ.get("CAROM_LIMIT_DIR", "")
    if not folder or not (Path(folder) / program).exists():
        return None
    command = [f"./{program}", str(gamma), *(LANE_BLOCKS if program == "simd" else ("1",))]
    shown = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True).stdout
    line = next(line for line in shown.splitlines() if "SIMD" in line or "BERN" in line)
    return 1.0 / float(re.search(r"([\d.e+]+) imp/s", line)[1])


@pytest.mark.benchmark(timer=time.perf_counter)
@pytest.mark.parametrize("gamma", GAMMAS)
def test_bounces_of_an_ensemble(benchmark, starts, gamma):
    """On one core, in turns with the hand-written programs and with a few motions of the peers."""
    pytest.importorskip("heyoka")
    rotor = source_paper_machine(gamma)
    heyoka, scipy = HeyokaFlights(rotor.parameters), ScipyFlights(rotor.parameters, 1e-10)
    costs: dict[str, list[float]] = {}

    def note(who, cost):
        if cost is not None:
            costs.setdefault(who, []).append(cost)

    def by_peer(peer, count):
        began = time.perf_counter()
        impacts = sum(len(bounces(peer, rotor.parameters, *start, UNTIL, MOST_IMPACTS)[0]) for start in starts[:count])
        return (time.perf_counter() - began) / impacts, impacts

    def take_turns():
        for program, who in PROGRAMS.items():
            note(who, hand_written(program, gamma))
        heyoka.seconds = 0.0
        _, impacts = by_peer(heyoka, 10)
        note("heyoka, terminal event, its own share", heyoka.seconds / impacts)
        note("SciPy DOP853 events, rtol 1e-10", by_peer(scipy, 1)[0])

    impacts = bounce(rotor, starts)
    benchmark.group = f"ensemble of bounces, one core, gamma = {gamma}"
    benchmark.pedantic(bounce, args=(rotor, starts), setup=take_turns, rounds=9)
    beside = {who: median(values) for who, values in costs.items()}
    benchmark.extra_info.update(who="carom", unit="impact", units=impacts, beside=beside)


@pytest.mark.parametrize("gamma", GAMMAS)
def test_to_where_it_settles(benchmark, starts, gamma):
    """The same starts with chatter and rub, each to its stated outcome."""
    rotor = source_paper_machine(gamma)
    benchmark.group = f"ensemble with every contact, to where it settles, one core, gamma = {gamma}"
    impacts = benchmark(follow, rotor, starts)
    benchmark.extra_info.update(who="carom", unit="impact", units=impacts)


@pytest.mark.benchmark(timer=time.perf_counter)
def test_cores(benchmark, starts):
    """The time of a start on one core, in turns with all cores."""
    rotor, many, cores = source_paper_machine(0.1), starts.repeat(16, axis=0), available_cores()
    seconds: list[float] = []

    def on_all_cores():
        began = time.perf_counter()
        follow(rotor, many, threads=cores)
        seconds.append(time.perf_counter() - began)

    on_all_cores()
    seconds.clear()
    benchmark.group = "ensemble with every contact, on several cores, gamma = 0.1"
    benchmark.pedantic(follow, args=(rotor, many), setup=on_all_cores, rounds=9)
    beside = {f"carom, {cores} cores": median(seconds) / len(many)}
    benchmark.extra_info.update(who="carom", unit="start", units=len(many), beside=beside)
