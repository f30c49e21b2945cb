"""Figure 2: periodic motions in both frames and their radius over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.plots.figure import TWO_COLUMNS, StyledFigure
from carom.plots.plane import (
    Complex,
    Floats,
    clearance_circle,
    direction_arrow,
    impacts,
    key,
    magnifier,
    orbit_path,
    path,
    point,
)
from carom.plots.style import LOOKS, styled
from carom.plots.words import clearance, orbit_look, orbit_symbol
from carom.reproductions.mora2014.drawing.panels import letter

if TYPE_CHECKING:
    from carom.orbits.orbit import Orbit
    from carom.reproductions.mora2014.motions import ShownMotion

SHOWN_PERIODS = 3
"""Number of periods for which the radius is drawn."""


@styled
def figure_2(motions: tuple[ShownMotion, ...]) -> Figure:
    """Draw each motion in the fixed frame, in the co-rotating one, and its radius: a row for each motion."""
    figure = StyledFigure(figsize=(TWO_COLUMNS, 1.02 * TWO_COLUMNS))
    rows = figure.subplots(len(motions), 3, width_ratios=(1.0, 1.0, 1.25))
    for (fixed, rotating, radius), motion in zip(rows, motions, strict=True):
        for axes in (fixed, rotating):
            clearance_circle(axes)
        if motion.orbit is None:
            _levitation(fixed, rotating, radius, motion)
            title = motion.words
        else:
            _orbit(fixed, rotating, radius, motion, motion.orbit)
            title = f"{orbit_symbol(motion.orbit.name)}, {motion.words}"
        radius.set_box_aspect(0.8)
        letter(fixed, motion.panel, rf"{title}, $\gamma$ = {motion.gamma:g}")
        fixed.set(xlabel=r"fixed frame, Re $Z$ ($c_\mathrm{r}$)", ylabel=r"Im $Z$ ($c_\mathrm{r}$)")
        rotating.set(xlabel=r"co-rotating frame, Re $U$ ($c_\mathrm{r}$)", ylabel=r"Im $U$ ($c_\mathrm{r}$)")
        radius.set(xlabel=r"time $t$ ($1/\Omega$)", ylabel=r"radius $r$ ($c_\mathrm{r}$)")
    return key(figure, rows.ravel(), columns=3)


def _levitation(fixed: Axes, rotating: Axes, radius: Axes, motion: ShownMotion) -> None:
    """Draw levitation: a point in the co-rotating frame, a circle in the fixed one."""
    look = LOOKS["contact-free"]
    place = motion.rotor.equilibrium
    times = np.linspace(0.0, motion.span, 400)
    line = place * np.exp(1j * times)
    fixed.plot(line.real, line.imag, "-", color=look.colour, lw=1.1)
    direction_arrow(fixed, line[times <= 0.5 * motion.span], look)
    point(rotating, place, "contact-free", size=5.5)
    radius.plot(times, np.full_like(times, abs(place)), "-", color=look.colour, lw=1.1)
    radius.axhline(1.0, **LOOKS["wall"].stroke)
    radius.set(xlim=(0.0, motion.span), ylim=(0.0, 1.08))


def _orbit(fixed: Axes, rotating: Axes, radius: Axes, motion: ShownMotion, orbit: Orbit) -> None:
    """Draw an orbit over about two turns of the shaft in the fixed frame, and over three periods of the radius."""
    look = LOOKS[orbit_look(orbit)]
    words = f"orbit, {look.words}"
    once = _path(orbit, 1)[1]
    inner = magnifier(rotating, once, words="")
    _loop(rotating, orbit, once, arrow=inner is None)
    virtual = abs(orbit.rotor.equilibrium) > 1.0
    words_of_rest = f"{LOOKS['contact-free'].words}, virtual" if virtual else ""
    point(rotating, orbit.rotor.equilibrium, "contact-free", hollow=virtual, label=words_of_rest)
    if inner is not None:
        _loop(inner, orbit, once)
        point(inner, orbit.rotor.equilibrium, "contact-free", label="")
    # A second turn of an orbit that stays near the wall would only fill the gaps between its dashes.
    count = max(1, round(motion.span / orbit.period / (1 if inner is None else 2)))
    times, line = _path(orbit, count)
    line = line * np.exp(1j * times)
    path(fixed, line, look, label=words, wall=1.0)
    direction_arrow(fixed, line[times <= 0.4 * motion.span], look)
    at_impacts = line[:: (len(times) - 1) // count]
    impacts(fixed, at_impacts, np.full(len(at_impacts), orbit.angular_speed), size=4.0)
    times, line = _path(orbit, SHOWN_PERIODS)
    radius.plot(times, np.abs(line), **look.stroke)
    radius.axhline(1.0, **LOOKS["wall"].stroke)
    impact_times = orbit.period * np.arange(SHOWN_PERIODS + 1)
    whirl = "forward" if orbit.angular_speed > -1.0 else "backward"
    point(radius, np.asarray(impact_times + 1j, complex), whirl, size=4.0, label="", clip=False)
    radius.set_xlim(0.0, times[-1])
    depth = 1.0 - float(np.abs(line).min())
    radius.set_ylim(1.0 - 1.12 * depth, 1.0 + 0.12 * depth)


def _path(orbit: Orbit, periods: int) -> tuple[Floats, Complex]:
    """Times and positions of an orbit in the units of the equations, as those of the paper; its machine has SI units too."""
    times, line = orbit_path(orbit, periods)
    return times, line / clearance(orbit.rotor.scales)


def _loop(axes: Axes, orbit: Orbit, once: np.ndarray, arrow: bool = True) -> None:
    look = LOOKS[orbit_look(orbit)]
    path(axes, once, look, label=f"orbit, {look.words}", wall=1.0)
    if arrow:
        direction_arrow(axes, once, look)
    impacts(axes, once[:1], np.array([orbit.angular_speed]), size=4.5)
