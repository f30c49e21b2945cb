"""The radius over time: how near to the wall the rotor runs, and when it hits the wall."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import blended_transform_factory
from numpy.typing import NDArray

from carom.arguments import Count, checked
from carom.outcome import Outcome
from carom.plots.bands import bands_over_time, drawing_times
from carom.plots.figure import StyledFigure, narrow
from carom.plots.plane import MANY_POINTS, Floats, finish, key, marker_size, one_axes, orbit_impacts, orbit_path, point
from carom.plots.style import LOOKS, ONE_COLUMN, TWO_COLUMNS, ZONE_SHADES, Look, styled
from carom.plots.words import axis_label, axis_time, clearance, orbit_look, orbit_title, told_in

if TYPE_CHECKING:
    from carom.motions.trajectories import Trajectory
    from carom.orbits.orbit import Orbit
    from carom.parameters import Scales, Zones

_PERIODS = 3
_LAST = 8
"""Number of last turns of the shaft drawn beside the envelope of a long motion."""
_SEEN = 0.02
"""Range of radii [clearance] from which swings can be seen."""
_COLUMNS, _CROWD = 100, 2
"""Columns of a panel, and number of turning points of the radius in a column from which it would look filled."""
_MOST_STRETCHES = 240
"""Largest number of stretches of time of an envelope."""
_MOST_MARKED = 40
"""Number of impacts above which those of an envelope are not marked."""
_BAND = "#c9d1db"


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

    Of a motion with many swings the band between smallest and largest radius is drawn, in a new figure with its last
    turns of the shaft below.  Near the wall a second axis of a machine in SI units shows the gap in micrometres.

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
    history = history_of(motion, periods)
    size = (ONE_COLUMN, ONE_COLUMN) if narrow() else (TWO_COLUMNS, 0.40 * TWO_COLUMNS)
    last = last_turns(history)
    if axes is not None or last is None:
        figure, drawn = one_axes(axes, size)
        draw_radius(drawn, history, zones)
        _gap_axis(drawn, history)
        return finish(figure, drawn, axes, title, columns=5)
    figure = StyledFigure(figsize=(size[0], 1.7 * size[1]))
    panels = figure.subplots(2, 1)
    for panel, shown in zip(panels, (history, last), strict=True):
        draw_radius(panel, shown, zones)
        _gap_axis(panel, shown)
    if title:
        figure.suptitle(title)
    key(figure, panels, columns=5)
    return figure


def draw_radius(axes: Axes, history: History, zones: Zones | None = None) -> None:
    """Draw the same of a history, without title, legend and second axis."""
    _set_range(axes, history, zones)
    axes.axhline(history.wall, **LOOKS["wall"].stroke, label="wall (touchdown bearing)", gid="wall")
    if history.crowded:
        _envelope(axes, history)
    else:
        _curve(axes, history)
    if history.trajectory is not None:
        bands_over_time(axes, history.trajectory)
    _marks(axes, history)
    axes.set(xlabel=axis_time(history.scales), ylabel=axis_label("radius $r$", "length", history.scales))
    if zones is not None:
        _bands(axes, zones, history.wall)


@dataclass(frozen=True)
class History:
    """The data drawn, in their units: radius over time, impact times, and whether each impact was in forward whirl."""

    times: Floats
    radius: Floats
    impacts: Floats
    forward: NDArray[np.bool_]
    look: Look
    words: str
    scales: Scales | None
    trajectory: Trajectory | None = None

    @property
    def wall(self) -> float:
        """The clearance."""
        return clearance(self.scales)

    @property
    def crowded(self) -> bool:
        """Whether the swings of a motion follow each other so closely that a curve would fill an area, most of the time."""
        if self.trajectory is None:
            return False
        columns = _COLUMNS // 2 if narrow() else _COLUMNS
        held, _ = np.histogram(self._turnings, columns, (self.times[0], self.times[-1]))
        return bool(2 * (held >= _CROWD).sum() >= columns)

    @property
    def stretches(self) -> int:
        """Number of stretches of time of the envelope: at most 240, each with some swings."""
        return int(np.clip(len(self._turnings) // (2 * _CROWD), 1, _MOST_STRETCHES))

    @property
    def _turnings(self) -> Floats:
        rising = np.diff(self.radius) > 0.0
        return self.times[1:-1][rising[1:] != rising[:-1]]


def history_of(motion: Trajectory | Orbit, periods: int = _PERIODS) -> History:
    """Return the data of an orbit over some periods, or of a whole motion."""
    return _of_orbit(cast("Orbit", motion), periods) if hasattr(motion, "path") else _of_trajectory(motion)


def last_turns(history: History) -> History | None:
    """Return the last turns of the shaft of a crowded motion; ``None`` if nothing can be seen in them."""
    trajectory = history.trajectory
    if trajectory is None or not history.crowded:
        return None
    last = _of_trajectory(trajectory, max(0.0, trajectory.time - _LAST * math.tau))
    return last if np.ptp(last.radius) > _SEEN * history.wall else None


def _of_orbit(orbit: Orbit, periods: int) -> History:
    scales = orbit.rotor.scales
    unit = told_in("time", scales)[0]
    times, position = orbit_path(orbit, periods)
    look = LOOKS[orbit_look(orbit)]
    impacts, speeds = orbit_impacts(orbit, periods)
    return History(
        unit * times, np.abs(position), unit * impacts, speeds > -1.0, look, f"radius ({look.words})", scales
    )


def _of_trajectory(trajectory: Trajectory, since: float = 0.0) -> History:
    scales = trajectory.scales
    unit, times, contacts = told_in("time", scales)[0], drawing_times(trajectory, since), trajectory.contacts
    times = np.unique(np.concatenate([[since], times, [trajectory.time]]))  # contact may last over both ends
    shown = contacts.time >= since
    return History(
        unit * times,
        clearance(scales) * trajectory.radius(times),
        unit * contacts.time[shown],
        contacts.angular_speed[shown] > -1.0,
        LOOKS["path"],
        "radius",
        scales,
        trajectory,
    )


def _set_range(axes: Axes, history: History, zones: Zones | None) -> None:
    """Show the range from the bearing centre to just beyond the wall; enlarge a motion that stays near the wall."""
    wall = history.wall
    lowest, highest = float(history.radius.min()), max(wall, float(history.radius.max()))
    whole = zones is not None or lowest < 0.5 * wall or highest - lowest < 1e-9 * wall
    bottom = 0.0 if whole else lowest - 0.12 * (highest - lowest)
    axes.set_ylim(bottom, highest + 0.06 * (highest - bottom))
    start, end = float(history.times[0]), float(history.times[-1])
    # The strip at the right shows the letters of the zones.
    axes.set_xlim(start, start + ((end - start) or 1.0) * (1.0 if zones is None else 1.025))


def _envelope(axes: Axes, history: History) -> None:
    """Draw the band between the smallest and the largest radius within each of many short stretches of time."""
    edges = np.linspace(history.times[0], history.times[-1], history.stretches + 1)
    # With values at the edges no stretch is empty.
    times = np.concatenate([edges, history.times])
    order = np.argsort(times, kind="stable")
    radius = np.concatenate([np.interp(edges, history.times, history.radius), history.radius])[order]
    first = np.searchsorted(times[order], edges[:-1])
    low, high = np.minimum.reduceat(radius, first), np.maximum.reduceat(radius, first)
    middle = 0.5 * (edges[1:] + edges[:-1])
    words = "radius, from smallest to largest"
    axes.fill_between(middle, low, high, color=_BAND, lw=0.0, label=words, gid="envelope")
    for bound in (low, high):
        axes.plot(middle, bound, color=history.look.colour, lw=0.6)


def _curve(axes: Axes, history: History) -> None:
    outside = history.radius > history.wall * (1.0 + 1e-9)
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


def _marks(axes: Axes, history: History) -> None:
    """Mark impacts on the wall line unless they are too many, and the end of the motion unless only its time was over."""
    size = marker_size(len(history.impacts))
    for meaning, chosen in (("forward", history.forward), ("backward", ~history.forward)):
        if chosen.any() and not (history.crowded and len(chosen) > _MOST_MARKED):
            point(
                axes, np.asarray(history.impacts[chosen] + 1j * history.wall, complex), meaning, size=size, clip=False
            )
    if history.trajectory is not None and history.trajectory.outcome is not Outcome.TIME_REACHED:
        last = complex(history.times[-1], history.radius[-1])
        point(axes, last, "end", label=f"end: {history.trajectory.outcome.words}", clip=False)


def _bands(axes: Axes, zones: Zones, wall: float) -> None:
    axes.fill_between([], [], color=ZONE_SHADES[-1], lw=0, label="zones A to D")
    bottom, top = axes.get_ylim()
    edges = (bottom, *(wall * limit for limit in zones.limits), min(top, wall))
    beside = blended_transform_factory(axes.transAxes, axes.transData)
    for low, high, letter, shade in zip(edges[:-1], edges[1:], zones.labels, ZONE_SHADES, strict=True):
        axes.axhspan(low, high, color=shade, lw=0, zorder=0, gid=f"zone {letter}")
        axes.text(0.992, (low + high) / 2.0, letter, transform=beside, ha="right", va="center", fontsize=7)


def _gap_axis(axes: Axes, history: History) -> None:
    """Near the wall of a known machine, show the gap in micrometres: the radii would have many equal digits."""
    if history.scales is None or axes.get_ylim()[0] <= 0.9 * history.wall:
        return
    # From mm to µm and back; the gap is 0 at the wall.
    right = axes.secondary_yaxis(
        "right",
        functions=(
            lambda radius: 1e3 * (history.wall - np.asarray(radius)),
            lambda gap: history.wall - 1e-3 * np.asarray(gap),
        ),
    )
    right.set_ylabel("gap to the wall (\N{GREEK SMALL LETTER MU}m)")
