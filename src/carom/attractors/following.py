"""Follow starts to where they settle, irregular ones with growing patience."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from carom.attractors.starts import Start
from carom.outcome import Outcome
from carom.rotors import Rotor
from carom.trajectories import Trajectory, simulate

__all__ = ["Ending", "endings_of"]

FIRST_PATIENCE = 1000
"""Impacts of a first look at a motion."""
FOLLOWED = 10
"""Irregular motions followed to the end of the patience before the others are taken for alike."""
LONGEST = 2e5
"""Time after which a look that has not settled is given up, in ``1/Ω``."""


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
        When that was known, in ``1/Ω``.
    impacts : int
        Until then.
    hardest_impulse : float
        Largest normal impulse until then, in ``m c_r Ω``.
    """

    start: Start
    attractor: str
    outcome: Outcome
    time: float
    impacts: int
    hardest_impulse: float


def endings_of(
    rotor: Rotor,
    starts: Sequence[Start],
    patience: int,
    name_of: Callable[[Trajectory], str],
    progress: Callable[[float], None],
) -> list[Ending]:
    """Follow all starts: a first look at each, and longer ones at those that are irregular so far.

    Parameters
    ----------
    rotor : Rotor
    starts : sequence of Start
    patience : int
        Impacts without recurrence after which bouncing counts as irregular.
    name_of : callable
        Called once with each motion that has settled, or been given up; its answer is the name of the attractor.
    progress : callable
        Called with the share done, 0 to 1.

    Returns
    -------
    list of Ending
        In the order of the starts.
    """
    looks = _Looks(rotor, starts, name_of)
    irregular = []
    for place in range(len(starts)):
        irregular += [place] if looks.look(place, min(FIRST_PATIENCE, patience)) else []
        progress(0.9 * (place + 1) / len(starts))
    parked: list[int] = []
    while irregular and looks.seen[irregular[0]] < patience:
        span = min(looks.seen[irregular[0]], patience - looks.seen[irregular[0]])
        lasting = [place for place in irregular if looks.look(place, span)]
        if len(lasting) < len(irregular):
            # Something has settled after so long: those taken for alike have to catch up.
            reached = looks.seen[irregular[0]]
            lasting += [place for place in parked if looks.look(place, reached - looks.seen[place])]
            parked = []
        elif len(lasting) > FOLLOWED:
            parked += lasting[FOLLOWED:]
        irregular = [place for place in lasting if place not in parked]
        progress(0.9 + 0.1 * looks.seen[irregular[0]] / patience if irregular else 1.0)
    looks.take_for_alike(irregular + parked)
    progress(1.0)
    return [ending for ending in looks.endings if ending]


class _Looks:
    """Looks at the motions of all starts, each a continuation of the one before."""

    def __init__(self, rotor: Rotor, starts: Sequence[Start], name_of: Callable[[Trajectory], str]) -> None:
        self.rotor, self.name_of, self.starts = rotor, name_of, starts
        self.states = [start.state for start in starts]
        self.endings: list[Ending | None] = [None] * len(starts)
        self.seen = [0] * len(starts)
        self.last: Trajectory | None = None

    def look(self, place: int, impacts: int) -> bool:
        """Follow a motion for so many impacts more; whether it is still irregular."""
        motion = simulate(self.rotor, self.states[place], LONGEST, settle=True, patience=impacts)
        irregular = motion.outcome in (Outcome.BOUNCING, Outcome.MIXED) and motion.multiplicity == 0
        self.states[place] = motion.final
        self.seen[place] += impacts
        impulses = motion.contacts.normal_impulse
        hardest = float(impulses.max()) if len(impulses) else 0.0
        name = "" if irregular else self.name_of(motion)
        ending = Ending(self.starts[place], name, motion.outcome, motion.time, len(impulses), hardest)
        before = self.endings[place]
        self.endings[place] = _joined(before, ending) if before else ending
        self.last = motion if irregular else self.last
        return irregular

    def take_for_alike(self, places: Sequence[int]) -> None:
        """Give the irregular motions their name, after the last one looked at."""
        if not places or self.last is None:
            return
        name = self.name_of(self.last)
        for place in places:
            ending = self.endings[place]
            if ending:
                self.endings[place] = dataclasses.replace(ending, attractor=name, outcome=self.last.outcome)


def _joined(before: Ending, after: Ending) -> Ending:
    """Two looks at a start as one."""
    return dataclasses.replace(
        after,
        time=before.time + after.time,
        impacts=before.impacts + after.impacts,
        hardest_impulse=max(before.hardest_impulse, after.hardest_impulse),
    )
