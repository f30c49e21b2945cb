"""Which motions exist where, as bars along a parameter: the panel below a bifurcation diagram."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from carom.base.outcome import STEADY_WORDS, Outcome
from carom.plots.style import LOOKS, OUTCOMES

if TYPE_CHECKING:
    from carom.bifurcations import Bifurcation, Diagram, OrbitBranch

Interval = tuple[float, float]

LEVITATION, RUB, ROLLING = STEADY_WORDS.values()
BOUNCING = Outcome.BOUNCING.words
_COLOURS = {
    LEVITATION: OUTCOMES["levitated"].colour,
    RUB: OUTCOMES["forward-rub"].colour,
    BOUNCING: OUTCOMES["bouncing"].colour,
    ROLLING: OUTCOMES["rolling"].colour,
}
_THICK = 4.5


def rows_of(diagram: Diagram) -> list[str]:
    """Return the rows that are not empty."""
    return [row for row, ranges in _ranges(diagram).items() if any(ranges)]


def row_of_point(point: Bifurcation) -> str | None:
    """Return the row in which a special point is marked; ``None`` if it belongs to an orbit."""
    return {"contact-free": LEVITATION, "rub": RUB, "rolling": ROLLING}.get(point.motion)


def coexistence(axes: Axes, diagram: Diagram, unit: float) -> None:
    """Draw a bar over the range of every motion: broad where it is stable, a thin dashed line where it is unstable.

    `unit` is the divisor of the parameter.
    """
    rows = rows_of(diagram)
    heights = {row: float(len(rows) - place) for place, row in enumerate(rows)}
    for row, (stable, unstable) in _ranges(diagram).items():
        bar = {"color": _COLOURS[row], "lw": _THICK, "solid_capstyle": "butt"}
        for intervals, look in ((unstable, LOOKS["unstable"].stroke | {"zorder": 1.5}), (stable, bar)):
            for low, high in _joined(intervals):
                axes.plot([low / unit, high / unit], [heights[row]] * 2, **look)
    axes.set_yticks([heights[row] for row in rows], rows)
    axes.tick_params(axis="y", length=0, which="both")
    axes.minorticks_off()
    axes.set_ylim(0.4, len(rows) + 0.6)


def _ranges(diagram: Diagram) -> dict[str, tuple[list[Interval], list[Interval]]]:
    """Return the ranges of the stable and of the unstable motions of each row, from top to bottom."""
    equilibria = {branch.kind: branch for branch in diagram.equilibria}
    marks = [point.value for point in diagram.points if np.isnan(point.radial_speed)]
    levitation, rub = equilibria["contact-free"], equilibria["stable rub"]
    return {
        LEVITATION: (_on_grid(levitation.values, levitation.admissible & levitation.stable, marks), []),
        RUB: (_on_grid(rub.values, rub.admissible & rub.stable, marks), []),
        BOUNCING: _on_orbits(diagram.branches),
        ROLLING: (_on_grid(diagram.rolling.values, diagram.rolling.holds, marks), []),
    }


def _on_grid(values: np.ndarray, there: np.ndarray, marks: list[float]) -> list[Interval]:
    """Return the intervals of an ascending grid where a motion exists, up to the special points at which it ends."""
    steps = []
    for i in range(len(values) - 1):
        low, high = float(values[i]), float(values[i + 1])
        if there[i] != there[i + 1]:
            between = [mark for mark in marks if low <= mark <= high] or [0.5 * (low + high)]
            low, high = (low, between[0]) if there[i] else (between[-1], high)
        if there[i] or there[i + 1]:
            steps.append((low, high))
    return steps


def _on_orbits(branches: Sequence[OrbitBranch]) -> tuple[list[Interval], list[Interval]]:
    """Return the intervals of branches with stable and with unstable orbits; each has the look of its orbit."""
    stable: list[Interval] = []
    unstable: list[Interval] = []
    for branch in branches:
        places = np.concatenate([np.arange(len(branch)), [point.place for point in branch.special]])
        order, looks = looks_between(branch, places)
        values = np.concatenate([branch.values, [point.value for point in branch.special]])[order]
        for look, *ends in zip(looks, values[:-1], values[1:], strict=True):
            if look != "virtual":
                (stable if look == "stable" else unstable).append((min(ends), max(ends)))
    return stable, unstable


def looks_between(branch: OrbitBranch, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the order of places on a branch, and the look of each interval between neighbours: that of the orbit it touches."""
    order = np.argsort(places, kind="stable")
    where = places[order]
    looks = np.where(branch.admissible, np.where(branch.stable, "stable", "unstable"), "virtual")
    whole = where == np.floor(where)
    nearest = np.where(whole[1:], where[1:], np.floor(where[:-1])).astype(int)
    return order, looks[np.minimum(nearest, len(looks) - 1)]


def _joined(intervals: list[Interval]) -> list[Interval]:
    """Merge overlapping intervals."""
    joined: list[Interval] = []
    for low, high in sorted(intervals):
        if joined and low <= joined[-1][1] + 1e-12 * abs(high):
            joined[-1] = joined[-1][0], max(high, joined[-1][1])
        else:
            joined.append((low, high))
    return joined
