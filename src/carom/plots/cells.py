"""The looks of motions, which pictures of basins and of attractors share, and cells painted in them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap, hsv_to_rgb, rgb_to_hsv, to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path

from carom.plots.plane import Floats, unique_entries
from carom.plots.style import OUTCOMES, Drawn, Look

if TYPE_CHECKING:
    from carom.attractors import MotionName
    from carom.basins import Basin

Bend = Callable[[Floats, Floats], tuple[Floats, Floats]]
"""Maps coordinates of cells to those of the axes."""


_TURNED = (0.0, -0.07, 0.07, 0.14)
"""Turns of the hue for the first, second, ... motion of one outcome."""
_WEIGHTS = (0.299, 0.587, 0.114)
"""Shares of red, green and blue in the grey of a print without colour."""


@dataclass(frozen=True)
class MotionLook:
    """The look of a motion.

    Attributes
    ----------
    index : int
        Its place among the motions, such as in ``Basin.motions``.
    colour : str
        That of its outcome; of another hue and as light for the second motion of one outcome.
    share : float
        Share of the starts that end on it.
    """

    index: int
    name: MotionName
    look: Look
    colour: str
    share: float

    @property
    def words(self) -> str:
        """Words of the legend."""
        return self.name.words

    def patch(self, *, share: bool = True) -> Patch:
        """Entry of the legend of a figure, by default with the share."""
        return Patch(**self.filled, lw=0.4, label=f"{self.words}, {100.0 * self.share:.3g} %" if share else self.words)

    @property
    def filled(self) -> Drawn:
        """Colour and hatching of an area."""
        return {"facecolor": self.colour, "edgecolor": ink(self.colour), "hatch": self.look.hatch}


def motion_looks(basin: Basin) -> list[MotionLook]:
    """Return the looks of the motions of a basin, as :func:`looks_of` does."""
    shares = basin.fractions
    return looks_of(basin.motions, [shares[name] for name in basin.motions])


def looks_of(names: Sequence[MotionName], shares: Sequence[float]) -> list[MotionLook]:
    """Return the looks of motions, sorted by outcome and share; those of one outcome differ in hue."""
    shown: list[MotionLook] = []
    for place in sorted(range(len(names)), key=lambda place: (names[place].outcome, -shares[place])):
        name = names[place]
        look = OUTCOMES["irregular" if name.irregular else name.outcome.label]
        alike = sum(entry.look is look for entry in shown)
        colour = _turned(look.colour, _TURNED[min(alike, len(_TURNED) - 1)])
        shown.append(MotionLook(place, name, look, colour, shares[place]))
    return shown


def _turned(colour: str, turn: float) -> str:
    """Return a colour of another hue that is as light: lightness tells outcomes apart, hue the motions of one outcome."""
    if not turn:
        return colour
    own = np.array(to_rgb(colour))
    hue, saturation, value = rgb_to_hsv(own)
    other = hsv_to_rgb(((hue + turn) % 1.0, saturation, value))
    light, wanted = (float(np.dot(_WEIGHTS, part)) for part in (other, own))
    if light > wanted:
        return to_hex(tuple(other * wanted / light))
    return to_hex(tuple(other + (1.0 - other) * (wanted - light) / (1.0 - light)))


def ink(colour: str) -> str:
    """Return the colour of hatching: a darker shade of the background, or white on dark backgrounds."""
    red, green, blue = to_rgb(colour)
    dark = 0.2126 * red + 0.7152 * green + 0.0722 * blue < 0.3
    return "#ffffff" if dark else to_hex((0.72 * red, 0.72 * green, 0.72 * blue))


def cells_path(corners: Sequence[Floats], inside: np.ndarray) -> Path:
    """Return cells, bool of shape (n, m), between corners of shape (m + 1, n + 1) as one path, so that hatching is continuous."""
    x, y = corners
    row, column = np.nonzero(inside.T)
    around = [(row, column), (row, column + 1), (row + 1, column + 1), (row + 1, column), (row, column)]
    vertices = np.stack([np.stack([x[place], y[place]], axis=-1) for place in around], axis=1)
    return Path(vertices.reshape(-1, 2), [Path.MOVETO, *[Path.LINETO] * 3, Path.CLOSEPOLY] * len(row))


def paint(
    axes: Axes, x: Floats, y: Floats, index: np.ndarray, motions: Sequence[MotionLook], bend: Bend = lambda x, y: (x, y)
) -> None:
    """Paint cells, given by their edges, in the colours of the motions; `bend` maps their corners to the axes."""
    places = np.full(index.shape, np.nan)
    for place, entry in enumerate(motions):
        places[index == entry.index] = place
    colours = ListedColormap([entry.colour for entry in motions])
    levels = BoundaryNorm(np.arange(len(motions) + 1) - 0.5, len(motions))
    corners = bend(*np.meshgrid(x, y))
    shown = np.ma.masked_invalid(places).T
    mesh = axes.pcolormesh(*corners, shown, cmap=colours, norm=levels, shading="flat", rasterized=True, gid="cells")
    mesh.set_edgecolor("face")
    mesh.set_linewidth(0.1)
    for entry in motions:  # hatched, so that they can be distinguished without colour too
        if entry.look.hatch and (index == entry.index).any():
            drawn: Drawn = {"hatch": entry.look.hatch, "ec": ink(entry.colour), "lw": 0.0, "zorder": 1.2}
            # Not a patch to axes: thousands of cells, whose limits the mesh has set.
            axes.add_artist(PathPatch(cells_path(corners, index == entry.index), fc="none", rasterized=True, **drawn))


def share_bars(axes: Axes, looks: Sequence[MotionLook], words: Sequence[str], ends: Sequence[float]) -> None:
    """Draw the share of each motion as a bar, the first on top, with words behind its end [%]."""
    for row, (look, said, end) in enumerate(zip(looks, words, ends, strict=True)):
        axes.barh(row, 100.0 * look.share, 0.65, **look.filled, lw=0.3)
        axes.annotate(said, (end, row), (4, 0), textcoords="offset points", va="center", fontsize=7)
    axes.set_yticks(range(len(looks)), [look.words for look in looks])
    axes.tick_params(axis="y", length=0)
    axes.invert_yaxis()
    axes.set(xlim=(0.0, 115.0), xticks=range(0, 101, 20))


def finish(figure: Figure, motions: Sequence[MotionLook], columns: int, *, shares: bool = True) -> Figure:
    """Add below a figure a legend of motions, with their shares, and of all that is labelled in the axes."""
    handles: list[object] = [*(entry.patch(share=shares) for entry in motions), *unique_entries(figure.axes)[0]]
    figure.legend(handles=handles, loc="outside lower center", ncols=min(columns, len(handles)))
    return figure
