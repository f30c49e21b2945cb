"""Curves over the time of a film: gap, forces and speeds, as paths of scalable graphics under one cursor."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from carom.motions.courses import Course
from carom.parameters import Scales
from carom.parameters.told import number, shown_in

WIDTH, HEIGHT = 520.0, 112.0
"""Size of the area of a strip, in units of the picture."""
TICKS = (1.0, 2.0, 2.5, 5.0, 10.0)


class Units(NamedTuple):
    """Units of a film: by what to multiply, and the unit."""

    time: tuple[float, str]
    length: tuple[float, str]
    force: tuple[float, str]
    speed: tuple[float, str]
    impulse: tuple[float, str]

    @classmethod
    def of(cls, scales: Scales | None) -> Units:
        """Those of machines: ms, µm, N, m/s; without scales those of the equations."""
        time, length, force, speed, impulse = (
            shown_in(kind, scales) for kind in ("time", "length", "force", "velocity", "impulse")
        )
        if scales is not None:
            length, speed = (1e3 * length[0], "µm"), (scales.velocity, "m/s")
        return cls(time, length, force, speed, impulse)


class Curve(NamedTuple):
    """A curve of a strip: its class, what it is, and the path of a scalable graphic."""

    name: str
    words: str
    path: str


@dataclass(frozen=True)
class Strip:
    """Curves over time.

    Attributes
    ----------
    unit : str
    curves : tuple of Curve
    marks : tuple of (float, str)
        Places of ticks from the top, with their text.
    zero : float
        Place of zero from the top.
    times : tuple of (float, str)
        Places of ticks of the time from the left, with their text.
    """

    unit: str
    curves: tuple[Curve, ...]
    marks: tuple[tuple[float, str], ...]
    zero: float
    times: tuple[tuple[float, str], ...]


def strips_of(course: Course, units: Units) -> tuple[Strip, ...]:
    """Gap with depth, forces or impulses, and slip with the speed of the race over the time of a film."""
    gap = units.length[0] * (1.0 - np.abs(course.place))
    normal, friction, slip = (
        np.where(course.held, values, np.nan)
        for values in (
            units.force[0] * course.force,
            units.force[0] * np.abs(course.friction),
            units.speed[0] * course.slip,
        )
    )
    forces = [("normal", "normal force", normal), ("friction", "friction", friction)]
    speeds = [("friction", "slip", slip)]
    if course.race is not None:
        speeds.append(("race", "surface of the race", units.speed[0] * course.race))
    strips = [
        _strip(
            course,
            units,
            units.length[1],
            [("path", "gap", gap), ("held", "in contact", np.where(course.held, gap, np.nan))],
        ),
        _strip(course, units, units.force[1], forces),
        _strip(course, units, units.speed[1], speeds),
    ]
    if course.blows is not None:
        times, impulses = units.time[0] * course.blows.times, units.impulse[0] * course.blows.impulses
        strips[1] = _stems(course, units, times, impulses)
    return tuple(strips)


def _strip(course: Course, units: Units, unit: str, curves: list[tuple[str, str, np.ndarray]]) -> Strip:
    low = min(0.0, *(float(np.nanmin(values, initial=0.0)) for _, _, values in curves))
    high = max(float(np.nanmax(values, initial=0.0)) for _, _, values in curves) or 1.0
    marks, place = _scale(low, high)
    drawn = tuple(
        Curve(name, words, _path(course.times / course.times[-1], place(values))) for name, words, values in curves
    )
    return Strip(unit, drawn, marks, float(place(np.zeros(1))[0]), _times(course, units))


def _stems(course: Course, units: Units, times: np.ndarray, impulses: np.ndarray) -> Strip:
    """Impulses of impacts on a rigid wall."""
    marks, place = _scale(0.0, float(impulses.max(initial=0.0)) or 1.0)
    ends = zip(WIDTH * times / (units.time[0] * course.times[-1]), place(impulses), strict=True)
    path = "".join(f"M{x:.1f} {HEIGHT:g}V{y:.1f}" for x, y in ends)
    return Strip(
        units.impulse[1], (Curve("normal", "impulse of each impact", path),), marks, HEIGHT, _times(course, units)
    )


def _scale(low: float, high: float) -> tuple[tuple[tuple[float, str], ...], Callable[[np.ndarray], np.ndarray]]:
    """Ticks from a low to a high value, and the function that gives places from the top."""
    step = _step(high - low, 3.0)
    low, high = low - 0.06 * (high - low) * (low < 0.0), high + 0.06 * (high - low)

    def place(values: np.ndarray) -> np.ndarray:
        return HEIGHT * (high - values) / (high - low)

    ticks = step * np.arange(math.ceil(low / step), math.floor(high / step) + 1)
    return tuple((float(place(tick)), number(float(tick)).replace("-", "\N{MINUS SIGN}")) for tick in ticks), place


def _times(course: Course, units: Units) -> tuple[tuple[float, str], ...]:
    end = units.time[0] * float(course.times[-1])
    step = _step(end, 6.0)
    return tuple((WIDTH * tick / end, number(float(tick))) for tick in step * np.arange(math.floor(end / step) + 1))


def _step(span: float, wanted: float) -> float:
    """Step of ticks: a round number, so that about so many fit."""
    rough = span / wanted
    power = 10.0 ** math.floor(math.log10(rough))
    return power * min(TICKS, key=lambda times: abs(times - rough / power))


def _path(shares: np.ndarray, places: np.ndarray) -> str:
    """Path through samples, with gaps where there is no number; of samples closer than half a unit the extremes are kept."""
    columns = np.floor(2.0 * WIDTH * shares).astype(int)
    text, pen = list[str](), "M"
    for column in np.split(np.arange(len(columns)), np.flatnonzero(np.diff(columns)) + 1):
        known = column[np.isfinite(places[column])]
        if not len(known):
            pen = "M"
            continue
        for kept in sorted(
            {int(known[0]), int(known[places[known].argmin()]), int(known[places[known].argmax()]), int(known[-1])}
        ):
            text.append(f"{pen}{WIDTH * shares[kept]:.1f} {places[kept]:.1f}")
            pen = "L"
    return "".join(text)
