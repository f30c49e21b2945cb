"""Basins of attraction: which disturbances lead to which motion, of one machine or of several side by side; which kicks are proven to come back; shares of attractors."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.disturbances import outward_from
from carom.parameters.formats import rounded_down, shown_in
from carom.plots.cells import MotionLook, finish, looks_of, motion_looks, paint, share_bars
from carom.plots.figure import ONE_COLUMN, TWO_COLUMNS, StyledFigure
from carom.plots.plane import around, circle, clearance_circle, key, label_frame, one_axes, point
from carom.plots.style import LOOKS, Drawn, styled
from carom.plots.words import clearance, counted, display_unit, formula, number

if TYPE_CHECKING:
    from carom.attractors import AttractorSet, MotionName
    from carom.basins import Basin, Cells, SmallestUnrecovered
    from carom.disturbances import Coordinate
    from carom.parameters import Scales

    ProvenKicks = Any
    """Those of :mod:`carom.proofs`, which lies above: arguments are compared with its name."""

_CHORDS = 120
"""Least number of straight edges in a ring of cells."""
_RING = (0.82, 0.98)
"""Inner and outer radius of the ring that shows what varies by one angle."""
_ROW, _EDGES = 0.26, 0.9
"""Height of the bar of an attractor and of everything else [inch]."""
_LINE = 22
"""Letters of a line of words in place of a picture."""
_REACH = 1.04
"""Half-width of the axes, relative to the largest disturbance."""
OF_ONE_SIZE: Drawn = {"ls": (0.0, (4.0, 2.0)), "lw": 0.8, "color": LOOKS["wall"].colour, "gid": "circle"}
"""Look of the circle of all disturbances of one size."""


@checked
@styled
def basin(basin: Basin, smallest: SmallestUnrecovered | None = None) -> Figure:
    """Draw where disturbances end, as a picture that depends on their coordinates.

    By size and direction: a disc, and beside it the shares at each size.  By two other coordinates, such as the
    components of a kick: a plane.  Releases from the wall and losses of a blade: a ring.  Samples: a bar for each motion with
    its confidence interval.  The figure is 180 mm wide, 112 mm for a plane, 88 mm for a ring.  `smallest` is the smallest kick or shock found that does not come back;
    it is marked in a picture of kicks or shocks.
    """
    motions, along, kind = motion_looks(basin), basin.coordinates, basin.plan.model.kind
    if basin.dataset["outcome"].dims == ("start",):
        return _bars(basin, motions)
    if not (len(along) == 2 or (len(along) == 1 and along[0].periodic)):
        raise InputError("basin", f"a grid of {kind}", "a grid over two coordinates, of releases, or a sample")
    round_ = len(along) == 2 and along[1].periodic
    width, height = (1.0, 0.62) if round_ else (0.62, 0.69) if len(along) == 2 else (0.49, 0.55)
    figure = StyledFigure(figsize=(width * TWO_COLUMNS, height * TWO_COLUMNS))
    axes, *beside = figure.subplots(1, 1 + round_, squeeze=False, width_ratios=(1.25, 1.0)[: 1 + round_])[0]
    draw_cells(axes, basin.cells, motions)
    if kind == "slice":
        velocity = complex(getattr(basin.plan.model, "velocity", 0.0))
        factor, unit = display_unit("velocity", basin.scales)
        said = "at rest" if velocity == 0 else f"at {factor * velocity:.3g} {unit}"
        axes.set_title(f"starts {said} in the fixed frame")
        levitation = complex(basin.rotor.system.arrays.offsets[0])
        point(axes, clearance(basin.scales) * levitation, "contact-free", colour="#ffffff")
    # Only sizes in all directions are radii of a picture.
    if smallest is not None and len(along) == 2 and (kind in (smallest.kind, "kick-plane")):
        _mark_smallest(axes, basin, smallest)
    for panel in beside:
        axes.set_title("(a)", loc="left", y=1.0)
        panel.set_title("(b)", loc="left", y=1.0)
        _stacked(panel, basin, motions)
    return finish(figure, motions, columns=1 if len(along) == 1 else 3 if round_ else 2)


@checked
@styled
def basin_pair(panels: Sequence[tuple[str, Basin | Cells]], required: float | None = None) -> Figure:
    """Draw basins of the same disturbances beside each other, such as those before and after a change of the machine.

    They share axes, legend and colours.  The figure is 88 mm wide.

    Parameters
    ----------
    panels : sequence of (str, Basin or Cells)
        Title and basin from left to right: of kicks by components, of shocks by peak and direction or of losses of a blade by
        phase.
    required : float, optional
        Size of kicks or shocks, in units of the equations, at which a circle is drawn: what must be survived.

    Raises
    ------
    InputError
        There is no panel, or these are no grids of such disturbances, all of one kind.
    """
    given: Sequence[tuple[str, Any]] = panels
    basins: list[Cells] = [getattr(entry, "cells", entry) for _, entry in given]
    kinds = sorted({basin.plan.model.kind for basin in basins})
    if len(kinds) != 1:
        raise InputError("panels", " and ".join(kinds) or None, "basins of one kind of disturbance, at least one")
    if any(basin.index.ndim != len(basin.plan.model.coordinates) for basin in basins) or not _by_place(basins[0]):
        raise InputError("panels", f"a plan of {kinds[0]}", "grids of kicks, shocks or losses of a blade")
    names = list(dict.fromkeys(name for basin in basins for name in basin.motions))
    motions = looks_of(names, [sum(_share(basin, name) for basin in basins) for name in names])
    figure = StyledFigure(figsize=(ONE_COLUMN, (0.7 + 0.045 * len(motions)) * ONE_COLUMN))
    drawn = figure.subplots(1, len(panels), sharex=True, sharey=True, squeeze=False)[0]
    size = basins[0].plan.model.coordinates[0]
    factor, unit = size.shown_in(basins[0].scales)
    for axes, (title, _), entry in zip(drawn, panels, basins, strict=True):
        axes.set_title(title)
        draw_cells(axes, entry, motions)
        axes.label_outer()
        if required is not None:
            words = f"must survive: up to {number(factor * required, 3)} {formula(unit)}"
            circle(axes, factor * required, **OF_ONE_SIZE, label=words)
    sizes = [(basin.plan.model.coordinates[0], basin.scales) for basin in basins]
    reach = _REACH * max(1.25 if size.periodic else size.shown_in(of)[0] * float(size.high) for size, of in sizes)
    drawn[0].set(xlim=(-reach, reach), ylim=(-reach, reach))  # and so the others
    return finish(figure, motions, columns=2, shares=False)


def _by_place(basin: Cells) -> bool:
    """Whether disturbances vary by an angle, by size and angle, or by two parts of a size: each has a place in a plane."""
    along = basin.plan.model.coordinates
    if len(along) == 1:
        return along[0].periodic
    return len(along) == 2 and not along[0].periodic and (along[1].periodic or along[0].scale == along[1].scale)


def _share(basin: Cells, name: MotionName) -> float:
    """Share of the cells that end in a motion."""
    return float((basin.index == basin.motions.index(name)).mean()) if name in basin.motions else 0.0


def draw_cells(axes: Axes, basin: Cells, motions: Sequence[MotionLook]) -> None:
    """Paint where disturbances end, by one angle, by size and angle, or by two sizes, in the looks of motions."""
    places = {entry.name: entry.index for entry in motions}
    index = np.array([*(places[name] for name in basin.motions), -1])[basin.index]
    along, scales = basin.plan.model.coordinates, basin.scales
    if along[-1].periodic:  # cells have straight edges: divide wide ones so that rings look round
        axes.set_aspect("equal")
        parts = -(-_CHORDS // index.shape[-1])
        turns = along[-1].edges(parts * index.shape[-1])
        index = np.repeat(index, parts, axis=-1)
    if len(along) == 1:
        paint(axes, turns, np.array(_RING), index[:, None], motions, around)
        _dial(axes, basin)
        return
    (factor, label), (across, label_across) = (_axis(each, scales) for each in along)
    sizes = factor * along[0].edges(index.shape[0])
    if along[1].periodic:
        paint(axes, turns, sizes, index.T, motions, around)
        axes.set(xlabel=f"{label}, 0° to the right", ylabel=label)
        return
    paint(axes, sizes, across * along[1].edges(index.shape[1]), index, motions)
    axes.set(xlabel=label, ylabel=label_across)
    if along[0].scale == along[1].scale:
        axes.set_aspect("equal")
    if basin.plan.model.kind == "slice":
        wall = clearance(scales)
        for cells in (*axes.collections, *axes.patches):  # those cut by the wall
            cells.set_clip_path(Circle((0.0, 0.0), wall, transform=axes.transData))
        clearance_circle(axes, reach=1.05, wall=wall)
        label_frame(axes, "rotating", scales)


def _dial(axes: Axes, basin: Cells) -> None:
    """Write what varies by one angle around and into its ring."""
    model, angle = basin.plan.model, basin.plan.model.coordinates[0]
    axes.set_axis_off()
    axes.set(xlim=(-1.3, 1.3), ylim=(-1.3, 1.3))
    for turned in (0, 90, 180, 270):
        x, y = around(np.radians(turned), np.array(1.15))
        axes.text(float(x), float(y), f"{turned}°", ha="center", va="center")
    words = angle.words
    if model.kind == "release":
        motion = {"fixed": "at rest in the fixed frame", "rotating": "at rest in the co-rotating frame"}
        words = f"released from the wall, {motion.get(str(model.describe()['motion']), 'rolling without slip')}"
    elif model.kind == "blade-loss":
        factor, unit = display_unit("unbalance" if basin.scales else "length", basin.scales)
        words = f"phase of the change of unbalance, {number(factor * float(str(model.describe()['change'])), 5)} {unit}"
        axes.annotate("", (0.78, 0.0), (0.0, 0.0), arrowprops={"arrowstyle": "-|>", "color": "#1a1a1a"})
        words += ", from the unbalance before (arrow)"
    axes.text(0.0, -0.08, textwrap.fill(words, _LINE), ha="center", va="top", fontsize=7)


def _stacked(axes: Axes, basin: Basin, motions: Sequence[MotionLook]) -> None:
    """Draw the share of each motion at each size, stacked."""
    factor, label = _axis(basin.coordinates[0], basin.scales)
    index = basin.cells.index
    edges = factor * basin.coordinates[0].edges(index.shape[0])
    starts = np.maximum((index >= 0).sum(axis=1), 1)
    below = np.zeros(index.shape[0])
    for entry in motions:
        share = 100.0 * (index == entry.index).sum(axis=1) / starts
        axes.stairs(below + share, edges, baseline=below, fill=True, **entry.filled, lw=0.0)
        below = below + share
    axes.set(xlim=(edges[0], edges[-1]), ylim=(0.0, 100.0), xlabel=label, ylabel="share of the directions (%)")


def _mark_smallest(axes: Axes, basin: Basin, smallest: SmallestUnrecovered) -> None:
    """Mark the smallest kick or shock found that does not come back and the circle of those that cannot reach the wall."""
    factor = basin.coordinates[0].shown_in(basin.scales)[0]
    circle(axes, factor * smallest.contact_free, **OF_ONE_SIZE, label="below: proven never to touch")
    if smallest.size is None:
        return
    place = smallest.size * np.exp(1j * (smallest.angle or 0.0))
    if not basin.coordinates[1].periodic:
        place *= np.conj(outward_from(basin.rotor))
    look: Drawn = {"marker": "o", "ms": 4.0, "mfc": "white", "mec": "#1a1a1a", "ls": "none"}
    words = f"smallest {smallest.kind} found that does not come back"
    axes.plot([factor * place.real], [factor * place.imag], **look, gid="smallest", label=words)


def _bars(basin: Basin, motions: list[MotionLook]) -> Figure:
    """Draw the shares of a sample with their confidence intervals."""
    figure, axes = one_axes((0.75 * TWO_COLUMNS, (0.16 + 0.075 * len(motions)) * TWO_COLUMNS))
    shares = [basin.share_of(basin.motions[entry.index]) for entry in motions]
    ends = [(100.0 * share.low, 100.0 * share.high) for share in shares]
    words = [f"{number(100.0 * share.fraction, 3)} %" for share in shares]
    share_bars(axes, motions, words, [high for _, high in ends])
    for row, span in enumerate(ends):
        axes.plot(span, [row, row], "|-", color="#1a1a1a", lw=0.8, ms=5.0)
    axes.set_xlabel(f"share of {basin.starts} {basin.share_recovered.population.words} (%), with 95 % confidence")
    return figure


@checked
@styled
def attractors(found: AttractorSet) -> Figure:
    """Draw the share of the disturbances that end on each attractor, of any rotor.

    An attractor that only starts next to it have reached has no bar.
    """
    figure, drawn = one_axes((TWO_COLUMNS, _EDGES + _ROW * len(found)))
    total = len(found.disturbances)
    looks = looks_of([member.name for member in found], [member.share_of_disturbances for member in found])
    by_row = sorted(looks, key=lambda look: look.index)
    counts = [f"{member.count} of {total}" for member in found]
    share_bars(drawn, by_row, counts, [100.0 * look.share for look in by_row])
    drawn.set_xlabel("share of the disturbances (%)")
    return figure


def _axis(coordinate: Coordinate, scales: Scales | None) -> tuple[float, str]:
    """Return the factor from dimensionless values to those shown, and the label with its unit."""
    factor, unit = coordinate.shown_in(scales)
    return factor, f"{coordinate.words} ({formula(unit)})"


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
def proven_kicks(kicks: ProvenKicks) -> Figure:
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


def _proven(axes: Axes, kicks: ProvenKicks) -> None:
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
        look: Drawn = {"fc": colour, "ec": colour, "lw": 0.2, "gid": "open" if part.open else "proven"}
        axes.add_collection(PolyCollection(cells, **look, rasterized=True, label=_words(part)))


def _words(part: Any) -> str:
    share = f"{number(100.0 * part.share, 3)} %"
    if part.refuted:
        return f"proven to end in the rub: {share}"
    if part.impacts is None:
        return f"open, {share}: {part.reason}"
    if part.impacts == 0:
        return f"proven, no contact: {share}"
    return f"proven, at most {counted(part.impacts, 'impact')}: {share}"


def _outline(edges: np.ndarray) -> np.ndarray:
    """Corners of a cell (n, 2), for a largest kick of 1."""
    slow, fast, first, last = edges
    turn = 2.0 * np.pi * np.linspace(first, last, 2 + int((last - first) / _CHORD))
    return np.hstack([around(turn, np.array(fast)), around(turn[::-1], np.array(slow))]).T


def _frame(axes: Axes, kicks: ProvenKicks) -> None:
    """Draw the circles of what never touches and of what all comes back."""
    factor, unit = display_unit("velocity", kicks.rotor.scales)
    reach = _REACH * factor * kicks.largest
    axes.set_aspect("equal")
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach))
    axes.set(xlabel=f"kick outward ({unit})", ylabel=f"kick in the sense of rotation ({unit})")
    marked = [(kicks.contact_free, (4.0, 2.0), "no contact below")]
    if not kicks.whole and kicks.all_up_to > kicks.contact_free:  # else it says no more
        marked.append((kicks.all_up_to, (1.0, 1.5), "all proven to come back below"))
    for size, dashes, words in marked:
        if 0.0 < size <= kicks.largest:
            label = f"{words} {number(rounded_down(factor * size))} {unit}"
            circle(axes, factor * size, ls=(0.0, dashes), lw=0.8, color=LOOKS["wall"].colour, label=label)
