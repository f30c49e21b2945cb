"""One motion in both frames, side by side: periodic orbits and simulated motions."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.base.arguments import Count, checked
from carom.base.outcome import InputError
from carom.plots.bands import bands_on_the_circle, drawing_times, flying
from carom.plots.figure import frames
from carom.plots.plane import (
    Frame,
    clearance_circle,
    direction_arrow,
    impacts,
    key,
    label_frame,
    magnifier,
    orbit_impacts,
    orbit_path,
    path,
    plane_note,
    point,
)
from carom.plots.style import LOOKS, Look, styled
from carom.plots.words import (
    clearance,
    contacts_in_words,
    counted,
    number,
    orbit_look,
    orbit_title,
    time_in_words,
)

if TYPE_CHECKING:
    from carom.motions.trajectories import Trajectory
    from carom.orbits.orbit import Orbit

_TURNS = 8
"""Last turns of the shaft that are drawn of a long motion."""
_LONG = 3.0
"""Ratio of the length of a motion to that of its last turns beyond which the rest is thinned."""
_ONCE: dict[str, Any] = {"marker": ".", "ms": 3.4, "mew": 0.0, "color": "#5d6f87", "zorder": 1.5}


@checked
@styled
def orbit(orbit: Orbit, periods: Count | None = None) -> Figure:
    """Draw a periodic orbit in the co-rotating and in the fixed frame.

    In the co-rotating frame the orbit closes after one period.  In the fixed frame it is quasi-periodic unless its
    period is a rational multiple of a turn of the shaft, so several periods are drawn.  Of a rotor with several contact
    planes the displacement at that of the first impact is drawn, with the impacts there.

    Parameters
    ----------
    orbit : carom.orbits.Orbit
        Orbit to draw.  The parts of a virtual orbit beyond the wall are drawn dotted and pale.
    periods : int, optional
        Number of periods in the fixed frame.  Default: 5 to 16 (fewer for a long period), the number after which the
        pattern comes nearest to closing.
    """
    count = _pattern_length(orbit.period) if periods is None else periods
    figure, (left, right) = frames(2)
    scales = orbit.scales
    wall, once = clearance(scales), orbit_path(orbit, 1)[1]
    reach = max(1.12, 1.06 * float(np.abs(once).max()) / wall)
    for drawn in (left, right):
        clearance_circle(drawn, reach, wall)
    _draw_orbit(left, orbit, "rotating", 1)
    _draw_orbit(right, orbit, "fixed", count)
    label_frame(left, "rotating", scales, plane_note(orbit, f"period $T$ = {time_in_words(orbit.period, scales)}"))
    turns = f"{number(count * orbit.period / math.tau, 3)} turns of the shaft"
    label_frame(right, "fixed", scales, plane_note(orbit, f"{counted(count, 'period')} = {turns}"))
    equilibrium = complex(orbit.rotor.system.arrays.offsets[orbit.leading_plane])
    _levitation(left, equilibrium, wall)
    inner = magnifier(left, once, wall=wall)
    if inner is not None:
        _draw_orbit(inner, orbit, "rotating", 1)
        _levitation(inner, equilibrium, wall)
    return key(figure, (left, right), columns=3, title=orbit_title(orbit))


def _draw_orbit(axes: Axes, orbit: Orbit, frame: Frame, periods: int) -> None:
    look = LOOKS[orbit_look(orbit)]
    times, line = orbit_path(orbit, periods)
    # In the fixed frame the position is Z = U e^(it), with the time t in 1/Omega.
    turn = np.exp(1j * times) if frame == "fixed" else np.ones_like(times)
    line = line * turn
    wall = clearance(orbit.scales)
    path(axes, line, look, label=f"orbit ({look.words})", width=None if periods == 1 else 0.6, wall=wall)
    direction_arrow(axes, line[times <= orbit.period], look)
    impact_times, speeds = orbit_impacts(orbit, periods)
    turned = np.exp(1j * impact_times) if frame == "fixed" else np.ones_like(impact_times)
    impacts(axes, wall * orbit.path(impact_times, orbit.leading_plane) * turned, speeds, size=4.5)
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
def motion(trajectory: Trajectory, since: float = 0.0, title: str | None = None) -> Figure:
    """Draw a simulated motion in the co-rotating and in the fixed frame.

    Of a long motion the last eight turns of the shaft are drawn, and before them the position once a turn.

    Parameters
    ----------
    since : float
        Draw only what happens from this time on [1/Omega], to leave out a transient.
    title : str, optional
        Default: number of impacts and outcome in words.

    Raises
    ------
    InputError
        If `since` is not a time of the motion.
    """
    if not 0.0 <= since <= trajectory.time:
        raise InputError("since", since, f"a time from 0 to the end of the motion at {trajectory.time:g}/Omega")
    figure, both = frames(2)
    long = trajectory.time - since > _LONG * _TURNS * math.tau
    last = trajectory.time - _TURNS * math.tau if long else since
    sides: tuple[tuple[Frame, Axes], ...] = (("rotating", both[0]), ("fixed", both[1]))
    bearing = f"touchdown bearing {trajectory.plane + 1}" if len(trajectory.rotor.system.contacts) > 1 else ""
    for frame, drawn in sides:
        clearance_circle(drawn, wall=clearance(trajectory.scales))
        label_frame(drawn, frame, trajectory.scales, bearing)
        if long:
            places = clearance(trajectory.scales) * trajectory.position(np.arange(since, last, math.tau), frame)
            words = "before: once a turn of the shaft"
            drawn.plot(places.real, places.imag, ls="none", **_ONCE, label=words, gid="once a turn")
        words = f"{LOOKS['path'].words}, last {counted(_TURNS, 'turn')}" if long else LOOKS["path"].words
        _stretch(drawn, trajectory, frame, (last, trajectory.time), replace(LOOKS["path"], words=words))
        bands_on_the_circle(drawn, trajectory, frame, since)
        ends = clearance(trajectory.scales) * trajectory.position(np.array([since, trajectory.time]), frame)
        point(drawn, complex(ends[0]), "start", size=3.5)
        point(drawn, complex(ends[1]), "end", size=5.5, label=f"end: {trajectory.outcome.words}")
    wall = clearance(trajectory.scales)
    _levitation(both[0], complex(trajectory.rotor.system.arrays.offsets[trajectory.plane]), wall)
    title = title or f"{contacts_in_words(trajectory)} \N{EM DASH} {trajectory.outcome.words}"
    return key(figure, both, columns=4, title=title)


def _stretch(axes: Axes, trajectory: Trajectory, frame: Frame, ends: tuple[float, float], look: Look) -> None:
    """Draw the path and the impacts of a stretch of a motion."""
    times = drawing_times(trajectory, *ends)
    times = np.append(ends[0], times[times > ends[0]])
    wall = clearance(trajectory.scales)
    line = wall * trajectory.position(times, frame)
    flight = np.where(flying(trajectory, times), line, complex(np.nan, np.nan))
    path(axes, flight, look, wall=wall)
    direction_arrow(axes, flight, look, fraction=0.9)
    log = trajectory.contacts
    shown = log.is_impact & (log.time >= ends[0]) & (log.time <= ends[1])
    if shown.any():
        impacts(axes, trajectory.position(log.time[shown], frame) * complex(wall), log.angular_speed[shown])


def _levitation(axes: Axes, equilibrium: complex, wall: float) -> None:
    """Mark the contact-free equilibrium, given in clearances; hollow if it lies beyond the wall."""
    virtual = abs(equilibrium) > 1.0
    words = LOOKS["contact-free"].words
    point(axes, wall * equilibrium, "contact-free", hollow=virtual, label=f"{words} (virtual)" if virtual else words)
