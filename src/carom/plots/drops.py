"""A drop on the touchdown bearing: its orbit in the fixed frame, and close to the wall."""

from __future__ import annotations

import cmath
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.base.arguments import Positive, checked
from carom.plots.courses import sampled
from carom.plots.figure import frames
from carom.plots.plane import MANY_POINTS, Floats, clearance_circle, key, label_frame, point
from carom.plots.style import LOOKS, styled
from carom.plots.words import axis_label, clearance

if TYPE_CHECKING:
    from carom.motions.courses import Course
    from carom.motions.trajectories import Trajectory
    from carom.parameters import Scales

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
    touches = bool(course.held.any()) or (course.impacts is not None and len(course.impacts) > 0)
    figure, (left, *close) = frames(1 + touches)
    wall = clearance(course.scales)
    clearance_circle(left, max(1.12, 1.06 * float(np.abs(course.place).max()) / wall), wall)
    _path(left, course, course.place.real, course.place.imag)
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
        xlabel="angle from the direction of gravity (°)",
        ylabel="gap to the wall (µm)" if course.scales else axis_label("gap to the wall", "length", None),
        title="close to the wall; below 0: depth" if deep else "close to the wall",
    )
