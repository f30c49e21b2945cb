"""A landing at all touchdown bearings over time: contact force of each, how fast the shaft and the races turn, temperatures; and a shaft on its way to standstill."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.base.arguments import Positive, checked
from carom.parameters.fields import RPM
from carom.plots.courses import draw_force, mark_stages, sampled
from carom.plots.figure import TWO_COLUMNS, StyledFigure
from carom.plots.plane import key
from carom.plots.style import LOOKS, Drawn, styled
from carom.plots.words import axis_time, display_unit

if TYPE_CHECKING:
    from carom.motions import SpinDown, TouchdownLoads
    from carom.motions.courses import Course
    from carom.motions.trajectories import Trajectory
    from carom.parameters import Scales

SHAFT: Drawn = LOOKS["path"].stroke | {"lw": 1.1}
_RACES = (("#009e73", "--"), ("#d55e00", "-."), ("#0072b2", ":"), ("#a52f74", (0, (5, 1, 1, 1, 1, 1))))
RACES: list[Drawn] = [{"color": colour, "ls": line, "lw": 1.1} for colour, line in _RACES]
"""Look of the race of each touchdown bearing; of more than four the first ones again."""
PARTS_DRAWN = (RACES[1], RACES[0], RACES[2], RACES[3])
"""The same of sleeve, race, balls and outer ring, whose temperatures are drawn."""
_BEARINGS = (("#0072b2", "-"), ("#d55e00", "--"), ("#009e73", "-."), ("#a52f74", ":"))
BEARINGS: list[Drawn] = [{"color": colour, "ls": line, "lw": 1.1} for colour, line in _BEARINGS]
"""Look of each touchdown bearing."""
_PANEL = 0.22
"""Height of a panel over the width of the figure."""


@checked
@styled
def landing(motion: Trajectory, title: str | None = None, *, until: Positive | None = None) -> Figure:
    """Draw the contact force at each touchdown bearing over time, the speeds of shaft and races where one of them changes, and temperatures where they are known.

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
    from carom.motions import drop_loads
    from carom.motions.courses import shown_until

    end = min(shown_until(motion) if until is None else until, motion.begins + motion.time)
    courses = [sampled(seen, end) for seen in motion.at_each]
    turning = any(course.race is not None for course in courses) or bool((courses[0].turns != 1.0).any())
    warm = [each for each in drop_loads(motion).planes if each.temperatures is not None]
    rows = len(courses) + turning + len(warm)
    figure = StyledFigure(figsize=(TWO_COLUMNS, _PANEL * max(2, rows) * TWO_COLUMNS))
    panels = list(figure.subplots(rows, 1, sharex=True, squeeze=False)[:, 0])
    for place, (axes, course) in enumerate(zip(panels, courses, strict=False), start=1):
        draw_force(axes, course, course)
        if len(courses) > 1:
            axes.set_title(f"touchdown bearing {place}", y=1.0)
    if turning:
        _turning(panels[len(courses)], motion, courses)
    for axes, loads in zip(panels[len(courses) + turning :], warm, strict=True):
        _warming(axes, loads)
        if len(courses) > 1:
            axes.set_title(f"touchdown bearing {loads.plane + 1}", y=1.0)
    for axes in panels:
        mark_stages(axes, courses[0])
        axes.label_outer()
    panels[-1].set(xlim=(0.0, float(courses[0].times[-1])), xlabel=axis_time(courses[0].scales))
    return key(figure, figure.axes, columns=4, title=title)


def _warming(axes: Axes, loads: TouchdownLoads) -> None:
    """Draw the temperature of each part of a touchdown bearing."""
    from carom.motions.heating import PARTS

    found = loads.temperatures
    if found is None or loads.scales is None:
        return
    times = found.times / loads.scales.time * display_unit("time", loads.scales)[0]
    for name, values, look in zip(PARTS, found.values.T, PARTS_DRAWN, strict=True):
        axes.plot(times, values, **look, label=name, gid=name)
    axes.set_ylabel("temperature (°C)")


@checked
@styled
def standstill(slowed: SpinDown, title: str | None = None) -> Figure:
    """Draw the speed of a shaft on its way to standstill, with the critical speeds that it passes, and the widest whirl in each step of speed.

    Parameters
    ----------
    slowed : carom.motions.SpinDown
    """
    scales, course = slowed.scales, slowed.course
    unit, label = _rotation(scales)
    figure = StyledFigure(figsize=(TWO_COLUMNS, 2 * _PANEL * TWO_COLUMNS))
    speeds, radii = figure.subplots(2, 1, sharex=True)
    factor, time = display_unit("time", scales)[0], axis_time(scales)
    if scales is not None and scales.time * slowed.time > 10.0:
        factor, time = scales.time, "time $t$ (s)"
    times, end = factor * course[:, 0], factor * slowed.time
    turns = unit * np.array([1.0, *course[:, 1], slowed.speed_at_end])
    speeds.plot([0.0, *times, end], turns, **SHAFT, label="shaft", gid="shaft")
    for critical in slowed.criticals:
        speeds.axhline(unit * critical, color="#7d6a4f", lw=0.8, ls=":", label="critical speed", gid="critical")
    for place, (values, look) in enumerate(zip(course[:, 2:-1].T, cycle(BEARINGS)), start=1):
        radii.plot(times, values, **look, label=f"touchdown bearing {place}", gid=f"radius {place}")
    radii.axhline(1.0, **LOOKS["wall"].stroke, label="wall", gid="wall")
    speeds.set(ylim=(0.0, None), ylabel=label)
    radii.set(ylim=(0.0, None), xlim=(0.0, end), xlabel=time, ylabel="whirl (clearances)")
    return key(figure, (speeds, radii), columns=4, title=title)


def _rotation(scales: Scales | None) -> tuple[float, str]:
    """By what speeds of rotation are multiplied, and their label: in rpm, or in those of the shaft at the beginning."""
    return (1.0, r"speed ($\Omega$)") if scales is None else (scales.speed / RPM, "speed (rpm)")


def _turning(axes: Axes, motion: Trajectory, courses: list[Course]) -> None:
    """Draw speeds of rotation."""
    unit, label = _rotation(motion.rotor.scales)
    axes.plot(courses[0].times, unit * courses[0].turns, **SHAFT, label="shaft", gid="shaft")
    lowest = 0.0
    for place, (course, race) in enumerate(zip(courses, motion.rotor.races, strict=True)):
        if course.race is not None and race is not None:
            # The speed of its surface, at its radius in clearances.
            own = course.race / race.radius / (1.0 if course.scales is None else course.scales.velocity)
            lowest = min(lowest, 1.05 * unit * float(own.min()))
            words = f"race {place + 1}" if len(courses) > 1 else "race"
            axes.plot(course.times, unit * own, **RACES[place % len(RACES)], label=words, gid=words)
    axes.set(ylim=(lowest, None), ylabel=label)
