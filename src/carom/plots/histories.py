"""The radius over time: how near to the wall the rotor runs, and when it hits the wall."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import blended_transform_factory
from numpy.typing import ArrayLike, NDArray

from carom.arguments import Count, checked
from carom.outcome import Outcome
from carom.plots.bands import bands_over_time, drawing_times
from carom.plots.figure import narrow
from carom.plots.plane import MANY_POINTS, Floats, finish, marker_size, one_axes, orbit_path, point
from carom.plots.style import LOOKS, ONE_COLUMN, TWO_COLUMNS, ZONE_SHADES, Look, styled
from carom.plots.words import axis_length, axis_time, ending, orbit_look, orbit_title

if TYPE_CHECKING:
    from carom.motions.trajectories import Trajectory
    from carom.orbits.orbit import Orbit
    from carom.parameters import Scales, Zones

_PERIODS = 3
_Conversion = Callable[[ArrayLike], ArrayLike]


@checked
@styled
def radius(
    motion: Trajectory | Orbit,
    zones: Zones | None = None,
    periods: Count = _PERIODS,
    title: str | None = None,
    *,
    axes: Axes | None = None,
) -> Figure:
    """Draw the distance of the rotor centre from the bearing centre over time, with the wall and the impacts.

    If the machine is known, a second pair of axes shows mm and ms.

    Parameters
    ----------
    zones : carom.parameters.Zones, optional
        Vibration zones A to D, drawn as bands behind the curve.
    periods : int
        Number of periods drawn of an orbit.
    title : str, optional
        Default: for an orbit its name and stability in words.
    """
    if hasattr(motion, "path"):
        title = title or orbit_title(cast("Orbit", motion))
    figure, drawn = one_axes(axes, (ONE_COLUMN, ONE_COLUMN) if narrow() else (TWO_COLUMNS, 0.40 * TWO_COLUMNS))
    draw_radius(drawn, motion, zones, periods)
    _second_axes(drawn, motion.rotor.scales)
    return finish(figure, drawn, axes, title, columns=5)


def draw_radius(axes: Axes, motion: Trajectory | Orbit, zones: Zones | None = None, periods: int = _PERIODS) -> None:
    """Draw the same without title, legend and second axes."""
    history = _of_orbit(cast("Orbit", motion), periods) if hasattr(motion, "path") else _of_trajectory(motion)
    scales = motion.rotor.scales
    _set_range(axes, history, zones)
    axes.axhline(1.0, **LOOKS["wall"].stroke, label="wall (touchdown bearing)", gid="wall")
    _curve(axes, history)
    if history.trajectory is not None:
        bands_over_time(axes, history.trajectory)
    _marks(axes, history)
    axes.set_xlabel(axis_time(scales))
    axes.set_ylabel(axis_length("radius", "$r$", scales))
    if zones is not None:
        _bands(axes, zones)


@dataclass(frozen=True)
class _History:
    """The data drawn: radius over time, impact times, and whether each impact was in forward whirl."""

    times: Floats
    radius: Floats
    impacts: Floats
    forward: NDArray[np.bool_]
    look: Look
    words: str
    trajectory: Trajectory | None = None


def _of_orbit(orbit: Orbit, periods: int) -> _History:
    times, position = orbit_path(orbit, periods)
    look = LOOKS[orbit_look(orbit)]
    forward = np.full(periods, orbit.angular_speed > -1.0)
    impacts = orbit.period * np.arange(1.0, periods + 1.0)
    return _History(times, np.abs(position), impacts, forward, look, f"radius ({look.words})")


def _of_trajectory(trajectory: Trajectory) -> _History:
    times = drawing_times(trajectory)
    contacts = trajectory.contacts
    return _History(
        times,
        trajectory.radius(times),
        contacts.time,
        contacts.angular_speed > -1.0,
        LOOKS["path"],
        "radius",
        trajectory,
    )


def _set_range(axes: Axes, history: _History, zones: Zones | None) -> None:
    """Show the range from the bearing centre to just beyond the wall; enlarge a motion that stays near the wall."""
    lowest, highest = float(history.radius.min()), max(1.0, float(history.radius.max()))
    whole = zones is not None or lowest < 0.5 or highest - lowest < 1e-9
    bottom = 0.0 if whole else lowest - 0.12 * (highest - lowest)
    axes.set_ylim(bottom, highest + 0.06 * (highest - bottom))
    # The strip at the right shows the letters of the zones.
    axes.set_xlim(0.0, (float(history.times[-1]) or 1.0) * (1.0 if zones is None else 1.025))


def _curve(axes: Axes, history: _History) -> None:
    outside = history.radius > 1.0 + 1e-9
    beyond = LOOKS["outside"]
    for part, look, words in ((~outside, history.look, history.words), (outside, beyond, beyond.words)):
        if part.any():
            axes.plot(
                history.times,
                np.where(part, history.radius, np.nan),
                **look.stroke | {"lw": max(look.width, 0.7)},
                rasterized=len(history.times) > MANY_POINTS,
                label=words,
                gid="outside" if look is beyond else "path",
            )


def _marks(axes: Axes, history: _History) -> None:
    """Mark impacts on the wall line, and the end of the motion unless only its time was over."""
    size = marker_size(len(history.impacts))
    for meaning, chosen in (("forward", history.forward), ("backward", ~history.forward)):
        if chosen.any():
            point(axes, np.asarray(history.impacts[chosen] + 1j, complex), meaning, size=size, clip=False)
    if history.trajectory is not None and history.trajectory.outcome is not Outcome.TIME_REACHED:
        last = complex(history.times[-1], history.radius[-1])
        point(axes, last, "end", label=f"end: {ending(history.trajectory.outcome)}", clip=False)


def _bands(axes: Axes, zones: Zones) -> None:
    axes.fill_between([], [], color=ZONE_SHADES[-1], lw=0, label="zones A to D")
    bottom, top = axes.get_ylim()
    edges = (bottom, *zones.limits, min(top, 1.0))
    beside = blended_transform_factory(axes.transAxes, axes.transData)
    for low, high, letter, shade in zip(edges[:-1], edges[1:], zones.labels, ZONE_SHADES, strict=True):
        axes.axhspan(low, high, color=shade, lw=0, zorder=0, gid=f"zone {letter}")
        axes.text(0.992, (low + high) / 2.0, letter, transform=beside, ha="right", va="center", fontsize=7)


def _second_axes(axes: Axes, scales: Scales | None) -> None:
    """Add axes with the time in ms and the radius in mm, if the machine is known.

    Near the wall the gap in micrometres is shown instead, because the radii would have many equal digits.
    """
    if scales is None:
        return
    top = axes.secondary_xaxis("top", functions=_linear(1e3 * scales.time))
    top.set_xlabel("time (ms)")
    if axes.get_ylim()[0] > 0.9:
        right = axes.secondary_yaxis("right", functions=_linear(-1e6 * scales.clearance, zero=1.0))
        right.set_ylabel("gap to the wall (\N{GREEK SMALL LETTER MU}m)")
    else:
        right = axes.secondary_yaxis("right", functions=_linear(1e3 * scales.clearance))
        right.set_ylabel("radius (mm)")


def _linear(factor: float, zero: float = 0.0) -> tuple[_Conversion, _Conversion]:
    """Return the conversion ``factor (x - zero)`` to the second axis, and its inverse."""
    return (
        lambda value: np.multiply(np.subtract(value, zero), factor),
        lambda value: np.add(np.divide(value, factor), zero),
    )
