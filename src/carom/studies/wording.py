"""Results as text: numbers with units, in SI units if the machine is known, otherwise in units of the equations; and where motions end."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial, partialmethod
from string import Formatter
from typing import Any

from carom.attractors import MotionName
from carom.base.arguments import checked
from carom.base.outcome import Outcome, printable
from carom.base.results import KINDS, attribute_of
from carom.models import Edge, Rotor, Span
from carom.parameters import DIMENSIONLESS_FIELDS, UNITS, Case, Field, Required, Scales
from carom.parameters.fields import RPM
from carom.parameters.formats import format_entry, format_quantity, number, own_entry
from carom.parameters.indentation import indentation_of_force, indentation_of_impact, is_compliant
from carom.parameters.numbers import own_numbers

SIZES = {"kick": "velocity", "shock": "acceleration", "base_record": "acceleration", "blade_loss": "unbalance"}
"""What the size of a kick, a shock or a loss of a blade is."""
_UNTOLD = ("phi", "radius_ratio")
"""Numbers that a line of present values leaves out."""
_NOUNS = ("contact", "impact", "bounce")
_LEAST = {"length": 0.1, "time": 0.1, "energy": 1.0, "power": 1.0}
"""Kinds with a prefix, and the least number that stands before it."""
_MANY_NEWTONS = 1e5
"""Bearing loads are usually given in N; from here on they have a prefix."""
_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"))
EVENTS = {
    "boundary-equilibrium": "levitation reaches the wall",
    "rub-fold": "a stable and an unstable rub meet (fold)",
    "fold": "two orbits meet (fold)",
    "speed-fold": "two orbits of one period meet (fold)",
    "grazing": "an orbit grazes the wall between two impacts",
    "non-smooth-hopf": "an orbit shrinks to levitation at the wall (non-smooth Hopf)",
    "slip-stop": "friction begins to stop the slip during impacts of an orbit",
    "contact-onset": "an orbit begins to stay on the wall after an impact",
    "period-doubling": "an orbit loses its stability (period doubling)",
    "neimark-sacker": "an orbit loses its stability (Neimark-Sacker)",
    "vanishing-period": "the period of an orbit shrinks to zero",
    "rolling-limit": "friction is just enough to keep the rotor rolling at every angle",
    "simulated": "the rotor can no longer levitate",
}
"""What happens at the ends of the ranges of motions."""


def counted(count: int, noun: str) -> str:
    """Write a count with its noun: ``1 orbit``, ``2 orbits``."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def listed(items: list[str]) -> str:
    """Join words: ``a``, ``a and b``, ``a, b and c``."""
    return items[0] if len(items) == 1 else f"{', '.join(items[:-1])} and {items[-1]}"


def rpm(speed: float) -> str:
    """A speed given in rad/s, in rpm: ``1,759 rpm``."""
    return f"{number(speed / RPM, max(4, len(f'{speed / RPM:.0f}')))} rpm" if speed < math.inf else "any speed"


def micrometres(length: float) -> str:
    """A length given in m, in µm: ``134 µm``."""
    return f"{number(1e6 * length, 3 if length < 1e-3 else 4)} µm"


def ending_phrase(motion: MotionName) -> str:
    """Return the words of a motion to follow a verb: (ends) ``in regular bouncing``, ``not settled``."""
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


def edge_words(edge: Edge) -> str:
    """Say what happens at the end of a range."""
    if edge.motion is not None:
        return f"beyond which disturbances ended in {motion_words(edge.motion)}"
    return f"where {EVENTS.get(edge.kind, f'an orbit ends ({edge.kind})')}"


def entry_words(entry: str) -> str:
    """An entry of the machine file as people say it: ``derivative gain``; a dimensionless number by its symbol."""
    return DIMENSIONLESS_FIELDS[entry].symbol if entry in DIMENSIONLESS_FIELDS else entry.replace("_", " ")


def indentation_of_steel(rotor: Rotor, impulse: float = 0.0, force: float = 0.0) -> float:
    """Least indentation, in clearances, of a rigid wall of solid steel by a normal impulse and a force; ``nan`` if unknown."""
    at = rotor.in_rigid_wall
    if at is None:
        return math.nan
    return max(indentation_of_impact(at, impulse / (1.0 + at.d)), indentation_of_force(at, force))


def no_rigid_wall(indentation: float) -> str:
    """Say that the rigid wall is not a valid model if the indentation of steel, in clearances, is large; else nothing."""
    return f"the rigid model does not apply: {steel_words(indentation)}" if is_compliant(indentation) else ""


def steel_words(indentation: float) -> str:
    """Say by how much, in clearances, even a wall of steel is indented."""
    share = f"{number(100.0 * indentation, 2)} %" if indentation < 10.0 else f"{number(indentation, 2)} times"
    what = "of the clearance" if indentation < 10.0 else "the clearance"
    return f"even solid steel is indented by at least {share} {what}"


def _radius(scales: Scales | None, value: float) -> str:
    share = f"{number(value, 3)} c_r"
    return share if scales is None else f"{share} ({Wording(scales).length(value)})"


def _rate(scales: Scales | None, period: float) -> str:
    if scales is None:
        return f"{number(2.0 * math.pi / period, 3)} times a turn"
    return f"{number(1.0 / (period * scales.time), 3)} times a second"


def _speed(scales: Scales | None, value: float) -> str:
    return f"{number(value)} Ω" if scales is None else format_entry("speed", value * scales.speed)


OTHER_KINDS: dict[str, Callable[[Scales | None, float], str]] = {
    "radius": _radius,
    "rate": _rate,
    "speed": _speed,
    "pressure": lambda _, value: f"{number(1e-9 * value, 3)} GPa",
    "newton": lambda _, value: f"{number(value, 3)} N",
    "percent": lambda _, value: f"{number(100.0 * value, 2)} %",
}
"""A radius in clearances and in mm, how often an event with a period comes, angular speed in rpm, a pressure
in Pa, a force in N, and a share."""


@checked
@dataclass(frozen=True)
class Wording:
    """Turns dimensionless results into text.

    Parameters
    ----------
    scales : Scales or None
        Without them results keep the units of the equations: ``c_r``, ``1/Ω``, ``m c_r Ω²``.
    in_terms : bool
        Whether damping and stiffness of the machine stand for the dimensionless numbers, where scales are known.
    fields : mapping of str to Field
        Parameters of a rotor that are none of the planar one.
    """

    scales: Scales | None
    in_terms: bool = True
    fields: Mapping[str, Field] = field(default_factory=dict)

    @property
    def of_machine(self) -> Scales | None:
        """Scales by which parameters are stated in the terms of the machine; ``None`` where dimensionless numbers are."""
        return self.scales if self.in_terms else None

    def write(self, value: Any, kind: str = "") -> str:
        """A value in units of the equations: of a kind of :class:`~carom.parameters.Scales`, one of :data:`OTHER_KINDS`, or as a plain number of four digits.

        Kinds that people read in their own unit are in it (mm/s, g, ms, mm); others have the prefix that leaves three digits.
        """
        if kind in _NOUNS:
            return counted(value, kind)
        if kind in OTHER_KINDS:
            return OTHER_KINDS[kind](self.scales, value)
        if not kind:
            return number(value)
        size = 0.0 if self.scales is None else value * getattr(self.scales, kind)
        if (self.scales is not None and kind in _LEAST) or (kind == "force" and abs(size) >= _MANY_NEWTONS):
            whole = kind == "time" and size >= 1e3  # no kiloseconds
            return f"{number(size, 4)} s" if whole else _with_prefix(size, UNITS[kind][1], _LEAST.get(kind, 1.0))
        return format_quantity(value, "length" if kind == "unbalance" and self.scales is None else kind, self.scales)

    length = partialmethod(write, kind="length")
    time = partialmethod(write, kind="time")
    velocity = partialmethod(write, kind="velocity")
    force = partialmethod(write, kind="force")
    impulse = partialmethod(write, kind="impulse")
    power = partialmethod(write, kind="power")
    per_second = partialmethod(write, kind="rate")
    radius = partialmethod(write, kind="radius")

    def fill(self, template: str, entry: object, **also: object) -> str | None:
        """A text with attributes of an entry as ``{name}`` or ``{name:kind}``; ``None`` where one of them is not known, or is zero.

        Without a kind it is that of :data:`~carom.base.results.KINDS`.  What is given ``also`` is text.
        """
        parts = []
        for before, name, kind, _ in Formatter().parse(template):
            parts.append(before)
            if name in also:
                parts.append(str(also[name]))
            elif name is not None:
                value = attribute_of(entry, name)
                if not value:
                    return None
                parts.append(value if isinstance(value, str) else self.write(value, kind or KINDS.get(name, "")))
        return "".join(parts)

    def rows(self, rows: Iterable[tuple[str, str]], entry: object, **also: object) -> list[tuple[str, str]]:
        """Labels with what they say of an entry, from templates of :meth:`fill`; what is not known is left out."""
        filled = ((label, self.fill(template, entry, **also)) for label, template in rows)
        return [(label, text) for label, text in filled if text is not None]

    def size_of(self, kind: str) -> Callable[[float], str]:
        """How the size of a kick, a shock or a loss of a blade is written."""
        return partial(self.write, kind=SIZES[kind])

    def value(self, name: str, value: float) -> str:
        """A value of a parameter; of a dimensionless one that of the entry of the machine, with its unit, if it is known."""
        entry, own = own_entry(name, value, self.of_machine)
        return format_entry(self.fields.get(entry, entry), own)

    def name(self, name: str) -> str:
        """Return what people call a parameter: ``damping`` for ``gamma``, or the symbol ``γ`` if the machine is not known."""
        entry = own_entry(name, 1.0, self.of_machine)[0]
        return self.fields[entry].words if entry in self.fields else entry_words(entry)

    def in_si(self, name: str, **values: float) -> dict[str, object]:
        """Values of a parameter in SI units, as plain data for JSON; nothing if the machine is not known."""
        if self.of_machine is None and not (self.scales and name in self.fields and self.fields[name].unit):
            return {}
        own = {f"{key}_si": own_entry(name, value, self.of_machine)[1] for key, value in values.items()}
        return {"quantity": self.name(name), **own}

    def in_both(self, name: str, **values: float) -> dict[str, object]:
        """Values of a parameter, with those in SI units if the machine is known."""
        return {"parameter": name, **values, **self.in_si(name, **values)}

    def required(self, required: Required) -> list[str]:
        """What a machine must survive: ``kicks of up to 166 mm/s``, and what else."""
        parts, shock = [f"kicks up to {self.velocity(required.kick)}"], required.shock
        if shock:
            parts.append(f"shocks up to {self.write(shock.peak, 'acceleration')} over {self.time(shock.duration)}")
        if (motion := required.base_record) is not None:
            parts.append(f"base motion {printable(motion.name)} up to {self.write(motion.largest, 'acceleration')}")
        if required.blade_loss:
            change = self.write(required.blade_loss, "unbalance")
            parts.append(f"blade losses that change the unbalance by {change}")
        return parts

    def where(self, name: str, spans: tuple[Span, ...], searched: Span | None = None) -> str:
        """Say for which values of a parameter something holds: ``below 3,408 N s/m``."""
        low, high = (self.value(name, edge.value) for edge in searched) if searched else ("", "")
        whole = f" searched ({low} to {high})" if searched else ""
        if not spans:
            return f"for no value{whole}"
        start, stop = (searched.low.value, searched.high.value) if searched else (0.0, math.inf)
        parts = []
        for span in spans:
            from_start, to_end = span.low.value <= start, span.high.value >= stop
            first, last = (self.value(name, edge.value) for edge in span)
            if from_start and to_end:
                return f"for every value{whole}"
            parts.append(f"below {last}" if from_start else f"above {first}" if to_end else f"from {first} to {last}")
        return " and ".join(parts)


def present_values(case: Case) -> str:
    """Return the present values of a machine in a line: ``damping 1,400 N s/m, stiffness 980,000 N/m, speed 1,759 rpm``."""
    if case.si:
        return ", ".join(f"{name} {format_entry(name, case.si[name])}" for name in ("damping", "stiffness", "speed"))
    if "speed" in case.parameters.varied:
        scales = case.parameters.scales
        speed = format_entry("speed", case.parameters.value("speed"))
        return f"mass {format_entry('mass', scales.mass)}, speed {speed}, clearance {format_entry('clearance', scales.clearance)}"
    own = own_numbers(case.parameters).items()
    shown = [(case.parameters.varied[name].symbol, value) for name, value in own if not name.startswith(_UNTOLD)]
    return ", ".join(f"{symbol} = {number(value)}" for symbol, value in shown)


def machine_heading(case: Case) -> str:
    """Return the name and the present values of a machine, for the heading of a figure."""
    return f"{case.name}: {present_values(case)}"


def _with_prefix(value: float, unit: str, least: float) -> str:
    """Write three digits with the largest prefix that leaves at least ``least``: ``0.668 mm``, not ``668 µm``."""
    for factor, prefix in _PREFIXES:
        if abs(value) >= least * factor:
            return f"{number(value / factor, 3)} {prefix}{unit}"
    return f"{number(value, 3)} {unit}"
