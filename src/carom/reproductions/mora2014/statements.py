"""The propositions and general statements of the source paper, each tested on its machine."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from carom.bifurcations.branches import speeds_at
from carom.closed_forms.periods import PeriodCondition
from carom.models import jeffcott
from carom.orbits.orbit import Orbit
from carom.orbits.single_impact import find_orbits
from carom.reproductions.mora2014.branches import FirstPair
from carom.reproductions.mora2014.periods import period_pair
from carom.reproductions.mora2014.plane import DampingStiffnessPlane
from carom.reproductions.mora2014.propositions import fixed_points, simultaneous_folds
from carom.reproductions.mora2014.source import machine_at, printed_texts

SAME_FOLD = 1e-9
"""Distance in damping below which two folds count as simultaneous; rounding errors are about 1e-13."""
WEAKEST = 0.005
"""Smallest damping at which the longer pairs are examined; there are 30 of them at this damping."""
DAMPINGS = 24
"""Number of dampings, in geometric progression, from there to the fold at which the last longer pair vanishes."""
PLACES = 200
"""Number of points examined on each orbit between its impacts: enough for three digits of the least distance."""


@dataclass(frozen=True)
class Claim:
    """A statement of the source paper, tested on its machine.

    Attributes
    ----------
    found : str
        The result computed, in words.
    """

    place: str
    statement: str
    holds: bool
    found: str


def claims(pair: FirstPair, plane: DampingStiffnessPlane) -> tuple[Claim, ...]:
    """Test the statements in the order of the text."""
    results = (*_propositions(pair), _longer_pairs(), _stability(pair), _third_region(plane))
    rows = zip(printed_texts("claims", {}), results, strict=True)
    return tuple(Claim(**row, holds=holds, found=found) for row, (holds, found) in rows)


def _propositions(branches: FirstPair) -> tuple[tuple[bool, str], ...]:
    """Whether each holds, and what was found."""
    many, weak = fixed_points(machine_at(0.1)), fixed_points(machine_at(0.06))
    folds = simultaneous_folds(machine_at(0.1))
    lower, upper = folds.lower.value, folds.upper.value
    hopf, kinds = branches.hopf, [cycle.criticality for cycle in branches.hopf.cycles]
    return (
        (many.total == 4 * many.pairs, f"at γ = 0.1, {many.words}"),
        (2 * weak.admissible == weak.total, f"at γ = 0.06, {weak.words}"),
        (folds.distance < SAME_FOLD, f"the folds are at γ = {lower:.10f} and {upper:.10f}"),
        (len(kinds) == 2 and hopf.subcritical, f"{len(kinds)} orbits at γ* = {hopf.gamma:.10f}: {', '.join(kinds)}"),
    )


def _longer_pairs() -> tuple[bool, str]:
    """Examine the pairs n > 1 along the damping, up to the fold of the last of them."""
    last = WEAKEST
    while len(periods := PeriodCondition.planar(machine_at(beyond := last * (1.0 + SAME_FOLD))).roots().periods) > 2:
        last, _ = period_pair(beyond, float(periods[2]), 2).fold
    counts, possible, nearest = [], 0, math.inf
    for gamma in np.geomspace(WEAKEST, last * (1.0 - SAME_FOLD), DAMPINGS):
        longer = _longer(float(gamma))
        counts.append(len(longer))
        possible += sum(orbit.admissible for orbit in longer)
        nearest = min(nearest, _beyond_wall(longer))
    words = (
        f"at {DAMPINGS} dampings from {WEAKEST:g} to the fold of the last such pair, γ = {last:.10f}, where there are {counts[0]} to "
        f"{counts[-1]} of them, admissible: {possible or 'none'}; those that meet the wall from inside pass it in between by at "
        f"least {nearest:.3f} clearances"
    )
    return possible == 0, words


def _longer(gamma: float) -> list[Orbit]:
    """Return the orbits of the pairs n > 1."""
    found = find_orbits(jeffcott(machine_at(gamma)))
    return [orbit for orbit in found if orbit.name.pair > 1]


def _beyond_wall(orbits: list[Orbit]) -> float:
    """Return a lower bound of how far orbits of one rotor that meet the wall from inside pass beyond it, each examined at ``PLACES`` points."""
    rotor = orbits[0].rotor
    speeds = speeds_at(rotor, np.zeros(len(orbits), int), np.concatenate([orbit.nodes for orbit in orbits]))
    inside = [orbit for orbit, speed in zip(orbits, speeds.real.tolist(), strict=True) if speed > 0.0]
    departures = [orbit.departure for orbit in inside]
    starts = rotor.system.amplitudes_of(np.array([(each.position, each.velocity) for each in departures]))
    times = np.linspace(0.0, [orbit.period for orbit in inside], PLACES)[1:-1]
    positions, _ = rotor.system.state(rotor.system.fly(starts, times))
    return float(np.abs(positions).max(axis=0).min()) - 1.0


def _stability(branches: FirstPair) -> tuple[bool, str]:
    stable = {
        name
        for branch in (branches.slow, branches.fast)
        for name, settled in zip(branch.names, branch.stable, strict=True)
        if settled
    }
    return stable == {"B1,d"}, f"stable somewhere along γ: {', '.join(sorted(stable)) or 'none'}"


def _third_region(plane: DampingStiffnessPlane) -> tuple[bool, str]:
    parts = [region for region in plane.regions if region.source == "R3"]
    rubbing = [region.part for region in parts if region.motions.rub]
    if not rubbing:
        return True, "no stable synchronous rub exists there"
    return False, f"a stable synchronous rub exists in {', '.join(rubbing)}"
