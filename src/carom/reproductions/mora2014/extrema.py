"""Figure 5: the local extrema of the radius between impacts, along the damping."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from carom.base.results import Result
from carom.base.roots import bracketed_root
from carom.bifurcations import Bifurcation, OrbitBranch
from carom.bifurcations.conditions import grazing_equations
from carom.core.planar import radial_rates
from carom.models import jeffcott
from carom.parameters import Numbers
from carom.reproductions.mora2014.branches import DAMPINGS, FirstPair
from carom.reproductions.mora2014.source import machine_at

SAMPLES = 96
"""Number of subintervals of the period in which extrema are searched."""
SAME_TIME = 1e-3
"""Distance in time, in periods, of the two extrema that meet at a located point."""


@dataclass(frozen=True)
class Extremum:
    """A local extremum of the radius.

    Attributes
    ----------
    time : float
        Since the impact, in ``1/Ω``.
    radius : float
        In clearances.
    """

    time: float
    radius: float


@dataclass(frozen=True, eq=False, repr=False)
class ExtremumLine(Result):
    """One extremum of the radius along a stretch of a branch of orbits.

    Attributes
    ----------
    places : ndarray, shape (m,)
        Position on the branch: index of the previous orbit plus the fraction of the step.
    gammas, radii : ndarray, shape (m,)
    """

    places: np.ndarray
    gammas: np.ndarray
    radii: np.ndarray


@dataclass(frozen=True, eq=False, repr=False)
class RadiusDiagram(Result):
    """Extrema of the radius of all four orbits, and the radius of levitation.

    Attributes
    ----------
    slow, fast : tuple of ExtremumLine
        Extrema of ``B1,a`` and ``B1,b`` (slow), and of ``B1,c`` and ``B1,d`` (fast).
    gammas, levitation : ndarray, shape (m,)
        Damping and radius of the contact-free equilibrium, which is virtual where the radius exceeds 1.
    """

    slow: tuple[ExtremumLine, ...]
    fast: tuple[ExtremumLine, ...]
    gammas: np.ndarray
    levitation: np.ndarray


def radius_diagram(pair: FirstPair) -> RadiusDiagram:
    """Compute figure 5 along the branches of the first pair of orbits."""
    gammas = np.sort(np.append(np.linspace(*DAMPINGS, 200), pair.hopf.gamma))
    levitation = np.array([abs(jeffcott(machine_at(gamma)).equilibrium) for gamma in gammas.tolist()])
    return RadiusDiagram(extremum_lines(pair.slow), extremum_lines(pair.fast), gammas, levitation)


def radius_extrema(numbers: Numbers, period: float, speed: float) -> list[Extremum]:
    """Return every local extremum of the radius strictly between the impacts of an orbit, in order of time.

    Parameters
    ----------
    period, speed : float
        ``T`` and ``ṙ`` of the orbit.
    """

    def outward(time: float) -> float:
        return grazing_equations(numbers, period, speed, time)[0]

    times = np.linspace(0.0, period, SAMPLES + 1)
    rates = _rates(numbers, period, speed, times)
    found = []
    for i in np.flatnonzero(rates[:-1] * rates[1:] < 0.0):
        time = bracketed_root(outward, float(times[i]), float(times[i + 1]))
        found.append(Extremum(time, _radius(numbers, period, speed, time)))
    return found


def extremum_lines(branch: OrbitBranch) -> tuple[ExtremumLine, ...]:
    """Follow every extremum of the radius along a branch of orbits.

    A segment ends where two extrema are born or vanish (``"radius-extremum"`` of
    :class:`~carom.bifurcations.Bifurcation`); its lines extend to that point.
    """
    extrema = [radius_extrema(*orbit[1:]) for orbit in branch.closed]
    turns = [point for point in branch.special if point.kind == "radius-extremum"]
    counts = np.array([len(found) for found in extrema])
    starts = [0, *(np.flatnonzero(np.diff(counts)) + 1).tolist(), len(counts)]
    lines = []
    for start, end in pairwise(starts):
        rows = [(float(place), branch.values[place], extrema[place]) for place in range(start, end)]
        for turn in turns:
            if start - 1 <= turn.place <= start:
                rows.insert(0, (turn.place, turn.value, _joined(turn, int(counts[start]))))
            elif end - 1 <= turn.place <= end:
                rows.append((turn.place, turn.value, _joined(turn, int(counts[start]))))
        lines += [
            ExtremumLine(
                places=np.array([place for place, _, _ in rows]),
                gammas=np.array([gamma for _, gamma, _ in rows]),
                radii=np.array([found[which].radius for _, _, found in rows]),
            )
            for which in range(counts[start])
        ]
    return tuple(lines)


def flattest(point: Bifurcation) -> Extremum:
    """Return the point of an orbit at which two extrema of the radius are born: its rate is zero but keeps its sign."""
    times = np.linspace(0.0, point.period, 8 * SAMPLES + 1)
    at = point.numbers, point.period, point.radial_speed
    rates = _rates(*at, times)
    size = np.abs(rates)
    # The rate touches zero without a change of sign; where the sign changes, there is a proper extremum.
    touching = np.flatnonzero(
        (size[1:-1] <= size[:-2]) & (size[1:-1] <= size[2:]) & (np.sign(rates[:-2]) == np.sign(rates[2:]))
    )
    place = int(touching[np.argmin(size[touching + 1])]) + 1
    before, here, after = rates[place - 1 : place + 2]
    # Vertex of the parabola through three rates.
    time = times[place] + 0.5 * (before - after) / (before - 2.0 * here + after) * (times[1] - times[0])
    return Extremum(float(time), _radius(*at, float(time)))


def _joined(turn: Bifurcation, count: int) -> list[Extremum]:
    """Return the extrema at the birth of two, as many as the segment has: the newborn one twice or not at all."""
    newborn = flattest(turn)
    found = radius_extrema(turn.numbers, turn.period, turn.radial_speed)
    passing = [entry for entry in found if abs(entry.time - newborn.time) > SAME_TIME * turn.period]
    twice = [newborn, newborn] if count > len(passing) else []
    return sorted([*passing, *twice], key=lambda entry: entry.time)


def _rates(numbers: Numbers, period: float, speed: float, times: np.ndarray) -> np.ndarray:
    """Return ``Re(Ū U̇)`` at times since the impact."""
    gamma, omega, _, _, mu, d, *_ = numbers
    rates: np.ndarray = radial_rates(gamma, omega, mu, d, period, speed, times)
    return rates


def _radius(numbers: Numbers, period: float, speed: float, time: float) -> float:
    return math.sqrt(1.0 + grazing_equations(numbers, period, speed, time)[1])
