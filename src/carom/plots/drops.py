"""A drop on the touchdown bearing: its orbit in the fixed frame, and depth, force, slip and race over time."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from carom.arguments import Positive, checked
from carom.models.weight import direction_of_fall
from carom.motions.contacts import presses, race_speed, yields
from carom.motions.bearing_loads import drop_loads as evaluated
from carom.motions.trajectories import Trajectory
from carom.outcome import InputError
from carom.parameters import Scales
from carom.plots.figure import StyledFigure
from carom.plots.plane import MANY_POINTS, Floats, clearance_circle, key, label_frame, point
from carom.plots.style import LOOKS, TWO_COLUMNS, Look, styled
from carom.plots.words import axis_label, axis_time, clearance, told_in

_EVEN = 6000
"""Samples at equal distances in time; the events of a motion are drawn beside them."""
_FIRST = 12
"""Contacts shown in the left column, before the whole drop."""
_FOLLOWED = 30
"""Contacts shown in the orbit, which more would cover."""
_SHORT = 0.25
"""Length of the first contacts, over that of the drop, above which they need no column of their own."""
_LATER = 1.15
"""Time up to which a drop is drawn, over that at which the rotor rests or whirls."""
_NEAR = 0.12
"""Distance from the wall, in clearances, up to which the close-up shows the orbit."""
RACE = Look("#009e73", "surface of the race", line="--", width=1.1)
SLIP = Look("#d55e00", "slip of the contact", line="-", width=0.9)
FORCE = LOOKS["wall"]


@dataclass(frozen=True)
class Course:
    """A drop at one plane from the release on, in the units of figures: times, places in the fixed frame, force, slip and race speed."""

    times: Floats
    place: NDArray[np.complex128]
    force: Floats
    slip: Floats
    race: Floats | None
    held: NDArray[np.bool_]
    down: float
    scales: Scales | None

    @property
    def gap(self) -> Floats:
        """Distance from the wall, in micrometres or clearances; negative in a wall that gives way."""
        return (clearance(self.scales) - np.abs(self.place)) * (1.0 if self.scales is None else 1e3)

    @property
    def from_below(self) -> Floats:
        """Angle from the direction of the fall, in degrees, −180 … 180."""
        turned = self.place * cmath.exp(-1j * self.down)
        return np.degrees(np.angle(turned))

    def contact(self, values: Floats) -> Floats:
        """Values where the wall presses, with gaps elsewhere."""
        return np.where(self.held, values, np.nan)


def course_of(motion: Trajectory, until: float) -> Course:
    """Sample all stages of a motion up to a time from the release, in ``1/Ω``."""
    scales, columns = motion.rotor.scales, list[tuple[Any, ...]]()
    for part in (each.seen_at(motion.plane) for each in motion.parts):
        end = min(part.time, until - part.begins)
        if end <= 0.0:
            break
        system, events = part.rotor.system, part.segment_starts[part.segment_starts <= end]
        even = np.linspace(0.0, end, max(2, int(_EVEN * end / until)))
        peaks = part.touches.peak_time if yields(system, part.plane) else np.zeros(0)
        times = np.unique(np.concatenate([even, events, np.nextafter(events[1:], 0.0), peaks[peaks <= end]]))
        amplitudes, phases = part.amplitudes_at(times)
        history = part.history(times)
        place = (1.0 - history.gap) * np.exp(1j * (history.angle + part.begins + times))
        race = race_speed(system, part.plane, amplitudes)
        held = presses(phases[:, part.plane])
        columns.append((part.begins + times, place, history.normal_force, np.abs(history.slip), race, held))
    times, place, force, slip, race, held = (np.concatenate(each) for each in zip(*columns, strict=True))
    units = {kind: told_in(kind, scales)[0] for kind in ("time", "length", "force")}
    drawn: NDArray[np.complex128] = place.astype(np.complex128) * units["length"]
    surface = 1.0 if scales is None else scales.velocity
    turns = motion.rotor.system.arrays.race[motion.plane] >= 0
    return Course(
        units["time"] * times,
        drawn,
        units["force"] * force,
        surface * slip,
        surface * race if turns else None,
        held,
        direction_of_fall(motion.rotor),
        scales,
    )


def _shown(motion: Trajectory, until: float | None) -> float:
    """Time up to which a drop is drawn, in ``1/Ω``."""
    whole = motion.begins + motion.time
    if whole == 0.0:
        raise InputError("motion", "no time followed", "a motion that lasts: give until")
    if until is not None:
        return min(until, whole)
    settled = evaluated(motion).settled_at
    return whole if settled is None else min(whole, max(_LATER * settled, settled + 4.0 * math.tau))


@checked
@styled
def drop_orbit(motion: Trajectory, until: Positive | None = None, title: str | None = None) -> Figure:
    """Draw a drop at its plane in the fixed frame, and beside it close to the wall: the gap over the angle from the direction of the fall.

    Parameters
    ----------
    motion : Trajectory
        With all its stages.
    until : float, optional
        Draw it up to this time from the release, in ``1/Ω``; by default until shortly after it has come to rest or to whirl, but
        not beyond thirty contacts.
    """
    end = _shown(motion, until)
    within = end if until is not None else _first(motion, end, _FOLLOWED)
    course = course_of(motion, within)
    figure = StyledFigure(figsize=(TWO_COLUMNS, 0.5 * TWO_COLUMNS))
    left, right = figure.subplots(1, 2)
    wall = clearance(course.scales)
    clearance_circle(left, max(1.12, 1.06 * float(np.abs(course.place).max()) / wall), wall)
    _path(left, course, course.place.real, course.place.imag)
    _arrow(left, course.down, wall)
    note = f"the first {_FOLLOWED} contacts" if within < end and until is None else ""
    label_frame(left, "fixed", course.scales, note)
    # Where it goes over the top the angle jumps.
    angles = course.from_below
    jumps = np.append(np.abs(np.diff(angles)) > 180.0, False)
    _path(right, course, np.where(jumps, np.nan, angles), course.gap)
    right.axhline(0.0, **LOOKS["wall"].stroke, gid="wall")
    low, near = float(course.gap.min()), _NEAR * wall * (1.0 if course.scales is None else 1e3)
    room = 0.08 * (near - low)
    right.set(
        ylim=(low - room, near),
        xlabel="angle from the direction of the fall (°)",
        ylabel=f"gap to the wall ({told_in('length', None)[1] if course.scales is None else 'µm'})",
        title="close to the wall; below 0: depth" if low < -1e-6 else "close to the wall",
    )
    _angle_range(right, angles[course.gap < near])
    for axes in (left, right):
        hardest = int(course.force.argmax())
        if course.force[hardest] > 0.0 and yields(motion.rotor.system, motion.plane):
            where = course.place if axes is left else angles + 1j * course.gap
            point(axes, complex(where[hardest]), "end", label="largest force", colour=SLIP.colour)
    point(left, complex(course.place[0]), "start", label="release", size=4.0)
    if title:
        figure.suptitle(title)
    key(figure, (left, right), columns=5)
    return figure


def _angle_range(axes: Axes, angles: Floats) -> None:
    """Show all angles, or those around the bottom if no others occur; with ticks at whole parts of a turn."""
    largest = float(np.abs(angles).max(initial=10.0))
    reach = next((each for each in (15.0, 30.0, 60.0, 90.0) if largest <= each), 180.0)
    axes.set(xlim=(-reach, reach), xticks=np.linspace(-reach, reach, 7 if reach in (15.0, 90.0) else 5))


def _path(axes: Axes, course: Course, across: Floats, up: Floats) -> None:
    """Draw a path, and over it the parts in contact."""
    many = len(across) > MANY_POINTS
    axes.plot(across, up, **LOOKS["path"].stroke, rasterized=many, label=LOOKS["path"].words, gid="path")
    if course.held.any():
        look = LOOKS["slide"]
        drawn = {**look.stroke, "lw": 1.2, "solid_capstyle": "butt", "zorder": 3}
        axes.plot(
            course.contact(across), course.contact(up), **drawn, rasterized=many, label="in contact", gid="contact"
        )


def _arrow(axes: Axes, down: float, wall: float) -> None:
    """Show the direction of the fall in the middle of the clearance."""
    tip = 0.32 * wall * cmath.exp(1j * down)
    drawn = {"arrowstyle": "-|>", "color": "#7d6a4f", "lw": 1.2, "mutation_scale": 8}
    axes.annotate("", (tip.real, tip.imag), (0.0, 0.0), arrowprops=drawn, gid="weight")


@checked
@styled
def drop_loads(motion: Trajectory, until: Positive | None = None, title: str | None = None) -> Figure:
    """Draw a drop over time: gap to the wall, normal force, and slip with the speed of the race's surface.

    Of a long drop the first contacts are drawn at the left, and the whole at the right.  On a rigid wall the impulse of each impact is drawn
    in place of its force, which has no size there.

    Parameters
    ----------
    motion : Trajectory
        With all its stages.
    until : float, optional
        As for :func:`drop_orbit`.
    """
    end = _shown(motion, until)
    whole, unit = course_of(motion, end), told_in("time", motion.rotor.scales)[0]
    blows = _blows(motion)
    first = unit * _first(motion, end, _FIRST)
    courses = [whole] if first > _SHORT * unit * end else [course_of(motion, first / unit), whole]
    figure = StyledFigure(figsize=(TWO_COLUMNS, 0.72 * TWO_COLUMNS))
    grid = figure.subplots(3, len(courses), sharex="col", squeeze=False)
    impulses: list[Axes] = []
    for place, course in enumerate(courses):
        gap, force, speed = grid[:, place]
        _gap(gap, course)
        impulses += _force(force, course, blows, lasts=place == len(courses) - 1)
        _speeds(speed, course, blows)
        speed.set(xlim=(0.0, float(course.times[-1])), xlabel=axis_time(course.scales))
        for each in motion.parts[1:]:
            for axes in grid[:, place]:
                axes.axvline(unit * each.begins, color="#7d6a4f", lw=0.8, ls=":", label="next stage", gid="stage")
    for axes, letter in zip(grid.T.ravel(), "abcdef", strict=False):
        axes.set_title(f"({letter})", loc="left", y=1.0)
    if len(courses) > 1:
        grid[0, 0].set_title("the first contacts", y=1.0)
        grid[0, 1].set_title(
            "until it rests or whirls" if end < motion.begins + motion.time else "the whole drop", y=1.0
        )
        for axes in grid[:, 1]:
            axes.set_ylabel("")
    if title:
        figure.suptitle(title)
    key(figure, grid.ravel().tolist(), columns=5)
    return figure


def _first(motion: Trajectory, end: float, number: int) -> float:
    """Time within which so many first contacts lie, from the release, in ``1/Ω``."""
    times = [
        part.begins + (part.touches.end if yields(part.rotor.system, part.plane) else part.contacts.time)
        for part in motion.parts
    ]
    every = np.concatenate(times)
    return min(end, float(np.sort(every)[number - 1]) * 1.02) if len(every) >= number else end


def _blows(motion: Trajectory) -> tuple[Floats, Floats, Floats] | None:
    """Times, impulses and slips before the impacts on a rigid wall, in the units of figures; ``None`` if the wall gives way."""
    if yields(motion.rotor.system, motion.plane):
        return None
    scales = motion.rotor.scales
    times = np.concatenate([part.begins + part.contacts.time for part in motion.parts])
    impulses = np.concatenate([part.contacts.normal_impulse for part in motion.parts])
    slips = np.concatenate([np.abs(part.contacts.slip_before) for part in motion.parts])
    factors = told_in("time", scales)[0], told_in("impulse", scales)[0], 1.0 if scales is None else scales.velocity
    return factors[0] * times, factors[1] * impulses, factors[2] * slips


def _gap(axes: Axes, course: Course) -> None:
    """Draw the gap to the wall; depth has room below it."""
    _path(axes, course, course.times, course.gap)
    axes.axhline(0.0, **LOOKS["wall"].stroke, label="wall (touchdown bearing)", gid="wall")
    axes.set_ylabel(f"gap to the wall ({told_in('length', None)[1] if course.scales is None else 'µm'})")


def _force(axes: Axes, course: Course, blows: tuple[Floats, Floats, Floats] | None, *, lasts: bool) -> list[Axes]:
    """Draw the normal force, and impulses on an axis of their own if the wall is rigid; return that axis."""
    axes.plot(course.times, course.force, color=FORCE.colour, lw=0.7, label="normal force", gid="force")
    axes.set(
        ylim=(0.0, 1.08 * float(course.force.max()) or 1.0), ylabel=axis_label("normal force", "force", course.scales)
    )
    if blows is None:
        return []
    times, impulses, _ = blows
    shown = times <= course.times[-1]
    if not shown.any():
        return []
    beside = axes.twinx()
    beside.vlines(times[shown], 0.0, impulses[shown], color=LOOKS["path"].colour, lw=0.6)
    beside.plot(times[shown], impulses[shown], "o", ms=2.2, color=LOOKS["path"].colour)
    axes.plot([], [], "o", ms=2.2, color=LOOKS["path"].colour, label="impulse of an impact (right axis)")
    beside.set_ylim(0.0, 1.15 * float(impulses.max()))
    if lasts:
        beside.set_ylabel(axis_label("impulse", "impulse", course.scales))
    return [beside]


def _speeds(axes: Axes, course: Course, blows: tuple[Floats, Floats, Floats] | None) -> None:
    """Draw the slip in contact, or before each impact on a rigid wall, and the speed of the race's surface."""
    slips = course.contact(course.slip)
    axes.plot(course.times, slips, **SLIP.stroke, label=SLIP.words, gid="slip")
    if blows is not None:
        shown = blows[0] <= course.times[-1]
        axes.plot(blows[0][shown], blows[2][shown], "o", ms=2.2, color=SLIP.colour, label="slip before an impact")
    race = np.zeros(1) if course.race is None else course.race
    if course.race is not None:
        axes.plot(course.times, race, **RACE.stroke, label=RACE.words, gid="race")
    unit = told_in("velocity", None)[1] if course.scales is None else "m/s"
    tallest = max(float(np.nanmax(slips, initial=0.0)), float(race.max()), *(blows[2].tolist() if blows else ()))
    axes.set(ylim=(min(0.0, 1.1 * float(race.min())), 1.1 * tallest or 1.0), ylabel=f"speed ({unit})")
