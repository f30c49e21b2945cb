"""Where disturbances ended: counts and descriptions of the attractors they reached."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass

from carom.attractors import Attractor, AttractorSet, Ending, MotionName


@dataclass(frozen=True)
class KickSize:
    """All kicks of one size."""

    speed: float
    """Size of the kicks, in ``c_r Ω``."""
    directions: int
    """Number of directions tried."""
    recovered: int
    """Number of kicks that came back to levitation."""
    lost: dict[MotionName, int]
    """Number of the other kicks by the attractor in which they ended."""


def ending_phrase(motion: MotionName) -> str:
    """Return the words of a motion to follow a verb: (ends) ``bouncing on B1,d``, (ends) ``in rolling backward whirl``."""
    words = motion.words
    return words if motion.orbit or not motion.outcome.settled else f"in {words}"


def touching(found: AttractorSet) -> tuple[Ending, ...]:
    """Return the disturbances in which the rotor touched the wall."""
    return tuple(ending for ending in found.disturbances if ending.touched)


def came_back(endings: tuple[Ending, ...]) -> int:
    """Count the disturbances that ended in levitation."""
    return sum(ending.recovered for ending in endings)


def hardest_impulse(found: AttractorSet) -> float:
    """Return the largest normal impulse in any disturbance, in ``m c_r Ω``."""
    return max((ending.hardest_impulse for ending in found.disturbances), default=0.0)


def kick_sizes(found: AttractorSet) -> tuple[KickSize, ...]:
    """Return the kicks out of levitation grouped by size, smallest first; none if a size has one direction only."""
    kicks = sorted((ending for ending in found.endings if ending.start.kind == "kick"), key=lambda e: e.start.speed)
    sizes: list[list[Ending]] = []
    for ending in kicks:
        # Kicks of one size in different directions have speeds that are equal up to rounding.
        if not sizes or not math.isclose(ending.start.speed, sizes[-1][0].start.speed, rel_tol=1e-9):
            sizes.append([])
        sizes[-1].append(ending)
    return tuple(_size(alike) for alike in sizes) if all(len(alike) > 1 for alike in sizes) else ()


def largest_all_back(found: AttractorSet) -> float | None:
    """Return the largest size tried up to which all kicks in all directions came back, in ``c_r Ω``; else ``None``."""
    back = None
    for size in kick_sizes(found):
        if size.lost:
            break
        back = size.speed
    return back


def _size(alike: list[Ending]) -> KickSize:
    lost = Counter(ending.attractor for ending in alike if not ending.recovered)
    return KickSize(alike[0].start.speed, len(alike), len(alike) - lost.total(), dict(lost))


def shown_example(found: AttractorSet, attractor: Attractor) -> Ending:
    """Choose the example of an attractor: the first to settle, among disturbances with contact if there are any."""
    endings = found.ending_on(attractor.name)
    for choice in (
        [ending for ending in endings if ending.start.disturbance and ending.impacts > 0],
        [ending for ending in endings if ending.start.disturbance],
    ):
        if choice:
            return min(choice, key=lambda ending: ending.time)
    return endings[0]
