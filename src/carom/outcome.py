"""What can come out of a computation: outcome codes and errors with a remedy.

Kernels return an :class:`Outcome`; Python code turns it into a result that carries the code, or into a
:class:`CaromError` that says what to do about it.
"""

from __future__ import annotations

from enum import IntEnum

__all__ = ["CaromError", "CaromWarning", "InputError", "Outcome", "Phase"]


class Outcome(IntEnum):
    """Outcome of a flight, an impact or a whole motion.

    The codes below 10 belong to a single flight, those from 10 to a motion that was stopped, those from 20 to one that
    has settled.  ``grazing`` can end both a flight and a motion.
    """

    CLEAR = 0
    CONTACT = 1
    GRAZING = 2
    TIME_REACHED = 10
    EVENT_LIMIT = 11
    CHATTER = 12
    LEVITATED = 20
    BOUNCING = 21
    MIXED = 22
    FORWARD_RUB = 23
    BACKWARD_WHIRL = 24
    ROLLING = 25

    @property
    def label(self) -> str:
        """Name used in tables and JSON, for example ``"time-reached"``."""
        return self.name.lower().replace("_", "-")

    @property
    def settled(self) -> bool:
        """Whether the motion has reached its end; what it does from there on is known."""
        return self >= Outcome.LEVITATED

    @property
    def meaning(self) -> str:
        """One sentence that explains the outcome to a user."""
        return _MEANINGS[self]


class Phase(IntEnum):
    """Kind of motion between two events."""

    FLIGHT = 0
    FORWARD_SLIP = 1
    BACKWARD_SLIP = 2
    ROLLING = 3

    @property
    def label(self) -> str:
        """Name used in tables and JSON, for example ``"forward-slip"``."""
        return self.name.lower().replace("_", "-")


_MEANINGS = {
    Outcome.CLEAR: "The flight stays inside the clearance until its horizon.",
    Outcome.CONTACT: "The flight reaches the wall with an outward radial velocity.",
    Outcome.GRAZING: (
        "The path touches the wall so nearly tangentially that double precision cannot decide whether it hits; "
        "move the start by more than 1e-12 to decide. Without damping a motion may go on grazing for ever."
    ),
    Outcome.TIME_REACHED: "The motion was followed to the time asked for without settling.",
    Outcome.EVENT_LIMIT: "The motion was stopped at the largest allowed number of events; raise max_events.",
    Outcome.CHATTER: "The impacts accumulate: the rotor goes over into lasting contact with the touchdown bearing.",
    Outcome.LEVITATED: "The rotor returns to contact-free levitation: no later flight can reach the wall.",
    Outcome.BOUNCING: "The rotor keeps bouncing on the touchdown bearing.",
    Outcome.MIXED: "The rotor keeps alternating between bounces and lasting contact.",
    Outcome.FORWARD_RUB: "The rotor rubs along the touchdown bearing in forward whirl.",
    Outcome.BACKWARD_WHIRL: "The rotor slides round the touchdown bearing in dry-friction backward whirl.",
    Outcome.ROLLING: "The rotor rolls round the touchdown bearing in backward whirl without slip.",
}


class CaromError(Exception):
    """Base class of all errors that carom raises on purpose."""


class CaromWarning(UserWarning):
    """What a user should know, while the results are right."""


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
