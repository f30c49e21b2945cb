"""One motion in both frames, side by side: periodic orbits, simulated motions, and drops in the fixed frame and close to the wall."""

from __future__ import annotations

import cmath
import math
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from carom.base.arguments import Count, Positive, checked
from carom.base.outcome import InputError
from carom.plots.courses import sampled
from carom.plots.figure import frames
from carom.plots.plane import (
    MANY_POINTS,
    Complex,
    Floats,
    Frame,
    clearance_circle,
    direction_arrow,
    impacts,
    key,
    label_frame,
    magnifier,
    orbit_path,
    path,
    point,
)
from carom.plots.style import LOOKS, Drawn, Look, styled
from carom.plots.words import (
    axis_label,
    axis_time,
    clearance,
    contacts_in_words,
    counted,
    number,
    orbit_look,
    orbit_title,
    time_in_words,
)

if TYPE_CHECKING:
    from carom.motions.courses import Course
    from carom.motions.kinematics import LastingContact
    from carom.motions.trajectories import Trajectory
    from carom.orbits.orbit import Orbit
    from carom.parameters import Scales

_TURNS = 8
"""Last turns of the shaft that are drawn of a long motion."""
_LONG = 3.0
"""Ratio of the length of a motion to that of its last turns beyond which the rest is thinned."""
_ONCE: Drawn = {"marker": ".", "ms": 3.4, "mew": 0.0, "color": "#5d6f87", "zorder": 1.5}


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
    label_frame(left, "rotating", scales, _plane_note(orbit, f"period $T$ = {time_in_words(orbit.period, scales)}"))
    turns = f"{number(count * orbit.period / math.tau, 3)} turns of the shaft"
    label_frame(right, "fixed", scales, _plane_note(orbit, f"{counted(count, 'period')} = {turns}"))
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
    impact_times, speeds = _orbit_impacts(orbit, periods)
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
    wall = clearance(trajectory.scales)
    reach = max(1.12, 1.06 * float(trajectory.radius(trajectory.sample()).max()))
    for frame, drawn in sides:
        clearance_circle(drawn, reach, wall)
        label_frame(drawn, frame, trajectory.scales, bearing)
        if long:
            places = wall * trajectory.position(np.arange(since, last, math.tau), frame)
            words = "before: once a turn of the shaft"
            drawn.plot(places.real, places.imag, ls="none", **_ONCE, label=words, gid="once a turn")
        words = f"{LOOKS['path'].words}, last {counted(_TURNS, 'turn')}" if long else LOOKS["path"].words
        _stretch(drawn, trajectory, frame, (last, trajectory.time), replace(LOOKS["path"], words=words))
        _bands_on_the_circle(drawn, trajectory, frame, since)
        ends = wall * trajectory.position(np.array([since, trajectory.time]), frame)
        point(drawn, complex(ends[0]), "start", size=3.5)
        point(drawn, complex(ends[1]), "end", size=5.5, label=f"end: {trajectory.outcome.words}")
    _levitation(both[0], complex(trajectory.rotor.system.arrays.offsets[trajectory.plane]), wall)
    title = title or f"{contacts_in_words(trajectory)} \N{EM DASH} {trajectory.outcome.words}"
    return key(figure, both, columns=4, title=title)


def _stretch(axes: Axes, trajectory: Trajectory, frame: Frame, ends: tuple[float, float], look: Look) -> None:
    """Draw the path and the impacts of a stretch of a motion."""
    times = _drawing_times(trajectory, *ends)
    times = np.append(ends[0], times[times > ends[0]])
    wall = clearance(trajectory.scales)
    line = wall * trajectory.position(times, frame)
    flight = np.where(_flying(trajectory, times), line, complex(np.nan, np.nan))
    path(axes, flight, look)
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


def _plane_note(orbit: Orbit, note: str = "") -> str:
    """Return a note on a picture of an orbit, which names the contact plane of its first impact if there are several."""
    plane = f"touchdown bearing {orbit.leading_plane + 1}" if len(orbit.rotor.system.contacts) > 1 else ""
    return ", ".join(filter(None, (plane, note)))


def _orbit_impacts(orbit: Orbit, periods: int) -> tuple[Floats, Floats]:
    """Return the times of the impacts after the first one [1/Omega], over whole periods, and the angular speeds just before each."""
    kept = [*range(1, orbit.impacts), 0]
    begins = np.concatenate([[orbit.period], np.cumsum(orbit.durations)[:-1]])[kept]
    times = (orbit.period * np.arange(periods)[:, None] + begins).ravel()
    return np.asarray(times, float), np.tile([orbit.sections[place].angular_speed for place in kept], periods)


_KINDS = ("slide", "roll")


_ARC_STEP = 0.03
"""Angle [rad] between points of a band: its chords deviate from the circle by less than the width of a line."""


_MOST_POINTS = 20_000
"""Largest number of points of a band: it then covers the circle many times, and more points would not be visible."""


def _flying(trajectory: Trajectory, times: Floats) -> np.ndarray:
    """Return which times belong to free flight; the end of a contact does if a flight follows."""
    free = np.ones(times.shape, bool)
    for span in trajectory.lasting_contacts:
        free &= (times < span.start) | ((times >= span.end) & (span.end < trajectory.time))
    return free


def _drawing_times(trajectory: Trajectory, since: float, end: float) -> Floats:
    """Return the times at which a motion is drawn within a stretch: dense in flight, only the two ends of a lasting contact.

    In contact the radius is 1, and :func:`_bands_on_the_circle` draws the rest.
    """
    # Enough points for smooth curves, but few enough for a small file.
    even = np.linspace(since, end, int(np.clip(60.0 * (end - since), 2000, 12000)))
    events = trajectory.segment_starts[1:]
    times = np.unique(np.concatenate([even, events, np.nextafter(events, 0.0)]))
    times = times[(times >= since) & (times <= end)]
    ends = [moment for span in trajectory.lasting_contacts for moment in (span.start, span.end)]
    return times[_flying(trajectory, times) | np.isin(times, ends)]


def _bands_on_the_circle(axes: Axes, trajectory: Trajectory, frame: Frame, since: float = 0.0) -> None:
    """Mark where on the circle the rotor slid or rolled, from a time on."""
    for kind in _KINDS:
        arcs = [
            np.append(_arc(trajectory, span, frame, since), np.nan)
            for span in trajectory.lasting_contacts
            if span.kind == kind and span.end > since
        ]
        if arcs:
            line = clearance(trajectory.scales) * np.concatenate(arcs)
            look = LOOKS[kind].stroke | {"solid_capstyle": "butt", "dash_capstyle": "butt", "zorder": 3}
            axes.plot(line.real, line.imag, **look, label=LOOKS[kind].words, gid=kind)


def _arc(trajectory: Trajectory, span: LastingContact, frame: Frame, since: float) -> Complex:
    start = max(span.start, since)
    position, velocity = trajectory.at_plane(np.linspace(start, span.end, 16))
    # On the wall (radius 1) the angular speed equals the tangential speed; the fixed frame adds the shaft speed, 1.
    fastest = float(np.abs((position.conj() * velocity).imag + (frame == "fixed")).max())
    points = int(np.ceil((span.end - start) * fastest / _ARC_STEP)) + 2
    end = span.end
    if points > _MOST_POINTS:
        points, end = _MOST_POINTS, start + _MOST_POINTS * _ARC_STEP / fastest
    return trajectory.position(np.linspace(start, end, points), frame)


BANDS = 256
"""Colours of a path by time."""
BY_TIME = "viridis"
_NEAR = 0.12
"""Distance from the wall, in clearances, up to which the close-up shows the orbit."""
_REACHES = {15.0: 7, 30.0: 5, 60.0: 5, 90.0: 7, 180.0: 5}
"""Angles up to which the close-up may reach to both sides, in degrees, with the number of ticks."""
_STEP = 15.0
"""Step of the angle around which the close-up is drawn, in degrees."""


@checked
@styled
def drop_orbit(motion: Trajectory, until: Positive | None = None, title: str | None = None) -> Figure:
    """Draw a drop in the fixed frame, and where it touches beside it close to the wall: the gap over the angle from the direction of gravity.

    Parameters
    ----------
    motion : Trajectory
        With all its stages, at its touchdown bearing.
    until : float, optional
        Draw it up to this time from the release, in ``1/Ω``; by default until shortly after it has come to rest or to whirl, but
        not beyond thirty contacts.

    Raises
    ------
    InputError
        No time was followed.
    """
    from carom.motions.courses import FOLLOWED, first_contacts, shown_until

    end = shown_until(motion)
    within = min(end, first_contacts(motion, FOLLOWED)) if until is None else min(until, motion.begins + motion.time)
    course = sampled(motion, within)
    falls = motion.rotor.acting.weight is not None
    if not falls:
        course = replace(course, down=0.0)
    # Without weight impacts lie all around: close to the wall they would be a comb.
    touches = bool(course.held.any()) or (falls and course.impacts is not None and len(course.impacts) > 0)
    figure, (left, *close) = frames(1 + touches)
    wall = clearance(course.scales)
    clearance_circle(left, max(1.12, 1.06 * float(np.abs(course.place).max()) / wall), wall)
    _path_by_time(left, course)
    if falls:
        _arrow(left, course.down, wall)
    label_frame(
        left, "fixed", course.scales, f"the first {FOLLOWED} contacts" if until is None and within < end else ""
    )
    for right in close:
        # In micrometres or clearances; negative in a compliant wall.
        gap = (wall - np.abs(course.place)) * _finer(course.scales)
        middle = _middle(course, gap)
        angles = middle + np.degrees(np.angle(course.place * cmath.exp(-1j * (course.down + np.radians(middle)))))
        # Opposite of the middle the angle jumps.
        jumps = np.append(np.abs(np.diff(angles)) > 180.0, False)
        _path(right, course, np.where(jumps, np.nan, angles), gap)
        _close_to_the_wall(right, course, angles, gap, middle)
        right.set_xlabel(f"angle from the {'direction of gravity' if falls else 'x axis'} (°)")
        hardest = int(course.force.argmax())
        if course.impacts is None:
            for axes, where in ((left, course.place), (right, angles + 1j * gap)):
                point(axes, complex(where[hardest]), "end", label="largest force", colour=LOOKS["unstable"].colour)
    point(left, complex(course.place[0]), "start", label="start", size=4.0)
    return key(figure, (left, *close), columns=5, title=title)


def _near(course: Course) -> float:
    """Largest gap of the close-up."""
    return _NEAR * clearance(course.scales) * _finer(course.scales)


def _middle(course: Course, gap: Floats) -> float:
    """Angle around which the rotor touches, in degrees from the direction of the fall: that direction itself unless it is far away."""
    touching = course.place[course.held] if course.held.any() else course.place[gap < _near(course)]
    mean = np.degrees(np.angle(touching.sum() * cmath.exp(-1j * course.down))) if len(touching) else 0.0
    return 0.0 if abs(mean) < 2.0 * _STEP else _STEP * round(float(mean) / _STEP)


def _finer(scales: Scales | None) -> float:
    """Micrometres of a millimetre where the clearance is in mm."""
    return 1.0 if scales is None else 1e3


def _path(axes: Axes, course: Course, across: Floats, up: Floats) -> None:
    """Draw a path, and over it the parts in contact."""
    many = len(across) > MANY_POINTS
    axes.plot(across, up, **LOOKS["path"].stroke, rasterized=many, label=LOOKS["path"].words, gid="path")
    if course.held.any():
        drawn = {**LOOKS["slide"].stroke, "lw": 1.2, "solid_capstyle": "butt", "zorder": 3}
        held = (np.where(course.held, values, np.nan) for values in (across, up))
        axes.plot(*held, **drawn, rasterized=many, label="in contact", gid="contact")


def _path_by_time(axes: Axes, course: Course) -> None:
    """Draw the path coloured by time, in bands each of which is one line, and a colour bar below."""
    edges = np.linspace(0, len(course.times) - 1, min(BANDS, len(course.times) - 1) + 1).astype(int)
    points = np.column_stack([course.place.real, course.place.imag])
    bands = [points[first : last + 1] for first, last in pairwise(edges)]
    path = LOOKS["path"]
    lines = LineCollection(bands, array=course.times[edges[:-1]], cmap=BY_TIME, lw=1.2 * path.width, gid="path")
    lines.set_rasterized(len(points) > MANY_POINTS)
    axes.add_collection(lines)
    bar = axes.figure.colorbar(lines, ax=axes, location="bottom", pad=0.02, aspect=40, label=axis_time(course.scales))
    bar.outline.set_linewidth(0.5)


def _arrow(axes: Axes, down: float, wall: float) -> None:
    """Show the direction of the fall in the middle of the clearance."""
    tip = 0.32 * wall * cmath.exp(1j * down)
    drawn = {"arrowstyle": "-|>", "color": "#7d6a4f", "lw": 1.2, "mutation_scale": 8}
    axes.annotate("", (tip.real, tip.imag), (0.0, 0.0), arrowprops=drawn, gid="weight")


def _close_to_the_wall(axes: Axes, course: Course, angles: Floats, gap: Floats, middle: float) -> None:
    """Set the range of the close-up to depths and places of the contacts, and draw the wall."""
    axes.axhline(0.0, **LOOKS["wall"].stroke, gid="wall")
    low, near = float(gap.min()), _near(course)
    deep = course.impacts is None and low < 0.0
    largest = float(np.abs(angles[gap < near] - middle).max(initial=10.0))
    reach = next(each for each in _REACHES if largest <= each)
    axes.set(
        xlim=(middle - reach, middle + reach),
        xticks=middle + np.linspace(-reach, reach, _REACHES[reach]),
        ylim=(low - 0.08 * (near - low), near),
        ylabel="gap to the wall (µm)" if course.scales else axis_label("gap to the wall", "length", None),
        title="close to the wall; below 0: depth" if deep else "close to the wall",
    )
