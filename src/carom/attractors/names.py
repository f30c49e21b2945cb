"""Names of the motions on which starts end."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

from carom.base.arguments import checked, having
from carom.base.outcome import DRIFTING_RUB, STEADY_WORDS, Outcome
from carom.orbits.names import Name, OrbitName


@dataclass(frozen=True, eq=False, repr=False)
class MotionName(Name):
    """Name of a motion, such as ``"levitation"`` or ``"2-impact bouncing"``: a text that also carries what it says.

    Parameters
    ----------
    multiplicity : int
        Impacts per period of bouncing; 0 if it is irregular, and for all other motions.
    drifting : bool
        Whether a forward rub moves along the wall in the co-rotating frame; otherwise it is synchronous.
    orbit : OrbitName or None
        The single-impact orbit that it is.
    number : int
        Number among the motions with the same name otherwise, from 1.
    """

    outcome: Outcome
    multiplicity: int = 0
    drifting: bool = False
    orbit: OrbitName | None = None
    number: int = 1

    def __new__(
        cls,
        outcome: Outcome,
        multiplicity: int = 0,
        drifting: bool = False,
        orbit: OrbitName | None = None,
        number: int = 1,
    ) -> MotionName:
        """Make the text from the parts."""
        text: str = outcome.words if outcome.settled else f"unresolved: {outcome.label}"
        if orbit is not None:
            text = orbit
        elif outcome in _REPEATING:
            text = f"{f'{multiplicity}-impact' if multiplicity else 'irregular'} {outcome.words}"
        elif outcome is Outcome.FORWARD_RUB:
            text = DRIFTING_RUB if drifting else STEADY_WORDS["rub"]
        return super().__new__(cls, f"{text} ({number})" if number > 1 else text)

    @classmethod
    @checked
    def of(cls, parts: Annotated[Mapping[str, Any], having("outcome", "orbit")]) -> MotionName:
        """Name from its parts as plain data, from :func:`dataclasses.asdict` or JSON."""
        orbit = OrbitName(**parts["orbit"]) if parts["orbit"] else None
        return cls(**{**parts, "outcome": Outcome(parts["outcome"]), "orbit": orbit})

    @property
    def words(self) -> str:
        """The name for people: that of :attr:`OrbitName.words <carom.orbits.names.OrbitName.words>` for an orbit; else the name itself."""
        if self.orbit is None:
            return str(self)
        return f"{self.orbit.words} ({self.number})" if self.number > 1 else self.orbit.words

    @property
    def irregular(self) -> bool:
        """Whether it is bouncing, with or without rub, that did not repeat itself as far as it was followed."""
        return self.outcome in _REPEATING and not self.multiplicity


_REPEATING = (Outcome.BOUNCING, Outcome.MIXED)

LEVITATION = MotionName(Outcome.LEVITATED)
SYNCHRONOUS_RUB = MotionName(Outcome.FORWARD_RUB)
