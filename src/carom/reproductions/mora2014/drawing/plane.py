"""Figure 6: multipliers along the damping, and the plane of damping and stiffness."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, NullLocator

from carom.bifurcations.conditions import spectral_radii
from carom.plots.diagrams import CURVES, branch_line, curve_line, mark_point
from carom.plots.figure import TWO_COLUMNS, StyledFigure
from carom.plots.style import styled
from carom.plots.words import with_symbols
from carom.reproductions.mora2014.drawing.panels import DAMPING, INK, branch_key, letter, name_branch

if TYPE_CHECKING:
    from carom.bifurcations import Curve
    from carom.reproductions.mora2014.branches import FirstPair
    from carom.reproductions.mora2014.plane import DampingStiffnessPlane

MARKED = ("fold", "period-doubling", "grazing", "non-smooth-hopf")

ASIDE = {"R1.2": (0.13, 0.885), "R4.2": (0.135, 0.692)}
"""Positions of the names of regions that are too narrow for them."""


@styled
def figure_6(pair: FirstPair, plane: DampingStiffnessPlane) -> Figure:
    """Draw the largest multipliers of the first four orbits, and the curves and regions of the plane."""
    figure = StyledFigure(figsize=(TWO_COLUMNS, 0.74 * TWO_COLUMNS))
    grid = figure.add_gridspec(2, 2, width_ratios=(0.8, 1.0), height_ratios=(1.0, 0.17))
    left, right, below = (figure.add_subfigure(cell) for cell in (grid[0, 0], grid[0, 1], grid[1, :]))
    stability, map_axes = left.subplots(), right.subplots()
    _multipliers(stability, pair)
    _plane(map_axes, plane)
    left.legend(handles=branch_key(MARKED), loc="outside lower center", ncols=2)
    right.legend(handles=_curve_key(plane), loc="outside lower center", ncols=2)
    words = [Line2D([], [], ls="none", label=with_symbols(text)) for text in _region_words(plane)]
    below.legend(handles=words, loc="center", ncols=2, handlelength=0.0, handletextpad=0.0, fontsize=6.5)
    return figure


def _region_words(plane: DampingStiffnessPlane) -> list[str]:
    """Describe the motions of each region; the motions that all regions have are named once."""
    common = plane.everywhere
    words = [
        f"{region.part}: {', '.join(part for part in region.motions.parts if part not in common)}"
        for region in plane.regions
    ]
    return [*words, f"in all of them: {', '.join(common)}"] if common else words


def _multipliers(axes: Axes, pair: FirstPair) -> None:
    axes.axhline(1.0, color=INK, lw=0.5)
    for branch in (pair.slow, pair.fast):
        sizes = np.abs(branch.multipliers).max(axis=1)
        at_points = spectral_radii([(point.numbers, point.period, point.radial_speed) for point in branch.special])
        branch_line(axes, branch, np.arange(len(branch)), branch.values, sizes, np.array(at_points))
        for point, size in zip(branch.special, at_points, strict=True):
            if point.kind in MARKED:
                mark_point(axes, point.kind, point.value, size, point.admissible)
    axes.set(yscale="log", ylim=(0.72, 16.0))
    axes.yaxis.set_major_locator(FixedLocator([0.8, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0]))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.set(xlim=(0.02, 0.19), xlabel=DAMPING, ylabel="largest modulus of the multipliers")
    letter(axes, "a", "stability of the orbits")
    for name in (("B1,a", 0.06, 1.45), ("B1,b", 0.1, 4.6), ("B1,c", 0.12, 1.11), ("B1,d", 0.135, 0.81)):
        name_branch(axes, *name)


def _plane(axes: Axes, plane: DampingStiffnessPlane) -> None:
    for curve in plane.curves:
        if curve.kind == "boundary-equilibrium":
            _boundary(axes, curve, plane)
        else:
            curve_line(axes, curve, np.ones(2))
    for curve in plane.curves:
        for point in curve.codimension2:
            axes.plot(*point.value, ls="none", marker="o", ms=4.5, mfc=INK, mec=INK, zorder=6)
    for region in plane.regions:
        aside = ASIDE.get(region.part)
        line = {"arrowstyle": "-", "lw": 0.5, "color": INK, "shrinkA": 1.0, "shrinkB": 0.0}
        axes.annotate(
            region.part,
            region.point,
            xytext=aside or region.point,
            arrowprops=line if aside else None,
            ha="center",
            va="center",
            gid="region",
        )
    axes.set(xlim=plane.plane.first_range, ylim=plane.plane.second_range, xlabel=DAMPING, ylabel=r"stiffness $\omega$")
    letter(axes, "b", "plane of damping and stiffness")


def _boundary(axes: Axes, curve: Curve, plane: DampingStiffnessPlane) -> None:
    """Draw it broad where it is a non-smooth Hopf bifurcation: up to its meeting with the fold."""
    end = plane.meeting("fold", "boundary-equilibrium").value
    look = CURVES["boundary-equilibrium"]
    x, y = curve.points.T
    born = x <= end[0]
    axes.plot(np.append(x[born], end[0]), np.append(y[born], end[1]), color=look.colour, lw=2.4)
    axes.plot(np.append(end[0], x[~born]), np.append(end[1], y[~born]), color=look.colour, lw=look.width)


def _curve_key(plane: DampingStiffnessPlane) -> list[Line2D]:
    entries = []
    for curve in plane.curves:
        look = CURVES[curve.kind]
        if curve.kind == "boundary-equilibrium":
            entries.append(Line2D([], [], color=look.colour, lw=2.4, label="non-smooth Hopf bifurcation"))
        entries.append(look.entry())
    return [*entries, Line2D([], [], ls="none", marker="o", ms=4.5, color=INK, label="two at once")]
