"""Figure 3: the period condition, its zeros along the damping, and the birth of the small orbits."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import NullLocator

from carom.plots.diagrams import POINTS, mark_point
from carom.plots.figure import TWO_COLUMNS, StyledFigure
from carom.plots.style import LOOKS, styled
from carom.plots.words import orbit_look, orbit_symbol, times_larger
from carom.reproductions.mora2014.drawing.panels import DAMPING, INK, letter
from carom.reproductions.mora2014.periods import LONGEST_DRAWN

if TYPE_CHECKING:
    from carom.orbits.orbit import Orbit
    from carom.reproductions.mora2014.periods import Birth, PeriodFunction, PeriodPair
    from carom.reproductions.mora2014.reproduction import Periods

SLATE = "#3d4f66"
MILLI = 1e-3
_LINES = ("-", "--")
_SIDES = {"below": r"$\gamma$ < $\gamma$*", "at": r"$\gamma$ = $\gamma$*", "above": r"$\gamma$ > $\gamma$*"}


@styled
def figure_3(periods: Periods, birth: float) -> Figure:
    """Draw the period condition, its zeros along the damping, and the birth of the small orbits.

    Parameters
    ----------
    birth : float
        Damping of the non-smooth Hopf bifurcation.
    """
    figure = StyledFigure(figsize=(TWO_COLUMNS, 0.86 * TWO_COLUMNS))
    axes = figure.subplot_mosaic("aaabbb;ccddee", height_ratios=(1.25, 1.0))
    _condition(axes["a"], periods.functions)
    _zeros(axes["b"], periods.pairs, birth)
    for place, stage in zip("cde", periods.births, strict=True):
        _birth(axes[place], stage)
    letter(axes["a"], "a", r"period condition $F_1$ and its zeros")
    letter(axes["b"], "b", r"zeros of $F_1$ along the damping")
    letter(axes["c"], "c", _SIDES["below"] + ": all virtual")
    axes["d"].set_title(_SIDES["at"] + ": on the wall")
    axes["e"].set_title(_SIDES["above"] + ": all admissible")
    figure.legend(handles=_key(periods), loc="outside lower center", ncols=4)
    return figure


def _condition(axes: Axes, functions: tuple[PeriodFunction, ...]) -> None:
    for line, function in zip(_LINES, functions, strict=True):
        axes.plot(function.periods, function.values, line, color=INK if line == "-" else SLATE, lw=0.9)
        roots = function.roots[function.roots < LONGEST_DRAWN]
        face = INK if line == "-" else "white"
        axes.plot(roots, np.zeros_like(roots), ls="none", marker="o", ms=3.5, mfc=face, mec=INK, mew=0.7, zorder=4)
    axes.axhline(0.0, color=INK, lw=0.5)
    axes.set_yscale("asinh", linear_width=0.2)
    axes.set_yticks([0.0, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0])
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.yaxis.set_minor_locator(NullLocator())
    axes.set_xlim(0.0, LONGEST_DRAWN)
    axes.set(ylim=(-0.25, 60.0), xlabel=r"period $T$ ($1/\Omega$)", ylabel=r"period condition $F_1$, linear near 0")


def _zeros(axes: Axes, pairs: tuple[PeriodPair, ...], birth: float) -> None:
    for pair in pairs:
        for longer, line in ((True, "-"), (False, "--")):
            # Both halves extend to the fold.
            shown = np.where((pair.longer == longer) | (pair.periods == pair.fold[1]), pair.periods, np.nan)
            axes.plot(pair.gammas, shown, line, color=INK, lw=0.9)
        mark_point(axes, "fold", *pair.fold)
    first = pairs[0]
    axes.axvline(birth, color=POINTS["non-smooth-hopf"].colour, lw=0.6, ls=":")
    for longer in (True, False):
        half = first.longer == longer
        order = np.argsort(first.gammas[half])
        period = float(np.interp(birth, first.gammas[half][order], first.periods[half][order]))
        mark_point(axes, "non-smooth-hopf", birth, period)
    axes.set_xlim(0.0, 0.2)
    axes.set(
        xticks=[0.0, 0.05, 0.1, 0.15, 0.2], ylim=(0.0, LONGEST_DRAWN), xlabel=DAMPING, ylabel=r"period $T$ ($1/\Omega$)"
    )


def _birth(axes: Axes, stage: Birth) -> None:
    """Draw radius over angle near the equilibrium, with the smaller orbit enlarged on the free side of the wall."""
    axes.axhline(1.0, **LOOKS["wall"].stroke)
    place = stage.rotor.equilibrium
    look = LOOKS["contact-free"]
    face = "white" if stage.side == "below" else look.colour
    axes.plot([0.0], [abs(place)], ls="none", marker=look.marker, ms=5.5, mfc=face, mec=look.colour, mew=0.8, zorder=5)
    for orbit in stage.orbits:
        _loop(axes, orbit, place)
    axes.set_xlim(-MILLI * 3.0, MILLI * 4.5)
    axes.set_ylim(1.0 - 6.0 * MILLI, 1.0 + 6.0 * MILLI)
    axes.set(xticks=MILLI * np.arange(-2.0, 5.0, 2.0), xlabel=r"angle from the equilibrium, $\theta - \theta^*$ (rad)")
    if stage.side == "below":
        axes.set_ylabel(r"radius $r$ ($c_\mathrm{r}$)")
    else:
        axes.set_yticklabels([])
    if stage.orbits:
        small, large = stage.orbits
        _enlarge(axes, small, place, stage.side)
        angle, radius = _polar(large, place)
        farthest = float(radius[np.argmax(np.abs(radius - 1.0))])
        aside = (float(angle.max()) + 0.5 * MILLI, 0.5 * (farthest + 1.0))
        axes.annotate(orbit_symbol(large.name), aside, ha="left", va="center")


def _enlarge(axes: Axes, orbit: Orbit, place: complex, side: str) -> None:
    low = 0.13 if side == "below" else 0.58
    inner = axes.inset_axes((0.5, low, 0.44, 0.34))
    inner.axhline(1.0, **LOOKS["wall"].stroke)
    _loop(inner, orbit, place)
    inner.margins(0.25)
    inner.set(xticks=(), yticks=())
    width = float(np.ptp(inner.get_xlim()))
    ratio = 0.44 * float(np.ptp(axes.get_xlim())) / width
    words = f"{orbit_symbol(orbit.name)}, {times_larger(ratio)} times"
    # Away from the lines that lead to the wall.
    if side == "below":
        inner.set_xlabel(words, fontsize=7, labelpad=2)
    else:
        inner.set_title(words, fontsize=7, pad=2)
    axes.indicate_inset_zoom(inner, edgecolor="#808080", lw=0.4, alpha=1.0)


def _loop(axes: Axes, orbit: Orbit, place: complex) -> None:
    angle, radius = _polar(orbit, place)
    look = LOOKS[orbit_look(orbit)]
    axes.plot(angle, radius, **look.stroke)
    axes.plot(angle[:1], radius[:1], ls="none", marker="o", ms=2.5, color=look.colour)


def _polar(orbit: Orbit, place: complex) -> tuple[np.ndarray, np.ndarray]:
    """Return angle, relative to that of a place, and radius over one period of the orbit."""
    line = orbit.path(np.linspace(0.0, orbit.period, 400, endpoint=False))
    line = np.append(line, line[0])
    return np.angle(line / place), np.abs(line)


def _key(periods: Periods) -> list[Line2D]:
    first, second = (function.gamma for function in periods.functions)
    dot: dict[str, Any] = {"lw": 0.9, "marker": "o", "ms": 3.5}
    return [
        Line2D([], [], color=INK, ls="-", **dot, label=rf"$F_1$ and zeros, $\gamma$ = {first:g}"),
        Line2D([], [], color=SLATE, ls="--", **dot, mfc="white", mec=INK, label=rf"$\gamma$ = {second:g}"),
        Line2D([], [], color=INK, ls="-", lw=0.9, label="longer period of a pair"),
        Line2D([], [], color=INK, ls="--", lw=0.9, label="shorter period of a pair"),
        POINTS["fold"].entry(),
        POINTS["non-smooth-hopf"].entry(),
        LOOKS["unstable"].entry("orbit, admissible, unstable"),
        LOOKS["virtual"].entry("orbit, virtual"),
        LOOKS["contact-free"].entry(f"{LOOKS['contact-free'].words} (hollow: virtual)"),
    ]
