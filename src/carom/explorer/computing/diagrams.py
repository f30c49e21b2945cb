"""Bifurcation diagram along one parameter, as lines, bars and points in the units of the page."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from carom.base.outcome import STEADY_WORDS
from carom.base.progress import ShowProgress
from carom.base.results import record
from carom.bifurcations import Diagram, EquilibriumBranch, OrbitBranch, find_bifurcations
from carom.explorer.computing.controls import Control, unit_of
from carom.models import Rotor
from carom.plots.diagrams import BOUNDARIES, POINTS
from carom.plots.style import LOOKS, OUTCOMES

_STEADY = {
    "contact-free": ("levitated", STEADY_WORDS["contact-free"]),
    "stable rub": ("forward-rub", f"stable {STEADY_WORDS['rub']}"),
}
"""Branches shown as bars: the outcome whose colour they have, and words."""


def diagram_along(rotor: Rotor, control: Control, progress: ShowProgress = None) -> dict[str, object]:
    """Compute the diagram over the whole slider of a parameter, ready to be drawn; speeds in mm/s if the machine is known, otherwise in ``c_r Ω``.

    ``lines`` are stretches of stable, unstable or virtual orbits with their impact speeds, ``bars`` intervals in which a steady motion is stable and possible,
    and ``points`` the columns of the special points; steady motions have the impact speed zero.
    """
    unit = unit_of(control.name)
    diagram = find_bifurcations(rotor, control.name, (unit * control.low, unit * control.high), progress=progress)
    heights = [_speeds(diagram, branch)[branch.admissible] for branch in diagram.orbits]
    return {
        **record(control, "name words unit low high"),
        "speed_unit": diagram.speed_unit,
        "top": 1.15 * float(np.concatenate([*heights, [0.0]]).max() or 1.0),
        "lines": [line for branch in diagram.orbits for line in _lines(branch, unit, _speeds(diagram, branch))],
        "bars": [bar for branch in diagram.equilibria for bar in _bars(branch, unit)],
        "points": _points(diagram, unit),
    }


def _speeds(diagram: Diagram, branch: OrbitBranch) -> np.ndarray:
    return diagram.shown_speeds(branch.values, branch.radial_speed)


def _lines(branch: OrbitBranch, unit: float, speeds: np.ndarray) -> Iterator[dict[str, object]]:
    looks = np.where(branch.admissible, np.where(branch.stable, "stable", "unstable"), "virtual")
    for kind in ("virtual", "unstable", "stable"):
        shown = looks == kind
        # A stretch meets its neighbours at the first point beyond it.
        shown[:-1] |= (looks[1:] == kind) & (kind != "virtual")
        if shown.any():
            y = np.where(shown, speeds, np.nan)
            yield {"x": branch.values / unit, "y": y, "kind": kind, "colour": LOOKS[kind].colour}


def _bars(branch: EquilibriumBranch, unit: float) -> Iterator[dict[str, object]]:
    if branch.kind not in _STEADY:
        return
    look, words = _STEADY[branch.kind]
    holds = np.concatenate([[False], branch.admissible & branch.stable, [False]])
    edges = np.flatnonzero(holds[1:] != holds[:-1])
    values = (branch.values / unit).tolist()
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        yield {"low": values[first], "high": values[last - 1], "words": words, "colour": OUTCOMES[look].colour}


def _points(diagram: Diagram, unit: float) -> dict[str, list[object]]:
    points: dict[str, list[object]] = {name: [] for name in ("x", "y", "words", "colour", "admissible")}
    for found in diagram.points:
        look = BOUNDARIES.get(found.detail, POINTS[found.kind])
        height = 0.0 if np.isnan(found.radial_speed) else float(diagram.shown_speeds(found.value, found.radial_speed))
        words = look.words if found.motion != "orbit" else f"{look.words}, {found.name}"
        row = (found.value / unit, height, words, look.colour, found.admissible)
        for column, value in zip(points.values(), row, strict=True):
            column.append(value)
    return points
