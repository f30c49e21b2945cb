"""Bifurcation diagram along one parameter, as lines, bars and points in the units of the page."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from carom.base.progress import ShowProgress
from carom.base.results import record
from carom.bifurcations import Diagram, OrbitBranch, find_bifurcations
from carom.explorer.computing.controls import Control, unit_of
from carom.models import Rotor
from carom.plots.diagrams import BOUNDARIES, COLOURS, LEVITATION, POINTS, RUB, ranges_of
from carom.plots.style import LOOKS

_STEADY = {LEVITATION: LEVITATION, RUB: f"stable {RUB}"}
"""Motions shown as bars, and their words."""


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
        "bars": [
            {"low": low / unit, "high": high / unit, "words": words, "colour": COLOURS[row]}
            for row, words in _STEADY.items()
            for low, high in ranges_of(diagram)[row][0]
        ],
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
