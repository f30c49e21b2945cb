"""Which motions exist where, as bars along a parameter: the panel below a bifurcation diagram."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from carom.base.outcome import DRIFTING_RUB, IRREGULAR_BOUNCING, STEADY_WORDS, Outcome
from carom.plots.style import LOOKS, OUTCOMES

if TYPE_CHECKING:
    from carom.bifurcations import AttractorSample, Bifurcation, Diagram, OrbitBranch

Interval = tuple[float, float]

LEVITATION, RUB, ROLLING = STEADY_WORDS.values()
BOUNCING, WITH_RUB = Outcome.BOUNCING.words, Outcome.MIXED.words
_COLOURS = {
    LEVITATION: OUTCOMES["levitated"].colour,
    RUB: OUTCOMES["forward-rub"].colour,
    DRIFTING_RUB: OUTCOMES["forward-rub"].colour,
    BOUNCING: OUTCOMES["bouncing"].colour,
    WITH_RUB: OUTCOMES["mixed"].colour,
    IRREGULAR_BOUNCING: OUTCOMES["irregular"].colour,
    Outcome.BACKWARD_WHIRL.words: OUTCOMES["backward-whirl"].colour,
    ROLLING: OUTCOMES["rolling"].colour,
}
ROWS = tuple(_COLOURS)
"""From top to bottom."""
_THICK = 4.5
_LARGEST = 26.0


def rows_of(diagram: Diagram) -> list[str]:
    """Return the rows that are not empty."""
    present = {_row_of_sample(sample) for sample in diagram.attractors}
    present |= {row for row, ranges in _ranges(diagram).items() if any(ranges)}
    return [row for row in ROWS if row in present]


def row_of_point(point: Bifurcation) -> str | None:
    """Return the row in which a special point is marked; ``None`` if it belongs to an orbit."""
    row = {"rubbing": WITH_RUB, "rolling": ROLLING}.get(point.motion)
    if row is None and np.isnan(point.radial_speed):
        row = LEVITATION if point.motion == "contact-free" else RUB
    return row


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
    for sample in diagram.attractors:
        _dot(axes, sample, heights[_row_of_sample(sample)], unit)
    axes.set_yticks([heights[row] for row in rows], rows)
    axes.tick_params(axis="y", length=0, which="both")
    axes.minorticks_off()
    axes.set_ylim(0.4, len(rows) + 0.6)


def _ranges(diagram: Diagram) -> dict[str, tuple[list[Interval], list[Interval]]]:
    """Return the ranges of the stable and of the unstable motions of each row."""
    equilibria = {branch.kind: branch for branch in diagram.equilibria}
    marks = [point.value for point in diagram.points if np.isnan(point.radial_speed)]
    levitation, rub = equilibria["contact-free"], equilibria["stable rub"]
    return {
        LEVITATION: (_on_grid(levitation.values, levitation.admissible & levitation.stable, marks), []),
        RUB: (_on_grid(rub.values, rub.admissible & rub.stable, marks), []),
        ROLLING: (_on_grid(diagram.rolling.values, diagram.rolling.holds, marks), []),
        BOUNCING: _on_orbits(diagram.branches),
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


def _row_of_sample(sample: AttractorSample) -> str:
    if sample.irregular:
        return IRREGULAR_BOUNCING
    words = str(OUTCOMES[sample.outcome].words)
    return next((row for row in (RUB, DRIFTING_RUB) if sample.name.startswith(row)), words)


def _dot(axes: Axes, sample: AttractorSample, height: float, unit: float) -> None:
    """Draw a dot whose area is proportional to the share of disturbances.

    A motion that none of them reached is a small empty ring.  Irregular bouncing that ends is a cross.
    """
    if sample.transient:
        size = _LARGEST * max(sample.share, 0.1)
        axes.scatter([sample.value / unit], [height], s=size, marker="x", color="#1a1a1a", linewidth=0.8, zorder=4)
        return
    axes.scatter(
        [sample.value / unit],
        [height],
        s=_LARGEST * (max(sample.share, 0.1) if sample.met else 0.05),
        facecolor="#ffffff" if sample.met else "none",
        edgecolor="#1a1a1a",
        linewidth=0.6,
        zorder=4,
    )
