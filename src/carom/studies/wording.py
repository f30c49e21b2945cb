"""Numbers with units as text: in SI units if the machine is known, otherwise in units of the equations."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from carom.base.arguments import checked
from carom.models import Span
from carom.parameters import DIMENSIONLESS_FIELDS, UNITS, Case, Field, Required, Scales
from carom.parameters.formats import format_entry, format_quantity, number, own_entry
from carom.parameters.indentation import gives_way
from carom.parameters.numbers import own_numbers

SIZES = {"kick": "velocity", "shock": "acceleration", "blade_loss": "unbalance"}
"""What the size of a kick, a shock or a loss of a blade is."""
_UNTOLD = ("phi", "radius_ratio")
"""Numbers that a line of present values leaves out."""
_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"))


def counted(count: int, noun: str) -> str:
    """Write a count with its noun: ``1 orbit``, ``2 orbits``."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def listed(items: list[str]) -> str:
    """Join words: ``a``, ``a and b``, ``a, b and c``."""
    return items[0] if len(items) == 1 else f"{', '.join(items[:-1])} and {items[-1]}"


def entry_words(entry: str) -> str:
    """An entry of the machine file as people say it: ``derivative gain``; a dimensionless number by its symbol."""
    return DIMENSIONLESS_FIELDS[entry].symbol if entry in DIMENSIONLESS_FIELDS else entry.replace("_", " ")


def no_rigid_wall(indentation: float) -> str:
    """Say that the rigid wall is not a valid model if the indentation of steel, in clearances, is large; else nothing."""
    return f"a rigid wall is no model there: {steel_words(indentation)}" if gives_way(indentation) else ""


def steel_words(indentation: float) -> str:
    """Say by how much, in clearances, even a wall of steel is indented."""
    share = f"{number(100.0 * indentation, 2)} %" if indentation < 10.0 else f"{number(indentation, 2)} times"
    what = "of the clearance" if indentation < 10.0 else "the clearance"
    return f"even solid steel is indented by at least {share} {what}"


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
        """Scales by which parameters are told in the terms of the machine; ``None`` where dimensionless numbers are."""
        return self.scales if self.in_terms else None

    def length(self, value: float) -> str:
        """A length given in ``c_r``."""
        return self._quantity(value, "length")

    def radius(self, value: float) -> str:
        """A radius in both units, for example ``0.955 c_r (0.668 mm)``."""
        share = f"{number(value, 3)} c_r"
        return share if self.scales is None else f"{share} ({self.length(value)})"

    def time(self, value: float) -> str:
        """A time given in ``1/Ω``."""
        return self._quantity(value, "time")

    def velocity(self, value: float) -> str:
        """A velocity of the rotor centre given in ``c_r Ω``; always in mm/s, so that those of a page compare at a glance."""
        return format_quantity(value, "velocity", self.scales)

    def acceleration(self, value: float) -> str:
        """An acceleration of the housing given in ``c_r Ω²``, in multiples of that of free fall."""
        return format_quantity(value, "acceleration", self.scales)

    def unbalance(self, value: float) -> str:
        """An unbalance given as an eccentricity in ``c_r``, in g mm; without scales as it is."""
        return format_quantity(value, "unbalance" if self.scales else "length", self.scales)

    def size_of(self, kind: str) -> Callable[[float], str]:
        """How the size of a kick, a shock or a loss of a blade is written."""
        write: Callable[[float], str] = getattr(self, SIZES[kind])
        return write

    def slip(self, value: float) -> str:
        """The speed of the surface of the rotor on the wall, given in ``c_r Ω``, in m/s."""
        return (
            f"{number(value * self.scales.velocity, 3)} m/s"
            if self.scales
            else format_quantity(value, "velocity", None)
        )

    def force(self, value: float) -> str:
        """A force given in ``m c_r Ω²``; below 100,000 N without prefix, as bearing loads are usually given in N."""
        if self.scales is not None and abs(value) * self.scales.force >= 1e5:
            return _with_prefix(value * self.scales.force, "N", least=1.0)
        return format_quantity(value, "force", self.scales)

    def impulse(self, value: float) -> str:
        """An impulse given in ``m c_r Ω``."""
        return format_quantity(value, "impulse", self.scales)

    def energy(self, value: float) -> str:
        """An energy given in ``m c_r² Ω²``."""
        return self._quantity(value, "energy", least=1.0)

    def power(self, value: float) -> str:
        """A power given in ``m c_r² Ω³``."""
        return self._quantity(value, "power", least=1.0)

    def per_second(self, period: float) -> str:
        """Write the frequency of an event with this period, in ``1/Ω``."""
        if self.scales is None:
            return f"{number(2.0 * math.pi / period, 3)} times a turn"
        return f"{number(1.0 / (period * self.scales.time), 3)} times a second"

    def value(self, name: str, value: float) -> str:
        """A value of a parameter; of a dimensionless one that of the entry of the machine, with its unit, if it is known."""
        entry, own = own_entry(name, value, self.of_machine)
        return format_entry(self.fields.get(entry, entry), own)

    def name(self, name: str) -> str:
        """Return what people call a parameter: ``damping`` for ``gamma``, or the symbol ``γ`` if the machine is not known."""
        entry = own_entry(name, 1.0, self.of_machine)[0]
        return self.fields[entry].words if entry in self.fields else entry_words(entry)

    def in_si(self, name: str, **values: float) -> dict[str, Any]:
        """Values of a parameter in SI units, as plain data for JSON; nothing if the machine is not known."""
        if self.of_machine is None and not (self.scales and name in self.fields and self.fields[name].unit):
            return {}
        own = {f"{key}_si": own_entry(name, value, self.of_machine)[1] for key, value in values.items()}
        return {"quantity": self.name(name), **own}

    def in_both(self, name: str, **values: float) -> dict[str, Any]:
        """Values of a parameter, with those in SI units if the machine is known."""
        return {"parameter": name, **values, **self.in_si(name, **values)}

    def required(self, required: Required) -> list[str]:
        """What a machine must survive: ``kicks of up to 166 mm/s``, and what else."""
        parts, shock = [f"kicks of up to {self.velocity(required.kick)}"], required.shock
        if shock:
            parts.append(f"shocks of up to {self.acceleration(shock.peak)} over {self.time(shock.duration)}")
        if required.blade_loss:
            parts.append(f"the loss of a blade that changes the unbalance by {self.unbalance(required.blade_loss)}")
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

    def _quantity(self, value: float, kind: str, least: float = 0.1) -> str:
        if self.scales is None:
            return format_quantity(value, kind, None)
        return _with_prefix(value * getattr(self.scales, kind), UNITS[kind][1], least)


def present_values(case: Case) -> str:
    """Return the present values of a machine in a line: ``damping 1,400 N s/m, stiffness 980,000 N/m, speed 1,759 rpm``."""
    if case.machine is None and "speed" in case.parameters.varied:
        scales = case.parameters.scales
        speed = format_entry("speed", case.parameters.value("speed"))
        return f"mass {format_entry('mass', scales.mass)}, speed {speed}, clearance {format_entry('clearance', scales.clearance)}"
    if case.machine is None:
        own = own_numbers(case.parameters).items()
        shown = [(case.parameters.varied[name].symbol, value) for name, value in own if not name.startswith(_UNTOLD)]
        return ", ".join(f"{symbol} = {number(value)}" for symbol, value in shown)
    return ", ".join(
        f"{name} {format_entry(name, getattr(case.machine, name))}" for name in ("damping", "stiffness", "speed")
    )


def machine_heading(case: Case) -> str:
    """Return the name and the present values of a machine, for the heading of a figure."""
    return f"{case.name}: {present_values(case)}"


def _with_prefix(value: float, unit: str, least: float) -> str:
    """Write three digits with the largest prefix that leaves at least ``least``: ``0.668 mm``, not ``668 µm``."""
    size = abs(value)
    if size == 0:
        return f"0 {unit}"
    for factor, prefix in _PREFIXES:
        if size >= least * factor:
            return f"{number(value / factor, 3)} {prefix}{unit}"
    return f"{number(value, 3)} {unit}"
