"""All equilibria and periodic orbits of a machine in one picture of the co-rotating frame."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from carom.arguments import Whole, checked
from carom.outcome import InputError
from carom.plots.closeups import Closeup, closeups
from carom.plots.figure import StyledFigure, narrow
from carom.plots.placement import spread_angles
from carom.plots.plane import (
    Complex,
    clearance_circle,
    direction_arrow,
    finish,
    key,
    label_frame,
    look_closer,
    one_axes,
    orbit_path,
    path,
    point,
)
from carom.plots.style import LOOKS, ONE_COLUMN, TWO_COLUMNS, styled
from carom.plots.words import axis_label, clearance, orbit_look, orbit_symbol

if TYPE_CHECKING:
    from carom.closed_forms.equilibria import Equilibrium, EquilibriumSet
    from carom.orbits.orbit import Orbit
    from carom.orbits.single_impact import OrbitSet
    from carom.parameters import Scales
    from carom.studies import Study

_ORDER = {"virtual": 0, "unstable": 1, "stable": 2}
_STATUS = {"admissible": "admissible", "boundary": "on the wall"}
_MOST_VIRTUAL = 8
"""Number of virtual orbits above which their paths and names are left out, since they would hide the physical ones."""
_FARTHEST = 3.0
"""Displacement beyond which an equilibrium is left out of a picture of a contact plane."""
_LABEL_RING = 1.17
"""Radius of the ring around the clearance circle on which the names sit."""


@dataclass(frozen=True)
class _Drawn:
    """An orbit with its path over one period from its first impact, complex positions in the co-rotating frame as they are drawn."""

    orbit: Orbit
    path: Complex

    @property
    def place(self) -> complex:
        """Where it is at its first impact."""
        return complex(self.path[0])

    @property
    def meaning(self) -> str:
        return orbit_look(self.orbit)


@checked
@styled
def equilibria_and_orbits(
    orbits: OrbitSet,
    equilibria: Iterable[Equilibrium] = (),
    title: str | None = None,
    *,
    virtual: bool = False,
    plane: Whole = 0,
    axes: Axes | None = None,
) -> Figure:
    """Draw all equilibria and periodic orbits of a machine in the co-rotating frame.

    The contact-free point is levitation; the rub points lie on the circle; each orbit touches the circle at its
    impact.  In a new figure, orbits too small to be seen are enlarged in panels of their own.

    Parameters
    ----------
    virtual : bool
        Draw virtual orbits too, pale.
    plane : int
        The contact plane, of a rotor with several.

    Raises
    ------
    InputError
        No such plane.
    """
    planes = len(orbits.rotor.system.contacts)
    if plane >= planes:
        raise InputError("plane", plane, f"a contact plane, from 0 to {planes - 1}")
    wanted = [orbit for orbit in orbits if orbit.admissible or virtual]
    shown = sorted(
        (_Drawn(orbit, orbit_path(orbit, 1, plane)[1]) for orbit in wanted), key=lambda drawn: _ORDER[drawn.meaning]
    )
    physical = [drawn for drawn in shown if drawn.meaning != "virtual"]
    scales = orbits.rotor.system.scales_at(plane, orbits.rotor.scales)
    wall = clearance(scales)
    places = [wall * complex(e.places[plane]) for e in equilibria]
    crowded = closeups([drawn.path for drawn in physical], places, wall) if axes is None else []
    figure, whole, panels = _panels(axes, len(crowded))
    hidden = [physical[i] for closeup in crowded for i in closeup.members]
    clearance_circle(whole, 1.36, wall)
    label_frame(whole, "rotating", scales, f"touchdown bearing {plane + 1}" if planes > 1 else "")
    named = shown if len(shown) - len(physical) <= _MOST_VIRTUAL else physical
    _draw(whole, equilibria, shown, wall, plane, without_arrow=hidden)
    tags = [(f"({letter})", closeup.middle) for letter, closeup in zip("bc", crowded, strict=False)]
    _name(whole, [drawn for drawn in named if drawn not in hidden], _LABEL_RING, wall, gap=0.14, tags=tags)
    for (tag, _), closeup, panel in zip(tags, crowded, panels, strict=True):
        _enlarge(whole, panel, closeup, tag, scales)
        _draw(panel, equilibria, shown, wall, plane)
        half = closeup.half / wall
        _name(panel, [physical[i] for i in closeup.members], 1.0 + 0.33 * half, wall, gap=0.24 * half)
    if panels:
        whole.set_title("(a) co-rotating frame")
    return finish(figure, whole, axes, title, columns=3 if panels else 2)


@checked
def overview(study: Study, title: str | None = None, *, virtual: bool = False) -> Figure:
    """Draw :func:`~carom.plots.equilibria_and_orbits` of a study.

    Raises
    ------
    InputError
        The rotor weighs something: in the frame that turns with the shaft its levitation is no point.
    """
    if study.heavy:
        allowed = "a rotor without weight; carom.plots.motion and carom.plots.basin draw what one with weight does"
        raise InputError("study", "of a rotor under gravity", allowed)
    points = cast("tuple[Equilibrium, ...]", study.equilibria)
    return equilibria_and_orbits(study.orbits, points, title, virtual=virtual)


def _panels(axes: Axes | None, count: int) -> tuple[Figure, Axes, list[Axes]]:
    """Return axes for the whole circle (left) and the close-ups (right): one of the same size, or two stacked."""
    if axes is not None or not count:
        size = (ONE_COLUMN, 1.25 * ONE_COLUMN) if narrow() else (0.7 * TWO_COLUMNS, 0.79 * TWO_COLUMNS)
        figure, whole = one_axes(axes, size)
        return figure, whole, []
    if narrow():
        figure = StyledFigure(figsize=(ONE_COLUMN, 1.85 * ONE_COLUMN))
        grid = figure.add_gridspec(2, count, height_ratios=(1.0, 1.0 / count))
        return figure, figure.add_subplot(grid[0, :]), [figure.add_subplot(grid[1, i]) for i in range(count)]
    figure = StyledFigure(figsize=(TWO_COLUMNS, (0.58 if count == 1 else 0.66) * TWO_COLUMNS))
    grid = figure.add_gridspec(count, 2, width_ratios=(count, 1))
    return figure, figure.add_subplot(grid[:, 0]), [figure.add_subplot(grid[i, 1]) for i in range(count)]


def _draw(
    axes: Axes,
    equilibria: Iterable[Equilibrium],
    shown: Sequence[_Drawn],
    wall: float,
    plane: int,
    without_arrow: Sequence[_Drawn] = (),
) -> None:
    virtual = sum(drawn.meaning == "virtual" for drawn in shown)
    many = virtual > _MOST_VIRTUAL
    for equilibrium in equilibria:
        _draw_equilibrium(axes, equilibrium, wall * complex(equilibrium.places[plane]))
    for drawn in shown:
        look = LOOKS["outside" if drawn.meaning == "virtual" else drawn.meaning]
        if drawn.meaning != "virtual" or not many:
            path(axes, drawn.path, look, label="", wall=wall)
        if drawn.meaning != "virtual" and drawn not in without_arrow:
            direction_arrow(axes, drawn.path, look)
        hollow = drawn.meaning != "stable"
        point(axes, drawn.place, drawn.meaning, hollow=hollow, size=3.2, label="", layer=5.0)
    for meaning in dict.fromkeys(drawn.meaning for drawn in reversed(shown)):
        look, line = LOOKS[meaning], LOOKS["outside" if meaning == "virtual" else meaning]
        note = f" ({virtual}, impacts only)" if meaning == "virtual" and many else ""
        axes.plot(
            [],
            [],
            linestyle="none" if note else line.line,
            color=line.colour,
            lw=line.width,
            marker=look.marker,
            markersize=3.2,
            markerfacecolor=look.colour if meaning == "stable" else "white",
            markeredgecolor=look.colour,
            label=f"periodic orbit: {look.words}{note}",
        )


@checked
@styled
def equilibria(found: EquilibriumSet, title: str | None = None) -> Figure:
    """Draw the equilibria of any rotor, in the clearance circle of each contact plane.

    Virtual equilibria that lie far outside are left out.
    """
    count = len(found[0].places)
    size = (
        (0.7 * TWO_COLUMNS, 0.75 * TWO_COLUMNS)
        if count == 1
        else (TWO_COLUMNS, (0.55 if count < 3 else 0.4) * TWO_COLUMNS)
    )
    figure = StyledFigure(figsize=size)
    panels = figure.subplots(1, count, squeeze=False)[0]
    for plane, drawn in enumerate(panels):
        scales = found.rotor.system.scales_at(plane, found.rotor.scales)
        wall = clearance(scales)
        shown = [entry for entry in found if abs(entry.places[plane]) <= _FARTHEST]
        reach = max(1.12, *(1.06 * abs(entry.places[plane]) for entry in shown)) if shown else 1.12
        clearance_circle(drawn, reach, wall)
        for entry in shown:
            _draw_equilibrium(drawn, entry, wall * complex(entry.places[plane]))
        label_frame(drawn, "rotating", scales, f"touchdown bearing {plane + 1}" if count > 1 else "")
    if title:
        figure.suptitle(title)
    key(figure, panels, columns=2)
    return figure


def _draw_equilibrium(axes: Axes, equilibrium: Equilibrium, place: complex) -> None:
    """Draw it filled if it can be observed (stable and not virtual), hollow otherwise, grey if virtual."""
    virtual = equilibrium.status == "virtual"
    kind = "stable" if equilibrium.stable else "unstable"
    state = LOOKS["virtual"].words if virtual else f"{_STATUS[equilibrium.status]}, {kind}"
    point(
        axes,
        place,
        equilibrium.kind,
        hollow=virtual or not equilibrium.stable,
        size=6.0,
        label=f"{LOOKS[equilibrium.kind].words}: {state}",
        colour=LOOKS["virtual"].colour if virtual else None,
    )


def _enlarge(whole: Axes, panel: Axes, closeup: Closeup, tag: str, scales: Scales | None) -> None:
    """Frame the panel around its close-up and mark the same square in the whole circle."""
    middle, half = closeup.middle, closeup.half
    look_closer(panel, middle, half, clearance(scales))
    panel.locator_params(nbins=4)
    panel.set_title(f"{tag} enlarged")
    panel.set(xlabel=axis_label("Re $U$", "length", scales), ylabel=axis_label("Im $U$", "length", scales))
    corner = (middle.real - half, middle.imag - half)
    square = Rectangle(corner, 2.0 * half, 2.0 * half, fill=False, edgecolor="#808080", lw=0.4, zorder=6, gid="square")
    whole.add_patch(square)


def _name(
    axes: Axes,
    shown: Sequence[_Drawn],
    ring: float,
    wall: float,
    gap: float,
    tags: Sequence[tuple[str, complex]] = (),
) -> None:
    """Write names on a ring around the clearance circle, joined to the impact points by thin lines.

    The radius of the ring is in clearances.
    """
    labels = [(orbit_symbol(d.orbit.name), d.place, LOOKS[d.meaning].colour) for d in shown]
    labels += [(tag, middle, "#1a1a1a") for tag, middle in tags]
    angles = spread_angles([np.angle(anchor) for _, anchor, _ in labels], gap)
    for (text, anchor, colour), angle in zip(labels, angles, strict=True):
        axes.annotate(
            text,
            xy=(anchor.real, anchor.imag),
            xytext=(ring * wall * np.cos(angle), ring * wall * np.sin(angle)),
            ha="center",
            va="center",
            fontsize=8,
            color=colour,
            bbox={"boxstyle": "square,pad=0.1", "facecolor": "white", "edgecolor": "none"},
            arrowprops={"arrowstyle": "-", "lw": 0.35, "color": "#808080", "shrinkA": 0, "shrinkB": 2},
            annotation_clip=False,
        )
