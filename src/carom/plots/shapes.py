"""Shapes of the free whirls of a flexible rotor along its shaft, with its bearings and sensors."""

from __future__ import annotations

import cmath
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.base.arguments import checked
from carom.plots.figure import StyledFigure
from carom.plots.plane import Floats, key
from carom.plots.style import LOOKS, TWO_COLUMNS, Look, styled
from carom.plots.words import number

if TYPE_CHECKING:
    import carom.rotors
    from carom.rotors import FlexibleMachine, WhirlMode

_COLUMNS, _ROW = 2, 0.165
"""Columns of panels, and height of a row, in widths of the figure."""
_REACH, _MARKED = 1.35, -1.12
"""Height of a panel over the largest displacement, and where bearings and sensors are marked in it."""
_ROUND = 0.05
"""Share of the other direction in a shape from which on it does not lie in one plane."""
_SHAFT, _DISC = 0.12, 0.6
"""Half heights at which the widest section of the shaft and discs are drawn; their lengths are to scale."""
_PLATE: dict[str, Any] = {"color": "#8c959f", "lw": 3.5, "solid_capstyle": "butt", "zorder": 0.5}
"""Look of a disc."""
_MILLIMETRES = 1e3
_PARTS = (
    ("magnet", Look("#1a1a1a", "magnet", marker="s")),
    ("sensor", Look("#1a1a1a", "sensor", marker="o")),
    ("touchdown", Look("#a52f74", "touchdown bearing", marker="|")),
)


@checked
@styled
def mode_shapes(flexible: FlexibleMachine, whirls: Sequence[carom.rotors.WhirlMode]) -> Figure:
    """Draw the shapes of free whirls along the shaft, one panel each, with the shaft, its discs, magnets, sensors and touchdown bearings.

    Lines are the displacement in the plane in which the whirl is widest, and, dotted, across it; the largest displacement is 1.  Whirls are
    from :func:`carom.rotors.find_whirls`.
    """
    rows = -(-len(whirls) // _COLUMNS)
    figure = StyledFigure(figsize=(TWO_COLUMNS, (0.12 + _ROW * rows) * TWO_COLUMNS))
    panels = figure.subplots(rows, _COLUMNS, sharex=True, sharey=True, squeeze=False).ravel()
    places = _MILLIMETRES * flexible.rotor.places
    for axes, whirl in zip(panels, whirls, strict=False):
        _shape(axes, places, whirl)
        _parts(axes, flexible)
        _shaft(axes, flexible.rotor)
        axes.set(xlim=(places[0], places[-1]), ylim=(-_REACH, _REACH), yticks=[-1.0, 0.0, 1.0])
    for axes in panels[len(whirls) :]:
        axes.remove()
    for axes in panels[max(len(whirls) - _COLUMNS, 0) : len(whirls)]:
        axes.tick_params(labelbottom=True)
        axes.set_xlabel("place along the shaft (mm)")
    for axes in panels[::_COLUMNS]:
        axes.set_ylabel("displacement")
    return key(figure, panels[: len(whirls)], columns=4)


def _shape(axes: Axes, places: Floats, whirl: WhirlMode) -> None:
    # The square of a rotating number tells the plane in which the shape is widest, whatever its sign.
    turned = whirl.widest * cmath.exp(-0.5j * cmath.phase(complex((whirl.widest**2).sum())))
    turned *= 1.0 if turned.real[np.abs(turned.real).argmax()] > 0.0 else -1.0
    look = LOOKS["backward" if whirl.sense == "backward" else "forward"]
    axes.axhline(0.0, color="#a6a6a6", lw=0.6)
    axes.plot(places, turned.real, color=look.colour, lw=1.4, label=f"{whirl.sense} whirl", gid="along")
    if np.abs(turned.imag).max() > _ROUND:
        axes.plot(places, turned.imag, color=look.colour, lw=1.0, ls=":", label=f"{whirl.sense}, across", gid="across")
    title = f"{number(whirl.frequency, 4)} Hz, {whirl.sense}, damping ratio {number(whirl.damping_ratio, 2)}"
    axes.set_title(title, fontsize="small")


def _shaft(axes: Axes, rotor: Any) -> None:
    """Draw the sections of the shaft and the places of its discs, of a rotor that is known by these."""
    sections = getattr(rotor, "sections", ())
    ends = _MILLIMETRES * np.cumsum([0.0, *(section.length for section in sections)])
    widest = max((section.outer_diameter for section in sections), default=1.0)
    for begin, end, section in zip(ends[:-1], ends[1:], sections, strict=True):
        half = _SHAFT * section.outer_diameter / widest
        axes.fill_between([begin, end], -half, half, fc="#e4e7ea", ec="#a6a6a6", lw=0.4, zorder=0, gid="shaft")
    discs, along = getattr(rotor, "discs", ()), _MILLIMETRES * rotor.node_places
    for disc in discs:
        axes.plot([along[disc.node]] * 2, [-_DISC, _DISC], **_PLATE, label="disc", gid="disc")


def _parts(axes: Axes, machine: FlexibleMachine) -> None:
    """Mark where bearings and sensors are, below the shape."""
    nodes = {
        "magnet": [bearing.node for bearing in machine.bearings],
        "sensor": [node for bearing in machine.bearings for node in bearing.sensor_nodes],
        "touchdown": [plane.node for plane in machine.touchdowns],
    }
    along = _MILLIMETRES * machine.rotor.node_places
    for name, look in _PARTS:
        at = along[nodes[name]]
        if len(at):
            drawn = look.mark(8.0 if name == "touchdown" else 4.5, filled=name != "sensor")
            axes.plot(at, np.full(len(at), _MARKED), **drawn, label=look.words, gid=name, clip_on=False)
