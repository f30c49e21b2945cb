"""One motion in both frames, side by side: periodic orbits and simulated motions."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.arguments import Count, checked
from carom.outcome import InputError
from carom.plots.bands import bands_on_the_circle, drawing_times, flying
from carom.plots.figure import StyledFigure, narrow
from carom.plots.plane import (
    Frame,
    clearance_circle,
    direction_arrow,
    faded_path,
    impacts,
    key,
    label_frame,
    magnifier,
    one_axes,
    orbit_path,
    path,
    point,
)
from carom.plots.style import LOOKS, ONE_COLUMN, TWO_COLUMNS, styled
from carom.plots.words import counted, ending, orbit_look, orbit_title, time_in_words, turns

if TYPE_CHECKING:
    from carom.motions.trajectories import Trajectory
    from carom.orbits.orbit import Orbit


@checked
@styled
def orbit(orbit: Orbit, periods: Count | None = None, *, axes: tuple[Axes, Axes] | None = None) -> Figure:
    """Draw a periodic orbit in the co-rotating and in the fixed frame.

    In the co-rotating frame the orbit closes after one period.  In the fixed frame it is quasi-periodic unless its
    period is a rational multiple of a turn of the shaft, so several periods are drawn.

    Parameters
    ----------
    orbit : carom.orbits.Orbit
        Orbit to draw.  The parts of a virtual orbit beyond the wall are drawn dotted and pale.
    periods : int, optional
        Number of periods in the fixed frame.  Default: 5 to 16 (fewer for a long period), the number after which the
        pattern comes nearest to closing.
    axes : sequence of two matplotlib.axes.Axes, optional
        For the co-rotating and the fixed frame.
    """
    count = _pattern_length(orbit.period) if periods is None else periods
    figure, (left, right) = _two_frames(axes)
    scales = orbit.rotor.scales
    once = orbit_path(orbit, 1)[1]
    reach = max(1.12, 1.06 * float(np.abs(once).max()))
    for drawn in (left, right):
        clearance_circle(drawn, reach)
    _draw_orbit(left, orbit, "rotating", 1)
    _draw_orbit(right, orbit, "fixed", count)
    label_frame(left, "rotating", scales, f"period $T$ = {time_in_words(orbit.period, scales)}")
    label_frame(right, "fixed", scales, f"{counted(count, 'period')} = {turns(count * orbit.period)}")
    _levitation(left, orbit.rotor.equilibrium)
    inner = magnifier(left, once)
    if inner is not None:
        _draw_orbit(inner, orbit, "rotating", 1)
        _levitation(inner, orbit.rotor.equilibrium)
    if axes is None:
        figure.suptitle(orbit_title(orbit))
        key(figure, (left, right), columns=3)
    return figure


def _draw_orbit(axes: Axes, orbit: Orbit, frame: Frame, periods: int) -> None:
    look = LOOKS[orbit_look(orbit)]
    times, line = orbit_path(orbit, periods)
    # In the fixed frame the position is Z = U e^(it), with the time t in 1/Omega.
    turn = np.exp(1j * times) if frame == "fixed" else np.ones_like(times)
    line = line * turn
    path(axes, line, look, label=f"orbit ({look.words})", width=None if periods == 1 else 0.6)
    direction_arrow(axes, line[times <= orbit.period], look)
    per_period = (len(times) - 1) // periods
    struck = line[per_period::per_period]
    impacts(axes, struck, np.full(len(struck), orbit.angular_speed), size=4.5)
    point(axes, complex(line[0]), "start", size=4.0, label="start, just after an impact")


def _pattern_length(period: float) -> int:
    """Return the number of periods after which the fixed-frame pattern is nearest to closing.

    It is chosen from 5 to 16 periods, which the eye can follow, or from fewer if 8 turns of the shaft contain no more.
    """
    most = int(np.clip(8.0 * math.tau / period, 1, 16))
    counts = np.arange(min(5, most), most + 1)
    gaps = np.abs(np.remainder(counts * period + math.pi, math.tau) - math.pi)
    return int(counts[np.argmin(gaps)])


@checked
@styled
def motion(
    trajectory: Trajectory,
    since: float = 0.0,
    fade: bool = False,
    title: str | None = None,
    *,
    axes: tuple[Axes, Axes] | None = None,
) -> Figure:
    """Draw a simulated motion in the co-rotating and in the fixed frame.

    Parameters
    ----------
    since : float
        Draw only what happens from this time on [1/Omega], to leave out a transient.
    fade : bool
        Draw the beginning pale, to emphasize the motion that it settles to.
    title : str, optional
        Default: number of impacts and outcome in words.
    axes : sequence of two matplotlib.axes.Axes, optional
        For the co-rotating and the fixed frame.

    Raises
    ------
    InputError
        If `since` is not a time of the motion.
    """
    if not 0.0 <= since <= trajectory.time:
        raise InputError("since", since, f"a time from 0 to the end of the motion at {trajectory.time:g}/Omega")
    figure, frames = _two_frames(axes)
    scales = trajectory.rotor.scales
    times = drawing_times(trajectory, since)
    times = np.append(since, times[times > since])
    contacts = trajectory.contacts
    shown = contacts.time >= since
    sides: tuple[tuple[Frame, Axes], ...] = (("rotating", frames[0]), ("fixed", frames[1]))
    for frame, drawn in sides:
        clearance_circle(drawn)
        label_frame(drawn, frame, scales)
        line = trajectory.position(times, frame)
        flight = np.where(flying(trajectory, times), line, complex(np.nan, np.nan))
        (faded_path if fade else path)(drawn, flight, LOOKS["path"])
        direction_arrow(drawn, flight, LOOKS["path"], fraction=0.9)
        bands_on_the_circle(drawn, trajectory, frame, since)
        if shown.any():
            impacts(drawn, trajectory.position(contacts.time[shown], frame), contacts.angular_speed[shown])
        point(drawn, complex(line[0]), "start", size=3.5)
        point(drawn, complex(line[-1]), "end", size=5.5, label=f"end: {ending(trajectory.outcome)}")
    _levitation(frames[0], complex(trajectory.rotor.system.arrays.offsets[trajectory.plane]))
    if axes is None:
        figure.suptitle(title or _motion_title(trajectory))
        key(figure, frames, columns=4)
    return figure


def _motion_title(trajectory: Trajectory) -> str:
    time = time_in_words(trajectory.time, trajectory.rotor.scales)
    return f"{counted(len(trajectory.contacts), 'impact')} in {time} \N{EM DASH} {ending(trajectory.outcome)}"


def _levitation(axes: Axes, equilibrium: complex) -> None:
    """Mark the contact-free equilibrium; hollow if it lies beyond the wall."""
    virtual = abs(equilibrium) > 1.0
    words = LOOKS["contact-free"].words
    point(axes, equilibrium, "contact-free", hollow=virtual, label=f"{words} (virtual)" if virtual else words)


def _two_frames(axes: tuple[Axes, Axes] | None) -> tuple[Figure, tuple[Axes, Axes]]:
    if axes is None:
        if narrow():
            figure = StyledFigure(figsize=(ONE_COLUMN, 2.35 * ONE_COLUMN))
            left, right = figure.subplots(2, 1)
            return figure, (left, right)
        figure = StyledFigure(figsize=(TWO_COLUMNS, 0.58 * TWO_COLUMNS))
        left, right = figure.subplots(1, 2)
        return figure, (left, right)
    left, right = axes
    return one_axes(left, (TWO_COLUMNS, TWO_COLUMNS))[0], (left, right)
