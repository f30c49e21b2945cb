"""The first pair of orbits along the damping, from which figures 4, 5 and 6a are drawn."""

from __future__ import annotations

from dataclasses import dataclass

from carom.base.results import Result
from carom.bifurcations import Bifurcation, OrbitBranch
from carom.bifurcations.words import continue_orbit
from carom.continuation import Steps
from carom.models import jeffcott
from carom.orbits.single_impact import find_orbits
from carom.reproductions.mora2014.propositions import HopfSide, hopf_side
from carom.reproductions.mora2014.source import machine_at

DAMPINGS = (0.002, 0.2)
"""Range of the damping; without damping there are infinitely many orbits."""
NEGATIVE = -0.52
"""Lowest damping to which the branch at negative damping, which no machine has, is followed."""
STEPS = Steps(first=0.005, largest=0.035)
"""Straight lines between the points are closer to the branches than 5e-4 of the width of a figure, a tenth of the width of a line."""


@dataclass(frozen=True, eq=False, repr=False)
class FirstPair(Result):
    """All branches of ``B1,a`` to ``B1,d``, and the local theory at their birth.

    Attributes
    ----------
    slow, fast : OrbitBranch
        ``B1,a`` and ``B1,b`` with the fold between them (slow); ``B1,c`` and ``B1,d`` with theirs (fast).
    negative : OrbitBranch
        ``B1,a`` and ``B1,c`` at negative damping, where they meet.
    hopf : HopfSide
        Where the slow orbits are born, with their slopes along the damping.
    """

    slow: OrbitBranch
    fast: OrbitBranch
    negative: OrbitBranch
    hopf: HopfSide

    @property
    def branches(self) -> tuple[OrbitBranch, ...]:
        """All three branches."""
        return self.slow, self.fast, self.negative

    def special(self, kind: str, letter: str) -> Bifurcation:
        """Return the special point of a kind on ``B1,letter``; of several, the one at the largest damping."""
        found = [
            point
            for branch in self.branches
            for point in branch.special
            if (point.kind, point.name) == (kind, f"B1,{letter}")
        ]
        return max(found, key=lambda point: point.value)


def first_pair() -> FirstPair:
    """Follow the first pair of orbits from ``γ = 0.1`` in both directions, and at negative damping."""
    orbits = find_orbits(jeffcott(machine_at(0.1)))
    # Without positive damping the search for all orbits would not end; these two have short periods.
    undamped = find_orbits(jeffcott(machine_at(-0.3)), 1.0)
    return FirstPair(
        slow=continue_orbit(orbits["B1,b"], "gamma", DAMPINGS, STEPS),
        fast=continue_orbit(orbits["B1,d"], "gamma", DAMPINGS, STEPS),
        negative=continue_orbit(undamped["B1,c"], "gamma", (NEGATIVE, DAMPINGS[0]), STEPS),
        hopf=hopf_side(machine_at(0.1)),
    )
