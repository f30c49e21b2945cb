"""By how much the linear law of magnets is wrong along a motion.

A differential pair with the air gap ``s₀``, the bias current ``i₀`` and the control current ``i`` pulls a rotor at ``x`` with

    F = k [(i₀ + i)²/(s₀ − x)² − (i₀ − i)²/(s₀ + x)²],

so without control current with ``4k i₀² s₀ x/(s₀² − x²)²``: with ``ξ = x/s₀``, ``1/(1 − ξ²)²`` times as hard as the linear law ``4k i₀² x/s₀³``.
Saturating iron takes from that, so it is an upper bound.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from carom.base.results import Result
from carom.motions.trajectories import Trajectory
from carom.parameters.formats import number

PER_TURN, SAMPLES = 1000, 5000
"""Instants, beside those of events, at which the place of a rotor at its magnets is looked at: in a turn, and at most in a stage or piece of one."""
TOGETHER = 2_000


def excess_pull(share: float) -> float:
    """By how much a magnet pulls harder than in the linear law, relative to that, at a share of its air gap from the centre, without control current."""
    return 1.0 / (1.0 - share**2) ** 2 - 1.0


def pull_words(share: float) -> str:
    """The same in words, to follow the place."""
    return f"there a magnet pulls up to {number(100.0 * excess_pull(share), 2)} % harder than in this linear model (less where its iron saturates)"


@dataclass(frozen=True, repr=False)
class MagnetReach(Result):
    """How near a rotor comes to its magnets while they act.

    Attributes
    ----------
    share : float
        Largest distance from the centre of a magnetic bearing over its air gap, while they act.
    reached : bool
        Whether it reaches one, whether they act or not.  A motion ends at the first event at which that is seen.
    """

    share: float
    reached: bool

    @property
    def words(self) -> str:
        """The same in sentences."""
        shown = "The rotor reaches a magnet: the simulated motion after that is not valid. " if self.reached else ""
        if not 0.0 < self.share < 1.0:
            return shown.rstrip()
        return shown + (
            f"While the magnets act, the rotor moves up to {number(100.0 * self.share, 2)} % of an air gap from the centre; {pull_words(self.share)}."
        )

    def document(self) -> dict[str, object]:
        """As plain data for JSON."""
        wrong = excess_pull(self.share) if self.share < 1.0 else None
        return {"share_of_air_gap": self.share, "reached": self.reached, "excess_pull": wrong}


def reach_with(known: MagnetReach | None, part: Trajectory) -> MagnetReach | None:
    """What is known of a motion with one more stage, or piece of one; ``None`` where no air gap is known."""
    gaps, system = part.rotor.system.magnets, part.rotor.system
    if gaps is None:
        return known
    before, share = known or MagnetReach(0.0, False), _largest(part, gaps)
    return MagnetReach(max(before.share, share if system.levitates else 0.0), before.reached or share > 1.0)


def _largest(part: Trajectory, gaps: np.ndarray) -> float:
    begun = part.segment_starts[0]
    even = np.linspace(begun, part.time, min(SAMPLES, math.ceil(PER_TURN * (part.time - begun) / math.tau) + 2))
    times = np.concatenate([part.segment_starts, even])
    pieces = np.array_split(times, math.ceil(len(times) / TOGETHER))
    return max(float(np.abs(np.reshape(part.at(each)[0], (len(each), -1)) @ gaps.T).max()) for each in pieces)
