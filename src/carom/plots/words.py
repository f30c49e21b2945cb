"""Names, titles and axis labels: words with their symbols and units; axes of machines in SI units have the dimensionless parameter on the opposite side."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Literal

import numpy as np
from matplotlib.axes import Axes

from carom.parameters.fields import MACHINE_FIELDS, PHYSICAL_PARTNER, Field
from carom.parameters.formats import number as plain
from carom.parameters.formats import shown_in
from carom.parameters.scaling import CONVERSIONS
from carom.plots.style import LOOKS

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from carom.motions.trajectories import Trajectory
    from carom.orbits.orbit import Orbit
    from carom.orbits.simulated import SimulatedOrbit
    from carom.parameters import Field, Scales

_ORBITS = re.compile(r"\b[BR]\d+,[a-d](?:/[a-d])*")
"""Names of orbits in a text; those that differ in the last letter are combined."""


def orbit_symbol(name: str) -> str:
    """Return an orbit name as mathematical text: ``"B1,d"`` becomes B with the subscript 1,d."""
    letter, subscript = name[:1], name[1:].replace(" ", r"\,")
    return rf"${letter}_{{\mathrm{{{subscript}}}}}$" if subscript[:1].isdigit() else name


def with_symbols(text: str) -> str:
    """Write the names of orbits in a text, such as ``B1,a/b``, as mathematical text."""
    return _ORBITS.sub(lambda match: orbit_symbol(match[0]), text)


def orbit_look(orbit: Orbit | SimulatedOrbit) -> str:
    """Return the key of :data:`carom.plots.style.LOOKS` for the kind of an orbit."""
    return orbit.multipliers.stability if orbit.admissible else "virtual"


def orbit_words(orbit: Orbit | SimulatedOrbit) -> str:
    """Return the name and kind of an orbit, for example ``B1,d — admissible, stable``."""
    return f"{orbit_symbol(orbit.name)} \N{EM DASH} {LOOKS[orbit_look(orbit)].words}"


def orbit_title(orbit: Orbit) -> str:
    """Return the same, with the reason if the orbit is virtual."""
    return orbit_words(orbit) if orbit.admissible or not orbit.reason else f"{orbit_words(orbit)}: {orbit.reason}"


def number(value: float, digits: int = 4) -> str:
    """Write a number for a label, without trailing zeros, with thousands separators; powers of ten as mathematical text."""
    text = f"{value:,.{digits}g}"
    if "e" not in text:
        return text
    mantissa, exponent = text.split("e")
    return rf"${mantissa}\times 10^{{{int(exponent)}}}$"


def counted(count: int, noun: str) -> str:
    """Write a count with its noun: ``no impact``, ``1 impact``, ``2 impacts``."""
    return f"{count or 'no'} {noun}" if count <= 1 else f"{count} {noun}s"


def contacts_in_words(motion: Trajectory) -> str:
    """Write how often a motion touched in which time, and at which touchdown bearing of several: ``2 impacts in 3 ms``."""
    noun = "contact" if motion.rotor.system.contacts[motion.plane].wall.stiffness else "impact"
    where = f" at touchdown bearing {motion.plane + 1}" if len(motion.at_each) > 1 else ""
    return f"{counted(len(motion.contacts), noun)}{where} in {time_in_words(motion.time, motion.rotor.scales)}"


def times_larger(ratio: float) -> str:
    """Write an enlargement with two digits."""
    return f"{float(f'{ratio:.2g}'):.0f}"


def formula(unit: str) -> str:
    """Return a unit of the equations as mathematical text; a unit of people stays as it is."""
    if not any(sign in unit for sign in ("c_r", "Ω", "Omega")):
        return unit
    parts = unit.replace("Omega", "Ω").replace("²", "^2").replace("³", "^3").split()
    return "$" + r"\,".join(part.replace("c_r", r"c_\mathrm{r}").replace("Ω", r"\Omega") for part in parts) + "$"


def display_unit(kind: str, scales: Scales | None) -> tuple[float, str]:
    """Return by what figures multiply a size in units of the equations, and the unit for their labels.

    The kind is a property of :class:`~carom.parameters.Scales`.  Without scales, sizes stay in units of the equations.
    """
    factor, unit = shown_in(kind, scales)
    return factor, formula(unit)


def clearance(scales: Scales | None) -> float:
    """Return the radius of the clearance circle as it is drawn: in mm, or 1 without scales."""
    return display_unit("length", scales)[0]


def time_in_words(time: float, scales: Scales | None) -> str:
    """Write a dimensionless time: in ms or s if the machine is known, otherwise in its own unit."""
    if scales is None:
        return rf"{number(time)} $/\,\Omega$"
    seconds = time * scales.time
    return f"{number(seconds, 3)} s" if seconds >= 1.0 else f"{number(1e3 * seconds, 3)} ms"


def axis_label(words: str, kind: str, scales: Scales | None) -> str:
    """Return an axis label: words or a symbol, and the unit of their kind as in :func:`display_unit`."""
    return f"{words} ({display_unit(kind, scales)[1]})"


def axis_time(scales: Scales | None) -> str:
    """Return the axis label of the time."""
    return axis_label("time $t$", "time", scales)


def parameter_label(field: Field, unit: str | None = None) -> str:
    """Return the words, symbol and unit of a parameter, by default the unit in which people usually say it."""
    unit = field.usual_unit if unit is None else unit
    symbol = {"γ": r"\gamma", "ω": r"\omega", "ρ": r"\rho", "φ": r"\varphi", "μ": r"\mu", "Ω": r"\Omega"}.get(
        field.symbol, field.symbol
    )
    return field.words + (f" ${symbol}$" if symbol else "") + (f" ({unit})" if unit else "")


def label_parameter(axes: Axes, direction: Literal["x", "y"], field: Field, scales: Scales | None, own: Axes) -> bool:
    """Label the axis of a parameter at the bottom or left; return whether its dimensionless value is on the other side.

    `axes` have the label, `own` the dimensionless values of a machine in SI units; they share the axis, or are the same.
    """
    label = parameter_label(field)
    partner = _partner(field, scales)
    if partner is None or scales is None:
        axes.set(**{f"{direction}label": label})
        return False
    conversion, size = CONVERSIONS[field.name], partner.usual_size

    def to_machine(values: ArrayLike) -> object:
        return conversion.value(np.asarray(values, float), scales) / size

    def from_machine(values: ArrayLike) -> object:
        # Matplotlib tries values beyond the axis.
        return (np.maximum(values, 0.0) * size / conversion.unit(scales)) ** (1.0 / conversion.power)

    near, far = ("bottom", "top") if direction == "x" else ("left", "right")
    axes.tick_params(axis=direction, which="both", **{near: False, f"label{near}": False})
    own.tick_params(axis=direction, which="both", **{far: True, f"label{far}": True})
    shown = getattr(axes, f"secondary_{direction}axis")(near, functions=(to_machine, from_machine))
    shown.set(**{f"{direction}label": parameter_label(partner)})
    getattr(shown, f"{direction}axis").set_major_formatter(lambda value, _: plain(value))
    getattr(own, f"{direction}axis").set_label_position(far)
    own.set(**{f"{direction}label": label})
    return True


def format_parameter(value: float, field: Field, scales: Scales | None) -> str:
    """Write a value of a parameter as its axis tells it, with its unit."""
    partner = _partner(field, scales)
    if partner is not None and scales is not None:
        value, field = float(CONVERSIONS[field.name].value(value, scales)), partner
    return f"{number(value / field.usual_size)} {field.usual_unit}".rstrip()


def _partner(field: Field, scales: Scales | None) -> Field | None:
    """The field of a machine that a dimensionless parameter stands for, if it has a unit."""
    partner = MACHINE_FIELDS.get(PHYSICAL_PARTNER.get(field.name, ""))
    return partner if scales is not None and partner is not None and partner.unit not in ("", "rad") else None
