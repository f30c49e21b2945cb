"""Multipliers of periodic orbits next to the unit circle."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.arguments import checked
from carom.plots.plane import Complex, one_axes
from carom.plots.style import LOOKS, ONE_COLUMN, styled
from carom.plots.words import orbit_look, orbit_words

if TYPE_CHECKING:
    from carom.orbits.orbit import Orbit

_SHAPES = ("o", "s", "^", "D", "v", "P", "X", "p", "<", ">", "h", "*")
_LINEAR_UP_TO = 2.0


@checked
@styled
def multipliers(orbits: Iterable[Orbit], *, virtual: bool = False, axes: Axes | None = None) -> Figure:
    """Draw the non-trivial multipliers of orbits next to the unit circle: one marker shape for each orbit.

    An orbit is stable if all its multipliers lie inside the circle.  A multiplier that leaves it through +1 means a
    fold, through -1 a period doubling, elsewhere a torus.  If the modulus of a multiplier exceeds 2, the plane outside
    the unit circle has a logarithmic radius: a multiplier keeps its direction and is drawn at the distance 1 + log10 of
    its modulus.  The axis labels then say so and the axes have no numbers; circles show the modulus.

    A new figure is 88 mm wide.

    Parameters
    ----------
    virtual : bool
        Draw the multipliers of virtual orbits too; if there are more than twelve orbits, these share one small marker.
    """
    every = [orbit for orbit in orbits if orbit.admissible or virtual]
    grouped = [orbit for orbit in every if not orbit.admissible] if len(every) > len(_SHAPES) else []
    shown = [orbit for orbit in every if orbit not in grouped]
    entries = len(shown) + bool(grouped)
    columns = 1 if entries <= 4 else 2
    lines = -(-entries // columns)
    largest = max((float(np.abs(orbit.multipliers.values).max()) for orbit in every), default=1.0)
    compressed = largest > _LINEAR_UP_TO
    height = (1.06 if compressed else 0.97) * ONE_COLUMN + 0.15 * lines
    figure, drawn = one_axes(axes, (ONE_COLUMN, height))
    _unit_circle(drawn)
    if compressed:
        _logarithmic_plane(drawn, largest)
    else:
        _linear_plane(drawn, largest)
    for orbit, shape in zip(shown, cycle(_SHAPES), strict=False):
        values = np.asarray(orbit.multipliers.values)
        _markers(drawn, _compress(values) if compressed else values, orbit, shape)
    if grouped:
        values = np.concatenate([orbit.multipliers.values for orbit in grouped])
        _dots(drawn, _compress(values) if compressed else values, len(grouped))
    if not every:
        drawn.plot([], [], linestyle="none", label="no periodic orbit" if virtual else "no possible periodic orbit")
    if axes is None:
        figure.legend(*drawn.get_legend_handles_labels(), loc="outside lower center", ncols=columns)
    else:
        drawn.legend(loc="upper left", bbox_to_anchor=(1.03, 1.0))
    return figure


def _compress(values: Complex) -> Complex:
    """Map values outside the unit circle to the distance 1 + log10 of their modulus; values inside are unchanged."""
    modulus = np.maximum(np.abs(values), 1.0)
    return values / modulus * (1.0 + np.log10(modulus))


def _unit_circle(axes: Axes) -> None:
    _circle(axes, 1.0, "#1a1a1a", 0.9, "unit-circle")
    axes.axhline(0.0, color="#c4c4c4", lw=0.35, zorder=0)
    axes.axvline(0.0, color="#c4c4c4", lw=0.35, zorder=0)
    axes.set_aspect("equal")


def _circle(axes: Axes, radius: float, colour: str, width: float, gid: str) -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 361)
    axes.plot(radius * np.cos(angle), radius * np.sin(angle), color=colour, lw=width, zorder=1, gid=gid)


def _linear_plane(axes: Axes, largest: float) -> None:
    reach = 1.08 * max(1.1, largest)
    ticks = np.arange(-2.0, 2.01, 0.5)
    axes.set(xticks=ticks, yticks=ticks, xlim=(-reach, reach), ylim=(-reach, reach))
    axes.set_xlabel(r"real part of the multiplier, Re $\lambda$ (no unit)")
    axes.set_ylabel(r"imaginary part of the multiplier, Im $\lambda$ (no unit)")


def _logarithmic_plane(axes: Axes, largest: float) -> None:
    reach = 1.08 * (1.0 + np.log10(largest))
    decades = range(int(np.ceil(np.log10(largest))) + 1)
    diagonal = np.exp(-0.25j * np.pi)
    for modulus in [factor * 10**decade for decade in decades for factor in (1, 2, 5)]:
        place = (1.0 + np.log10(modulus)) * diagonal
        if place.real > 0.97 * reach:
            break
        power = float(np.log10(modulus)).is_integer()
        if modulus > 1:
            _circle(axes, abs(place), "#a6a6a6" if power else "#dcdcdc", 0.4, "modulus")
        if power or len(decades) <= 3:
            box = {"boxstyle": "square,pad=0.15", "facecolor": "white", "edgecolor": "none"}
            axes.text(place.real, place.imag, f"{modulus}", fontsize=6, ha="center", va="center", bbox=box, zorder=2)
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), xticks=(), yticks=())
    axes.set_xlabel(
        "direction of Re $\\lambda$ (circles: $|\\lambda|$, no unit; distance from the\n"
        "centre $|\\lambda|$ up to 1, $1+\\log_{10}|\\lambda|$ beyond)"
    )
    axes.set_ylabel(r"direction of Im $\lambda$")


def _markers(axes: Axes, values: Complex, orbit: Orbit, shape: str) -> None:
    meaning = orbit_look(orbit)
    colour = LOOKS[meaning].colour
    axes.plot(
        values.real,
        values.imag,
        linestyle="none",
        marker=shape,
        markersize=4.8,
        markerfacecolor=colour if meaning == "stable" else "none",
        markeredgecolor=colour,
        markeredgewidth=0.9,
        label=orbit_words(orbit),
        zorder=3 if meaning == "stable" else 4,
        gid=orbit.name,
    )


def _dots(axes: Axes, values: Complex, count: int) -> None:
    look = LOOKS["virtual"]
    words = f"{count} orbits \N{EM DASH} {look.words}"
    axes.plot(values.real, values.imag, ".", markersize=2.5, color=look.colour, label=words, zorder=2, gid="virtual")
