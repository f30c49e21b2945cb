"""What can come out of a computation: outcome codes and errors with a remedy.

Kernels return an :class:`Outcome`; Python code turns it into a result that carries the code, or into a
:class:`CaromError` that says what to do about it.
"""

from __future__ import annotations

from enum import IntEnum

__all__ = ["CaromError", "InputError", "Outcome"]


class Outcome(IntEnum):
    """Outcome of a flight, an impact or a whole motion.

    The codes below 10 belong to a single flight, those from 10 to a motion.  ``grazing`` can end both.
    """

    CLEAR = 0
    CONTACT = 1
    GRAZING = 2
    TIME_REACHED = 10
    IMPACT_LIMIT = 11
    CHATTER = 12

    @property
    def label(self) -> str:
        """Name used in tables and JSON, for example ``"time-reached"``."""
        return self.name.lower().replace("_", "-")

    @property
    def meaning(self) -> str:
        """One sentence that explains the outcome to a user."""
        return _MEANINGS[self]


_MEANINGS = {
    Outcome.CLEAR: "The flight stays inside the clearance until its horizon.",
    Outcome.CONTACT: "The flight reaches the wall with an outward radial velocity.",
    Outcome.GRAZING: (
        "The path touches the wall so nearly tangentially that double precision cannot decide whether it hits; "
        "move the start by more than 1e-12 to decide."
    ),
    Outcome.TIME_REACHED: "The motion was followed to the time asked for.",
    Outcome.IMPACT_LIMIT: "The motion was stopped at the largest allowed number of impacts; raise max_impacts.",
    Outcome.CHATTER: "The impacts accumulate: the rotor goes over into lasting contact with the touchdown bearing.",
}


class CaromError(Exception):
    """Base class of all errors that carom raises on purpose."""


class InputError(CaromError, ValueError):
    """An input that cannot be used.

    Parameters
    ----------
    field : str
        Name of the input, as the user wrote it.
    value : object
        The value given; ``None`` where nothing was given.
    allowed : str
        What is allowed there, or how to mend it.
    """

    def __init__(self, field: str, value: object, allowed: str) -> None:
        self.field = field
        self.value = value
        self.allowed = allowed
        shown = "nothing given" if value is None else _one_line(value)
        super().__init__(f"{field} = {shown}: {_one_line(allowed)}")


def _one_line(value: object, limit: int = 300) -> str:
    text = " ".join(str(value).split())
    return text if len(text) <= limit else text[: limit - 1] + "…"
