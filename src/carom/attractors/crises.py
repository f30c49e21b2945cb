"""Where along a parameter irregular bouncing begins to end: a bracket of a boundary crisis, from survival on both sides."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from carom.arguments import Count, checked
from carom.attractors.lifetimes import Lifetimes, measure_lifetimes
from carom.attractors.starts import DisturbanceSet
from carom.models import Rotor, Subject, axis, rotor_of
from carom.outcome import CaromError, InputError
from carom.results import Result

STEPS = 12
"""Halvings of the interval."""


@dataclass(frozen=True, eq=False, repr=False)
class Crisis(Result):
    """Interval of a parameter: at one end irregular bouncing was seen to end, at the other it was not.

    Attributes
    ----------
    rotor : Model
    name : str
        The parameter.
    lasting, ending : float
        Its values at the two ends: where none of the motions stopped bouncing, and where some did.
    lifetimes : dict
        Value of the parameter to :class:`Lifetimes`, for every value tried.
    """

    shown: ClassVar[tuple[str, ...]] = ("rotor", "name", "lasting", "ending", "words")

    rotor: Rotor
    name: str
    lasting: float
    ending: float
    lifetimes: dict[float, Lifetimes]

    @property
    def half_lives(self) -> tuple[tuple[float, float | None], ...]:
        """Values of the parameter and the half-life in impacts there; ``None`` where no end was seen, or none fits the ends."""
        return tuple((value, found.half_life) for value, found in sorted(self.lifetimes.items()))

    @property
    def words(self) -> str:
        """What was seen on both sides, in two sentences."""
        before, after = self.lifetimes[self.lasting], self.lifetimes[self.ending]
        return (
            f"At {self.name} = {self.ending:.7g} bouncing was seen to end: {after.words} "
            f"At {self.lasting:.7g} it was not: {before.words} "
            "This is evidence from samples: bouncing may end there too, but more rarely than could be seen."
        )


@checked
def locate_crisis(
    machine: Subject,
    name: str,
    lasting: float,
    ending: float,
    *,
    steps: Count = STEPS,
    tolerance: float = 0.0,
    starts: DisturbanceSet | None = None,
    **limits: Any,
) -> Crisis:
    """Halve an interval of a parameter between a value where bouncing was not seen to end and one where it was.

    Bouncing that becomes periodic has not ended.  Near a crisis half-lives grow without bound, so the end at which bouncing
    lasts is only as sharp as the impacts and the motions followed.  The bracket may hold several crises, of which one is found.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    name : str
        Parameter to vary.
    lasting, ending : float
        Values at the two ends.
    steps : int
        Largest number of halvings.
    tolerance : float
        Length of the interval at which to stop.
    starts : DisturbanceSet, optional
        By default the standard set of :func:`measure_lifetimes`.
    **limits
        ``impacts``, ``discarded``, ``count``, ``seed`` and ``threads`` of :func:`measure_lifetimes`.

    Raises
    ------
    CaromError
        Bouncing ends at both values, or at none.
    """
    rotor = rotor_of(machine)
    axis(rotor, name)
    if lasting == ending:
        raise InputError("ending", ending, "a value other than the one at which bouncing lasts")
    found = {value: measure_lifetimes(rotor.replace(**{name: value}), starts, **limits) for value in (lasting, ending)}
    for value, wanted in ((lasting, False), (ending, True)):
        if _ends(found[value]) is not wanted:
            seen = "is seen to end" if not wanted else "is not seen to end"
            raise CaromError(f"bouncing {seen} at {name} = {value:g}: {found[value].words}")
    low, high = lasting, ending
    for _ in range(steps):
        if abs(high - low) <= tolerance:
            break
        middle = 0.5 * (low + high)
        found[middle] = measure_lifetimes(rotor.replace(**{name: middle}), starts, **limits)
        if _ends(found[middle]):
            high = middle
        else:
            low = middle
    return Crisis(rotor, name, low, high, found)


def _ends(found: Lifetimes) -> bool:
    """Whether some motion stopped bouncing after the discarded impacts."""
    late = (found.impacts > found.discarded) & found.ended
    return any("bouncing" not in end for end, one in zip(found.ends, late, strict=True) if one)
