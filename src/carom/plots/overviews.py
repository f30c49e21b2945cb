"""All equilibria and periodic orbits of a machine in one picture of the co-rotating frame."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.arguments import Whole, checked
from carom.outcome import InputError
from carom.plots.figure import StyledFigure, narrow
from carom.plots.placement import spread_angles
from carom.plots.plane import (
    Complex,
    clearance_circle,
    direction_arrow,
    finish,
    key,
    label_frame,
    one_axes,
    orbit_path,
    path,
    point,
)
from carom.plots.style import LOOKS, ONE_COLUMN, TWO_COLUMNS, styled
from carom.plots.words import clearance, orbit_look, orbit_symbol

if TYPE_CHECKING:
    from carom.closed_forms.equilibria import Equilibrium, EquilibriumSet
    from carom.orbits.orbit import Orbit
    from carom.orbits.single_impact import OrbitSet
    from carom.studies import Study

_ORDER = {"virtual": 0, "unstable": 1, "stable": 2}
_STATUS = {"admissible": "admissible", "boundary": "on the wall"}
_FARTHEST = 3.0
"""Displacement beyond which an equilibrium is left out of a picture of a contact plane."""
_LABEL_RING, _LABEL_GAP = 1.17, 0.14
"""Radius of the ring around the clearance circle on which the names sit, and the least angle between two [rad]."""


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
    impact.

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
    scales = orbits.rotor.system.scales_at(plane, orbits.rotor.scales)
    wall = clearance(scales)
    size = (ONE_COLUMN, 1.25 * ONE_COLUMN) if narrow() else (0.7 * TWO_COLUMNS, 0.79 * TWO_COLUMNS)
    figure, whole = one_axes(axes, size)
    clearance_circle(whole, 1.36, wall)
    label_frame(whole, "rotating", scales, f"touchdown bearing {plane + 1}" if planes > 1 else "")
    for equilibrium in equilibria:
        _draw_equilibrium(whole, equilibrium, wall * complex(equilibrium.places[plane]))
    _draw_orbits(whole, shown, wall)
    _name(whole, shown, wall)
    return finish(figure, whole, axes, title, columns=2)


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


def _draw_orbits(axes: Axes, shown: Sequence[_Drawn], wall: float) -> None:
    """Draw the paths of orbits, with a mark at the first impact of each and an entry of the legend for each kind."""
    for drawn in shown:
        look = LOOKS["outside" if drawn.meaning == "virtual" else drawn.meaning]
        path(axes, drawn.path, look, label="", wall=wall)
        if drawn.meaning != "virtual":
            direction_arrow(axes, drawn.path, look)
        hollow = drawn.meaning != "stable"
        point(axes, drawn.place, drawn.meaning, hollow=hollow, size=3.2, label="", layer=5.0)
    for meaning in dict.fromkeys(drawn.meaning for drawn in reversed(shown)):
        look, line = LOOKS[meaning], LOOKS["outside" if meaning == "virtual" else meaning]
        axes.plot(
            [],
            [],
            linestyle=line.line,
            color=line.colour,
            lw=line.width,
            marker=look.marker,
            markersize=3.2,
            markerfacecolor=look.colour if meaning == "stable" else "white",
            markeredgecolor=look.colour,
            label=f"periodic orbit: {look.words}",
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


def _name(axes: Axes, shown: Sequence[_Drawn], wall: float) -> None:
    """Write names on a ring around the clearance circle, joined to the impact points by thin lines."""
    angles = spread_angles([np.angle(drawn.place) for drawn in shown], _LABEL_GAP)
    for drawn, angle in zip(shown, angles, strict=True):
        axes.annotate(
            orbit_symbol(drawn.orbit.name),
            xy=(drawn.place.real, drawn.place.imag),
            xytext=(_LABEL_RING * wall * np.cos(angle), _LABEL_RING * wall * np.sin(angle)),
            ha="center",
            va="center",
            fontsize=8,
            color=LOOKS[drawn.meaning].colour,
            bbox={"boxstyle": "square,pad=0.1", "facecolor": "white", "edgecolor": "none"},
            arrowprops={"arrowstyle": "-", "lw": 0.35, "color": "#808080", "shrinkA": 0, "shrinkB": 2},
            annotation_clip=False,
        )
