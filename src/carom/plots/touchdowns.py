"""A touchdown over time: radius, regime and whirl, forces and energies."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.arguments import checked
from carom.plots.cells import ink
from carom.plots.figure import StyledFigure
from carom.plots.histories import draw_radius, history_of, last_turns
from carom.plots.plane import Floats, key, one_axes
from carom.plots.style import LOOKS, REGIMES, TWO_COLUMNS, WORKS, Look, styled
from carom.plots.words import axis_time, told_in

if TYPE_CHECKING:
    from carom.motions.ledger import EnergyLedger
    from carom.motions.trajectories import Trajectory
    from carom.parameters import Scales

_SAMPLES = 4000
_LARGE = 1e5
"""Size in N and J from which kN and kJ are written."""
_MOST_STEMS = 60
"""Number of impacts above which impulses are points without stems, which would merge into an area."""
_WIDE_RANGE = 50.0
"""Ratio of the largest to the median contact force beyond which the axis is logarithmic."""


@checked
@styled
def touchdown(trajectory: Trajectory, ledger: EnergyLedger | None = None, title: str | None = None) -> Figure:
    """Draw a touchdown in three panels over one time axis, with the energies of its motion in four.

    From top to bottom: distance from the centre; regime and whirl direction; impulses and contact forces; energies and
    works, if a ledger is given.  If the distance has too many swings for a curve, its band is drawn, and its last turns in a panel below.
    """
    history = history_of(trajectory)
    last = last_turns(history)
    along = 3 if ledger is None else 4
    heights = [1.0, 0.32, *([1.0] * (along - 2)), *([] if last is None else [1.0])]
    figure = StyledFigure(figsize=(TWO_COLUMNS, 0.35 * sum(heights) * TWO_COLUMNS))
    panels = figure.subplots(len(heights), 1, height_ratios=heights)
    for panel in panels[1:along]:
        panel.sharex(panels[0])
    draw_radius(panels[0], history)
    regimes(trajectory, axes=panels[1])
    forces(trajectory, axes=panels[2])
    if ledger is not None:
        energies(ledger, axes=panels[3])
    if last is not None:
        draw_radius(panels[along], last)
    for panel, letter in zip(panels, "abcde", strict=False):
        panel.set_title(f"({letter})", loc="left", y=1.0)
    for panel in panels[: along - 1]:
        panel.set_xlabel("")
        panel.tick_params(labelbottom=False)
    if title:
        figure.suptitle(title)
    key(figure, panels, columns=4)
    return figure


@checked
@styled
def regimes(trajectory: Trajectory, *, axes: Axes | None = None) -> Figure:
    """Draw two ribbons over time: the regime (flight, sliding, rolling) and the direction of whirl."""
    figure, drawn = one_axes(axes, (TWO_COLUMNS, 0.2 * TWO_COLUMNS))
    scales = trajectory.scales
    unit = told_in("time", scales)[0]
    ends = unit * np.append(trajectory.segment_starts, trajectory.time)
    shown = {}
    for first, last in trajectory.stretches():
        regime = REGIMES[int(trajectory.segment_phases[first, trajectory.plane])]
        _ribbon(drawn, ends[first], ends[last], 1.05, regime)
        shown[regime.words] = regime
    for start, end, forward in _whirl(trajectory):
        whirl = "forward" if forward else "backward"
        _ribbon(drawn, unit * start, unit * end, 0.0, LOOKS[whirl])
        shown[f"{whirl} whirl"] = LOOKS[whirl]
    for words, look in shown.items():
        drawn.fill_between([], [], **_filled(look), label=words)
    drawn.set_ylim(-0.1, 2.1)
    drawn.set_yticks([0.475, 1.525], ["whirl", "regime"])
    drawn.tick_params(axis="y", length=0)
    drawn.set(xlim=(0.0, unit * trajectory.time), xlabel=axis_time(scales))
    if axes is None:
        key(figure, [drawn], columns=4)
    return figure


def _ribbon(axes: Axes, start: float, end: float, bottom: float, look: Look) -> None:
    axes.fill_between([start, end], bottom, bottom + 0.95, **_filled(look))


def _filled(look: Look) -> dict[str, Any]:
    """Colour and hatching of an area, which differ in greyscale too."""
    return {"facecolor": look.colour, "edgecolor": ink(look.colour), "hatch": look.hatch or None, "lw": 0}


def _whirl(trajectory: Trajectory) -> list[tuple[float, float, bool]]:
    """Return the intervals of forward and backward whirl in the fixed frame: start, end, whether forward."""
    times = trajectory.sample(_SAMPLES)
    position, velocity = trajectory.at_plane(times)
    forward = (position.conj() * (velocity + 1j * position)).imag > 0.0
    edges = [0, *(np.flatnonzero(np.diff(forward)) + 1), len(times) - 1]
    return [
        (float(times[first]), float(times[last]), bool(forward[first])) for first, last in itertools.pairwise(edges)
    ]


@checked
@styled
def forces(trajectory: Trajectory, *, axes: Axes | None = None) -> Figure:
    """Draw the normal and friction force of lasting contact over time, and the impulse of each impact.

    Forces are in N and impulses in N s (right axis) if the machine is known, otherwise in units of the equations.
    Without lasting contact there is no force to draw, and the panel says so.
    """
    figure, drawn = one_axes(axes, (TWO_COLUMNS, 0.4 * TWO_COLUMNS))
    scales = trajectory.scales
    if trajectory.lasting_contacts:
        _contact_forces(drawn, trajectory)
    else:
        drawn.set_yticks([])
        words = "no lasting contact" if len(trajectory.contacts) else "no contact"
        drawn.text(0.5, 0.94, words, transform=drawn.transAxes, ha="center", va="top", gid="no force")
    drawn.set(xlabel=axis_time(scales), xlim=(0.0, told_in("time", scales)[0] * trajectory.time))
    if len(trajectory.contacts):
        _impulses(drawn, trajectory)
    if axes is None:
        key(figure, figure.axes, columns=3)
    return figure


def _contact_forces(axes: Axes, trajectory: Trajectory) -> None:
    """Draw normal and friction force over the intervals of lasting contact."""
    scales = trajectory.scales
    times = _contact_times(trajectory)
    gaps = np.isnan(times)
    forces = np.full((2, len(times)), np.nan)
    forces[:, ~gaps] = trajectory.forces(times[~gaps])
    unit, name = _unit_of(np.nanmax(forces[0]), "force", scales)
    moments = told_in("time", scales)[0] * times
    normal, friction = (part * unit for part in forces)
    for values, look, words in (
        (normal, LOOKS["wall"], "normal force of lasting contact"),
        (np.abs(friction), LOOKS["roll"], "friction force, size"),
    ):
        axes.plot(moments, np.where(gaps, np.nan, values), **look.stroke | {"lw": 0.9}, label=words)
    held = normal[~gaps & (normal > 0.0)]
    if len(held) and held.max() > _WIDE_RANGE * np.median(held):
        axes.set_yscale("log")
    else:
        axes.set_ylim(0.0, 1.1 * held.max() if len(held) else None)
    axes.set_ylabel(f"contact force ({name})")


def _unit_of(largest: float, kind: str, scales: Scales | None) -> tuple[float, str]:
    """Return the factor to a unit in which large numbers need no power of ten, and its name."""
    unit, name = told_in(kind, scales)
    return (1e-3 * unit, f"k{name}") if scales and unit * largest >= _LARGE else (unit, name)


def _contact_times(trajectory: Trajectory) -> Floats:
    """Return the times at which lasting contact is drawn, with a gap (nan) after each interval."""
    pieces = []
    for span in trajectory.lasting_contacts:
        count = max(50, int(_SAMPLES * (span.end - span.start) / trajectory.time))
        inside = np.linspace(span.start, span.end, count + 1)[:-1]
        pieces.append(np.append(inside, np.nan))
    return np.concatenate(pieces)


def _impulses(axes: Axes, trajectory: Trajectory) -> None:
    """Draw the normal impulses as stems, on a separate axis at the right."""
    beside = axes.twinx()
    log, scales = trajectory.contacts, trajectory.scales
    unit, name = told_in("impulse", scales)
    times, heights = told_in("time", scales)[0] * log.time, unit * log.normal_impulse
    look = LOOKS["path"]
    if len(times) <= _MOST_STEMS:
        beside.vlines(times, 0.0, heights, color=look.colour, lw=0.5)
    beside.plot(times, heights, "o", ms=1.8, color=look.colour, label="normal impulse (right axis)")
    # Leave room above for the words that say that there is no force.
    beside.set(ylim=(0.0, None if trajectory.lasting_contacts else 1.25 * heights.max()), ylabel=f"impulse ({name})")
    axes.plot([], [], "o", ms=1.8, color=look.colour, label="normal impulse (right axis)")


@checked
@styled
def energies(ledger: EnergyLedger, *, axes: Axes | None = None) -> Figure:
    """Draw the energy of the rotor and the works that change it; circulatory ones, of weight and in a wall where there are any."""
    figure, drawn = one_axes(axes, (TWO_COLUMNS, 0.4 * TWO_COLUMNS))
    scales = ledger.scales
    largest = max(float(np.abs(getattr(ledger, name)).max()) for name in WORKS)
    unit, short = _unit_of(largest, "energy", scales)
    times = told_in("time", scales)[0] * ledger.times
    drawn.axhline(0.0, color="#a6a6a6", lw=0.5)
    for name, look in WORKS.items():
        values = getattr(ledger, name)
        if name not in ("circulatory", "forces", "wall_loss") or values.any():
            drawn.plot(times, unit * values, **look.stroke, label=look.words)
    drawn.set(xlim=(0.0, float(times[-1])), xlabel=axis_time(scales), ylabel=f"energy, work since the start ({short})")
    if axes is None:
        key(figure, [drawn], columns=3)
    return figure
