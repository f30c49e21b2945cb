"""Motions over time: distance from the centre, contact forces and impulses, speeds of the contact, energies."""

from __future__ import annotations

from dataclasses import replace
from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.base.arguments import Positive, checked
from carom.base.outcome import Outcome
from carom.plots.figure import ONE_COLUMN, TWO_COLUMNS, StyledFigure, narrow
from carom.plots.plane import MANY_POINTS, Floats, impacts, key, one_axes, point, shade_zones
from carom.plots.style import LOOKS, WORKS, ZONE_SHADES, Drawn, Look, styled
from carom.plots.words import axis_label, axis_time, clearance, display_unit, number

if TYPE_CHECKING:
    from carom.disturbances import ShockResponse
    from carom.motions.contacts import ContactLog
    from carom.motions.courses import Course
    from carom.motions.ledger import EnergyLedger
    from carom.motions.trajectories import Trajectory
    from carom.parameters import Scales, Zones

_FIRST = 12
"""Contacts shown in the left column, before the whole motion."""
_SHORT = 0.25
"""Length of the first contacts, over that of the motion, above which they need no column of their own."""
_SEVERAL = 3
"""Number of impacts on a rigid wall from which their impulses and slips have panels."""
_MARGIN = 0.02
"""What is shown before the beginning, over the length of the motion, so that an impact there does not lie on the frame."""
_LARGE = 1e5
"""Size in N and J from which kN and kJ are written."""
_STICKS = 1e-6
"""Slip [c_r Ω] below which a contact rolls."""
_WIDE_RANGE = 50.0
"""Ratio of the largest to the median contact force beyond which the axis is logarithmic."""
_MOST_STAGES = 12
"""Number of stages above which their beginnings are not marked."""
_MOST_MARKED = 300
"""Number of impacts above which they are not marked."""
_DOTS: Drawn = {"ls": "none", "marker": "o", "ms": 2.2, "color": LOOKS["path"].colour}
"""Look of impulses."""
NORMAL = Look("#0072b2", "normal force", line="-", width=0.9)
FRICTION = Look("#cc79a7", "friction, size", line="--", width=1.1)
RACE = Look("#009e73", "surface of the race", line="--", width=1.1)
SLIP = Look("#d55e00", "slip of the contact", line="-", width=0.9)


@checked
@styled
def radius(motion: Trajectory, zones: Zones | None = None) -> Figure:
    """Draw the distance of the rotor centre from the bearing centre over time, with the wall and the impacts.

    Parameters
    ----------
    zones : carom.parameters.Zones, optional
        Vibration zones A to D, drawn as bands behind the curve.
    """
    figure, drawn = one_axes((ONE_COLUMN, ONE_COLUMN) if narrow() else (TWO_COLUMNS, 0.40 * TWO_COLUMNS))
    if motion.begins + motion.time > 0.0:
        _distance(drawn, motion, sampled(motion, motion.begins + motion.time))
    else:
        place = clearance(motion.scales) * np.abs(motion.at_plane(np.zeros(1))[0])
        _curve(drawn, np.zeros(1), place, motion.scales)
        point(drawn, complex(0.0, place[0]), "end", label=f"end: {motion.outcome.words}", clip=False)
    if zones is not None:
        drawn.set_ylim(bottom=0.0)
        _zones(drawn, zones, clearance(motion.scales))
    return key(figure, [drawn], columns=5)


@checked
@styled
def touchdown(
    motion: Trajectory, ledger: EnergyLedger | None = None, title: str | None = None, *, until: Positive | None = None
) -> Figure:
    """Draw a motion with contact over time, with all its stages: distance, force, speeds of the contact, and energies if a ledger is given.

    Of a long motion the first contacts are drawn at the left, and the whole at the right.  On a rigid wall the impulse of each impact is drawn
    beside the force of lasting contact.

    Parameters
    ----------
    until : float, optional
        Draw it up to this time from its beginning, in ``1/Ω``; by default as far as it was followed.

    Raises
    ------
    InputError
        No time was followed.
    """
    from carom.motions.courses import first_contacts, shown_until

    settled, whole = shown_until(motion), motion.begins + motion.time
    end = whole if until is None else min(until, whole)
    first = first_contacts(motion, _FIRST)
    spans = [end] if first > _SHORT * end or narrow() else [first, end]
    courses = [sampled(motion, span) for span in spans]
    impacts, lasts = courses[-1].impacts, bool(courses[-1].held.any())
    several = lasts or (impacts is not None and len(impacts) >= _SEVERAL)
    # An impact or two on a rigid wall would be dots in panels of their own: the legend says how hard they are.
    rows = 3 if several or courses[-1].race is not None else 1
    figure = StyledFigure(figsize=(TWO_COLUMNS, 0.24 * max(2, rows + (ledger is not None)) * TWO_COLUMNS))
    grid = figure.subplots(rows + (ledger is not None), len(spans), sharex="col", sharey="row", squeeze=False)
    for place, course in enumerate(courses):
        panels = list(grid[:, place])
        _distance(panels[0], motion, course)
        if rows > 1:
            draw_force(panels[1], course, courses[-1], last=place == len(spans) - 1)
            _speeds(panels[2], course)
        elif impacts is not None and len(impacts):
            unit = display_unit("impulse", course.scales)[1]
            words = f"impulse at most {number(float(impacts.normal_impulse.max()), 3)} {unit}"
            panels[0].plot([], [], ls="none", label=words, gid="hardest")
        if ledger is not None:
            _energies(panels[-1], ledger)
        margin = _MARGIN * float(course.times[-1])
        panels[-1].set(xlim=(-margin, float(course.times[-1])), xlabel=axis_time(course.scales))
        for axes in panels:
            axes.label_outer()
            mark_stages(axes, course)
    for axes, letter in zip(grid.T.ravel() if grid.size > 1 else (), "abcdefgh", strict=False):
        axes.set_title(f"({letter})", loc="left", y=1.0)
    if len(spans) > 1:
        grid[0, 0].set_title("the first contacts", y=1.0)
        rests = "until it rests or whirls" if end <= settled < whole else "drawn part of the motion"
        grid[0, 1].set_title("the whole motion" if end == whole else rests, y=1.0)
    return key(figure, grid.ravel().tolist(), columns=4, title=title)


def mark_stages(axes: Axes, course: Course) -> None:
    """Mark where later stages begin, unless these are the many steps of a speed that changes."""
    for begins in course.stages if len(course.stages) <= _MOST_STAGES else ():
        axes.axvline(begins, color="#7d6a4f", lw=0.8, ls=":", label="next stage", gid="stage")


@checked
@styled
def energies(ledger: EnergyLedger) -> Figure:
    """Draw the energy of the rotor and the works that change it; circulatory ones, of weight and in a wall where there are any."""
    figure, drawn = one_axes((TWO_COLUMNS, 0.4 * TWO_COLUMNS))
    _energies(drawn, ledger)
    return key(figure, [drawn], columns=3)


def _energies(axes: Axes, ledger: EnergyLedger) -> None:
    scales = ledger.scales
    largest = max(float(np.abs(getattr(ledger, name)).max()) for name in WORKS)
    unit, short = display_unit("energy", scales)
    if scales and unit * largest >= _LARGE:
        unit, short = 1e-3 * unit, f"k{short}"
    times = display_unit("time", scales)[0] * ledger.times
    axes.axhline(0.0, color="#a6a6a6", lw=0.5)
    for name, look in WORKS.items():
        values = getattr(ledger, name)
        if name not in ("circulatory", "forces", "wall_loss") or values.any():
            axes.plot(times, unit * values, **look.stroke, label=look.words)
    axes.set(xlim=(0.0, float(times[-1])), xlabel=axis_time(scales), ylabel=f"energy, work since the start ({short})")


def sampled(motion: Trajectory, until: float) -> Course:
    """Sample a motion in the units of figures; speeds in m/s."""
    from carom.motions.courses import course_of

    course = course_of(motion, until)
    factors = {kind: display_unit(kind, course.scales)[0] for kind in ("time", "length", "force", "impulse")}
    factors["speed"] = 1.0 if course.scales is None else course.scales.velocity

    def shown(part: object, **kinds: str) -> dict[str, Any]:
        known = {name: getattr(part, name) for name in kinds}
        return {name: factors[kinds[name]] * value for name, value in known.items() if value is not None}

    if (impacts := course.impacts) is not None:
        sizes = shown(impacts, time="time", normal_impulse="impulse", friction_impulse="impulse", slip_before="speed")
        impacts = replace(impacts, **sizes)
    places = shown(
        course,
        times="time",
        place="length",
        mount="length",
        force="force",
        friction="force",
        slip="speed",
        race="speed",
    )
    stages = tuple(factors["time"] * each for each in course.stages)
    return replace(course, **places, impacts=impacts, stages=stages)


def _distance(axes: Axes, motion: Trajectory, course: Course) -> None:
    """Draw the distance from the centre with the contacts, and why the motion ends."""
    scales, distance = course.scales, np.abs(course.place)
    _curve(axes, course.times, distance, scales)
    rolls = course.slip <= _STICKS * (1.0 if scales is None else scales.velocity)
    for meaning, those in (("slide", course.held & ~rolls), ("roll", course.held & rolls)):
        if those.any():
            look = {**LOOKS[meaning].stroke, "solid_capstyle": "butt", "dash_capstyle": "butt", "zorder": 3}
            words = LOOKS[meaning].words
            axes.plot(np.where(those, course.times, np.nan), distance, **look, label=words, gid=meaning)
    logs = [(part.begins, part.seen_at(motion.plane).contacts) for part in motion.parts]
    times = display_unit("time", scales)[0] * np.concatenate([begins + log.time for begins, log in logs])
    shown = (times <= course.times[-1]) & np.concatenate([log.is_impact for _, log in logs])
    speeds = np.concatenate([log.angular_speed for _, log in logs])
    if shown.sum() <= _MOST_MARKED:
        impacts(axes, times[shown] + 1j * clearance(scales), speeds[shown], clip=False)
    whole = display_unit("time", scales)[0] * (motion.begins + motion.time)
    if motion.outcome is not Outcome.TIME_REACHED and course.times[-1] >= 0.999 * whole:
        place = complex(course.times[-1], distance[-1])
        point(axes, place, "end", label=f"end: {motion.outcome.words}", clip=False)


def _curve(axes: Axes, times: Floats, distance: Floats, scales: Scales | None) -> None:
    """Draw a distance over time with the wall, from the bearing centre on, or enlarged if it stays near the wall."""
    wall = clearance(scales)
    axes.axhline(wall, **LOOKS["wall"].stroke, label="wall (touchdown bearing)", gid="wall")
    look = LOOKS["path"].stroke | {"lw": 0.7, "rasterized": len(times) > MANY_POINTS}
    axes.plot(times, distance, **look, label="radius", gid="path")
    lowest, highest = float(distance.min()), max(wall, float(distance.max()))
    whole = lowest < 0.5 * wall or highest - lowest < 1e-9 * wall
    bottom = 0.0 if whole else lowest - 0.12 * (highest - lowest)
    end = times[-1] if times[-1] > times[0] else times[0] + 1.0
    axes.set(xlim=(times[0], end), ylim=(bottom, highest + 0.06 * (highest - bottom)))
    axes.set(xlabel=axis_time(scales), ylabel=axis_label("radius $r$", "length", scales))


def _zones(axes: Axes, zones: Zones, wall: float) -> None:
    axes.fill_between([], [], color=ZONE_SHADES[-1], lw=0, label="zones A to D")
    bottom, top = axes.get_ylim()
    shade_zones(axes, (bottom, *(wall * limit for limit in zones.limits), min(top, wall)), zones.labels)


def draw_force(axes: Axes, course: Course, whole: Course, *, last: bool = True) -> None:
    """Draw the forces of contact, and impulses if the wall is rigid: on an axis of their own beside forces, if there are any."""
    impacted = course.impacts is not None and len(course.impacts) > 0
    lasts = bool((whole.held & (whole.force > 0.0)).any())
    if lasts or not impacted:
        _forces(axes, course, whole)
    if course.impacts is not None and impacted:
        label = axis_label("impulse", "impulse", course.scales)
        axes.plot([], [], **_DOTS, label=f"impulse of an impact{' (right axis)' * lasts}")
        _impulses(axes.twinx() if lasts else axes, course.impacts, label if last or not lasts else "")


def _forces(axes: Axes, course: Course, whole: Course) -> None:
    """Draw the forces of contact in the unit that the whole motion needs."""
    large = bool(course.scales) and float(whole.force.max()) >= _LARGE
    factor, unit = 1e-3 if large else 1.0, f"{'k' * large}{display_unit('force', course.scales)[1]}"
    normal = factor * np.where(course.held, course.force, np.nan if course.impacts is not None else 0.0)
    friction = factor * np.where(course.held, np.abs(course.friction), np.nan)
    for values, look in ((normal, NORMAL), (friction, FRICTION)):
        if course.held.any():
            axes.plot(course.times, values, **look.stroke, label=look.words, gid=look.words.split(",")[0])
    held = normal[course.held & (course.force > 0.0)]
    if course.impacts is not None and len(held) and held.max() > _WIDE_RANGE * np.median(held):
        axes.set_yscale("log")
    else:
        axes.set_ylim(0.0, 1.08 * float(np.max(held, initial=0.0)) or 1.0)
    axes.set_ylabel(f"contact force ({unit})")


def _impulses(axes: Axes, impacts: ContactLog, label: str) -> None:
    """Draw impulses as stems."""
    axes.vlines(impacts.time, 0.0, impacts.normal_impulse, color=LOOKS["path"].colour, lw=0.6)
    axes.plot(impacts.time, impacts.normal_impulse, **_DOTS)
    axes.set(ylim=(0.0, 1.15 * float(impacts.normal_impulse.max())), ylabel=label)


def _speeds(axes: Axes, course: Course) -> None:
    """Draw the slip in contact, or before each impact on a rigid wall, and the speed of the race's surface."""
    slips, race = np.where(course.held, course.slip, np.nan), np.zeros(1) if course.race is None else course.race
    if course.held.any():
        axes.plot(course.times, slips, **SLIP.stroke, label=SLIP.words, gid="slip")
    tallest = max(float(np.nanmax(slips, initial=0.0)), float(race.max()))
    if course.impacts is not None and len(course.impacts):
        times, slips = course.impacts.time, np.abs(course.impacts.slip_before)
        axes.plot(times, slips, **_DOTS | {"color": SLIP.colour}, label="slip before an impact")
        tallest = max(tallest, float(slips.max()))
    if course.race is not None:
        axes.plot(course.times, race, **RACE.stroke, label=RACE.words, gid="race")
    unit = display_unit("velocity", None)[1] if course.scales is None else "m/s"
    axes.set(ylim=(min(0.0, 1.1 * float(race.min())), 1.1 * tallest or 1.0), ylabel=f"speed ({unit})")


@checked
@styled
def shock_response(found: ShockResponse) -> Figure:
    """Draw the shock response spectra of the base and of the rotor along both axes of the fixed frame, over the natural frequency."""
    figure, axes = one_axes((TWO_COLUMNS, 0.5 * TWO_COLUMNS))
    scales = found.scales
    factor, unit = (scales.speed / (2.0 * np.pi), "Hz") if scales else (1.0, r"$\Omega$")
    for (name, curve), colour in zip(found.curves, cycle((NORMAL.colour, SLIP.colour, RACE.colour, FRICTION.colour))):
        for along, line, values in zip("xy", ("-", "--"), curve, strict=True):
            if values.any():
                shown = display_unit("acceleration", scales)[0] * values
                axes.plot(factor * found.frequencies, shown, ls=line, color=colour, label=f"{name}, along {along}")
    axes.set(
        xscale="log",
        yscale="log",
        xlabel=f"natural frequency ({unit})",
        ylabel=axis_label(f"largest acceleration, $Q$ = {number(found.quality)}", "acceleration", scales),
    )
    return key(figure, [axes], columns=2)
