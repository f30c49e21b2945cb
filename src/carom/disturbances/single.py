"""A single disturbance: one size, one direction, one instant.  Its text is the same on the command line and in Python."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from carom.base.outcome import InputError
from carom.parameters import Scales, read_size
from carom.parameters.formats import format_angle
from carom.parameters.quantities import comma_advice, without_separators

if TYPE_CHECKING:
    from carom.disturbances.echo import Echo
    from carom.disturbances.model import Disturbance
    from carom.models import Rotor, Subject
    from carom.motions.starts import State


class Part(NamedTuple):
    """A part of the text of a disturbance: one of its fields, or of its coordinates."""

    name: str
    called: str
    """What errors and help call it, such as ``"SPEED"``."""
    kind: str
    """Property of :class:`~carom.parameters.Scales` that gives its unit, ``"angle"``, or ``"node"``."""
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
        part.name: _number(option, part, each, scales, model.bare) for part, each in zip(parts, given, strict=False)
    }
    for part in parts[len(given) :]:
        usual = part.usual
        found[part.name] = usual / float(getattr(scales, part.kind)) if usual else usual
    fields = {each.name for each in dataclasses.fields(model)}
    stated: dict[str, Any] = {name: value for name, value in found.items() if name in fields}
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


def _number(option: str, part: Part, text: str, scales: Scales | None, bare: bool) -> float:
    """The number of a part, in units of the equations; where the scales are known it needs a unit, but an angle of zero."""
    if part.kind == "node":
        number = text.removeprefix("node").strip()
        if not number.isdecimal():
            raise InputError(option, text, "must be the number of a node, from 0 on, such as 'node 7'")
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
