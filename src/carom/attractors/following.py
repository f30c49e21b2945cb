"""Follow starts until they settle, irregular ones with growing patience."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from carom.attractors.starts import Start
from carom.attractors.survival import HALF_LIVES, Survival, measure_survival
from carom.models import Jeffcott
from carom.motions.settling import longest_time
from carom.motions.starts import State
from carom.motions.trajectories import Trajectory, simulate
from carom.outcome import Outcome

__all__ = ["Ending", "endings_of"]

FIRST_PATIENCE = 1000
"""Impacts for which a motion is followed at first."""
AFFORDABLE = 2_000_000
"""Largest cost of following all irregular motions for one half-life, in impacts: half a second."""


@dataclass(frozen=True)
class Ending:
    """Where one start ended.

    Attributes
    ----------
    start : Start
    attractor : str
        Name of the :class:`Attractor`.
    outcome : Outcome
    time : float
        Time at which the outcome was known, in ``1/Ω``.
    impacts : int
        Impacts until then.
    hardest_impulse : float
        Largest normal impulse until then, in ``m c_r Ω``.
    irregular : bool
        Whether it still bounces irregularly.
    survival : Survival or None
        How long irregular bouncing lasts, if the motion is irregular or was so after 1000 impacts; otherwise ``None``.
    """

    start: Start
    attractor: str
    outcome: Outcome
    time: float
    impacts: int
    hardest_impulse: float
    irregular: bool = False
    survival: Survival | None = None


def endings_of(
    rotor: Jeffcott,
    starts: Sequence[Start],
    patience: int,
    name_of: Callable[[Trajectory], str],
    progress: Callable[[float], None],
) -> list[Ending]:
    """Follow all starts: first each for a short time, then longer those that are still irregular.

    The lifetime of irregular motion is measured.  If it is transient, the irregular motions are followed until they
    leave it, unless that takes too long.

    Parameters
    ----------
    rotor : Jeffcott
    starts : sequence of Start
    patience : int
        Impacts without recurrence after which bouncing counts as irregular.
    name_of : callable
        Called once with each motion that has settled, or been given up; returns the name of the attractor.
    progress : callable
        Called with the fraction done, 0 to 1.

    Returns
    -------
    list of Ending
        In the order of the starts.
    """
    looks = _Stages(rotor, starts, name_of)
    irregular = []
    for place in range(len(starts)):
        irregular += [place] if looks.look(place, min(FIRST_PATIENCE, patience)) else []
        progress(0.9 * (place + 1) / len(starts))
    seen, met = FIRST_PATIENCE, looks.states_of(irregular)
    while irregular and seen < patience:
        span = min(seen, patience - seen)
        irregular = [place for place in irregular if looks.look(place, span)]
        seen += span
        progress(0.9 + 0.05 * min(seen / patience, 1.0))
    if met:
        survival = _survival(rotor, looks.states_of(irregular) or met, patience)
        if irregular and survival.half_life is not None:
            irregular = looks.follow_out(irregular, survival.half_life)
        looks.note(irregular, survival)
    progress(1.0)
    return [ending for ending in looks.endings if ending]


def _survival(rotor: Jeffcott, states: Sequence[State], patience: int) -> Survival:
    positions = np.array([state.position for state in states])
    velocities = np.array([state.velocity for state in states])
    return measure_survival(rotor, positions, velocities, impacts=patience)


class _Stages:
    """Motions of all starts, followed in stages; each stage continues the one before."""

    def __init__(self, rotor: Jeffcott, starts: Sequence[Start], name_of: Callable[[Trajectory], str]) -> None:
        self.rotor, self.name_of, self.starts = rotor, name_of, starts
        self.states = [start.state for start in starts]
        self.endings: list[Ending | None] = [None] * len(starts)
        self.was_irregular = [False] * len(starts)
        self.last: dict[Outcome, Trajectory] = {}
        self.limit = longest_time(rotor)

    def look(self, place: int, impacts: int) -> bool:
        """Follow a motion for a number of further impacts; return whether it is still irregular."""
        motion = simulate(self.rotor, self.states[place], self.limit, settle=True, patience=impacts)
        irregular = motion.outcome in (Outcome.BOUNCING, Outcome.MIXED) and motion.multiplicity == 0
        self.states[place] = motion.final
        self.was_irregular[place] |= irregular
        impulses = motion.contacts.normal_impulse
        hardest = float(impulses.max()) if len(impulses) else 0.0
        name = "" if irregular else self.name_of(motion)
        ending = Ending(self.starts[place], name, motion.outcome, motion.time, len(impulses), hardest)
        before = self.endings[place]
        self.endings[place] = _joined(before, ending) if before else ending
        if irregular:
            self.last[motion.outcome] = motion
        return irregular

    def states_of(self, places: Sequence[int]) -> list[State]:
        """States that these motions have reached."""
        return [self.states[place] for place in places]

    def follow_out(self, irregular: list[int], half_life: float) -> list[int]:
        """Follow transient irregular motions until they leave, if affordable; return those that have not left."""
        span = max(FIRST_PATIENCE, int(half_life))
        for _ in range(HALF_LIVES):
            if not irregular or len(irregular) * span > AFFORDABLE:
                break
            irregular = [place for place in irregular if self.look(place, span)]
        return irregular

    def note(self, irregular: Sequence[int], survival: Survival) -> None:
        """Attach the survival to every motion that was ever irregular; name the motions that still are."""
        for place, ending in enumerate(self.endings):
            if ending and self.was_irregular[place]:
                self.endings[place] = dataclasses.replace(ending, survival=survival)
        for place in irregular:
            ending = self.endings[place]
            if ending:
                name = self.name_of(self.last[ending.outcome])
                self.endings[place] = dataclasses.replace(ending, attractor=name, irregular=True)


def _joined(before: Ending, after: Ending) -> Ending:
    """Combine two consecutive stages of one motion."""
    return dataclasses.replace(
        after,
        time=before.time + after.time,
        impacts=before.impacts + after.impacts,
        hardest_impulse=max(before.hardest_impulse, after.hardest_impulse),
    )
