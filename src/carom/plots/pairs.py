"""Basins side by side, of one machine before and after a change: with one range, one legend and the same colours."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from carom.arguments import checked
from carom.outcome import InputError
from carom.plots.cells import CHORDS, MotionLook, looks_of, paint
from carom.plots.figure import StyledFigure
from carom.plots.rings import around, paint_ring
from carom.plots.style import LOOKS, ONE_COLUMN, styled
from carom.plots.words import formula, number

if TYPE_CHECKING:
    from carom.attractors import MotionName
    from carom.basins import Basin, Cells

_LINE = 22
"""Letters of a line of words in place of a picture."""
_REACH = 1.04
"""Half-width of the axes, relative to the largest disturbance."""


@checked
@styled
def basin_pair(panels: Sequence[tuple[str, Basin | Cells | str]], required: float | None = None) -> Figure:
    """Draw basins of the same disturbances beside each other, such as those before and after a change of the machine.

    They share axes, legend and colours.  The figure is 88 mm wide.

    Parameters
    ----------
    panels : sequence of (str, Basin, Cells or str)
        Title and basin from left to right: of kicks by components, of shocks by peak and direction or of losses of a blade by
        phase. A text instead of a basin is written in its place.
    required : float, optional
        Size of kicks or shocks, in units of the equations, at which a circle is drawn: what must be survived.

    Raises
    ------
    InputError
        None of the panels has a basin, or these are no grids of such disturbances, all of one kind.
    """
    # A basin has cells; cells and words are what they are.
    given: Sequence[tuple[str, Any]] = panels
    shown: list[tuple[str, Cells | str]] = [(title, getattr(entry, "cells", entry)) for title, entry in given]
    basins = [entry for _, entry in shown if not isinstance(entry, str)]
    kinds = sorted({basin.plan.model.kind for basin in basins})
    if len(kinds) != 1:
        raise InputError("panels", " and ".join(kinds) or None, "basins of one kind of disturbance, at least one")
    if any(basin.index.ndim != len(basin.plan.model.coordinates) for basin in basins) or not _by_place(basins[0]):
        raise InputError("panels", f"a plan of {kinds[0]}", "grids of kicks, shocks or losses of a blade")
    motions = _motions(basins)
    figure = StyledFigure(figsize=(ONE_COLUMN, (0.7 + 0.045 * len(motions)) * ONE_COLUMN))
    drawn = figure.subplots(1, len(panels), sharex=True, sharey=True, squeeze=False)[0]
    for axes, (title, entry) in zip(drawn, shown, strict=True):
        axes.set_title(title)
        if isinstance(entry, str):
            _write(axes, entry)
        else:
            _paint(axes, entry, motions)
            axes.label_outer()
    reach = _REACH * max(_largest(basin) for basin in basins)
    drawn[0].set(xlim=(-reach, reach), ylim=(-reach, reach))  # and so the others
    handles: list[Artist] = [look.named(_words(look, motions)) for look in motions]
    if required is not None:
        handles += _circle([axes for axes in drawn if axes.axison], basins[0], required)[:1]
    figure.legend(handles=handles, loc="outside lower center", ncols=2)
    return figure


def _by_place(basin: Cells) -> bool:
    """Whether disturbances vary by an angle, by size and angle, or by two parts of a size: each has a place in a plane."""
    along = basin.plan.model.coordinates
    if len(along) == 1:
        return along[0].periodic
    return len(along) == 2 and not along[0].periodic and (along[1].periodic or along[0].scale == along[1].scale)


def _motions(basins: Sequence[Cells]) -> list[MotionLook]:
    """Looks of the motions of all basins, which are the same in each."""
    names = list(dict.fromkeys(name for basin in basins for name in basin.motions))
    return looks_of(names, [sum(_share(basin, name) for basin in basins) for name in names])


def _share(basin: Cells, name: MotionName) -> float:
    """Share of the cells that end in a motion."""
    return float((basin.index == basin.motions.index(name)).mean()) if name in basin.motions else 0.0


def _words(entry: MotionLook, motions: Sequence[MotionLook]) -> str:
    """Words of a motion; with the name of its orbit only where others have the same words."""
    alone = sum(other.look is entry.look for other in motions) == 1
    return entry.look.words if entry.name.orbit and alone else entry.words


def _paint(axes: Axes, basin: Cells, motions: list[MotionLook]) -> None:
    """Paint the cells of a basin in the looks of all motions."""
    places = {entry.name: entry.index for entry in motions}
    index = np.array([*(places[name] for name in basin.motions), -1])[basin.index]
    along = basin.plan.model.coordinates
    axes.set_aspect("equal")
    if len(along) == 1:
        paint_ring(axes, along[0], index, motions)
        axes.set_axis_off()
        return
    factor, unit = along[0].shown_in(basin.scales)
    across, up = ("direction 0°", along[0].words) if along[1].periodic else (along[0].words, along[1].words)
    axes.set(xlabel=f"{across} ({formula(unit)})", ylabel=f"{up} ({formula(unit)})")
    if along[1].periodic:
        parts = -(-CHORDS // index.shape[1])
        turns = along[1].edges(parts * index.shape[1])
        paint(axes, turns, factor * along[0].edges(index.shape[0]), np.repeat(index.T, parts, axis=0), motions, around)
    else:
        x, y = (factor * each.edges(cells) for each, cells in zip(along, index.shape, strict=True))
        paint(axes, x, y, index, motions)


def _largest(basin: Cells) -> float:
    """Size of the largest disturbance, as it is drawn; a ring has the radius 1."""
    size = basin.plan.model.coordinates[0]
    return 1.0 if size.periodic else size.shown_in(basin.scales)[0] * float(size.high)


def _write(axes: Axes, text: str) -> None:
    """Write words in place of a picture."""
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.text(0.5, 0.5, textwrap.fill(text, _LINE), ha="center", va="center", transform=axes.transAxes)


def _circle(drawn: Sequence[Axes], basin: Cells, required: float) -> list[Line2D]:
    """Draw the circle of what must be survived; return its lines."""
    factor, unit = basin.plan.model.coordinates[0].shown_in(basin.scales)
    turn = np.linspace(0.0, 2.0 * np.pi, 361)
    look: dict[str, Any] = {"ls": (0.0, (4.0, 2.0)), "lw": 0.8, "color": LOOKS["wall"].colour, "gid": "required"}
    look["label"] = f"must survive: up to {number(factor * required, 3)} {formula(unit)}"
    return [line for axes in drawn for line in axes.plot(*around(turn, np.array(factor * required)), **look)]
