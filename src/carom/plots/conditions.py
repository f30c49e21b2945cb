"""The period condition F1(T) = 0, whose roots are all single-impact orbits."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator
from matplotlib.transforms import blended_transform_factory

from carom.base.arguments import Reals, checked
from carom.base.outcome import InputError
from carom.plots.figure import narrow
from carom.plots.placement import spread
from carom.plots.plane import Floats, finish, one_axes
from carom.plots.style import LOOKS, ONE_COLUMN, TWO_COLUMNS, styled
from carom.plots.words import axis_label, orbit_symbol, time_in_words, told_in

if TYPE_CHECKING:
    from carom.orbits.orbit import Orbit
    from carom.orbits.single_impact import OrbitSet

_INK = LOOKS["path"].colour
_SAME_PERIOD = 1e-6
"""Relative difference below which an orbit belongs to a root: far above rounding, far below the spacing of roots."""
_MOST_NAMES = 10
"""Largest number of names above the frame; only roots with an admissible orbit are named."""
_NAME = 0.48
"""Room for a name above the frame [inch]."""
_LINEAR = 0.05
"""Value of F1 at which the scale changes from linear to logarithmic."""


@checked
@styled
def period_condition(orbits: OrbitSet, periods: Reals, values: Reals, *, axes: Axes | None = None) -> Figure:
    """Draw F1 over the period, its roots with the names of their orbits, and the bound that makes the list complete.

    Parameters
    ----------
    orbits : carom.orbits.OrbitSet
        All single-impact orbits of a rotor, with the roots and the bound.
    periods : array_like, shape (n,)
        Periods at which F1 is drawn [1/Omega], ascending.
    values : array_like, shape (n,)
        F1 at those periods (no unit).
    """
    if np.ndim(periods) != 1 or np.shape(periods) != np.shape(values):
        raise InputError("values", np.shape(values), f"one for each period, which have shape {np.shape(periods)}")
    figure, drawn = one_axes(axes, (ONE_COLUMN, ONE_COLUMN) if narrow() else (TWO_COLUMNS, 0.42 * TWO_COLUMNS))
    scales = orbits.rotor.scales
    factor = told_in("time", scales)[0]
    times, condition = factor * np.asarray(periods, dtype=float), np.asarray(values, dtype=float)
    words = r"period condition $F_1(T)$, zero for an orbit with one impact a period"
    drawn.plot(times, condition, color=_INK, lw=0.9, label=words, gid="condition")
    drawn.axhline(0.0, color="#1a1a1a", lw=0.5, gid="zero")
    bound, right = factor * orbits.longest_period, float(times[-1])
    # A distant bound is only named in the legend.
    drawn.set_xlim(0.0, 1.06 * (bound if right < bound < 1.3 * right else right))
    claim = "no root" if orbits.complete else "not searched"
    words = rf"{claim} beyond $T_\mathrm{{max}}$ = {time_in_words(orbits.longest_period, scales)}"
    drawn.axvspan(bound, max(bound, drawn.get_xlim()[1]), color="#ebebeb", lw=0, zorder=0, label=words, gid="bound")
    _roots(drawn, orbits)
    drawn.set(xlabel=axis_label("period $T$", "time", scales), ylabel=r"period condition $F_1$ (no unit)")
    low, high = min(0.0, float(condition.min())), max(0.0, float(condition.max()))
    if high > 10.0 * max(
        -low, _LINEAR
    ):  # F1 dips a little below zero, where the roots are, and peaks high above it at the resonances
        drawn.set_yscale("asinh", linear_width=_LINEAR)
        drawn.yaxis.set_major_formatter(lambda value, _: f"{value:g}".replace("-", "\N{MINUS SIGN}"))
        powers, limits = 10.0 ** np.arange(-1.0, 1.0 + np.ceil(np.log10(high))), drawn.get_ylim()
        drawn.set_yticks([*-powers, 0.0, *powers])
        drawn.set_ylim(limits)
        drawn.yaxis.set_minor_locator(NullLocator())
        drawn.set_ylabel(f"{drawn.get_ylabel()},\nscale linear near 0, logarithmic beyond")
    return finish(figure, drawn, axes)


def _roots(axes: Axes, orbits: OrbitSet) -> None:
    """Mark the roots on the zero line; the names of their orbits stand above the frame."""
    factor = told_in("time", orbits.rotor.scales)[0]
    roots = np.asarray(orbits.periods, dtype=float)
    if not len(roots):
        axes.plot([], [], linestyle="none", label="no root: no orbit with one impact a period")
        return
    members = [[orbit for orbit in orbits if abs(orbit.period - root) <= _SAME_PERIOD * root] for root in roots]
    physical = np.array([any(orbit.admissible for orbit in found) for found in members])
    empty = np.array([not found for found in members])
    grey = LOOKS["virtual"].colour
    for chosen, face, edge, size, words in (
        (physical, _INK, "#1a1a1a", 4.5, "root with an admissible orbit"),
        (~physical & ~empty, "white", grey, 3.5, "root with virtual orbits only"),
        (empty, grey, grey, 3.0, "root without an orbit"),
    ):
        if chosen.any():
            look: dict[str, Any] = {"mfc": face, "mec": edge, "mew": 0.6, "ms": size}
            places = factor * roots[chosen]
            axes.plot(places, np.zeros_like(places), "o", **look, zorder=4, label=words, gid="root")
    possible = [[orbit for orbit in found if orbit.admissible] for found in members]
    labels = [
        f"{_name(found)}\n$T$ = {factor * root:#.4g}" for found, root in zip(possible, roots, strict=True) if found
    ]
    _name_roots(axes, factor * roots[physical][:_MOST_NAMES], labels[:_MOST_NAMES])


def _name_roots(axes: Axes, roots: Floats, labels: list[str]) -> None:
    left, right = axes.get_xlim()
    gap = _NAME * axes.figure.dpi / axes.bbox.width * (right - left)
    places = spread(roots, gap, left + gap / 2.0, right - gap / 2.0)
    across = blended_transform_factory(axes.transData, axes.transAxes)
    for root, place, label in zip(roots, places, labels, strict=True):
        axes.annotate(
            label,
            xy=(root, 0.0),
            xycoords="data",
            xytext=(place, 1.03),
            textcoords=across,
            ha="center",
            va="bottom",
            fontsize=7,
            arrowprops={"arrowstyle": "-", "lw": 0.35, "color": "#808080", "shrinkA": 0, "shrinkB": 3},
            annotation_clip=False,
        )


def _name(found: list[Orbit]) -> str:
    """Return one name for the orbits of a root, ``B1,a/c``."""
    from carom.orbits.names import combined

    return orbit_symbol(combined(orbit.name for orbit in found))
