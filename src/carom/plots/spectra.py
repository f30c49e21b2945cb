"""Multipliers of periodic orbits next to the unit circle."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import SymmetricalLogLocator

from carom.base.arguments import checked
from carom.plots.plane import circle, key, one_axes
from carom.plots.style import LOOKS, ONE_COLUMN, styled
from carom.plots.words import orbit_look, orbit_words

if TYPE_CHECKING:
    from carom.orbits.orbit import Orbit

_SHAPES = ("o", "s", "^", "D", "v", "P", "X", "p", "<", ">", "h", "*")
_LINEAR_UP_TO = 2.0


@checked
@styled
def multipliers(orbits: Iterable[Orbit]) -> Figure:
    """Draw the non-trivial multipliers of orbits next to the unit circle: one marker shape for each orbit.

    An orbit is stable if all its multipliers lie inside the circle.  A multiplier that leaves it through +1 means a
    fold, through -1 a period doubling, elsewhere a torus.  If the modulus of a multiplier exceeds 2, both axes are logarithmic
    beyond -1 and 1.

    A new figure is 88 mm wide.
    """
    shown = [orbit for orbit in orbits if orbit.admissible]
    columns = 1 if len(shown) <= 4 else 2
    lines = -(-len(shown) // columns)
    figure, drawn = one_axes((ONE_COLUMN, 0.97 * ONE_COLUMN + 0.15 * lines))
    _plane(drawn, max((float(np.abs(orbit.multipliers.values).max()) for orbit in shown), default=1.0))
    for orbit, shape in zip(shown, cycle(_SHAPES), strict=False):
        _markers(drawn, orbit, shape)
    if not shown:
        drawn.plot([], [], linestyle="none", label="no possible periodic orbit")
    return key(figure, [drawn], columns)


def _plane(axes: Axes, largest: float) -> None:
    """Draw the unit circle in a plane that holds the largest modulus; beyond 1 it is logarithmic if that is large."""
    circle(axes, 1.0, color="#1a1a1a", lw=0.9, zorder=1, gid="unit-circle")
    axes.axhline(0.0, color="#c4c4c4", lw=0.35, zorder=0)
    axes.axvline(0.0, color="#c4c4c4", lw=0.35, zorder=0)
    reach = 1.08 * max(1.1, largest)
    note = "no unit"
    if largest > _LINEAR_UP_TO:
        reach, note = 1.3 * largest, "no unit; logarithmic beyond 1"
        axes.set_xscale("symlog", linthresh=1.0)
        axes.set_yscale("symlog", linthresh=1.0)
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(SymmetricalLogLocator(base=10.0, linthresh=1.0))
            axis.set_major_formatter(lambda value, _: f"{value:g}".replace("-", "\N{MINUS SIGN}"))
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    axes.set(xlabel=rf"Re $\lambda$ ({note})", ylabel=rf"Im $\lambda$ ({note})")


def _markers(axes: Axes, orbit: Orbit, shape: str) -> None:
    meaning, values = orbit_look(orbit), np.asarray(orbit.multipliers.values)
    stable = meaning == "stable"
    look = LOOKS[meaning].mark(4.8, filled=stable) | {"marker": shape, "mew": 0.9, "zorder": 3 if stable else 4}
    axes.plot(values.real, values.imag, **look, label=orbit_words(orbit), gid=orbit.name)
