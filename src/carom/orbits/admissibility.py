"""Whether an orbit is a motion of the machine, or why it is not."""

from __future__ import annotations

import numpy as np

from carom.base.outcome import Outcome, Phase
from carom.core.events import INSIDE, LEAVING, first_crossing
from carom.core.friction import friction_margin, slip_of
from carom.core.layout import rub_workspace, workspace
from carom.core.rub import lift_off, wall_push
from carom.core.variation import apply_impact
from carom.models import Rotor
from carom.orbits.shooting import TOLERANCE, ShootingStart
from carom.orbits.word import Kind, Word

IMPACT_RTOL = 1e-7
"""Relative difference below which the certified next event and the end of a segment count as the same event."""
SHIFT = 1e-4
"""Relative difference up to which they may be the same event if the rotor is on the wall from one to the other."""
AT_REST = 1e-14
"""Radial speed, in ``c_r Ω``, that counts as none: the size of rounding."""


def slip_stays_forward(rotor: Rotor) -> bool:
    """Whether an orbit with one impact a period cannot stay inside the wall if its slip is stopped or backward.

    After an impact that leaves no forward slip, the rotor moves backward along the wall at the speed ``s`` or more in
    the fixed frame.  There stiffness and unbalance change its velocity by less than ``ρ + ω²`` per unit of time.  So
    while it stays inside, it has moved backward after a time ``τ``, measured along the tangent at the impact, by more
    than ``b(τ) = s(1 − e^{−γτ})/γ − (ρ + ω²)τ²/2``.  Let ``b`` reach one clearance at ``τ₁ ≤ π``.  With a period above
    ``τ₁`` the rotor would pass through the wall.  A shorter period ends at the place of the impact rotated forward by
    the angle ``T``, where the rotor cannot be because ``b > 0``.
    """
    parameters = rotor.parameters
    if parameters.mu == 0.0:
        return True
    if parameters.gamma <= 0.0:
        return False
    times = np.linspace(0.0, np.pi, 200)
    gone = -parameters.radius_ratio * np.expm1(-parameters.gamma * times) / parameters.gamma
    return bool((gone - 0.5 * (parameters.rho + parameters.omega**2) * times**2).max() > 1.0)


def departure(rotor: Rotor, kind: Kind, node: np.ndarray) -> np.ndarray:
    """Amplitudes just after the impact at the beginning of a segment."""
    after = node.copy()
    apply_impact(rotor.system.arrays, 0, kind.sense, after, np.empty((0, len(node)), complex))
    return after


def why_virtual(rotor: Rotor, word: Word, start: ShootingStart) -> str:
    """Reason why an orbit of this word, nodes and durations is not admissible; empty if it is."""
    nodes = rotor.system.nodes.amplitudes(start.nodes)
    for i, (kind, node, duration) in enumerate(zip(word, nodes, start.durations.tolist(), strict=True)):
        reason = _why_no_impact(rotor, kind, node, duration)
        if reason:
            return reason if len(word) == 1 else f"segment {i + 1} of {len(word)}: {reason}"
    return ""


def _why_no_impact(rotor: Rotor, kind: Kind, node: np.ndarray, duration: float) -> str:
    """Reason why an impact and the flight after it are not a motion."""
    contact = rotor.system.contacts[0]
    wall = contact.wall
    _, local = contact.local(node)
    if local.real <= AT_REST:
        return "it would reach the wall from outside (radial speed not above 0)"
    stops = friction_margin(local, wall) >= 0.0
    if kind is Kind.IMPACT_STOPPED:
        if not stops:
            return "friction would not stop the slip during the impact"
    elif wall.friction > 0.0:
        if kind.sense * slip_of(local, wall) < 0.0:
            return "its slip, and so friction, would have the opposite direction"
        if stops:
            return "friction would stop the slip during the impact"
    after = departure(rotor, kind, node)
    if wall.restitution == 0.0 and wall_push(rotor.system.arrays, 0, after)[0] >= 0.0:
        return "it would stay on the wall: it does not rebound and is pressed outward"
    code, time = _first_contact(rotor, after, 1.5 * duration)
    if code == Outcome.CLEAR or _same_impact(rotor, after, time, duration):
        return ""
    if code == Outcome.GRAZING:
        return f"it grazes the wall at t = {time:.6g} after the impact"
    return f"it would cross the wall at t = {time:.6g}, before its period is over"


def _same_impact(rotor: Rotor, after: np.ndarray, time: float, duration: float) -> bool:
    """Whether the next contact of a flight and its end are one event.

    The nodes are on the wall as closely as Newton's method brings them, which shifts a slow impact in time by far more.
    """
    apart = abs(time - duration)
    if apart <= IMPACT_RTOL * duration or apart > SHIFT * duration:
        return apart <= IMPACT_RTOL * duration
    between, _ = rotor.system.at_plane(rotor.system.fly(after, np.array(0.5 * (time + duration))), 0)
    return bool(abs(abs(between) - 1.0) <= TOLERANCE * (1.0 + np.abs(after).max()))


def _first_contact(rotor: Rotor, start: np.ndarray, horizon: float) -> tuple[int, float]:
    """Outcome and time of the first contact after an impact."""
    arrays, work = rotor.system.arrays, workspace(len(start))
    if rotor.system.contacts[0].wall.restitution > 0.0:
        outcome, time = first_crossing(arrays, rotor.system.table, 0, start, horizon, LEAVING, work)
        return outcome, time
    # Without rebound the radial speed is zero at first: the distance from the wall grows with the square of time.
    amplitudes = start.copy()
    aloft, returned = lift_off(arrays, np.array([Phase.FLIGHT]), amplitudes, horizon, rub_workspace(len(start)))
    if aloft == 0.0:
        return int(Outcome.GRAZING), 0.0
    if returned:
        return int(Outcome.CONTACT), aloft
    outcome, time = first_crossing(arrays, rotor.system.table, 0, amplitudes, horizon - aloft, INSIDE, work)
    return outcome, aloft + time
