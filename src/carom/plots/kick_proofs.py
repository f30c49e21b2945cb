"""Which kicks are proven to come back: the cells of kicks by their impacts, and why others are open."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from carom.base.arguments import checked
from carom.parameters.formats import rounded_down, shown_in
from carom.plots.plane import around, circle, key, one_axes
from carom.plots.style import LOOKS, ONE_COLUMN, styled
from carom.plots.words import counted, display_unit, formula, number

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


@checked
@styled
def proven_kicks(kicks: Any) -> Figure:
    """Draw what is proven of a disc of kicks.

    Cells are shown by the number of impacts after which they return at most, and the open ones by the reason.  Circles mark the kicks that never
    touch and the speed up to which all are proven to come back.  The figure is 88 mm wide.

    Parameters
    ----------
    kicks : ProvenKicks
    """
    entries = len(kicks.parts) + 2
    figure, axes = one_axes((ONE_COLUMN, (1.2 + 0.045 * entries) * ONE_COLUMN))
    _proven(axes, kicks)
    _frame(axes, kicks)
    unit = shown_in("velocity", kicks.rotor.scales)[1]
    return key(figure, [axes], columns=1, title=f"Proven: {kicks.words.replace(unit, formula(unit))}")


def _proven(axes: Axes, kicks: Any) -> None:
    """Fill the cells: green the darker the more impacts, in the colour of the rub, grey where nothing is proven."""
    greys = iter(_GREYS)
    radius = display_unit("velocity", kicks.rotor.scales)[0] * kicks.largest
    outlines = [radius * _outline(edges) for edges in kicks.edges]
    for place, part in enumerate(kicks.parts):
        if part.impacts is not None:
            colour = _TEALS[min(part.impacts, len(_TEALS) - 1)]
        else:
            colour = _RUB if part.refuted else next(greys, _GREYS[-1])
        cells = [outlines[cell] for cell in np.flatnonzero(kicks.places == place)]
        # Edges of their own colour, for no gap shows between cells then.
        look: dict[str, Any] = {"fc": colour, "ec": colour, "lw": 0.2, "gid": "open" if part.open else "proven"}
        axes.add_collection(PolyCollection(cells, **look, rasterized=True, label=_words(part)))


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
    factor, unit = display_unit("velocity", kicks.rotor.scales)
    reach = _REACH * factor * kicks.largest
    axes.set_aspect("equal")
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach))
    axes.set(xlabel=f"kick outward ({unit})", ylabel=f"kick in the sense of rotation ({unit})")
    marked = [(kicks.contact_free, (4.0, 2.0), "none touches below")]
    if not kicks.whole and kicks.all_up_to > kicks.contact_free:  # else it says no more
        marked.append((kicks.all_up_to, (1.0, 1.5), "all proven to come back below"))
    for size, dashes, words in marked:
        if 0.0 < size <= kicks.largest:
            label = f"{words} {number(rounded_down(factor * size))} {unit}"
            circle(axes, factor * size, ls=(0.0, dashes), lw=0.8, color=LOOKS["wall"].colour, label=label)
