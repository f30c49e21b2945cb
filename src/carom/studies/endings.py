"""Where disturbances ended: counts and descriptions of the attractors they reached."""

from __future__ import annotations

from collections.abc import Iterable

from carom.attractors import Attractor, AttractorSet, Ending, MotionName
from carom.base.outcome import Outcome


def ending_phrase(motion: MotionName) -> str:
    """Return the words of a motion to follow a verb: (ends) ``in regular bouncing``, (ends) ``unresolved: grazing``."""
    words = motion.words
    return f"in {words}" if motion.outcome.settled else words


def motion_words(motion: str) -> str:
    """Words of a motion that stand alone: ``regular bouncing``, ``rolling backward whirl``."""
    return motion.words if isinstance(motion, MotionName) else str(motion)


def ending_words(outcome: Outcome, motions: Iterable[MotionName] = ()) -> str:
    """Say where a disturbance with an outcome ends: ``it ends in synchronous rub``; undecided outcomes are no ends.

    The motion has its own name if it is the only one of the known motions with this outcome.  Bouncing on no known orbit may
    have been given up after its last impact that was followed, and is not stated as an end.
    """
    if outcome is Outcome.BEYOND_MODEL:
        return f"it goes {outcome.words}"
    if not outcome.settled:
        return f"its end was not found: {outcome.words}"
    names = [name for name in motions if name.outcome is outcome]
    known = names[0] if len(names) == 1 else None
    if outcome in (Outcome.BOUNCING, Outcome.MIXED) and not (known and known.orbit):
        return f"it was still {outcome.words} at the end of the simulation"
    return f"it ends {ending_phrase(known) if known else f'in {outcome.words}'}"


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
    disturbed = [ending for ending in endings if ending.start.disturbance]
    return min(disturbed, key=lambda ending: (not ending.impacts, ending.time), default=endings[0])
