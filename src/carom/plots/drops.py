"""A drop on the touchdown bearing: its orbit in the fixed frame, and depth, force, slip and race over time."""

from __future__ import annotations

import cmath
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.arguments import Positive, checked
from carom.outcome import Outcome
from carom.plots.figure import StyledFigure
from carom.plots.plane import MANY_POINTS, Floats, clearance_circle, key, label_frame, point
from carom.plots.style import LOOKS, TWO_COLUMNS, Look, styled
from carom.plots.words import axis_label, axis_time, clearance, told_in

if TYPE_CHECKING:
    from carom.motions.courses import Blows, Course
    from carom.motions.trajectories import Trajectory
    from carom.parameters import Scales

_FIRST = 12
"""Contacts shown in the left column, before the whole drop."""
_SHORT = 0.25
"""Length of the first contacts, over that of the drop, above which they need no column of their own."""
_NEAR = 0.12
"""Distance from the wall, in clearances, up to which the close-up shows the orbit."""
_REACHES = {15.0: 7, 30.0: 5, 60.0: 5, 90.0: 7, 180.0: 5}
"""Angles up to which the close-up may reach, in degrees, with the number of ticks."""
RACE = Look("#009e73", "surface of the race", line="--", width=1.1)
SLIP = Look("#d55e00", "slip of the contact", line="-", width=0.9)


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

    Raises
    ------
    InputError
        No time was followed.
    """
    from carom.motions.courses import FOLLOWED, first_contacts, shown_until

    end = shown_until(motion)
    within = min(end, first_contacts(motion, FOLLOWED)) if until is None else min(until, motion.begins + motion.time)
    course = _course(motion, within)
    figure = StyledFigure(figsize=(TWO_COLUMNS, 0.5 * TWO_COLUMNS))
    left, right = figure.subplots(1, 2)
    wall = clearance(course.scales)
    clearance_circle(left, max(1.12, 1.06 * float(np.abs(course.place).max()) / wall), wall)
    _path(left, course, course.place.real, course.place.imag)
    _arrow(left, course.down, wall)
    label_frame(
        left, "fixed", course.scales, f"the first {FOLLOWED} contacts" if until is None and within < end else ""
    )
    gap, angles = _gap_of(course), np.degrees(np.angle(course.place * cmath.exp(-1j * course.down)))
    # Where it goes over the top the angle jumps.
    jumps = np.append(np.abs(np.diff(angles)) > 180.0, False)
    _path(right, course, np.where(jumps, np.nan, angles), gap)
    _close_to_the_wall(right, course, angles, gap)
    hardest = int(course.force.argmax())
    if course.blows is None and course.force[hardest] > 0.0:
        for axes, where in ((left, course.place), (right, angles + 1j * gap)):
            point(axes, complex(where[hardest]), "end", label="largest force", colour=SLIP.colour)
    point(left, complex(course.place[0]), "start", label="release", size=4.0)
    if title:
        figure.suptitle(title)
    key(figure, (left, right), columns=5)
    return figure


def _course(motion: Trajectory, until: float) -> Course:
    """Sample a drop in the units of figures; speeds in m/s."""
    from carom.motions.courses import course_of

    course = course_of(motion, until)
    scales, blows = course.scales, course.blows
    time, length, force, impulse = (told_in(kind, scales)[0] for kind in ("time", "length", "force", "impulse"))
    speed = 1.0 if scales is None else scales.velocity
    if blows is not None:
        blows = blows._replace(
            times=time * blows.times,
            impulses=impulse * blows.impulses,
            frictions=impulse * blows.frictions,
            slips=speed * blows.slips,
        )
    return replace(
        course,
        times=time * course.times,
        place=length * course.place,
        mount=None if course.mount is None else length * course.mount,
        force=force * course.force,
        friction=force * course.friction,
        slip=speed * course.slip,
        race=None if course.race is None else speed * course.race,
        blows=blows,
        stages=tuple(time * each for each in course.stages),
    )


def _gap_of(course: Course) -> Floats:
    """Distance from the wall, in micrometres or clearances; negative in a wall that gives way."""
    gap: Floats = (clearance(course.scales) - np.abs(course.place)) * _finer(course.scales)
    return gap


def _finer(scales: Scales | None) -> float:
    """Micrometres of a millimetre where the clearance is in mm."""
    return 1.0 if scales is None else 1e3


def _gap_label(scales: Scales | None) -> str:
    return f"gap to the wall ({told_in('length', None)[1] if scales is None else 'µm'})"


def _held(course: Course, values: Floats) -> Floats:
    """Values where the wall presses, with gaps elsewhere."""
    return np.where(course.held, values, np.nan)


def _path(axes: Axes, course: Course, across: Floats, up: Floats) -> None:
    """Draw a path, and over it the parts in contact."""
    many = len(across) > MANY_POINTS
    axes.plot(across, up, **LOOKS["path"].stroke, rasterized=many, label=LOOKS["path"].words, gid="path")
    if course.held.any():
        drawn = {**LOOKS["slide"].stroke, "lw": 1.2, "solid_capstyle": "butt", "zorder": 3}
        axes.plot(_held(course, across), _held(course, up), **drawn, rasterized=many, label="in contact", gid="contact")


def _arrow(axes: Axes, down: float, wall: float) -> None:
    """Show the direction of the fall in the middle of the clearance."""
    tip = 0.32 * wall * cmath.exp(1j * down)
    drawn = {"arrowstyle": "-|>", "color": "#7d6a4f", "lw": 1.2, "mutation_scale": 8}
    axes.annotate("", (tip.real, tip.imag), (0.0, 0.0), arrowprops=drawn, gid="weight")


def _close_to_the_wall(axes: Axes, course: Course, angles: Floats, gap: Floats) -> None:
    """Set the range of the close-up to depths and places of the contacts, and draw the wall."""
    axes.axhline(0.0, **LOOKS["wall"].stroke, gid="wall")
    low, near = float(gap.min()), _NEAR * clearance(course.scales) * _finer(course.scales)
    deep = course.blows is None and low < 0.0
    largest = float(np.abs(angles[gap < near]).max(initial=10.0))
    reach = next(each for each in _REACHES if largest <= each)
    axes.set(
        xlim=(-reach, reach),
        xticks=np.linspace(-reach, reach, _REACHES[reach]),
        ylim=(low - 0.08 * (near - low), near),
        xlabel="angle from the direction of the fall (°)",
        ylabel=_gap_label(course.scales),
        title="close to the wall; below 0: depth" if deep else "close to the wall",
    )


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
        Draw it up to this time from the release, in ``1/Ω``; by default until shortly after it has come to rest or to whirl.

    Raises
    ------
    InputError
        No time was followed.
    """
    from carom.motions.courses import first_contacts, shown_until

    followed = motion.begins + motion.time
    end = shown_until(motion) if until is None else min(until, followed)
    first = first_contacts(motion, _FIRST)
    spans = [end] if first > _SHORT * end else [first, end]
    figure = StyledFigure(figsize=(TWO_COLUMNS, 0.72 * TWO_COLUMNS))
    grid = figure.subplots(3, len(spans), sharex="col", squeeze=False)
    for place, span in enumerate(spans):
        _column(grid[:, place], _course(motion, span), last=place == len(spans) - 1)
    for axes, letter in zip(grid.T.ravel(), "abcdef", strict=False):
        axes.set_title(f"({letter})", loc="left", y=1.0)
    if len(spans) > 1:
        grid[0, 0].set_title("the first contacts", y=1.0)
        grid[0, 1].set_title(_whole(motion, end), y=1.0)
        for axes in grid[:, 1]:
            axes.set_ylabel("")
    if title:
        figure.suptitle(title)
    key(figure, grid.ravel().tolist(), columns=5)
    return figure


def _whole(motion: Trajectory, end: float) -> str:
    """What of a drop is shown up to a time from the release."""
    if end < motion.begins + motion.time:
        return "until it rests or whirls"
    return "as far as it is recorded" if motion.outcome is Outcome.EVENT_LIMIT else "the whole drop"


def _column(panels: np.ndarray, course: Course, *, last: bool) -> None:
    """Draw gap, force and speeds over one time axis."""
    gap, force, speed = panels
    _path(gap, course, course.times, _gap_of(course))
    gap.axhline(0.0, **LOOKS["wall"].stroke, label="wall (touchdown bearing)", gid="wall")
    gap.set_ylabel(_gap_label(course.scales))
    _force(force, course, last=last)
    _speeds(speed, course)
    speed.set(xlim=(0.0, float(course.times[-1])), xlabel=axis_time(course.scales))
    for begins in course.stages:
        for axes in panels:
            axes.axvline(begins, color="#7d6a4f", lw=0.8, ls=":", label="next stage", gid="stage")


def _force(axes: Axes, course: Course, *, last: bool) -> None:
    """Draw the normal force, and impulses on an axis of their own if the wall is rigid."""
    axes.plot(course.times, course.force, color=LOOKS["wall"].colour, lw=0.7, label="normal force", gid="force")
    axes.set_ylim(0.0, 1.08 * float(course.force.max()) or 1.0)
    axes.set_ylabel(axis_label("normal force", "force", course.scales))
    if course.blows is not None and len(course.blows.times):
        _impulses(axes, course.blows, axis_label("impulse", "impulse", course.scales) if last else "")


def _impulses(axes: Axes, blows: Blows, label: str) -> None:
    """Draw impulses as stems, on a separate axis at the right."""
    beside = axes.twinx()
    dots: dict[str, Any] = {"ls": "none", "marker": "o", "ms": 2.2, "color": LOOKS["path"].colour}
    beside.vlines(blows.times, 0.0, blows.impulses, color=LOOKS["path"].colour, lw=0.6)
    beside.plot(blows.times, blows.impulses, **dots)
    beside.set(ylim=(0.0, 1.15 * float(blows.impulses.max())), ylabel=label)
    axes.plot([], [], **dots, label="impulse of an impact (right axis)")


def _speeds(axes: Axes, course: Course) -> None:
    """Draw the slip in contact, or before each impact on a rigid wall, and the speed of the race's surface."""
    slips, race = _held(course, course.slip), np.zeros(1) if course.race is None else course.race
    axes.plot(course.times, slips, **SLIP.stroke, label=SLIP.words, gid="slip")
    tallest = max(float(np.nanmax(slips, initial=0.0)), float(race.max()))
    if course.blows is not None:
        times, slips = course.blows.times, course.blows.slips
        axes.plot(times, slips, "o", ms=2.2, color=SLIP.colour, label="slip before an impact")
        tallest = max(tallest, float(slips.max(initial=0.0)))
    if course.race is not None:
        axes.plot(course.times, race, **RACE.stroke, label=RACE.words, gid="race")
    unit = told_in("velocity", None)[1] if course.scales is None else "m/s"
    axes.set(ylim=(min(0.0, 1.1 * float(race.min())), 1.1 * tallest or 1.0), ylabel=f"speed ({unit})")
