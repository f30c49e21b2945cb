"""Bifurcation diagram along one parameter, as lines, bars and points in the units of the page."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.base.outcome import STEADY_WORDS
from carom.base.progress import ShowProgress
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


@dataclass(frozen=True, eq=False)
class DiagramLine:
    """A stretch of orbits of one kind: their impact speeds, and whether they are stable, unstable or virtual."""

    x: np.ndarray
    y: np.ndarray
    kind: str
    colour: str


@dataclass(frozen=True)
class Bar:
    """An interval of the parameter in which a steady motion is stable and possible."""

    low: float
    high: float
    words: str
    colour: str


@dataclass(frozen=True)
class DiagramPoint:
    """A special point; steady motions have the impact speed zero."""

    x: float
    y: float
    words: str
    colour: str
    admissible: bool


@dataclass(frozen=True, eq=False)
class DiagramPicture:
    """A diagram, ready to be drawn; speeds in mm/s if the machine is known, otherwise in ``c_r Ω``."""

    control: Control
    speed_unit: str
    top: float
    lines: tuple[DiagramLine, ...]
    bars: tuple[Bar, ...]
    points: tuple[DiagramPoint, ...]


def picture_along(rotor: Rotor, control: Control, progress: ShowProgress = None) -> DiagramPicture:
    """Compute the diagram over the whole slider of a parameter."""
    unit = unit_of(control.name)
    diagram = find_bifurcations(rotor, control.name, (unit * control.low, unit * control.high), progress=progress)
    heights = [_speeds(diagram, branch)[branch.admissible] for branch in diagram.orbits]
    return DiagramPicture(
        control=control,
        speed_unit=diagram.speed_unit,
        top=1.15 * float(np.concatenate([*heights, [0.0]]).max() or 1.0),
        lines=tuple(line for branch in diagram.orbits for line in _lines(branch, unit, _speeds(diagram, branch))),
        bars=tuple(bar for branch in diagram.equilibria for bar in _bars(branch, unit)),
        points=tuple(_points(diagram, unit)),
    )


def _speeds(diagram: Diagram, branch: OrbitBranch) -> np.ndarray:
    return diagram.shown_speeds(branch.values, branch.radial_speed)


def _lines(branch: OrbitBranch, unit: float, speeds: np.ndarray) -> list[DiagramLine]:
    looks = np.where(branch.admissible, np.where(branch.stable, "stable", "unstable"), "virtual")
    lines = []
    for kind in ("virtual", "unstable", "stable"):
        shown = looks == kind
        # A stretch meets its neighbours at the first point beyond it.
        shown[:-1] |= (looks[1:] == kind) & (kind != "virtual")
        if shown.any():
            y = np.where(shown, speeds, np.nan)
            lines.append(DiagramLine(branch.values / unit, y, kind, LOOKS[kind].colour))
    return lines


def _bars(branch: EquilibriumBranch, unit: float) -> list[Bar]:
    if branch.kind not in _STEADY:
        return []
    look, words = _STEADY[branch.kind]
    holds = np.concatenate([[False], branch.admissible & branch.stable, [False]])
    edges = np.flatnonzero(holds[1:] != holds[:-1])
    values = branch.values / unit
    return [
        Bar(float(values[first]), float(values[last - 1]), words, OUTCOMES[look].colour)
        for first, last in zip(edges[::2], edges[1::2], strict=True)
    ]


def _points(diagram: Diagram, unit: float) -> list[DiagramPoint]:
    points = []
    for found in diagram.points:
        look = BOUNDARIES.get(found.detail, POINTS[found.kind])
        height = 0.0 if np.isnan(found.radial_speed) else float(diagram.shown_speeds(found.value, found.radial_speed))
        words = look.words if found.motion != "orbit" else f"{look.words}, {found.name}"
        points.append(DiagramPoint(found.value / unit, height, words, look.colour, found.admissible))
    return points
