"""Load of a touchdown on its bearing: impacts, forces, and the heat of friction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from carom.arguments import checked
from carom.closed_forms.hertz import ball_pressure
from carom.closed_forms.known import known_of
from carom.models.in_bearing import bearing_of
from carom.motions.contacts import ContactLog, presses, slip_velocity, yields
from carom.motions.ledger import contact_power
from carom.motions.quadrature import NODES, WEIGHTS, pieces
from carom.motions.trajectories import Trajectory
from carom.outcome import Outcome, Phase
from carom.parameters import Scales
from carom.results import KINDS, Result

RECENT = 10
"""Impacts at least, over which the power of bouncing is averaged."""
MEASURED = ("impulse", "force", "depth", "power", "heat", "restitution_loss", "contact_time", "lasting_power")
"""Loads that have a unit."""


@dataclass(frozen=True, eq=False, repr=False)
class TouchdownLoads(Result):
    """Loads of a motion at its contact plane, in units of the equations; ``si`` gives them in SI units.

    On a wall that gives way a contact, from entering the wall until leaving it, counts as an impact too.

    Attributes
    ----------
    outcome : Outcome
        Where the motion settled, or why it was stopped.
    impacts : int
        Number of impacts.
    impulse : float
        Largest normal impulse of an impact, ``m c_r Ω``; of a contact that lasts at the end, whose impulse grows on, it is left out.
    force : float
        Largest normal force in lasting contact, ``m c_r Ω²``.  If the motion goes on rolling, that of the planar rotor over a
        whole turn.
    depth : float
        Largest depth in the wall, ``c_r``; 0 if the wall is rigid.
    power : float
        Largest power of friction in lasting contact, ``m c_r² Ω³``.
    heat : float
        Work lost to friction, in impacts and in lasting contact, ``m c_r² Ω²``.
    restitution_loss : float
        Work lost along the normal, in impacts or in a wall that gives way, ``m c_r² Ω²``.
    contact_time : float
        Duration of lasting contact, ``1/Ω``.
    lasting_power : float
        Power of friction with which the motion goes on, ``m c_r² Ω³``: at its end in lasting contact, or averaged over the last
        impacts; 0 if it does not go on in contact.
    scales : Scales or None
    pressure : float or None
        Largest pressure of the most loaded ball on the race, in Pa (:func:`carom.closed_forms.ball_pressure`), if the touchdown bearing
        states its balls.
    """

    outcome: Outcome
    impacts: int
    impulse: float
    force: float
    depth: float
    power: float
    heat: float
    restitution_loss: float
    contact_time: float
    lasting_power: float
    scales: Scales | None = None
    pressure: float | None = None

    @property
    def goes_on(self) -> bool:
        """Whether the motion has settled in contact, so that impacts or heat have no end."""
        return self.outcome.settled and self.outcome is not Outcome.LEVITATED

    @property
    def goes_on_bouncing(self) -> bool:
        """Whether it has settled to bouncing, so that its impacts have no end."""
        return self.outcome in (Outcome.BOUNCING, Outcome.MIXED)

    def si(self) -> dict[str, float] | None:
        """Loads in SI units by name; ``None`` without scales."""
        if self.scales is None:
            return None
        si = {name: getattr(self, name) * getattr(self.scales, KINDS[name]) for name in MEASURED}
        return si if self.pressure is None else {**si, "pressure": self.pressure}


@checked
def touchdown_loads(trajectory: Trajectory) -> TouchdownLoads:
    """Evaluate the loads of a motion at its contact plane.

    Friction does the work ``F v`` on the contact point, which slips with ``v = s + 1 + θ̇``; in an impact the work is that of the
    impulse on the mean of the slip velocities before and after.  The largest force and power of lasting contact on a rigid wall are those
    at the ends of its steps and at 16 nodes in each.  Loads on a wall that gives way are those of :attr:`Trajectory.touches`.
    """
    rotor, scales = trajectory.rotor, trajectory.scales
    loads = (_in_wall if yields(rotor.system, trajectory.plane) else _on_wall)(trajectory)
    bearing, pressure = bearing_of(rotor), None
    if bearing is not None and scales is not None:
        pressure = ball_pressure(bearing, loads["force"] * scales.force)
    return TouchdownLoads(
        outcome=trajectory.outcome,
        **loads,
        contact_time=sum(contact.end - contact.start for contact in trajectory.lasting_contacts),
        scales=scales,
        pressure=pressure,
    )


def _on_wall(trajectory: Trajectory) -> dict[str, Any]:
    """Loads on a rigid wall."""
    at_plane = trajectory.event_planes == trajectory.plane
    log = trajectory.contacts
    # A landing stands for the last bounces of a chatter.
    landings = trajectory.log_of(trajectory.is_landing & at_plane)
    heat, force, power = _lasting(trajectory)
    if trajectory.outcome is Outcome.ROLLING:
        force = max(force, known_of(trajectory.rotor).rolling_force)
    return {
        "impacts": len(log),
        "impulse": float(log.normal_impulse.max(initial=0.0)),
        "force": force,
        "depth": 0.0,
        "power": power,
        "heat": heat + float(_friction_work(log).sum() + _friction_work(landings).sum()),
        "restitution_loss": float(_normal_work(log).sum() + _normal_work(landings).sum()),
        "lasting_power": _lasting_power(trajectory, log.time, _friction_work(log)),
    }


def _in_wall(trajectory: Trajectory) -> dict[str, Any]:
    """Loads on a wall that gives way."""
    touches = trajectory.touches
    return {
        "impacts": len(touches),
        "impulse": float(touches.normal_impulse[~touches.lasts].max(initial=0.0)),
        "force": float(touches.peak_force.max(initial=0.0)),
        "depth": float(touches.deepest.max(initial=0.0)),
        "power": float(touches.peak_power.max(initial=0.0)),
        "heat": float(touches.heat.sum()),
        "restitution_loss": float(touches.normal_loss.sum()),
        "lasting_power": _lasting_power(trajectory, touches.start, touches.heat),
    }


def _friction_work(log: ContactLog) -> np.ndarray:
    """Work lost to friction in impacts, shape (n,)."""
    work: np.ndarray = -0.5 * log.tangential_impulse * (log.slip_before + log.slip_after)
    return work


def _normal_work(log: ContactLog) -> np.ndarray:
    """Work lost along the normal in impacts, shape (n,)."""
    work: np.ndarray = 0.5 * log.normal_impulse * (log.radial_speed + log.radial_speed_after)
    return work


def _lasting(trajectory: Trajectory) -> tuple[float, float, float]:
    """Work of friction in lasting contact, and the largest force and power there."""
    edges, counts = pieces(trajectory)
    rubs = np.repeat(presses(trajectory.segment_phases[:, trajectory.plane]), counts)
    starts, half = edges[:-1][rubs], 0.5 * np.diff(edges)[rubs]
    if not len(starts):
        return 0.0, 0.0, 0.0
    nodes, ends = (starts + half)[:, None] + half[:, None] * NODES, np.nextafter(edges[1:][rubs], 0.0)
    # In the order of time the series of each step is needed once.
    amplitudes, phases = trajectory.amplitudes_at(np.column_stack([starts, nodes, ends]))
    normal, grip = trajectory.forces_of(amplitudes, phases)
    lost = -grip * slip_velocity(trajectory.rotor.system, trajectory.plane, amplitudes)
    return float((half * (lost[:, 1:-1] @ WEIGHTS)).sum()), float(normal.max()), max(float(lost.max()), 0.0)


def _lasting_power(trajectory: Trajectory, times: np.ndarray, works: np.ndarray) -> float:
    """Power of friction with which a settled motion goes on, from the times of impacts and the work lost to friction in each."""
    if not trajectory.outcome.settled or trajectory.outcome is Outcome.LEVITATED:
        return 0.0
    if trajectory.segment_phases[-1, trajectory.plane] == Phase.ROLLING:
        return 0.0
    if presses(trajectory.segment_phases[-1, trajectory.plane]):
        return float(-contact_power(trajectory, np.array([trajectory.time]))[0][0])
    if len(times) < 2:
        return 0.0
    recent = slice(-max(RECENT, 2 * trajectory.multiplicity) - 1, None)
    times, works = times[recent], works[recent]
    return float(works[1:].sum() / (times[-1] - times[0]))
