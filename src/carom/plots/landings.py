"""A landing at all touchdown bearings over time: contact force of each, and how fast the shaft and the races turn."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.base.arguments import Positive, checked
from carom.parameters.fields import RPM
from carom.plots.courses import draw_force, mark_stages, sampled
from carom.plots.figure import TWO_COLUMNS, StyledFigure
from carom.plots.plane import key
from carom.plots.style import LOOKS, styled
from carom.plots.words import axis_time

if TYPE_CHECKING:
    from carom.motions.courses import Course
    from carom.motions.trajectories import Trajectory

RACES = (("#009e73", "--"), ("#d55e00", "-."), ("#0072b2", ":"), ("#a52f74", (0, (5, 1, 1, 1, 1, 1))))
"""Colour and line of the race of each touchdown bearing; of more than four the first ones again."""
_PANEL = 0.22
"""Height of a panel over the width of the figure."""


@checked
@styled
def landing(motion: Trajectory, title: str | None = None, *, until: Positive | None = None) -> Figure:
    """Draw the contact force at each touchdown bearing over time, and below the speeds of shaft and races where one of them changes.

    Parameters
    ----------
    motion : Trajectory
        With all its stages.
    until : float, optional
        Draw it up to this time from its beginning, in ``1/Ω``; by default until shortly after it has come to rest or to whirl.

    Raises
    ------
    InputError
        No time was followed.
    """
    from carom.motions.courses import shown_until

    end = min(shown_until(motion) if until is None else until, motion.begins + motion.time)
    courses = [sampled(seen, end) for seen in motion.at_each]
    turning = any(course.race is not None for course in courses) or bool((courses[0].turns != 1.0).any())
    rows = len(courses) + turning
    figure = StyledFigure(figsize=(TWO_COLUMNS, _PANEL * max(2, rows) * TWO_COLUMNS))
    panels = list(figure.subplots(rows, 1, sharex=True, squeeze=False)[:, 0])
    for place, (axes, course) in enumerate(zip(panels, courses, strict=False), start=1):
        draw_force(axes, course, course)
        if len(courses) > 1:
            axes.set_title(f"touchdown bearing {place}", y=1.0)
    if turning:
        _turning(panels[-1], motion, courses)
    for axes in panels:
        mark_stages(axes, courses[0])
        axes.label_outer()
    panels[-1].set(xlim=(0.0, float(courses[0].times[-1])), xlabel=axis_time(courses[0].scales))
    return key(figure, figure.axes, columns=4, title=title)


def _turning(axes: Axes, motion: Trajectory, courses: list[Course]) -> None:
    """Draw speeds of rotation, in rpm or in those of the shaft at the beginning."""
    scales = motion.rotor.scales
    unit = 1.0 if scales is None else scales.speed / RPM
    axes.plot(
        courses[0].times, unit * courses[0].turns, **LOOKS["path"].stroke | {"lw": 1.1}, label="shaft", gid="shaft"
    )
    for place, (course, race) in enumerate(zip(courses, motion.rotor.races, strict=True)):
        if course.race is not None and race is not None:
            # The speed of its surface, at its radius in clearances.
            own = course.race / race.radius / (1.0 if course.scales is None else course.scales.velocity)
            colour, line = RACES[place % len(RACES)]
            words = f"race {place + 1}" if len(courses) > 1 else "race"
            axes.plot(course.times, unit * own, color=colour, ls=line, lw=1.1, label=words, gid=words)
    axes.set(ylim=(min(0.0, axes.get_ylim()[0]), None), ylabel="speed ($\\Omega$)" if scales is None else "speed (rpm)")
