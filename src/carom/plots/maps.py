"""Maps of a number over two parameters: shaded cells with their colour bar, cells without a value, and the machine as it is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colorbar import Colorbar
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from carom.base.outcome import STEADY_WORDS
from carom.plots.plane import Floats
from carom.plots.style import Look

BLANKS = MappingProxyType(
    {
        "no-levitation": Look("#e6e6e6", f"no {STEADY_WORDS['contact-free']}", hatch=r"\\"),
        "none": Look("#ffffff", "no such value", hatch="////"),
        "waiting": Look("#ffffff", "not computed yet", hatch="...."),
        "failed": Look("#ffffff", "failed", hatch="xxxx"),
    }
)
"""Why a cell has no value: distinguished by hatching, also in greyscale and for colour-blind readers."""
SHADES = "cividis"
"""Colour map that can be read by colour-blind readers and in greyscale (Nuñez, Anderton, Renslow 2018)."""
_INK = "#8c8c8c"
"""Colour of the hatching and edges of cells without a value."""


def cell_edges(values: Floats, logarithmic: bool = False) -> Floats:
    """Return the edges of the cells around values: halfway between them on their axis."""
    along = np.log(values) if logarithmic else np.asarray(values, float)
    steps = np.diff(along) if len(along) > 1 else np.ones(1)
    edges = np.concatenate(
        [[along[0] - 0.5 * steps[0]], along[:-1] + 0.5 * np.diff(along), [along[-1] + 0.5 * steps[-1]]]
    )
    return np.exp(edges) if logarithmic else edges


def draw_map(
    axes: Axes,
    edges: tuple[Floats, Floats],
    values: np.ma.MaskedArray,
    words: str,
    reasons: Mapping[str, np.ndarray],
    replaced: Mapping[str, str] = MappingProxyType({}),
    **look: Any,
) -> Colorbar | None:
    """Draw cells, values of shape (n, m) between n + 1 and m + 1 edges, in shades with a colour bar; masked ones by why they have no value.

    Parameters
    ----------
    words : str
        Label of the colour bar; without words there is none.
    reasons, replaced : mapping
        Cells without a value, and words instead of those of the looks, by keys of :data:`BLANKS`.
    **look
        Colour map and its limits, as for ``pcolormesh``.
    """
    mesh = axes.pcolormesh(*edges, values.T, rasterized=True, gid="cells", **{"cmap": SHADES, **look})
    for key, cells in reasons.items():
        mark_cells(axes, edges, cells, replace(BLANKS[key], words=replaced.get(key, BLANKS[key].words)), key)
    if not words:
        return None
    bar = axes.figure.colorbar(mesh, ax=axes, pad=0.02, label=words)
    bar.outline.set_linewidth(0.5)
    return bar


def mark_cells(axes: Axes, edges: tuple[Floats, Floats], cells: np.ndarray, look: Look, gid: str) -> None:
    """Fill or hatch cells with a look, whose words stand in the legend."""
    if cells.any():
        drawn: dict[str, object] = {"facecolor": look.colour, "hatch": look.hatch, "edgecolor": _INK, "zorder": 1.5}
        axes.add_patch(PathPatch(cells_path(np.meshgrid(*edges), cells), lw=0.0, gid=gid, label=look.words, **drawn))


def mark_present(axes: Axes, place: Sequence[float], edges: Sequence[Floats], words: str) -> None:
    """Mark the machine as it is, if it lies between edges of cells."""
    if not all(min(along) <= value <= max(along) for value, along in zip(place, edges, strict=True)):
        return
    star: dict[str, Any] = {"marker": "*", "ms": 9.0, "mfc": "white", "mec": "#1a1a1a", "mew": 0.7, "ls": "none"}
    axes.plot(*place, **star, gid="present", clip_on=False, zorder=4, label=words)


def cells_path(corners: Sequence[Floats], inside: np.ndarray) -> Path:
    """Return cells, bool of shape (n, m), between corners of shape (m + 1, n + 1) as one path, so that hatching is continuous."""
    x, y = corners
    row, column = np.nonzero(inside.T)
    around = [(row, column), (row, column + 1), (row + 1, column + 1), (row + 1, column), (row, column)]
    vertices = np.stack([np.stack([x[place], y[place]], axis=-1) for place in around], axis=1)
    return Path(vertices.reshape(-1, 2), [Path.MOVETO, *[Path.LINETO] * 3, Path.CLOSEPOLY] * len(row))
