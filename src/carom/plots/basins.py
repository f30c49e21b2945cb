"""Basins of attraction: which disturbances lead to which motion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle
from matplotlib.projections.polar import PolarAxes
from matplotlib.ticker import MaxNLocator

from carom.arguments import checked
from carom.disturbances import outward_from
from carom.outcome import InputError
from carom.plots.cells import CHORDS, MotionLook, finish, motion_looks, paint
from carom.plots.figure import StyledFigure
from carom.plots.plane import clearance_circle, label_frame, point
from carom.plots.rings import dial, ring
from carom.plots.style import LOOKS, TWO_COLUMNS, styled
from carom.plots.words import clearance, formula, number, told_in

if TYPE_CHECKING:
    from carom.basins import Basin, SmallestLoss
    from carom.disturbances import Coordinate
    from carom.parameters import Scales


@checked
@styled
def basin(basin: Basin, smallest: SmallestLoss | None = None, title: str | None = None) -> Figure:
    """Draw where disturbances end, as a picture that depends on their coordinates.

    By size and direction: a polar picture, and beside it the shares at each size.  By two other coordinates, such as the
    components of a kick: a plane.  Releases from the wall and losses of a blade: a ring.  Samples: a bar for each motion with
    its confidence interval.  The figure is 180 mm wide, 88 mm for a ring.  `smallest` is the smallest kick or shock found that is lost;
    it is marked in a picture of kicks or shocks.
    """
    motions = motion_looks(basin)
    kind, grid = basin.plan.model.kind, basin.dataset["outcome"].dims != ("start",)
    if not grid:
        return _bars(basin, motions, title)
    if kind == "release":
        return ring(basin, motions, title)
    if len(basin.coordinates) == 1 and basin.coordinates[0].periodic:
        return dial(basin, motions, title)
    if len(basin.coordinates) != 2:
        raise InputError("basin", f"a grid of {kind}", "a grid over two coordinates, of releases, or a sample")
    size, direction = basin.coordinates
    if size.low == 0.0 and direction.periodic:
        return _polar(basin, motions, smallest, title)
    return _plane(basin, motions, smallest, title)


def _polar(basin: Basin, motions: list[MotionLook], smallest: SmallestLoss | None, title: str | None) -> Figure:
    size, direction = basin.coordinates
    factor, label = _axis(size, basin.scales)
    dataset = basin.dataset
    cells = dataset["outcome"].shape
    figure = StyledFigure(figsize=(TWO_COLUMNS, 0.62 * TWO_COLUMNS))
    grid = figure.add_gridspec(1, 2, width_ratios=(1.25, 1.0))
    round_, beside = figure.add_subplot(grid[0], projection="polar"), figure.add_subplot(grid[1])
    parts = -(-CHORDS // cells[1])  # cells have straight edges: divide wide ones so that rings look round
    index = np.repeat(dataset["motion"].values.T, parts, axis=0)
    paint(round_, direction.edges(parts * cells[1]), factor * size.edges(cells[0]), index, motions)
    round_.set_title("(a)", loc="left", y=1.0)
    _rule(round_, factor * size.high)
    round_.set_xlabel(f"radius: {label}\nangle: {direction.words}, co-rotating frame")
    handles: list[Artist] = []
    # The size of a step of the unbalance is a change of the eccentricity: no radius of this picture.
    if smallest is not None and basin.plan.model.kind == smallest.kind:
        handles = _mark_smallest(round_, smallest, factor)
    _stacked(beside, basin, motions)
    beside.set_title("(b)", loc="left", y=1.0)
    return finish(figure, motions, title, handles, columns=3)


def _rule(axes: Axes, high: float) -> None:
    """Draw rings and rays of a polar picture, white on top of the colours."""
    axes.set_ylim(0.0, high)
    axes.grid(visible=True, color="#ffffff", lw=0.3, alpha=0.7)
    axes.set_axisbelow(False)
    axes.set_xticks(np.deg2rad(np.arange(0, 360, 45)))
    axes.tick_params(axis="x", pad=1)
    if isinstance(axes, PolarAxes):
        axes.set_rlabel_position(22.5)
    # A label on the outermost ring would overlap the frame.
    axes.yaxis.set_major_locator(MaxNLocator(4, prune="both"))
    for tick in axes.yaxis.get_ticklabels():
        tick.set_bbox({"boxstyle": "round,pad=0.1", "facecolor": "white", "edgecolor": "none", "alpha": 0.8})


def _stacked(axes: Axes, basin: Basin, motions: Sequence[MotionLook]) -> None:
    """Draw the share of each motion at each size, stacked."""
    size = basin.coordinates[0]
    factor, label = _axis(size, basin.scales)
    index = basin.dataset["motion"].values
    edges = factor * size.edges(index.shape[0])
    starts = np.maximum((index >= 0).sum(axis=1), 1)
    below = np.zeros(index.shape[0])
    for entry in motions:
        share = 100.0 * (index == entry.index).sum(axis=1) / starts
        axes.stairs(below + share, edges, baseline=below, fill=True, **entry.filled, lw=0.0)
        below = below + share
    axes.set(xlim=(edges[0], edges[-1]), ylim=(0.0, 100.0), xlabel=label, ylabel="share of the directions (%)")


def _mark_smallest(axes: Axes, smallest: SmallestLoss, factor: float) -> list[Artist]:
    """Mark the smallest kick or shock found that is lost and the circle of those that cannot reach the wall."""
    ring = np.linspace(0.0, 2.0 * np.pi, 361)
    look: dict[str, Any] = {"ls": (0.0, (4.0, 2.0)), "lw": 0.7, "color": LOOKS["wall"].colour}
    words = "below: proven never to touch"
    handles: list[Artist] = [*axes.plot(ring, np.full(ring.shape, factor * smallest.harmless), **look, label=words)]
    if smallest.size is not None:
        handles += _mark_lost(axes, smallest, smallest.angle or 0.0, factor * smallest.size)
    return handles


def _mark_lost(axes: Axes, smallest: SmallestLoss, x: float, y: float) -> list[Line2D]:
    """Mark the smallest disturbance found that is lost; return its legend entry."""
    look: dict[str, Any] = {"marker": "o", "ms": 4.0, "mfc": "white", "mec": "#1a1a1a"}
    return axes.plot([x], [y], ls="none", gid="smallest", label=f"smallest {smallest.kind} found that is lost", **look)


def _plane(basin: Basin, motions: list[MotionLook], smallest: SmallestLoss | None, title: str | None) -> Figure:
    x, y = basin.coordinates
    dataset, kind = basin.dataset, basin.plan.model.kind
    cells = dataset["outcome"].shape
    figure = StyledFigure(figsize=(0.62 * TWO_COLUMNS, 0.69 * TWO_COLUMNS))
    axes = figure.subplots()
    handles: list[Artist] = []
    if kind == "slice":
        wall = clearance(basin.scales)
        paint(axes, wall * x.edges(cells[0]), wall * y.edges(cells[1]), dataset["motion"].values, motions)
        clearance_circle(axes, reach=1.05, wall=wall)
        for cells_drawn in axes.collections:  # those cut by the wall
            cells_drawn.set_clip_path(Circle((0.0, 0.0), wall, transform=axes.transData))
        label_frame(axes, "rotating", basin.scales)
        point(axes, wall * complex(basin.rotor.system.arrays.offsets[0]), "contact-free", label="", colour="#ffffff")
        velocity = complex(getattr(basin.plan.model, "velocity", 0.0))
        factor, unit = told_in("velocity", basin.scales)
        said = "at rest" if velocity == 0 else f"at {factor * velocity:.3g} {unit}"
        axes.set_title(f"starts {said} in the fixed frame")
        rest = LOOKS["contact-free"]
        handles = [Line2D([], [], ls="none", marker=rest.marker, ms=5, mfc="white", mec="#1a1a1a", label=rest.words)]
    else:
        factor, label = _axis(x, basin.scales)
        across, label_across = _axis(y, basin.scales)
        paint(axes, factor * x.edges(cells[0]), across * y.edges(cells[1]), dataset["motion"].values, motions)
        axes.set(xlabel=label, ylabel=label_across)
        if kind == "kick-plane":
            axes.set_aspect("equal")
            axes.plot([0.0], [0.0], "+", ms=6.0, mew=0.7, color="white")
        if smallest is not None and smallest.size is not None:
            turned = smallest.size * np.exp(1j * (smallest.angle or 0.0)) * np.conj(outward_from(basin.rotor))
            handles = [*_mark_lost(axes, smallest, factor * turned.real, factor * turned.imag)]
    return finish(figure, motions, title, handles, columns=2)


def _bars(basin: Basin, motions: list[MotionLook], title: str | None) -> Figure:
    """Draw the shares of a sample with their confidence intervals."""
    figure = StyledFigure(figsize=(0.75 * TWO_COLUMNS, (0.16 + 0.075 * len(motions)) * TWO_COLUMNS))
    axes = figure.subplots()
    for row, entry in enumerate(reversed(motions)):
        share = basin.share_of(basin.motions[entry.index])
        axes.barh(row, 100.0 * share.fraction, 0.62, **entry.filled, lw=0.3)
        axes.plot([100.0 * share.low, 100.0 * share.high], [row, row], "|-", color="#1a1a1a", lw=0.8, ms=5.0)
        said = f"{number(100.0 * share.fraction, 3)} %"
        axes.annotate(
            said, (100.0 * share.high, row), xytext=(4.0, 0.0), textcoords="offset points", va="center", fontsize=7
        )
    axes.set_yticks(range(len(motions)), [entry.words for entry in reversed(motions)])
    axes.tick_params(axis="y", length=0)
    axes.set_xlim(0.0, 112.0)
    axes.set_xticks(range(0, 101, 20))
    axes.set_xlabel(f"share of {basin.starts} {basin.share_recovered.population.words} (%), with 95 % confidence")
    if title:
        figure.suptitle(title)
    return figure


def _axis(coordinate: Coordinate, scales: Scales | None) -> tuple[float, str]:
    """Return the factor from dimensionless values to those shown, and the label with its unit."""
    factor, unit = coordinate.shown_in(scales)
    return factor, f"{coordinate.words} ({formula(unit)})"
