"""What became of disturbances: counts and words about the attractors they reached."""

from __future__ import annotations

import math
from dataclasses import dataclass

from carom.attractors import Attractor, AttractorSet, Ending
from carom.outcome import Outcome

__all__ = [
    "KickSize",
    "ending_phrase",
    "ending_words",
    "hardest_impulse",
    "kick_sizes",
    "largest_all_back",
    "shown_example",
    "touching",
]

_WORDS = {
    "levitation": "contact-free levitation",
    "rolling": "rolling backward whirl",
    "backward whirl": "sliding backward whirl",
}


@dataclass(frozen=True)
class KickSize:
    """All kicks of one size.

    Attributes
    ----------
    speed : float
        In ``c_r Ω``.
    directions : int
        How many were tried.
    recovered : int
        How many came back to levitation.
    lost : dict of str to int
        Where the others ended: name of the attractor and how many.
    """

    speed: float
    directions: int
    recovered: int
    lost: dict[str, int]


def ending_words(attractor: str) -> str:
    """Name of an attractor as an engineer would say it: ``bouncing on B1,d``, ``rolling backward whirl``."""
    if attractor[:1] in ("B", "R") and attractor[1:2].isdigit():
        return f"bouncing on {attractor}"
    return _WORDS.get(attractor, attractor)


def ending_phrase(attractor: str) -> str:
    """The same after a verb: ``ends bouncing on B1,d``, ``ends in rolling backward whirl``."""
    words = ending_words(attractor)
    return words if words.startswith(("bouncing", "unresolved")) else f"in {words}"


def touching(found: AttractorSet) -> tuple[Ending, ...]:
    """Disturbances in which the rotor touched the wall."""
    return tuple(
        ending
        for ending in found.disturbances
        if ending.impacts > 0 or (ending.outcome.settled and ending.outcome is not Outcome.LEVITATED)
    )


def hardest_impulse(found: AttractorSet) -> float:
    """Largest normal impulse in any disturbance, in ``m c_r Ω``."""
    return max((ending.hardest_impulse for ending in found.disturbances), default=0.0)


def kick_sizes(found: AttractorSet) -> tuple[KickSize, ...]:
    """Kicks out of levitation by size, the smallest first."""
    kicks = sorted((ending for ending in found.endings if ending.start.kind == "kick"), key=lambda e: e.start.speed)
    sizes: list[list[Ending]] = []
    for ending in kicks:
        # A kick in another direction has the same size to rounding.
        if not sizes or not math.isclose(ending.start.speed, sizes[-1][0].start.speed, rel_tol=1e-9):
            sizes.append([])
        sizes[-1].append(ending)
    return tuple(_size(alike) for alike in sizes)


def largest_all_back(found: AttractorSet) -> float | None:
    """Largest of the sizes tried up to which kicks in all directions tried came back, in ``c_r Ω``."""
    back = None
    for size in kick_sizes(found):
        if size.lost:
            break
        back = size.speed
    return back


def _size(alike: list[Ending]) -> KickSize:
    lost: dict[str, int] = {}
    for ending in alike:
        if ending.outcome is not Outcome.LEVITATED:
            lost[ending.attractor] = lost.get(ending.attractor, 0) + 1
    return KickSize(alike[0].start.speed, len(alike), len(alike) - sum(lost.values()), lost)


def shown_example(found: AttractorSet, attractor: Attractor) -> Ending:
    """The start to show for an attractor: a disturbance with contact if there is one, the one that settles first."""
    endings = found.ending_on(attractor.name)
    for choice in (
        [ending for ending in endings if ending.start.disturbance and ending.impacts > 0],
        [ending for ending in endings if ending.start.disturbance],
    ):
        if choice:
            return min(choice, key=lambda ending: ending.time)
    return endings[0]
