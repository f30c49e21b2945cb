"""Bifurcation diagrams along one parameter with bars of what exists where, and the looks of special points and of curves in two parameters.

Conventions of the field: stable solid, unstable dashed, virtual faint; every kind of special point has its own marker.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from carom.base.arguments import checked
from carom.base.outcome import STEADY_WORDS, Outcome
from carom.plots.figure import TWO_COLUMNS, StyledFigure
from carom.plots.style import LOOKS, OUTCOMES, Drawn, Look, styled
from carom.plots.words import axis_label, format_parameter, label_parameter

if TYPE_CHECKING:
    from carom.bifurcations import Bifurcation, Curve, Diagram, OrbitBranch

POINTS = MappingProxyType(
    {
        "fold": Look("#1a1a1a", "fold of two orbits", marker=">"),
        "speed-fold": Look("#1a1a1a", "fold of two radial speeds", marker="<"),
        "period-doubling": Look("#d55e00", "period doubling", marker="s"),
        "neimark-sacker": Look("#56b4e9", "Neimark–Sacker bifurcation", marker="h"),
        "grazing": Look("#0072b2", "grazing", marker="v"),
        "vanishing-impact": Look("#0072b2", "grazing, one impact more", marker="1"),
        "contact-change": Look(OUTCOMES["backward-whirl"].colour, "contact begins or ends in between", marker="2"),
        "radius-extremum": Look("#808080", "new extremum of the radius", marker="D"),
        "slip-stop": Look("#e69f00", "friction stops the slip", marker="P"),
        "non-smooth-hopf": Look("#009e73", "non-smooth Hopf bifurcation", marker="*"),
        "boundary-equilibrium": Look("#009e73", f"{STEADY_WORDS['contact-free']} meets the wall", marker="p"),
        "levitation-lost": Look("#cc79a7", f"{STEADY_WORDS['contact-free']} is lost", marker="4"),
        "rub-fold": Look(OUTCOMES["forward-rub"].colour, f"fold of {STEADY_WORDS['rub']}s", marker="X"),
        "contact-onset": Look(OUTCOMES["backward-whirl"].colour, "lasting contact begins", marker="^"),
        "rolling-limit": Look(OUTCOMES["rolling"].colour, "rolling no longer holds", marker="d"),
    }
)
"""Markers of special points (read-only)."""

_LINES: dict[str, Drawn] = {
    "fold": {"line": "-", "width": 1.1},
    "speed-fold": {"line": "-.", "width": 0.9},
    "period-doubling": {"line": "--", "width": 1.1},
    "neimark-sacker": {"line": "-.", "width": 1.1},
    "grazing": {"line": (0.0, (6.0, 1.5, 1.0, 1.5)), "width": 1.1},
    "slip-stop": {"line": ":", "width": 1.1},
    "boundary-equilibrium": {"line": "-", "width": 1.2},
    "non-smooth-hopf": {"line": "-", "width": 4.5, "colour": "#a3dcca"},
    "rub-fold": {"line": "--", "width": 1.4},
    "contact-onset": {"line": "-", "width": 1.1},
    "rolling-limit": {"line": "-.", "width": 1.1},
    "levitation-lost": {"line": ":", "width": 1.4},
}
CURVES = MappingProxyType({kind: replace(POINTS[kind], marker="none", **look) for kind, look in _LINES.items()})
"""Lines of curves in two parameters (read-only)."""

BOUNDARIES = MappingProxyType(
    {
        "persistence": Look("#009e73", f"{STEADY_WORDS['contact-free']} turns into {STEADY_WORDS['rub']}", marker="p"),
        "non-smooth fold": Look("#009e73", f"{STEADY_WORDS['contact-free']} and saddle of rub vanish", marker="8"),
    }
)
"""Markers of boundary equilibria with what becomes of levitation (read-only)."""

FAINT = 0.3
"""Opacity of curves that only virtual orbits have."""
_PRESENT: Drawn = {"color": "#1a1a1a", "lw": 0.8, "ls": (0, (1, 1.5)), "zorder": 1.2}
"""Look of the value of the machine itself."""


@checked
@styled
def bifurcation_diagram(diagram: Diagram) -> Figure:
    """Draw all motions along a parameter, with their special points, in two panels.

    Upper, where there are orbits: their radial speed at the impact, in mm/s if the machine is known.  Lower: which motions exist, with broad bars
    where they are stable.  The shaft speed is in rpm.
    """
    strip = 0.18 * len(rows_of(diagram))
    unit, scales = diagram.axis.field.usual_size, diagram.model.scales
    lowest, highest = _limits(diagram)
    ratios = (2.4, strip) if highest else (strip,)
    figure = StyledFigure(figsize=(TWO_COLUMNS, (0.14 + 0.18 * sum(ratios)) * TWO_COLUMNS))
    *upper, below = figure.subplots(len(ratios), 1, sharex=True, height_ratios=ratios, squeeze=False)[:, 0]
    coexistence(below, diagram, unit)
    label_parameter(below, "x", diagram.axis.field, scales, own=[*upper, below][0])
    below.set_xlim(diagram.interval[0] / unit, diagram.interval[1] / unit)
    for panel in upper:
        _speeds(panel, diagram, unit)
        panel.axhline(0.0, color="#1a1a1a", lw=0.5)
        panel.set(
            ylim=(lowest, highest), ylabel=axis_label(r"radial speed at the impact, $\dot r$", "velocity", scales)
        )
    present = _mark_present(diagram, (*upper, below), unit)
    marked = _mark_points(diagram, upper, below, unit)
    kinds = ("stable", "unstable") if diagram.orbits or diagram.several else ()
    lines = [LOOKS[kind].entry(f"{kind} orbit") for kind in kinds]
    handles = [*lines, *(look.entry() for look in marked), *present]
    figure.legend(handles=handles, loc="outside lower center", ncols=4)
    return figure


def _speeds(axes: Axes, diagram: Diagram, unit: float) -> None:
    """Draw the radial speeds of orbits at each of their impacts, in their display unit."""
    for branch in diagram.branches:
        special = np.array([point.value for point in branch.special])
        places, values = np.arange(len(branch)), branch.values / unit
        for k, speeds in enumerate(branch.radial_speeds.T):
            there = [each.radial_speed if each.shot is None else each.shot.impact_speeds[k] for each in branch.special]
            marked = diagram.shown_speeds(special, np.array(there, float))
            shown = diagram.shown_speeds(branch.values, speeds)
            branch_line(axes, branch, places, values, shown, marked, unit, virtual=False)


def _mark_present(diagram: Diagram, panels: tuple[Axes, ...], unit: float) -> list[Line2D]:
    """Mark the value of the machine itself, if it lies in the interval; return its legend entry."""
    value = float(diagram.axis.value(diagram.model))
    if not diagram.interval[0] <= value <= diagram.interval[1]:
        return []
    words = f"present value: {format_parameter(value, diagram.axis.field, diagram.model.scales)}"
    return [panel.axvline(value / unit, gid="present", label=words, **_PRESENT) for panel in panels][:1]


def _mark_points(diagram: Diagram, upper: list[Axes], below: Axes, unit: float) -> list[Look]:
    """Mark the special points of orbits at their speed and those of other motions on their bars; return the looks of the visible ones, each once."""
    rows = rows_of(diagram)
    heights = dict(zip(rows, below.get_yticks()[: len(rows)], strict=True))
    seen = set()
    for point in diagram.points:
        row, look = row_of_point(point), BOUNDARIES.get(point.detail, POINTS[point.kind])
        speed = float(diagram.shown_speeds(point.value, point.radial_speed))
        panels, height = (upper, speed) if row is None else ([below], heights.get(row))
        if height is None or not point.admissible:
            continue
        for axes in panels:
            _mark(axes, look, point.value / unit, float(height), point.admissible)
            low, high = axes.get_ylim()
            if low <= height <= high:
                seen.add(look.words)
    return [look for look in (*POINTS.values(), *BOUNDARIES.values()) if look.words in seen]


def branch_line(
    axes: Axes,
    branch: OrbitBranch,
    places: np.ndarray,
    values: np.ndarray,
    heights: np.ndarray,
    special_heights: np.ndarray | None = None,
    unit: float = 1.0,
    virtual: bool = True,
) -> None:
    """Draw a quantity along a branch; its look changes at the special points.

    It is known at ascending places on the branch (see :class:`~carom.bifurcations.Bifurcation`), shape (n,), and at the
    special points, where it is interpolated by default.  `values` are those of the parameter in the unit drawn; `unit`
    is the divisor of the parameter of special points.  Stretches of virtual orbits are left out unless `virtual` is set.
    """
    special = [point for point in branch.special if places[0] <= point.place <= places[-1]]
    extra = np.array([point.place for point in special])
    if special_heights is None:
        special_heights = np.interp(extra, places, heights)
    order, stretches = looks_between(branch, np.concatenate([places, extra]))
    x = np.concatenate([values, [point.value / unit for point in special]])[order]
    y = np.concatenate([heights, special_heights])[order]
    if len(x) < 2:  # it only touches the end of the range
        return
    for first, last, look in _runs(np.append(stretches, stretches[-1:])):
        if look == "virtual" and not virtual:
            continue
        alpha = 0.6 if look == "virtual" else 1.0
        axes.plot(x[first : last + 1], y[first : last + 1], **LOOKS[look].stroke, alpha=alpha)


def _runs(looks: np.ndarray) -> list[tuple[int, int, str]]:
    """Return the runs of equal looks, each extended to the first point of the next."""
    changes = np.flatnonzero(looks[1:] != looks[:-1]) + 1
    starts = [0, *changes.tolist()]
    ends = [*changes.tolist(), len(looks) - 1]
    return [(first, last, str(looks[first])) for first, last in zip(starts, ends, strict=True)]


def mark_point(axes: Axes, kind: str, x: float, y: float, admissible: bool = True) -> None:
    """Mark a special point; hollow if only virtual motions have it."""
    _mark(axes, POINTS[kind], x, y, admissible)


def _mark(axes: Axes, look: Look, x: float, y: float, admissible: bool) -> None:
    # Points that are not bifurcations are drawn behind the others.
    size, order = (3.6, 4.9) if look is POINTS["radius-extremum"] else (5.0, 5.0)
    axes.plot([x], [y], **look.mark(size, filled=admissible), mew=0.8, zorder=order)


def _limits(diagram: Diagram) -> tuple[float, float]:
    """Return the range of all speeds of possible orbits, with a margin for virtual ones; its end is 0 if there are none."""
    speeds = [
        diagram.shown_speeds(branch.values[branch.admissible, None], branch.radial_speeds[branch.admissible]).ravel()
        for branch in diagram.branches
    ]
    shown = np.concatenate([*speeds, [0.0]])
    high = float(shown.max())
    return -0.12 * (high or 1.0), 1.1 * high


def curve_line(axes: Axes, curve: Curve, units: np.ndarray, virtual: bool = True) -> None:
    """Draw a curve in the plane of two parameters, faint or not at all where only virtual motions have it."""
    look = CURVES[curve.kind]
    x, y = (curve.points / units).T
    for first, last, real in _runs(np.where(curve.admissible, "real", "virtual")):
        if real == "virtual" and not virtual:
            continue
        alpha = 1.0 if real == "real" else FAINT
        axes.plot(x[first : last + 1], y[first : last + 1], **look.stroke, alpha=alpha)


Interval = tuple[float, float]

LEVITATION, RUB, ROLLING = STEADY_WORDS.values()
BOUNCING = Outcome.BOUNCING.words
COLOURS = {
    LEVITATION: OUTCOMES["levitated"].colour,
    RUB: OUTCOMES["forward-rub"].colour,
    BOUNCING: OUTCOMES["bouncing"].colour,
    ROLLING: OUTCOMES["rolling"].colour,
}
_THICK = 4.5


def rows_of(diagram: Diagram) -> list[str]:
    """Return the rows that are not empty."""
    return [row for row, ranges in ranges_of(diagram).items() if any(ranges)]


def row_of_point(point: Bifurcation) -> str | None:
    """Return the row in which a special point is marked; ``None`` if it belongs to an orbit."""
    return {"contact-free": LEVITATION, "rub": RUB, "rolling": ROLLING}.get(point.motion)


def coexistence(axes: Axes, diagram: Diagram, unit: float) -> None:
    """Draw a bar over the range of every motion: broad where it is stable, a thin dashed line where it is unstable.

    `unit` is the divisor of the parameter.
    """
    rows = rows_of(diagram)
    heights = {row: float(len(rows) - place) for place, row in enumerate(rows)}
    for row, (stable, unstable) in ranges_of(diagram).items():
        bar = {"color": COLOURS[row], "lw": _THICK, "solid_capstyle": "butt"}
        for intervals, look in ((unstable, LOOKS["unstable"].stroke | {"zorder": 1.5}), (stable, bar)):
            for low, high in intervals:
                axes.plot([low / unit, high / unit], [heights[row]] * 2, **look)
    axes.set_yticks([heights[row] for row in rows], rows)
    axes.tick_params(axis="y", length=0, which="both")
    axes.minorticks_off()
    axes.set_ylim(0.4, len(rows) + 0.6)


def ranges_of(diagram: Diagram) -> dict[str, tuple[list[Interval], list[Interval]]]:
    """Return the ranges of the stable and of the unstable motions of each row, from top to bottom, without gaps or overlaps."""
    equilibria = {branch.kind: branch for branch in diagram.equilibria}
    marks = [point.value for point in diagram.points if np.isnan(point.radial_speed)]
    levitation, rub = equilibria["contact-free"], equilibria["stable rub"]
    found = {
        LEVITATION: (_on_grid(levitation.values, levitation.admissible & levitation.stable, marks), []),
        RUB: (_on_grid(rub.values, rub.admissible & rub.stable, marks), []),
        BOUNCING: _on_orbits(diagram.branches),
        ROLLING: (_on_grid(diagram.rolling.values, diagram.rolling.holds, marks), []),
    }
    return {row: (_joined(holds), _joined(fails)) for row, (holds, fails) in found.items()}


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
