"""Figures 4 and 5: speeds at the impact and extrema of the radius along the damping."""

from __future__ import annotations

from operator import attrgetter
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from carom.plots.diagrams import branch_line, mark_point
from carom.plots.figure import TWO_COLUMNS, StyledFigure
from carom.plots.style import LOOKS, Look, styled
from carom.reproductions.mora2014.drawing.panels import DAMPING, INK, branch_key, letter, name_branch

if TYPE_CHECKING:
    from carom.bifurcations import OrbitBranch
    from carom.reproductions.mora2014.branches import FirstPair
    from carom.reproductions.mora2014.extrema import ExtremumLine, RadiusDiagram

MARKED = ("fold", "speed-fold", "period-doubling", "neimark-sacker", "grazing", "non-smooth-hopf")
LOCAL = Look(INK, "local theory", line=(0.0, (1.0, 1.4)), width=1.3)


@styled
def figure_4(pair: FirstPair) -> Figure:
    """Draw radial and angular speed of the first four orbits, and the local theory near their birth."""
    figure = StyledFigure(figsize=(TWO_COLUMNS, 0.8 * TWO_COLUMNS))
    grid = figure.subplots(2, 2)
    speeds = (("radial_speed", "radial_speed"), ("angular_speed", "orbit.angular_speed"))
    for (axes, birth), (speed, at) in zip(grid, (map(attrgetter, names) for names in speeds), strict=True):
        for drawn in (axes, birth):
            drawn.axhline(0.0, color=INK, lw=0.5)
            for branch in pair.branches:
                heights = np.array([at(point) for point in branch.special])
                branch_line(drawn, branch, np.arange(len(branch)), branch.values, speed(branch), heights)
                for point in branch.special:
                    if point.kind in MARKED:
                        mark_point(drawn, point.kind, point.value, at(point), point.admissible)
        axes.set_xlim(-0.53, 0.2)
        axes.axvspan(-0.53, 0.0, color="#f3f3f3", lw=0.0, zorder=-2)
        axes.text(0.02, 0.96, "negative damping", transform=axes.transAxes, va="top", color="#666666")
        birth.set_xlim(0.045, 0.115)
    gammas = np.array([0.045, 0.115])
    for cycle in pair.hopf.cycles:
        for row, slope in enumerate((cycle.radial_slope, cycle.angular_slope)):
            grid[row, 1].plot(gammas, slope * (gammas - pair.hopf.gamma), **LOCAL.stroke, zorder=3)
    _name_figure_4(grid)
    for axes, panel, words in zip(
        grid.ravel(),
        "abcd",
        ("radial speed", "near the birth of the small orbits", "angular speed", "near the birth of the small orbits"),
        strict=True,
    ):
        letter(axes, panel, words)
        axes.set_xlabel(DAMPING)
        axes.set_ylabel(
            r"$\dot{r}$ before the impact ($c_\mathrm{r}\Omega$)"
            if panel in "ab"
            else r"$\dot{\theta}$ before the impact ($\Omega$)"
        )
    entries = branch_key(MARKED)
    entries.insert(3, LOCAL.entry())
    figure.legend(handles=entries, loc="outside lower center", ncols=4)
    return figure


def _name_figure_4(grid: np.ndarray) -> None:
    limits = (-0.06, 0.85), (-0.0042, 0.0068), (-3.6, 0.55), (-0.0155, 0.0115)
    places = (
        (("B1,a", -0.22, 0.045), ("B1,b", 0.125, 0.055), ("B1,c", -0.22, 0.17), ("B1,d", 0.115, 0.8)),
        (("B1,a", 0.106, 0.0012), ("B1,b", 0.0975, 0.0054)),
        (("B1,a", -0.18, 0.2), ("B1,c", -0.4, -0.2), ("B1,b", 0.125, 0.2), ("B1,d", 0.15, -1.25)),
        (("B1,a", 0.108, 0.0014), ("B1,b", 0.1, -0.0072), ("B1,c", 0.054, -0.0129)),
    )
    for axes, ends, names in zip(grid.ravel(), limits, places, strict=True):
        axes.set_ylim(ends)
        for name in names:
            name_branch(axes, *name)


@styled
def figure_5(pair: FirstPair, radii: RadiusDiagram) -> Figure:
    """Draw the local extrema of the radius between impacts."""
    figure = StyledFigure(figsize=(TWO_COLUMNS, 0.46 * TWO_COLUMNS))
    left, right = figure.subplots(1, 2)
    for axes, branch, lines in ((left, pair.slow, radii.slow), (right, pair.fast, radii.fast)):
        axes.axhline(1.0, **LOOKS["wall"].stroke)
        for line in lines:
            branch_line(axes, branch, line.places, line.gammas, line.radii)
        _mark_extrema(axes, branch, lines)
        axes.set_xlabel(DAMPING)
        axes.set_ylabel(r"local extrema of the radius $r$ ($c_\mathrm{r}$)")
        axes.set(xlim=(0.02, 0.2), xticks=[0.05, 0.1, 0.15, 0.2])
    _levitation(left, radii)
    left.set_ylim(0.962, 1.018)
    right.set_ylim(0.0, 1.15)
    letter(left, "a", "small orbits and levitation")
    letter(right, "b", "large orbits")
    for axes, names in (
        (left, (("B1,a", 0.14, 0.9945), ("B1,b", 0.14, 0.986))),
        (right, (("B1,c", 0.11, 0.87), ("B1,d", 0.13, 0.3))),
    ):
        for name in names:
            name_branch(axes, *name)
    kinds = ("fold", "non-smooth-hopf", "radius-extremum", "grazing", "period-doubling")
    entries = branch_key(kinds)
    entries.insert(3, Line2D([], [], color=LOOKS["contact-free"].colour, lw=1.1, label=LOOKS["contact-free"].words))
    figure.legend(handles=entries, loc="outside lower center", ncols=5)
    return figure


def _mark_extrema(axes: Axes, branch: OrbitBranch, lines: tuple[ExtremumLine, ...]) -> None:
    """Mark each special point on the extremum that it concerns; folds and period doublings on all lines."""
    for point in branch.special:
        if point.kind in ("non-smooth-hopf", "grazing"):
            mark_point(axes, point.kind, point.value, 1.0)
            continue
        for line in lines:
            if line.places[0] <= point.place <= line.places[-1]:
                height = float(np.interp(point.place, line.places, line.radii))
                ends = point.place in (line.places[0], line.places[-1])
                if point.kind != "radius-extremum" or (ends and _shared(lines, line, point.place, height)):
                    mark_point(axes, point.kind, point.value, height, point.admissible)


def _shared(lines: tuple[ExtremumLine, ...], line: ExtremumLine, place: float, height: float) -> bool:
    """Whether another line of the same segment ends at the same point, so that two extrema meet there."""
    others = (other for other in lines if other is not line and other.places[0] == line.places[0])
    return any(abs(float(np.interp(place, other.places, other.radii)) - height) < 1e-12 for other in others)


def _levitation(axes: Axes, radii: RadiusDiagram) -> None:
    """Draw the contact-free equilibrium, faint where it is virtual."""
    colour = LOOKS["contact-free"].colour
    for allowed, alpha in ((radii.levitation <= 1.0, 1.0), (radii.levitation >= 1.0, 0.35)):
        axes.plot(radii.gammas, np.where(allowed, radii.levitation, np.nan), color=colour, lw=1.1, alpha=alpha)
