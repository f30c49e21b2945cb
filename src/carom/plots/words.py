"""Names, titles and axis labels: words with their symbols and units."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from carom.outcome import Outcome
from carom.plots.style import LOOKS

if TYPE_CHECKING:
    from carom.orbits.orbit import Orbit
    from carom.parameters import Field, Scales


def orbit_symbol(name: str) -> str:
    """Return an orbit name as mathematical text: ``"B1,d"`` becomes B with the subscript 1,d."""
    letter, subscript = name[:1], name[1:].replace(" ", r"\,")
    return rf"${letter}_{{\mathrm{{{subscript}}}}}$" if subscript else f"${letter}$"


def orbit_look(orbit: Orbit) -> str:
    """Return the key of :data:`carom.plots.style.LOOKS` for the kind of an orbit."""
    if not orbit.admissible:
        return "virtual"
    return "stable" if orbit.stable else "unstable"


def orbit_words(orbit: Orbit) -> str:
    """Return the name and kind of an orbit, for example ``B1,d — admissible, stable``."""
    return f"{orbit_symbol(orbit.name)} \N{EM DASH} {LOOKS[orbit_look(orbit)].words}"


def orbit_title(orbit: Orbit) -> str:
    """Return the same, with the reason if the orbit is virtual."""
    return orbit_words(orbit) if orbit.admissible or not orbit.reason else f"{orbit_words(orbit)}: {orbit.reason}"


def ending(outcome: Outcome) -> str:
    """Describe how a motion ended, briefly enough for a legend."""
    return outcome.words


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


def times_larger(ratio: float) -> str:
    """Write an enlargement with two digits."""
    return f"{float(f'{ratio:.2g}'):.0f}"


def time_in_words(time: float, scales: Scales | None) -> str:
    """Write a dimensionless time with its unit, and in ms if the machine is known."""
    text = rf"{number(time)} $/\,\Omega$"
    return text if scales is None else f"{text} ({_seconds(time * scales.time)})"


def _seconds(time: float) -> str:
    return f"{number(time, 3)} s" if time >= 1.0 else f"{number(1e3 * time, 3)} ms"


def axis_length(words: str, symbol: str, scales: Scales | None) -> str:
    """Return the axis label of a length in clearances, with the size of the clearance if the machine is known."""
    size = "" if scales is None else f" = {number(1e3 * scales.clearance, 3)} mm"
    return rf"{words} {symbol} (units of $c_\mathrm{{r}}${size})"


def axis_time(scales: Scales | None) -> str:
    """Return the axis label of the dimensionless time."""
    if scales is None:
        return r"time $t$ (units of $1/\Omega$)"
    return rf"time $t$ (units of $1/\Omega$ = {number(1e3 * scales.time, 3)} ms)"


def parameter_unit(field: Field) -> float:
    """Return the divisor of a parameter in figures, which show it in the unit in which people usually say it."""
    return field.usual_size


def parameter_label(field: Field, unit: str | None = None) -> str:
    """Return the words, symbol and unit of a parameter, by default the unit in which people usually say it."""
    unit = field.usual_unit if unit is None else unit
    symbol = {"γ": r"\gamma", "ω": r"\omega", "ρ": r"\rho", "φ": r"\varphi", "μ": r"\mu", "Ω": r"\Omega"}.get(
        field.symbol, field.symbol
    )
    return rf"{field.words} ${symbol}$" + (f" ({unit})" if unit else "")


def turns(time: float) -> str:
    """Write a dimensionless time as turns of the shaft."""
    return f"{number(time / math.tau, 3)} turns of the shaft"
