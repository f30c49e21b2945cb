"""Where disturbances ended: counts and descriptions of the attractors they reached."""

from __future__ import annotations

from carom.attractors import Attractor, AttractorSet, Ending, MotionName
from carom.outcome import Outcome


def ending_phrase(motion: MotionName) -> str:
    """Return the words of a motion to follow a verb: (ends) ``bouncing on B1,d``, (ends) ``in rolling backward whirl``."""
    words = motion.words
    return words if motion.orbit or not motion.outcome.settled else f"in {words}"


def motion_words(motion: str) -> str:
    """Words of a motion that stand alone: ``bouncing on B1,d``, ``rolling backward whirl``."""
    return motion.words if isinstance(motion, MotionName) else str(motion)


def ending_words(outcome: Outcome) -> str:
    """A clause on the outcome of a disturbance that is lost: `` (ends in synchronous rub)``."""
    if not outcome.settled:
        return " (its end was not found)"
    return f" (ends {_BOUNCING.get(outcome) or f'in {MotionName(outcome)}'})"


_BOUNCING = {Outcome.BOUNCING: "bouncing", Outcome.MIXED: "bouncing with rub"}


def touching(found: AttractorSet) -> tuple[Ending, ...]:
    """Return the disturbances in which the rotor touched the wall."""
    return tuple(ending for ending in found.disturbances if ending.touched)


def came_back(endings: tuple[Ending, ...]) -> int:
    """Count the disturbances that ended in levitation."""
    return sum(ending.recovered for ending in endings)


def hardest_impulse(found: AttractorSet) -> float:
    """Return the largest normal impulse in any disturbance, in ``m c_r Ω``."""
    return max((ending.hardest_impulse for ending in found.disturbances), default=0.0)


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
