"""All equilibria and periodic orbits of a machine in one picture of the co-rotating frame, and their multipliers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import cycle
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import SymmetricalLogLocator
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import isotonic_regression  # type: ignore[import-untyped]

from carom.base.arguments import Whole, checked
from carom.base.outcome import InputError
from carom.plots.figure import ONE_COLUMN, TWO_COLUMNS, StyledFigure, narrow
from carom.plots.plane import (
    Complex,
    around,
    circle,
    clearance_circle,
    direction_arrow,
    key,
    label_frame,
    one_axes,
    orbit_path,
    path,
    point,
)
from carom.plots.style import LOOKS, Drawn, styled
from carom.plots.words import clearance, orbit_look, orbit_symbol, orbit_words

if TYPE_CHECKING:
    from carom.closed_forms.equilibria import Equilibrium, EquilibriumSet
    from carom.models import Rotor
    from carom.orbits.orbit import Orbit
    from carom.orbits.simulated import SimulatedOrbit
    from carom.orbits.single_impact import OrbitSet

_STATUS = {"admissible": "admissible", "boundary": "on the wall"}
_FARTHEST = 3.0
"""Displacement beyond which an equilibrium is left out of a picture of a contact plane."""
_LABEL_RING, _LABEL_GAP = 1.17, 0.14
"""Radius of the ring around the clearance circle on which the names sit, and the least angle between two [rad]."""


@checked
@styled
def equilibria_and_orbits(
    orbits: OrbitSet,
    equilibria: Iterable[Equilibrium] = (),
    *,
    plane: Whole = 0,
) -> Figure:
    """Draw all equilibria and periodic orbits of a machine in the co-rotating frame.

    The contact-free point is levitation; the rub points lie on the circle; each orbit touches the circle at its
    impact.

    Parameters
    ----------
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
    wanted = sorted((orbit for orbit in orbits if orbit.admissible), key=lambda orbit: orbit.stable)
    shown = {orbit: orbit_path(orbit, 1, plane)[1] for orbit in wanted}
    size = (ONE_COLUMN, 1.25 * ONE_COLUMN) if narrow() else (0.7 * TWO_COLUMNS, 0.79 * TWO_COLUMNS)
    figure, whole = one_axes(size)
    wall = _draw_equilibria(whole, orbits.rotor, plane, equilibria, 1.36)
    _draw_orbits(whole, shown)
    _name(whole, shown, wall)
    return key(figure, [whole], columns=2)


@checked
def overview(study: Any) -> Figure:
    """Draw :func:`~carom.plots.equilibria_and_orbits` of a study.

    Raises
    ------
    InputError
        The rotor weighs something: in the frame that turns with the shaft its levitation is no point.
    """
    if study.under_gravity:
        allowed = "a rotor without weight; carom.plots.motion and carom.plots.basin draw what one with weight does"
        raise InputError("study", "of a rotor under gravity", allowed)
    points = cast("tuple[Equilibrium, ...]", study.equilibria)
    return equilibria_and_orbits(study.orbits, points)


def _draw_orbits(axes: Axes, shown: Mapping[Orbit, Complex]) -> None:
    """Draw the paths of orbits, with a mark at the first impact of each and an entry of the legend for each kind."""
    for orbit, line in shown.items():
        meaning = orbit_look(orbit)
        look = LOOKS[meaning]
        path(axes, line, look, label="")
        direction_arrow(axes, line, look)
        point(axes, complex(line[0]), meaning, hollow=meaning != "stable", size=3.2, label="")
    for meaning in dict.fromkeys(orbit_look(orbit) for orbit in reversed(list(shown))):
        look = LOOKS[meaning]
        marked = look.mark(3.2) | ({} if meaning == "stable" else {"mfc": "white"}) | look.stroke
        axes.plot([], [], **marked, label=f"periodic orbit: {look.words}")


@checked
@styled
def equilibria(found: EquilibriumSet) -> Figure:
    """Draw the equilibria of any rotor, in the clearance circle of each contact plane.

    Virtual equilibria that lie far outside are left out.
    """
    count = len(found[0].places)
    width, height = (0.7, 0.75) if count == 1 else (1.0, 0.55 if count < 3 else 0.4)
    figure = StyledFigure(figsize=(width * TWO_COLUMNS, height * TWO_COLUMNS))
    panels = figure.subplots(1, count, squeeze=False)[0]
    for plane, drawn in enumerate(panels):
        shown = [entry for entry in found if abs(entry.places[plane]) <= _FARTHEST]
        reach = max(1.12, *(1.06 * abs(entry.places[plane]) for entry in shown)) if shown else 1.12
        _draw_equilibria(drawn, found.rotor, plane, shown, reach)
    return key(figure, panels, columns=2)


def _draw_equilibria(axes: Axes, rotor: Rotor, plane: int, shown: Iterable[Equilibrium], reach: float) -> float:
    """Draw equilibria in a circle: filled if stable and not virtual, hollow otherwise, grey if virtual; return its radius as it is drawn."""
    scales = rotor.system.scales_at(plane, rotor.scales)
    wall = clearance(scales)
    clearance_circle(axes, reach, wall)
    label_frame(axes, "rotating", scales, f"touchdown bearing {plane + 1}" if len(rotor.system.contacts) > 1 else "")
    for each in shown:
        virtual = each.status == "virtual"
        kind = f"{_STATUS[each.status]}, {'stable' if each.stable else 'unstable'}" if not virtual else ""
        point(
            axes,
            wall * complex(each.places[plane]),
            each.kind,
            hollow=virtual or not each.stable,
            size=6.0,
            label=f"{LOOKS[each.kind].words}: {kind or LOOKS['virtual'].words}",
            colour=LOOKS["virtual"].colour if virtual else None,
        )
    return wall


def _name(axes: Axes, shown: Mapping[Orbit, Complex], wall: float) -> None:
    """Write names on a ring around the clearance circle, joined to the impact points by thin lines."""
    angles = spread_angles([np.angle(line[0]) for line in shown.values()], _LABEL_GAP)
    look: Drawn = {
        "bbox": {"boxstyle": "square,pad=0.1", "facecolor": "white", "edgecolor": "none"},
        "arrowprops": {"arrowstyle": "-", "lw": 0.35, "color": "#808080", "shrinkA": 0, "shrinkB": 2},
    }
    look |= {"ha": "center", "va": "center", "fontsize": 8, "annotation_clip": False}
    for (orbit, line), angle in zip(shown.items(), angles, strict=True):
        ends = (line[0].real, line[0].imag), around(angle, _LABEL_RING * wall)
        axes.annotate(orbit_symbol(orbit.name), *ends, **look, color=LOOKS[orbit_look(orbit)].colour)


_SHAPES = ("o", "s", "^", "D", "v", "P", "X", "p", "<", ">", "h", "*")
_LINEAR_UP_TO = 2.0


@checked
@styled
def multipliers(orbits: Iterable[Orbit | SimulatedOrbit]) -> Figure:
    """Draw the non-trivial multipliers of orbits next to the unit circle: one marker shape for each orbit.

    An orbit is stable if all its multipliers lie inside the circle.  A multiplier that leaves it through +1 means a
    fold, through -1 a period doubling, elsewhere a torus.  If the modulus of a multiplier exceeds 2, both axes are logarithmic
    beyond -1 and 1.

    A new figure is 88 mm wide.
    """
    shown = [orbit for orbit in orbits if orbit.admissible]
    columns = 1 if len(shown) <= 4 else 2
    lines = -(-len(shown) // columns)
    figure, drawn = one_axes((ONE_COLUMN, 0.97 * ONE_COLUMN + 0.15 * lines))
    _plane(drawn, max((float(np.abs(orbit.multipliers.values).max()) for orbit in shown), default=1.0))
    for orbit, shape in zip(shown, cycle(_SHAPES), strict=False):
        _markers(drawn, orbit, shape)
    if not shown:
        drawn.plot([], [], linestyle="none", label="no possible periodic orbit")
    return key(figure, [drawn], columns)


def _plane(axes: Axes, largest: float) -> None:
    """Draw the unit circle in a plane that holds the largest modulus; beyond 1 it is logarithmic if that is large."""
    circle(axes, 1.0, color="#1a1a1a", lw=0.9, zorder=1, gid="unit-circle")
    axes.axhline(0.0, color="#c4c4c4", lw=0.35, zorder=0)
    axes.axvline(0.0, color="#c4c4c4", lw=0.35, zorder=0)
    reach = 1.08 * max(1.1, largest)
    note = "no unit"
    if largest > _LINEAR_UP_TO:
        reach, note = 1.3 * largest, "no unit; logarithmic beyond 1"
        axes.set_xscale("symlog", linthresh=1.0)
        axes.set_yscale("symlog", linthresh=1.0)
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(SymmetricalLogLocator(base=10.0, linthresh=1.0))
            axis.set_major_formatter(lambda value, _: f"{value:g}".replace("-", "\N{MINUS SIGN}"))
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    axes.set(xlabel=rf"Re $\lambda$ ({note})", ylabel=rf"Im $\lambda$ ({note})")


def _markers(axes: Axes, orbit: Orbit | SimulatedOrbit, shape: str) -> None:
    meaning, values = orbit_look(orbit), np.asarray(orbit.multipliers.values)
    stable = meaning == "stable"
    look = LOOKS[meaning].mark(4.8, filled=stable) | {"marker": shape, "mew": 0.9, "zorder": 3 if stable else 4}
    axes.plot(values.real, values.imag, **look, label=orbit_words(orbit), gid=orbit.name)


def spread(wanted: ArrayLike, gap: float) -> NDArray[np.float64]:
    """Return positions at least `gap` apart, in the order of the wanted ones and nearest in the least-squares sense.

    With ``y_i = x_i - i gap`` the task is to find the non-decreasing sequence nearest to y: isotonic regression.
    """
    positions = np.asarray(wanted, dtype=float)
    order, offsets = np.argsort(positions, kind="stable"), gap * np.arange(len(positions))
    placed = np.empty_like(positions)
    placed[order] = isotonic_regression(positions[order] - offsets).x + offsets
    return placed


def spread_angles(wanted: ArrayLike, gap: float) -> NDArray[np.float64]:
    """Return the same around a circle [rad]; the circle is cut in the widest gap between labels."""
    angles = np.asarray(wanted, dtype=float)
    if len(angles) < 2:
        return angles.copy()
    turned = np.sort(np.mod(angles, 2.0 * np.pi))
    spaces = np.diff(np.append(turned, turned[0] + 2.0 * np.pi))
    cut = turned[np.argmax(spaces)] + spaces.max() / 2.0
    return spread(np.mod(angles - cut, 2.0 * np.pi), gap) + cut
