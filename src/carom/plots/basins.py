"""Basins of attraction: which disturbances lead to which motion."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap, to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch
from matplotlib.projections.polar import PolarAxes
from matplotlib.ticker import MaxNLocator

from carom.outcome import InputError
from carom.plots.figure import StyledFigure
from carom.plots.plane import Floats, clearance_circle, label_frame, point
from carom.plots.style import LOOKS, ONE_COLUMN, OUTCOMES, TWO_COLUMNS, Look, styled
from carom.plots.words import number, orbit_symbol

if TYPE_CHECKING:
    from carom.attractors import MotionName
    from carom.basins import Basin, SmallestLoss
    from carom.disturbances import Coordinate
    from carom.parameters import Scales

Bend = Callable[[Floats, Floats], tuple[Floats, Floats]]
"""Maps coordinates of cells to those of the axes."""

_PALER = (0.0, 0.4, 0.65, 0.8)
"""Shares of white mixed into the colours of the first, second, ... motion of one outcome."""
_CHORDS = 120
"""Least number of straight edges in a ring of cells."""
_RING = (0.82, 0.98)
"""Inner and outer radius of the ring that shows releases from the wall."""
_BRIGHT = {"m/s": (1e3, "mm/s"), "m": (1e3, "mm"), "m/s^2": (1.0 / 9.80665, "g")}
"""SI units as figures show them: factor and unit."""


@dataclass(frozen=True)
class MotionLook:
    """The look of a motion.

    Attributes
    ----------
    index : int
        Its place in ``Basin.motions``.
    colour : str
        That of its outcome; paler for the second motion of one outcome.
    share : float
        Of the starts that end on it.
    """

    index: int
    name: MotionName
    look: Look
    colour: str
    share: float

    @property
    def words(self) -> str:
        """Words of the legend; the name of an orbit is mathematical text."""
        if self.name.orbit:
            return f"{self.look.words} on {orbit_symbol(self.name)}"
        return self.plain_words

    @property
    def plain_words(self) -> str:
        """The same as plain text."""
        return self.name.words if self.name.outcome.settled else self.look.words

    @property
    def patch(self) -> Patch:
        """Entry of the legend of a figure."""
        percent = f"{100.0 * self.share:.3g} %"
        return Patch(
            facecolor=self.colour,
            hatch=self.look.hatch,
            edgecolor=_ink(self.colour),
            lw=0.4,
            label=f"{self.words}, {percent}",
        )


@styled
def basin(basin: Basin, smallest: SmallestLoss | None = None, title: str | None = None) -> Figure:
    """Draw where disturbances end, as a picture that depends on their coordinates.

    By size and direction: a polar picture, and beside it the shares at each size.  By two other coordinates, such as the
    components of a kick: a plane.  Releases from the wall: a ring.  Samples: a bar for each motion with its confidence
    interval.  The figure is 180 mm wide, 88 mm for a ring.  `smallest` is the smallest kick or shock found that is lost;
    it is marked in a picture of kicks or shocks.
    """
    motions = motion_looks(basin)
    kind, grid = basin.plan.model.kind, basin.dataset["outcome"].dims != ("start",)
    if not grid:
        return _bars(basin, motions, title)
    if kind == "release":
        return _ring(basin, motions, title)
    if len(basin.coordinates) != 2:
        raise InputError("basin", f"a grid of {kind}", "a grid over two coordinates, of releases, or a sample")
    size, direction = basin.coordinates
    if size.low == 0.0 and direction.periodic:
        return _polar(basin, motions, smallest, title)
    return _plane(basin, motions, smallest, title)


def motion_looks(basin: Basin) -> list[MotionLook]:
    """Return the looks of the motions, sorted by outcome; those of one outcome differ in paleness."""
    shares = basin.fractions
    shown: list[MotionLook] = []
    for place, name in sorted(enumerate(basin.motions), key=lambda entry: (entry[1].outcome, -shares[entry[1]])):
        look = OUTCOMES["irregular" if name.irregular else name.outcome.label]
        alike = sum(entry.look is look for entry in shown)
        colour = _paler(look.colour, _PALER[min(alike, len(_PALER) - 1)])
        shown.append(MotionLook(place, name, look, colour, shares[name]))
    return shown


def _paler(colour: str, white: float) -> str:
    red, green, blue = (part + white * (1.0 - part) for part in to_rgb(colour))
    return to_hex((red, green, blue))


def _ink(colour: str) -> str:
    """Return the colour of hatching: a darker shade of the background, or white on dark backgrounds."""
    red, green, blue = to_rgb(colour)
    dark = 0.2126 * red + 0.7152 * green + 0.0722 * blue < 0.3
    return "#ffffff" if dark else to_hex((0.72 * red, 0.72 * green, 0.72 * blue))


def _paint(
    axes: Axes, x: Floats, y: Floats, index: np.ndarray, motions: Sequence[MotionLook], bend: Bend = lambda x, y: (x, y)
) -> None:
    """Paint cells, given by their edges, in the colours of the motions; `bend` maps their corners to the axes."""
    order = {entry.index: place for place, entry in enumerate(motions)}
    places = np.full(index.shape, np.nan)
    for entry in motions:
        places[index == entry.index] = order[entry.index]
    colours = ListedColormap([entry.colour for entry in motions])
    levels = BoundaryNorm(np.arange(len(motions) + 1) - 0.5, len(motions))
    mesh = axes.pcolormesh(
        *bend(*np.meshgrid(x, y)),
        np.ma.masked_invalid(places).T,
        cmap=colours,
        norm=levels,
        shading="flat",
        rasterized=True,
        gid="cells",
    )
    mesh.set_edgecolor("face")
    mesh.set_linewidth(0.1)
    _hatch(axes, bend(*np.meshgrid(_nodes(x), _nodes(y))), np.pad(index, 1, mode="edge"), motions)


def _nodes(edges: Floats) -> Floats:
    """Return the centres of cells, and the outermost edges."""
    return np.concatenate([edges[:1], 0.5 * (edges[1:] + edges[:-1]), edges[-1:]])


def _hatch(axes: Axes, nodes: tuple[Floats, Floats], index: np.ndarray, motions: Sequence[MotionLook]) -> None:
    """Hatch the areas of motions, so that they can be distinguished in greyscale too."""
    for entry in motions:
        inside = (index == entry.index).astype(float)
        if entry.look.hatch and inside.any():
            area = axes.contourf(*nodes, inside.T, levels=[0.5, 1.5], colors="none", hatches=[entry.look.hatch])
            area.set_edgecolor(_ink(entry.colour))
            area.set_linewidth(0.0)
            area.set_rasterized(True)


def _polar(basin: Basin, motions: list[MotionLook], smallest: SmallestLoss | None, title: str | None) -> Figure:
    size, direction = basin.coordinates
    factor, label = _axis(size, basin.scales)
    dataset = basin.dataset
    cells = dataset["outcome"].shape
    figure = StyledFigure(figsize=(TWO_COLUMNS, 0.62 * TWO_COLUMNS))
    grid = figure.add_gridspec(1, 2, width_ratios=(1.25, 1.0))
    round_, beside = figure.add_subplot(grid[0], projection="polar"), figure.add_subplot(grid[1])
    parts = -(-_CHORDS // cells[1])  # cells have straight edges: divide wide ones so that rings look round
    index = np.repeat(dataset["motion"].values.T, parts, axis=0)
    _paint(round_, direction.edges(parts * cells[1]), factor * size.edges(cells[0]), index, motions)
    round_.set_title("(a)", loc="left", y=1.0)
    _rule(round_, factor * size.high)
    round_.set_xlabel(f"radius: {label}\nangle: {direction.words}, co-rotating frame")
    handles: list[Artist] = []
    if smallest is not None and basin.plan.model.kind == smallest.kind:
        handles = _mark_smallest(round_, smallest, factor)
    _stacked(beside, basin, motions)
    beside.set_title("(b)", loc="left", y=1.0)
    return _finish(figure, motions, title, handles, columns=3)


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
        axes.stairs(
            below + share,
            edges,
            baseline=below,
            fill=True,
            facecolor=entry.colour,
            edgecolor=_ink(entry.colour),
            hatch=entry.look.hatch,
            lw=0.0,
        )
        below = below + share
    axes.set_xlim(edges[0], edges[-1])
    axes.set_ylim(0.0, 100.0)
    axes.set_xlabel(label)
    axes.set_ylabel("share of the directions (%)")


def _mark_smallest(axes: Axes, smallest: SmallestLoss, factor: float) -> list[Artist]:
    """Mark the smallest kick or shock found that is lost and the circle of those that cannot reach the wall."""
    ring = np.linspace(0.0, 2.0 * np.pi, 361)
    wall = LOOKS["wall"]
    dashes = (0.0, (4.0, 2.0))
    axes.plot(ring, np.full(ring.shape, factor * smallest.harmless), ls=dashes, lw=0.7, color=wall.colour)
    handles: list[Artist] = [Line2D([], [], ls=dashes, lw=0.7, color=wall.colour, label="below: proven never to touch")]
    if smallest.size is not None:
        axes.plot([smallest.angle or 0.0], [factor * smallest.size], ls="none", gid="smallest", **_LOST)
        handles.append(_lost_handle(smallest))
    return handles


_LOST: dict[str, Any] = {"marker": "o", "ms": 4.0, "mfc": "white", "mec": "#1a1a1a"}


def _lost_handle(smallest: SmallestLoss) -> Line2D:
    return Line2D([], [], ls="none", label=f"smallest {smallest.kind} found that is lost", **_LOST)


def _plane(basin: Basin, motions: list[MotionLook], smallest: SmallestLoss | None, title: str | None) -> Figure:
    x, y = basin.coordinates
    dataset, kind = basin.dataset, basin.plan.model.kind
    cells = dataset["outcome"].shape
    figure = StyledFigure(figsize=(0.62 * TWO_COLUMNS, 0.69 * TWO_COLUMNS))
    axes = figure.subplots()
    handles: list[Artist] = []
    if kind == "slice":
        _paint(axes, x.edges(cells[0]), y.edges(cells[1]), dataset["motion"].values, motions)
        clearance_circle(axes, reach=1.05)
        for cells_drawn in axes.collections:  # those cut by the wall
            cells_drawn.set_clip_path(Circle((0.0, 0.0), 1.0, transform=axes.transData))
        label_frame(axes, "rotating", basin.scales)
        point(axes, complex(basin.rotor.system.arrays.offsets[0]), "contact-free", label="", colour="#ffffff")
        velocity = complex(dataset["start_vx"].values.flat[0], dataset["start_vy"].values.flat[0])
        said = "at rest in the co-rotating frame" if velocity == 0 else rf"$\dot U$ = {velocity:.3g} $c_r\Omega$"
        axes.set_title(f"starts {said}")
        handles = [Line2D([], [], ls="none", marker="p", ms=5, mfc="white", mec="#1a1a1a", label="levitation")]
    else:
        factor, label = _axis(x, basin.scales)
        across, label_across = _axis(y, basin.scales)
        _paint(axes, factor * x.edges(cells[0]), across * y.edges(cells[1]), dataset["motion"].values, motions)
        axes.set_xlabel(label)
        axes.set_ylabel(label_across)
        if kind == "kick-plane":
            axes.set_aspect("equal")
            axes.plot([0.0], [0.0], "+", ms=6.0, mew=0.7, color="white")
        if smallest is not None and smallest.size is not None:
            turned = smallest.size * np.exp(1j * (smallest.angle or 0.0)) * np.conj(_outward(basin))
            axes.plot([factor * turned.real], [factor * turned.imag], ls="none", gid="smallest", **_LOST)
            handles = [_lost_handle(smallest)]
    return _finish(figure, motions, title, handles, columns=2)


def _outward(basin: Basin) -> complex:
    rest = complex(basin.rotor.system.arrays.offsets[0])
    return rest / abs(rest) if rest else complex(np.exp(1j * basin.rotor.unbalance_phase))


def _ring(basin: Basin, motions: list[MotionLook], title: str | None) -> Figure:
    """Draw the places on the wall, coloured by the motion to which a release there leads."""
    figure = StyledFigure(figsize=(ONE_COLUMN, 1.13 * ONE_COLUMN))
    axes = figure.subplots()
    cells = basin.dataset["motion"].values
    parts = -(-_CHORDS // len(cells))
    edges = basin.coordinates[0].edges(parts * len(cells))

    def bend(angle: Floats, radius: Floats) -> tuple[Floats, Floats]:
        return radius * np.cos(angle), radius * np.sin(angle)

    _paint(axes, edges, np.array(_RING), np.repeat(cells, parts)[:, None], motions, bend)
    clearance_circle(axes, reach=1.05)
    label_frame(axes, "rotating", basin.scales)
    point(axes, complex(basin.rotor.system.arrays.offsets[0]), "contact-free", label="")
    motion = {"fixed": "at rest in the fixed frame", "rotating": "at rest in the co-rotating frame"}
    said = motion.get(str(basin.plan.model.describe()["motion"]), "rolling without slip")
    axes.set_title(f"released from the wall, {said}")
    look = LOOKS["contact-free"]
    rest = Line2D([], [], ls="none", marker=look.marker, ms=5.0, mfc=look.colour, mec="#1a1a1a", label="levitation")
    return _finish(figure, motions, title, [rest], columns=1)


def _bars(basin: Basin, motions: list[MotionLook], title: str | None) -> Figure:
    """Draw the shares of a sample with their confidence intervals."""
    figure = StyledFigure(figsize=(0.75 * TWO_COLUMNS, (0.16 + 0.075 * len(motions)) * TWO_COLUMNS))
    axes = figure.subplots()
    for row, entry in enumerate(reversed(motions)):
        share = basin.share_of(basin.motions[entry.index])
        axes.barh(
            row,
            100.0 * share.fraction,
            0.62,
            facecolor=entry.colour,
            edgecolor=_ink(entry.colour),
            hatch=entry.look.hatch,
            lw=0.3,
        )
        axes.plot([100.0 * share.low, 100.0 * share.high], [row, row], "|-", color="#1a1a1a", lw=0.8, ms=5.0)
        said = f"{number(100.0 * share.fraction, 3)} %"
        axes.annotate(
            said, (100.0 * share.high, row), xytext=(4.0, 0.0), textcoords="offset points", va="center", fontsize=7
        )
    axes.set_yticks(range(len(motions)), [entry.words for entry in reversed(motions)])
    axes.tick_params(axis="y", length=0)
    axes.set_xlim(0.0, 112.0)
    axes.set_xticks(range(0, 101, 20))
    axes.set_xlabel(f"share of {basin.starts} starts (%), with 95 % confidence")
    if title:
        figure.suptitle(title)
    return figure


def _axis(coordinate: Coordinate, scales: Scales | None) -> tuple[float, str]:
    """Return the factor from dimensionless values to those shown, and the label with its unit."""
    if scales is None or not coordinate.scale:
        unit = {
            "velocity": r"$c_\mathrm{r}\Omega$",
            "length": r"$c_\mathrm{r}$",
            "acceleration": r"$c_\mathrm{r}\Omega^2$",
        }
        return 1.0, f"{coordinate.words} ({unit.get(coordinate.scale, coordinate.units[0])})"
    si = coordinate.units[1]
    more, unit_shown = _BRIGHT.get(si, (1.0, si))
    return coordinate.si(scales) * more, f"{coordinate.words} ({unit_shown})"


def _finish(
    figure: Figure, motions: Sequence[MotionLook], title: str | None, more: Sequence[Artist], columns: int
) -> Figure:
    """Add the title, and the legend below."""
    if title:
        figure.suptitle(title)
    handles: list[Any] = [*(entry.patch for entry in motions), *more]
    figure.legend(handles=handles, loc="outside lower center", ncols=min(columns, len(handles)))
    return figure
