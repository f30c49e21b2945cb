"""Possible ends of a computation: outcome codes, and errors with a remedy.

Kernels return an :class:`Outcome`; Python code turns it into a result that carries the code, or into a
:class:`CaromError` that says what to do about it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from enum import IntEnum
from types import MappingProxyType
from typing import ParamSpec, TypeVar

_LONGEST_VALUE, _LONGEST_WORDS = 160, 600
_MOST_LINES = 20
_Given = ParamSpec("_Given")
_Read = TypeVar("_Read")


class Outcome(IntEnum):
    """Outcome of a flight, an impact or a whole motion.

    The codes below 10 belong to a single flight, those from 10 to a motion that was stopped, those from 20 to one that
    has settled.  ``GRAZING`` can end a flight as well as a motion.
    """

    CLEAR = 0
    CONTACT = 1
    GRAZING = 2
    TIME_REACHED = 10
    EVENT_LIMIT = 11
    CHATTER = 12
    LOW_BOUNCES = 13
    TRIGGERED = 14
    BEYOND_MODEL = 15
    STALLED = 16
    LEVITATED = 20
    BOUNCING = 21
    MIXED = 22
    FORWARD_RUB = 23
    BACKWARD_WHIRL = 24
    ROLLING = 25
    AT_REST = 26

    @property
    def label(self) -> str:
        """Name used in tables and JSON, for example ``"time-reached"``."""
        return self.name.lower().replace("_", "-")

    @property
    def words(self) -> str:
        """What people call the motion, for example ``"rolling backward whirl"``; of one not known, why it is not.

        Everything that is written for people takes the name from here, or from :data:`STEADY_WORDS` beside it;
        :class:`~carom.attractors.MotionName` adds what tells motions of one outcome apart.
        """
        return _WORDS[self]

    @property
    def settled(self) -> bool:
        """Whether the motion has settled, so that its further course is known."""
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
    SEPARATED = 4
    """Without force, still inside the place of a wall that comes back more slowly than the rotor leaves it."""

    @property
    def label(self) -> str:
        """Name used in tables and JSON, for example ``"forward-slip"``."""
        return self.name.lower().replace("_", "-")


_WORDS = {
    Outcome.CLEAR: "flight without contact",
    Outcome.CONTACT: "contact",
    Outcome.GRAZING: "grazes the wall, undecided",
    Outcome.TIME_REACHED: "not settled",
    Outcome.EVENT_LIMIT: "limit of events reached",
    Outcome.CHATTER: "chatter, ends in lasting contact",
    Outcome.LOW_BOUNCES: "low bounces along the wall, undecided",
    Outcome.TRIGGERED: "continues in the next stage",
    Outcome.BEYOND_MODEL: "beyond the model",
    Outcome.STALLED: "too stiff to be followed",
    Outcome.LEVITATED: "levitation",
    Outcome.BOUNCING: "bouncing",
    Outcome.MIXED: "bouncing with rub",
    Outcome.FORWARD_RUB: "forward rub",
    Outcome.BACKWARD_WHIRL: "sliding backward whirl",
    Outcome.ROLLING: "rolling backward whirl",
    Outcome.AT_REST: "rest on the touchdown bearing",
}
STEADY_WORDS: Mapping[str, str] = MappingProxyType(
    {"contact-free": Outcome.LEVITATED.words, "rub": "synchronous rub", "rolling": Outcome.ROLLING.words}
)
"""What people call the steady motions, by their code: ``kind`` of an equilibrium, ``motion`` of a special point."""
DRIFTING_RUB = "drifting rub"
"""The forward rub that is not steady."""
IRREGULAR_BOUNCING = f"irregular {Outcome.BOUNCING.words}"
REGULAR_BOUNCING = f"regular {Outcome.BOUNCING.words}"
"""Bouncing with one impact a period, on an orbit known in closed form."""
_MEANINGS = {
    Outcome.CLEAR: "The flight stays inside the clearance until its horizon.",
    Outcome.CONTACT: "The flight reaches the wall with an outward radial velocity.",
    Outcome.GRAZING: (
        "The path touches the wall so nearly tangentially that double precision cannot decide whether there is an impact; "
        "move the start by more than 1e-12 to decide. Without damping a motion may go on grazing for ever; "
        "and planes that jam under strong friction may leave no forces that obey the laws."
    ),
    Outcome.TIME_REACHED: "The motion had not settled by the requested time.",
    Outcome.EVENT_LIMIT: "The motion was stopped at the largest allowed number of events; raise max_events.",
    Outcome.CHATTER: "The impacts accumulate: lasting contact with the touchdown bearing begins.",
    Outcome.LOW_BOUNCES: (
        "The rotor stays at the wall in bounces too low and too fast to be followed; "
        "whether they decay to lasting contact is unknown."
    ),
    Outcome.TRIGGERED: "The trigger of this stage has ended it; the motion continues in the next stage, if there is one.",
    Outcome.BEYOND_MODEL: (
        "The rotor is more than one clearance deep in a touchdown bearing, or reaches a magnet, whose air gap usually is two clearances; "
        "this is beyond the model, and the motion is not followed further."
    ),
    Outcome.STALLED: (
        "Something of the machine acts so quickly that its motion cannot be followed: a turn of the shaft would take more than ten million "
        "steps. It may be a race with much drag and hardly any inertia, which stands still, so leave race_inertia out; or a filter, an amplifier, "
        "a mount or a wall that answers within nanoseconds: make it slower, or leave it out."
    ),
    Outcome.LEVITATED: "The rotor returns to levitation: no later flight can reach the wall.",
    Outcome.BOUNCING: "The rotor continues bouncing on the touchdown bearing.",
    Outcome.MIXED: "The rotor continues bouncing with rub: bounces and lasting contact alternate.",
    Outcome.FORWARD_RUB: "The rotor ends in forward rub: it slides along the touchdown bearing in the sense of rotation, or turns with the shaft.",
    Outcome.BACKWARD_WHIRL: "The rotor ends in sliding backward whirl: dry friction, or negative damping, drives it round the touchdown bearing.",
    Outcome.ROLLING: "The rotor ends in rolling backward whirl: it rolls round the touchdown bearing without slip.",
    Outcome.AT_REST: "The rotor ends in rest on the touchdown bearing: it lies there by its weight, or rocks, and does not go round.",
}


class CaromError(Exception):
    """Base class of all errors that carom raises on purpose."""


class CaromWarning(UserWarning):
    """A condition that the user should know of; the results are still correct."""


class InputError(CaromError, ValueError):
    """An input that cannot be used.

    Its text is one line without control characters, whatever the input was.

    Parameters
    ----------
    field : str
        Name of the input, as the user wrote it.
    value : object
        The value given; ``None`` where nothing was given.
    allowed : str
        What is allowed there, or how to correct the input.
    without : str
        What is said of the field where nothing was given.
    """

    def __init__(self, field: str, value: object, allowed: str, without: str = "= nothing given") -> None:
        self.field = field
        self.value = value
        self.allowed = allowed
        given = without if value is None else f"= {shown(value)}"
        super().__init__(f"{shown(field)} {given}: {printable(_cut(allowed, _LONGEST_WORDS))}")

    @property
    def errors(self) -> tuple[InputError, ...]:
        """All errors that it reports: only itself."""
        return (self,)

    def under(self, where: str) -> InputError:
        """All of these with what is put before the names of their fields."""
        return together([InputError(where + each.field, each.value, each.allowed) for each in self.errors])


class MultipleInputError(InputError):
    """Several inputs that cannot be used, reported together: one line each; of very many, only the first ones.

    ``field``, ``value`` and ``allowed`` are those of the first error.
    """

    def __init__(self, errors: Sequence[InputError]) -> None:
        first = errors[0]
        super().__init__(first.field, first.value, first.allowed)
        self._errors = tuple(errors)
        lines = [str(error) for error in self._errors[:_MOST_LINES]]
        if len(self._errors) > _MOST_LINES:
            lines.append(f"{len(self._errors) - _MOST_LINES} more errors of this kind or others")
        self.args = ("\n".join(lines),)

    @property
    def errors(self) -> tuple[InputError, ...]:
        """All errors that it reports."""
        return self._errors


class Problems:
    """Input errors collected while reading continues, to be reported together."""

    def __init__(self) -> None:
        self.errors: list[InputError] = []

    def attempt(self, read: Callable[_Given, _Read], /, *given: _Given.args, **named: _Given.kwargs) -> _Read | None:
        """Return what a function reads, or None if it raises an input error, which is collected."""
        try:
            return read(*given, **named)
        except InputError as problem:
            self.errors += problem.errors
            return None

    def raise_all(self) -> None:
        """Raise the collected errors together, if there are any."""
        if self.errors:
            raise together(self.errors)


def together(errors: Sequence[InputError]) -> InputError:
    """Combine one or more errors into one."""
    return errors[0] if len(errors) == 1 else MultipleInputError(errors)


def printable(text: str) -> str:
    r"""Return a text that can be shown anywhere: on one line, with unprintable characters as escapes.

    Control characters, line breaks, marks that change the direction of writing and lone surrogates become ``\x1b``,
    ``\n``, ``\u202e``, ...; visible characters stay.
    """
    if text.isprintable():
        return text
    return "".join(sign if sign.isprintable() else sign.encode("unicode_escape").decode("ascii") for sign in text)


def shown(given: object) -> str:
    """Return a value as an error message prints it: printable, not too long, never empty; of a table what stands above it."""
    if isinstance(given, bool):
        return str(given).lower()
    if isinstance(heading := getattr(given, "heading", None), str):
        return shown(heading)
    try:
        text = str(given)
    except ValueError:  # an integer with more digits than Python prints
        return "a number of thousands of digits"
    except RecursionError:
        return "a value that is nested too deeply"
    return printable(_cut(text, _LONGEST_VALUE)) if text.strip() else repr(text[:_LONGEST_VALUE])


def _cut(text: str, length: int) -> str:
    return text if len(text) <= length else text[: length - 1] + "…"
