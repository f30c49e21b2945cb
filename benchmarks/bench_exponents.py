"""Lyapunov exponents, beside the simulation alone and beside two motions that are kept close to each other."""

from __future__ import annotations

import math
import time

import pytest
from workload import source_paper_machine

from carom.motions import State, simulate
from carom.orbits import find_orbits, lyapunov_exponents

# A busy machine disturbs the processor's time less than the time of day.
pytestmark = pytest.mark.benchmark(timer=time.process_time, group="Lyapunov exponents, chaos at gamma = 0.082")

IMPACTS, FEW = 100_000, 1000
TWO = "two motions brought back to 1e-8 after each 10/Omega: the largest exponent alone, with its error"


@pytest.fixture(scope="module")
def chaos():
    """The chaotic bouncing of the machine of the source paper, and a start on it."""
    rotor = source_paper_machine(0.082)
    beside = find_orbits(rotor)["B1,d"].departure
    start = State(beside.position, 1.001 * beside.velocity)
    return rotor, simulate(rotor, start, 1e5, max_events=5000).final


def note(benchmark, who, impacts):
    benchmark.extra_info.update(who=who, unit="impact", units=impacts)


def test_exponents(benchmark, chaos):
    found = benchmark.pedantic(lyapunov_exponents, args=(*chaos, IMPACTS), kwargs={"transient": 100}, rounds=3)
    assert found.positive
    note(benchmark, "carom", IMPACTS)


def test_simulation_alone(benchmark, chaos):
    benchmark.pedantic(simulate, args=(*chaos, 1e6), kwargs={"max_events": IMPACTS}, rounds=3)
    note(benchmark, "the simulation alone, with its log", IMPACTS)


def test_two_motions(benchmark, chaos):
    rotor, start = chaos

    def followed() -> int:
        first, second, impacts, grown = start, State(0.99999999 * start.position, start.velocity), 0, 0.0
        while impacts < FEW:
            motions = [simulate(rotor, state, 10.0) for state in (first, second)]
            first, other = (motion.final for motion in motions)
            apart = other.position - first.position, other.velocity - first.velocity
            size = math.hypot(*map(abs, apart))
            grown += math.log(size / 1e-8)
            impacts += len(motions[0].arrivals)
            position = first.position + 1e-8 / size * apart[0]
            second = State(position / max(1.0, abs(position)), first.velocity + 1e-8 / size * apart[1])
        return impacts

    impacts = followed()
    benchmark.pedantic(followed, rounds=3)
    note(benchmark, TWO, impacts)
