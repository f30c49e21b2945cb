"""Every orbit reported stable attracts a disturbed simulation, and every unstable one repels it."""

from collections.abc import Iterable, Iterator

import numpy as np
import pytest

from carom.motions import State, simulate
from carom.orbits import Orbit, find_orbits
from carom.parameters import Parameters
from tests.machines import PAPER

pytestmark = pytest.mark.jit_only
LEAST = 1e-3
"""Distance of the largest multiplier from the unit circle below which a simulation takes too long to tell."""
SIZE = 1e-7
"""Relative change of the velocity: far above rounding, and small enough for the derivative to hold."""


def orbits(machine: Parameters, most: int, guesses: int) -> Iterator[Orbit]:
    """Admissible orbits with one impact of period up to 40, and those with up to a number of impacts that a search finds."""
    yield from (orbit for orbit in find_orbits(machine, 40.0) if orbit.admissible)
    found = find_orbits(machine, impacts=most, guesses=guesses)
    yield from (orbit for orbit in found if orbit.impacts > 1 and orbit.flies)


def distances(orbit: Orbit, seed: int, periods: int) -> np.ndarray:
    """Largest difference of the radial speeds from those of the orbit in each period, of a motion that starts beside it."""
    rng, before = np.random.default_rng(seed), orbit.departure
    start = State(before.position, before.velocity * (1.0 + SIZE * complex(*rng.normal(size=2))))
    motion = simulate(orbit.rotor, start, (periods + 0.5) * orbit.period)
    speeds = motion.contacts.radial_speed
    whole = len(speeds) // orbit.impacts
    # The first contact after the start is the second of the period.
    expected = np.roll(orbit.impact_speeds, -1)
    return np.abs(speeds[: whole * orbit.impacts].reshape(whole, -1) - expected).max(axis=1)


def tells(orbit: Orbit, seed: int) -> bool:
    """Whether the simulation did what the multipliers say; neutral orbits are left out."""
    radius = orbit.multipliers.spectral_radius
    if abs(radius - 1.0) < LEAST:
        return True
    if orbit.stable:
        # A disturbance may grow at first: look after it should have become a thousandth.
        periods = min(int(np.ceil(np.log(1e-3) / np.log(max(radius, 1e-3)))) + 3, 20_000)
        apart = distances(orbit, seed, periods)
        return len(apart) >= periods - 1 and bool(apart[-1] < 0.2 * max(apart[0], 1e-3 * SIZE))
    periods = int(np.ceil(np.log(1e3) / np.log(radius))) + 3
    apart = distances(orbit, seed, min(periods, 20_000))
    return bool(apart.max() > 10.0 * apart[0]) or len(apart) < periods - 2


def confirmed(machine: Parameters, found: Iterable[Orbit]) -> tuple[int, int]:
    """Numbers of stable and of unstable orbits that the simulation confirms; it must confirm all."""
    counts = [0, 0]
    for orbit in found:
        assert tells(orbit, 4), (machine, orbit)
        counts[orbit.stable] += 1
    return counts[1], counts[0]


def test_orbits_of_the_papers_machine():
    machines = [PAPER.replace(gamma=gamma) for gamma in (0.083, 0.09, 0.12)]
    counts = np.array([confirmed(machine, orbits(machine, 3, 100)) for machine in machines])
    assert counts[:, 0].sum() >= 3
    assert counts[:, 1].sum() > 8
