"""Pictures of disturbances that vary by one angle: releases from the wall, and losses of a blade."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from carom.plots.cells import CHORDS, MotionLook, finish, paint
from carom.plots.figure import StyledFigure
from carom.plots.plane import Floats, clearance_circle, label_frame, point
from carom.plots.style import LOOKS, ONE_COLUMN
from carom.plots.words import clearance, number, told_in

if TYPE_CHECKING:
    from carom.basins import Basin
    from carom.disturbances import Coordinate

_RING = (0.82, 0.98)
"""Inner and outer radius of the ring that shows releases from the wall."""


def ring(basin: Basin, motions: list[MotionLook], title: str | None) -> Figure:
    """Draw the places on the wall, coloured by the motion to which a release there leads."""
    figure, axes = _painted_ring(basin, motions, clearance(basin.scales))
    wall = clearance(basin.scales)
    clearance_circle(axes, reach=1.05, wall=wall)
    label_frame(axes, "rotating", basin.scales)
    point(axes, wall * complex(basin.rotor.system.arrays.offsets[0]), "contact-free", label="")
    motion = {"fixed": "at rest in the fixed frame", "rotating": "at rest in the co-rotating frame"}
    said = motion.get(str(basin.plan.model.describe()["motion"]), "rolling without slip")
    axes.set_title(f"released from the wall, {said}")
    look = LOOKS["contact-free"]
    rest = Line2D([], [], ls="none", marker=look.marker, ms=5.0, mfc=look.colour, mec="#1a1a1a", label=look.words)
    return finish(figure, motions, title, [rest], columns=1)


def dial(basin: Basin, motions: list[MotionLook], title: str | None) -> Figure:
    """Draw an angle all around, coloured by the motion to which each leads."""
    figure, axes = _painted_ring(basin, motions)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set(xlim=(-1.3, 1.3), ylim=(-1.2, 1.2))
    axes.annotate("", (0.75, 0.0), (0.0, 0.0), arrowprops={"arrowstyle": "-|>", "color": "#1a1a1a"})
    for turned in (0, 90, 180, 270):
        place = np.radians(turned)
        axes.text(1.12 * np.cos(place), 1.12 * np.sin(place), f"{turned}°", ha="center", va="center")
    coordinate = basin.coordinates[0]
    if basin.plan.model.kind == "blade-loss":
        axes.text(0.36, 0.05, "unbalance before", ha="center", va="bottom", fontsize=7)
        axes.set_title(f"phase of the change of unbalance,\n{_change_of_unbalance(basin)}")
    else:
        axes.set_title(coordinate.words)
    return finish(figure, motions, title, [], columns=1)


def _change_of_unbalance(basin: Basin) -> str:
    """How much the loss of a blade changes the unbalance."""
    factor, unit = told_in("unbalance" if basin.scales else "length", basin.scales)
    return f"{number(factor * float(str(basin.plan.model.describe()['change'])), 5)} {unit}"


def _painted_ring(basin: Basin, motions: list[MotionLook], wall: float = 1.0) -> tuple[Figure, Axes]:
    """A new figure with a ring of cells within the radius `wall`."""
    figure = StyledFigure(figsize=(ONE_COLUMN, 1.13 * ONE_COLUMN))
    axes = figure.subplots()
    paint_ring(axes, basin.coordinates[0], basin.dataset["motion"].values, motions, wall)
    return figure, axes


def paint_ring(axes: Axes, angle: Coordinate, index: np.ndarray, motions: list[MotionLook], wall: float = 1.0) -> None:
    """Paint cells along an angle as a ring within the radius `wall`, in the colours of the motions."""
    parts = -(-CHORDS // len(index))
    edges = angle.edges(parts * len(index))
    paint(axes, edges, wall * np.array(_RING), np.repeat(index, parts)[:, None], motions, around)


def around(angle: Floats, radius: Floats) -> tuple[Floats, Floats]:
    """Places in the plane at angles and distances."""
    return radius * np.cos(angle), radius * np.sin(angle)
