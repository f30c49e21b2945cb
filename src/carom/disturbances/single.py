"""A single disturbance: one size, one direction, one instant.

Its text is the same on the command line and in Python.  A sentence says what was done to a rotor: sizes in the units of people, velocities in the
fixed frame.
"""

from __future__ import annotations

import cmath
import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from carom.base.outcome import InputError
from carom.base.results import in_si
from carom.parameters import MACHINE_FIELDS, Scales, read_size
from carom.parameters.formats import format_angle, format_quantity, number
from carom.parameters.quantities import comma_advice, without_separators

if TYPE_CHECKING:
    from carom.disturbances.model import Disturbance
    from carom.models import Rotor, Subject
    from carom.motions.starts import State


@dataclass(frozen=True)
class Echo:
    """One disturbance as it was taken.

    Attributes
    ----------
    kind : {"kick", "shock", "blade-loss", "start", "drop", "unbalance"}
    words : str
        Such as ``"Kick: 60 mm/s at 30°"``, and from where its angles count.
    sizes : mapping of str to (float, str)
        Each size in units of the equations, with its property of :class:`~carom.parameters.Scales`; empty for angles.
    """

    kind: str
    words: str
    sizes: Mapping[str, tuple[float, str]]

    def document(self, scales: Scales | None) -> dict[str, object]:
        """Return it as plain data, with sizes in SI units too where the scales are known."""
        document: dict[str, object] = {"kind": self.kind, "words": self.words}
        for name, (value, scale) in self.sizes.items():
            document[name] = value
            if scale:
                document |= in_si(document, scales, **{name: scale})
        return document


def angles_words(phase: float, when: str = "") -> str:
    """From where angles count: the real axis of the co-rotating frame, from which the phase of the unbalance counts too."""
    return f"angles are measured from the x axis that turns with the shaft{when}, in the sense of rotation (unbalance at {format_angle(phase)})"


def echo_of_unbalance(eccentricity: float, interval: tuple[float, float], scales: Scales) -> Echo:
    """The unbalance at every speed of a range, by the eccentricity in clearances and speeds in rad/s."""
    shown = MACHINE_FIELDS["speed"]
    low, high = (f"{number(shown.in_usual_unit(speed), 6)} {shown.usual_unit}" for speed in interval)
    words = f"Unbalance: {format_quantity(eccentricity, 'unbalance', scales)}, eccentricity {format_quantity(eccentricity, 'length', scales)}, at speeds from {low} to {high}"
    sizes = {"unbalance": (eccentricity, "unbalance"), "eccentricity": (eccentricity, "length")}
    ends = zip(("lowest_speed", "highest_speed"), interval, strict=True)
    return Echo("unbalance", words, {**sizes, **{name: (speed / scales.speed, "speed") for name, speed in ends}})


def moving(place: complex, rate: complex, scales: Scales | None) -> Echo:
    """A displacement and its rate in the frame that turns with the shaft; the velocity is stated in the fixed frame."""
    speed = rate + 1j * place
    distance = format_quantity(abs(place), "length", scales)
    at = f"{distance} from the bearing centre at {format_angle(cmath.phase(place))}"
    moves = f"moving at {format_quantity(abs(speed), 'velocity', scales)} towards {format_angle(cmath.phase(speed))} in the fixed frame"
    return Echo(
        "start",
        f"{at}, {moves}",
        {
            "radius": (abs(place), "length"),
            "angle": (cmath.phase(place), ""),
            "speed": (abs(speed), "velocity"),
            "direction": (cmath.phase(speed), ""),
        },
    )


def in_both_units(value: float, kind: str, scales: Scales | None) -> str:
    """Write a size in units of the machine, and in brackets in those of the equations."""
    own = format_quantity(value, kind, None, 4)
    return own if scales is None else f"{format_quantity(value, kind, scales, 4)} ({own})"


def eccentricity_words(value: float, scales: Scales | None) -> str:
    """Write an eccentricity given in clearances, with the unbalance that it is if the mass is known."""
    own = format_quantity(value, "length", None, 5)
    if scales is None:
        return own
    return f"{format_quantity(value, 'length', scales, 5)} ({own}, {format_quantity(value, 'unbalance', scales, 5)})"


class Part(NamedTuple):
    """A part of the text of a disturbance: one of its fields, or of its coordinates."""

    name: str
    called: str
    """What errors and help call it, such as ``"SPEED"``."""
    kind: str
    """Property of :class:`~carom.parameters.Scales` that gives its unit, ``"angle"``, ``"node"`` or ``"count"``."""
    usual: float | None = None
    """What it is where the text ends before it, in SI units (of a node, the only one there is); ``None`` if it must be stated."""
    optional: bool = True


@dataclass(frozen=True)
class Single:
    """One disturbance of a kind, for :func:`carom.simulate`.

    Attributes
    ----------
    model : Disturbance
        Its kind.
    values : tuple of float or str
        Values of its coordinates, in units of the equations or text with a unit.
    instant : float or str
        Angle by which the shaft has turned when it comes, in rad or text with a unit.
    """

    model: Disturbance
    values: tuple[float | str, ...]
    instant: float | str = 0.0

    def stages(self, machine: Subject) -> tuple[Rotor, State]:
        """Return the machine that moves, perhaps in stages or another one than before, and its start."""
        return self.model.apply(machine, *self.values, instant=self.instant)

    def echo(self, rotor: Rotor) -> Echo:
        """What was done to a rotor: kind, sizes, and from where angles count; with the instant of the turn where that matters."""
        *values, instant = self.model.whole(self.values, self.instant, rotor.scales)
        found = self.model.echo(rotor, *values)
        if not rotor.depends_on_instant:
            return found
        words = (
            f"{found.words}; at this instant the co-rotating x axis is {format_angle(instant)} ahead of the fixed one"
        )
        return dataclasses.replace(found, words=words, sizes={**found.sizes, "instant": (instant, "")})


def read_single(model: type[Disturbance], text: str, scales: Scales | None, option: str) -> Single:
    """Read the text of a disturbance, such as ``"60 mm/s, 30 deg"``, ``"10 g, 5 ms, 30 deg"`` or ``"200 g mm, 0 deg, node 7"``.

    Errors call it by the ``option``.

    Raises
    ------
    InputError
        Too few or too many parts, or one is no such quantity.
    """
    parts, allowed = model.parts, text_allowed(model, scales)
    least = sum(not part.optional for part in parts)
    given = split_text(option, text, tuple(range(least, len(parts) + 1)), allowed)
    doubtful = len(given) > 1 and not model.bare and (scales is not None or not given[0].strip("0."))
    if doubtful and (advice := comma_advice(text)):
        unit = " with its unit" if scales and not any(map(str.isalpha, text)) else ""
        raise InputError(option, text, f"{allowed}; {advice}{unit}")
    if len(given) < len(parts) and scales is None and parts[len(given)].usual:
        raise InputError(option, text, allowed)  # what is usual is in SI units
    found: dict[str, float | None] = {
        part.name: read_part(option, part, each, scales, model.bare) for part, each in zip(parts, given, strict=False)
    }
    for part in parts[len(given) :]:
        usual = part.usual
        found[part.name] = usual / float(getattr(scales, part.kind)) if usual else usual
    fields = {each.name for each in dataclasses.fields(model)}
    stated: dict[str, Any] = {name: value for name, value in found.items() if name in fields and value is not None}
    try:
        made = model(**stated)
        # A size that is a field is that of the disturbance itself.
        values = (found.get(each.name) for each in made.coordinates)
        return Single(made, made.whole([each for each in values if each is not None])[:-1])
    except InputError as problem:
        raise InputError(option, text, f"{problem.field}: {problem.allowed}") from None


def text_allowed(model: type[Disturbance], scales: Scales | None) -> str:
    """What the text of a disturbance must be, as the end of an error message."""
    parts = model.parts
    forms = [",".join(part.called for part in parts[:count]) for count in range(1, len(parts) + 1)]
    forms = [form for count, form in enumerate(forms, 1) if all(part.optional for part in parts[count:])]
    listed = f"{', '.join(forms[:-1])} or {forms[-1]}" if len(forms) > 1 else forms[0]
    return f"must be {listed} such as {model.example if scales or model.bare else _OWN}"


_OWN = "0.4,0.2"
"""Sizes with an angle of a machine in units of the equations."""


WHOLE = {"node": "the number of a node, from 0 on, such as 'node 7'", "count": "a whole number for {}, such as 3"}
"""Kinds of parts that are whole numbers, and what their text must be."""


def read_part(option: str, part: Part, text: str, scales: Scales | None, bare: bool = False) -> float:
    """Read the number of a part, in units of the equations; where the scales are known it needs a unit, but an angle of zero."""
    if part.kind in WHOLE:
        number = text.removeprefix("node").strip()
        if not number.isdecimal():
            raise InputError(option, text, f"must be {WHOLE[part.kind].format(part.called)}")
        return int(number)
    if part.kind == "angle" and not text.strip("0."):
        return 0.0
    size = read_size(option, text, part.kind, scales, bare=bare).own(scales)
    if part.kind == "unbalance" and not size > 0.0:
        allowed = "must be an eccentricity or an unbalance above 0, such as 0.1 mm or 5000 g mm"
        raise InputError(option, text, allowed)
    return size


def split_text(option: str, text: str, counts: tuple[int, ...], allowed: str) -> list[str]:
    """Split at commas, but not at those that separate thousands."""
    pieces, parts = text.split(","), list[str]()
    while pieces:
        sizes = range(len(pieces), 1, -1)  # the longest that is one number
        size = next((size for size in sizes if "," not in without_separators(",".join(pieces[:size]))), 1)
        parts.append(",".join(pieces[:size]).strip())
        del pieces[:size]
    if len(parts) not in counts or not all(parts):
        raise InputError(option, text, allowed)
    return parts
