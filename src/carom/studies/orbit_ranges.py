"""For which damping, and for which stiffness, orbits with one impact a period are possible: by search."""

from __future__ import annotations

import math

import numpy as np

from carom.bifurcations import Window, WindowEnd, orbit_windows
from carom.closed_forms.thresholds import Gain
from carom.models import Jeffcott
from carom.orbits.single_impact import longest_within_reach, orbits_within_reach
from carom.outcome import CaromError
from carom.parameters import DIMENSIONLESS_FIELDS, Parameters
from carom.progress import ShowProgress
from carom.studies.ranges import Edge, MotionRange, Span

FINEST_STEP = {"gamma": 0.1, "omega": 0.05}
"""Relative step between the values at which all orbits are computed."""
NEARBY = 1e-6
"""Relative distance from an edge at which the certified lists of orbits must confirm it."""


def single_impact_ranges(parameters: Parameters, gain: Gain, progress: ShowProgress = None) -> tuple[MotionRange, ...]:
    """Find where single-impact orbits are motions of the machine (:func:`~carom.bifurcations.orbit_windows`).

    Damping is searched from a fraction of the machine's own to where the rotor is far overdamped; stiffness from a
    quarter of the machine's own to four times it.  Return the ranges of all admissible orbits, and of the stable ones if there are not
    too many orbits to follow; none if no search is possible: for stiffness without damping, or with so little that there are too many orbits to follow or to
    list.
    """
    values = _values(parameters, gain)
    if values is None:
        return ()
    searched, step = Span(Edge(values[0]), Edge(values[-1])), values[1] / values[0] - 1.0
    possible: tuple[Window, ...] = ()  # a balanced rotor has no such orbit
    stable: tuple[Window, ...] | None = ()
    if parameters.rho > 0.0:
        try:
            windows = orbit_windows(parameters, gain, values, progress)
        except CaromError:
            return ()
        possible, stable = windows.possible, windows.stable
    spans = tuple(_span(parameters, gain, window, stable=False) for window in possible)
    found = [MotionRange("single-impact", gain, spans, searched, step)]
    if stable is not None:
        spans = tuple(_span(parameters, gain, window, stable=True) for window in stable)
        found.append(MotionRange("stable-single-impact", gain, spans, searched, step))
    return tuple(found)


def _values(parameters: Parameters, gain: Gain) -> list[float] | None:
    """Return the values to search, in geometric progression; the list of orbits is complete at each of them."""
    limits = DIMENSIONLESS_FIELDS[gain]
    if gain == "omega":
        lowest, highest = 0.5 * parameters.omega, 2.0 * parameters.omega
    else:
        lowest = min(0.02 * max(1.0, parameters.omega), 0.5 * parameters.gamma if parameters.gamma > 0 else 1.0)
        highest = 8.0 * max(1.0, parameters.omega, parameters.gamma)
        while lowest < 0.1 * highest and not _can_search(parameters.replace(gamma=lowest)):
            lowest *= 2.0
        highest = min(highest, limits.highest)
        # A soft rotor is so strongly overdamped there that one of its exponents decays very slowly.
        while highest > 4.0 * max(lowest, parameters.gamma) and not _can_search(parameters.replace(gamma=highest)):
            highest *= 0.5
    lowest, highest = max(lowest, limits.lowest), min(highest, limits.highest)
    ends = [parameters.replace(**{gain: value}) for value in (lowest, highest)]
    if lowest >= highest or not all(_can_search(end) for end in ends):
        return None
    steps = math.ceil(math.log(highest / lowest) / math.log1p(FINEST_STEP[gain]))
    return np.geomspace(lowest, highest, steps + 1).tolist()


def _can_search(parameters: Parameters) -> bool:
    return parameters.gamma > 0.0 and longest_within_reach(Jeffcott(parameters)) is None


def _span(parameters: Parameters, gain: Gain, window: Window, *, stable: bool) -> Span:
    return Span(_edge(parameters, gain, window.low, 1.0, stable), _edge(parameters, gain, window.high, -1.0, stable))


def _edge(parameters: Parameters, gain: Gain, end: WindowEnd, inward: float, stable: bool) -> Edge:
    """Turn the end of a window into an edge; it is certified if the orbits found close by on both sides confirm it."""
    if not end.kind:
        return Edge(end.value)
    there = [
        any(
            orbit.admissible and (orbit.stable or not stable)
            for orbit in orbits_within_reach(Jeffcott(parameters.replace(**{gain: place})))
        )
        for place in (end.value * (1.0 + inward * NEARBY), end.value * (1.0 - inward * NEARBY))
    ]
    return Edge(end.value, end.kind, end.period, certified=there == [True, False])
