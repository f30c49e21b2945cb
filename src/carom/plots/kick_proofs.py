"""Which kicks are proven to come back: the proven part over the sampled basin, and the cells by their impacts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.parameters.formats import rounded_down, shown_in
from carom.plots.basins import draw_cells
from carom.plots.cells import MotionLook, around, finish, looks_of
from carom.plots.figure import StyledFigure, narrow
from carom.plots.style import LOOKS, ONE_COLUMN, TWO_COLUMNS, styled
from carom.plots.words import counted, formula, number, told_in

if TYPE_CHECKING:
    from carom.basins import Basin, Cells

PIXELS = 640
"""Points along each side of the disc at which it is asked what is proven."""
_REACH = 1.04
"""Half-width of the axes, relative to the largest kick."""
_TEALS = ("#d3f0ea", "#8fd3c5", "#4fae9f", "#2b857a", "#175e58", "#0b3b3a")
"""Of kicks with at most no, one, two, … impacts; the last one also of those with more."""
_GREYS = ("#e9e5dc", "#d0cabb", "#b7b1a1", "#9f9989", "#868071")
"""Of open cells, that of the largest area first."""
_RUB = "#a52f74"
"""Of kicks that are proven to end in the rub."""
_CHORD = 1.0 / 120.0
"""Largest angle of a straight edge, in turns."""
_VEIL = 0.62
"""How much white lies over what is not proven."""


@checked
@styled
def proven_kicks(kicks: Any, basin: Basin | Cells | None = None, title: str | None = None) -> Figure:
    """Draw what is proven of a disc of kicks.

    With a basin, where kicks end is shown pale where it is simulated only, and in full colour where it is proven.  Beside it, the cells are shown by the number of impacts after which they return at most, and the open ones by the reason.  Circles mark the kicks that never
    touch and the speed up to which all are proven to come back.  The figure is 180 mm wide, 88 mm without a basin.

    Parameters
    ----------
    kicks : ProvenKicks
    basin : Basin or Cells, optional
        Where kicks of the same machine end, by components: ``map_basins(machine, Grid(KickPlane(...), (120, 120)))``.
    title : str, optional
        By default what is proven.

    Raises
    ------
    InputError
        The basin is no grid of kicks by components.
    """
    given: Any = basin  # a basin has cells, and cells are what they are
    shown: Cells | None = getattr(given, "cells", given)
    if shown is not None and (shown.plan.model.kind != "kick-plane" or shown.index.ndim != 2):
        raise InputError("basin", f"a plan of {shown.plan.model.kind}", "a grid of kicks by components")
    figure, drawn = _panels(kicks, shown)
    motions: list[MotionLook] = []
    if shown is not None:
        names = shown.motions
        motions = looks_of(names, [float((shown.index == place).mean()) for place in range(len(names))])
        _sampled(drawn[0], kicks, shown, motions)
        drawn[0].set_title("(a) simulated; in full colour where proven")
        drawn[1].set_title("(b) proven, cell by cell")
    _proven(drawn[-1], kicks)
    for axes in drawn:
        _frame(axes, kicks)
    return finish(figure, motions, title or _title(kicks), columns=2, shares=False)


def _panels(kicks: Any, basin: Cells | None) -> tuple[Figure, list[Axes]]:
    """A new figure with axes beside each other; below each other where figures are one column wide."""
    entries = len(kicks.parts) + 2 + (0 if basin is None else len(basin.motions) + 1)
    if basin is None or narrow():
        panels = 1 if basin is None else 2
        figure = StyledFigure(figsize=(ONE_COLUMN, (1.06 * panels + 0.14 + 0.045 * entries) * ONE_COLUMN))
        return figure, list(figure.subplots(panels, 1, squeeze=False)[:, 0])
    figure = StyledFigure(figsize=(TWO_COLUMNS, (0.55 + 0.011 * entries) * TWO_COLUMNS))
    return figure, list(figure.subplots(1, 2))


def _title(kicks: Any) -> str:
    unit = shown_in("velocity", kicks.rotor.scales)[1]
    return f"Proven: {kicks.words.replace(unit, formula(unit))}"


def _sampled(axes: Axes, kicks: Any, basin: Cells, motions: list[MotionLook]) -> None:
    """Paint where kicks end, pale where nothing is proven."""
    draw_cells(axes, basin, motions)
    reach = told_in("velocity", kicks.rotor.scales)[0] * kicks.largest
    for cells in (*axes.collections, *axes.patches):  # those on the rim
        cells.set_clip_path(Circle((0.0, 0.0), reach, transform=axes.transData))
    line = np.linspace(-kicks.largest, kicks.largest, PIXELS)
    proven = np.array([*(not part.open for part in kicks.parts), False])[kicks.at(*np.meshgrid(line, line))]
    veil = np.ones((PIXELS, PIXELS, 4))
    veil[..., 3] = np.where(proven, 0.0, _VEIL)
    place: dict[str, Any] = {"extent": (-reach, reach, -reach, reach), "origin": "lower", "zorder": 1.5}
    axes.imshow(veil, **place, interpolation="nearest", gid="veil")
    if not kicks.whole:
        axes.fill_between([], [], fc="white", ec="#a6a6a6", lw=0.4, label="pale: not proven")


def _proven(axes: Axes, kicks: Any) -> None:
    """Fill the cells in the looks of their parts."""
    looks = _looks(kicks)
    radius = told_in("velocity", kicks.rotor.scales)[0] * kicks.largest
    outlines = [radius * _outline(edges) for edges in kicks.edges]
    for place, (look, part) in enumerate(zip(looks, kicks.parts, strict=True)):
        cells = [outlines[cell] for cell in np.flatnonzero(kicks.places == place)]
        # Edges of their own colour, for no gap shows between cells then.
        edge = {"edgecolor": look["facecolor"], "lw": 0.2, "gid": "open" if part.open else "proven"}
        axes.add_collection(PolyCollection(cells, **look, **edge, rasterized=True, label=_words(part)))


def _looks(kicks: Any) -> list[dict[str, Any]]:
    """Colours of the parts: green the darker the more impacts, that of the rub, grey where nothing is proven."""
    left = iter(_GREYS)

    def colour(part: Any) -> str:
        if part.impacts is not None:
            return _TEALS[min(part.impacts, len(_TEALS) - 1)]
        return _RUB if part.refuted else next(left, _GREYS[-1])

    return [{"facecolor": colour(part)} for part in kicks.parts]


def _words(part: Any) -> str:
    share = f"{number(100.0 * part.share, 3)} %"
    if part.refuted:
        return f"proven to end in the rub: {share}"
    if part.impacts is None:
        return f"open, {share}: {part.reason}"
    if part.impacts == 0:
        return f"proven, never touches: {share}"
    return f"proven, at most {counted(part.impacts, 'impact')}: {share}"


def _outline(edges: np.ndarray) -> np.ndarray:
    """Corners of a cell (n, 2), for a largest kick of 1."""
    slow, fast, first, last = edges
    turn = 2.0 * np.pi * np.linspace(first, last, 2 + int((last - first) / _CHORD))
    return np.hstack([around(turn, np.array(fast)), around(turn[::-1], np.array(slow))]).T


def _frame(axes: Axes, kicks: Any) -> None:
    """Draw the circles of what never touches and of what all comes back."""
    factor, unit = told_in("velocity", kicks.rotor.scales)
    reach = _REACH * factor * kicks.largest
    axes.set_aspect("equal")
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach))
    axes.set(xlabel=f"kick outward ({unit})", ylabel=f"kick in the sense of rotation ({unit})")
    marked = [(kicks.harmless, (4.0, 2.0), "none touches below")]
    if not kicks.whole and kicks.all_up_to > kicks.harmless:  # else it says no more
        marked.append((kicks.all_up_to, (1.0, 1.5), "all proven to come back below"))
    for size, dashes, words in marked:
        if 0.0 < size <= kicks.largest:
            circle = around(np.linspace(0.0, 2.0 * np.pi, 361), np.array(factor * size))
            label = f"{words} {number(rounded_down(factor * size))} {unit}"
            axes.plot(*circle, ls=(0.0, dashes), lw=0.8, color=LOOKS["wall"].colour, label=label)
