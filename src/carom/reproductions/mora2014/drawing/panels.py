"""Parts that the panels share: letters, legend entries, and names on branches."""

from __future__ import annotations

from collections.abc import Iterable

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from carom.plots.diagrams import POINTS
from carom.plots.style import LOOKS
from carom.plots.words import orbit_symbol

DAMPING = r"damping $\gamma$"
INK = "#1a1a1a"


def letter(axes: Axes, panel: str, words: str = "") -> None:
    """Give a panel a heading: its letter in bold and some words."""
    axes.set_title(rf"$\mathbf{{({panel})}}$" + (f"  {words}" if words else ""), loc="left")


def branch_key(points: Iterable[str]) -> list[Line2D]:
    """Return legend entries for orbits and for special points of these kinds."""
    lines = [LOOKS[look].entry(f"{look} orbit") for look in ("stable", "unstable", "virtual")]
    return lines + [POINTS[kind].entry() for kind in points]


def name_branch(axes: Axes, name: str, x: float, y: float) -> None:
    """Write the name of an orbit at a point beside its branch."""
    axes.annotate(orbit_symbol(name), (x, y), ha="center", va="center", color=INK, gid="name")
