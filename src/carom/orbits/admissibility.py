"""Whether an orbit is a motion of the machine, or why it is not."""

from __future__ import annotations

import numpy as np

from carom.core.event_log import EventLog
from carom.core.events import INSIDE, LEAVING, first_crossing
from carom.core.fate import memory
from carom.core.friction import slip_of, spare_friction
from carom.core.layout import rub_workspace, workspace
from carom.core.phases import AWAY
from carom.core.rub import lift_off, rest_on_wall, wall_push
from carom.core.rub_step import NOWHERE
from carom.core.segments import MOST_STEPS
from carom.core.variation import strike
from carom.models import Rotor
from carom.motions.simulation import follow
from carom.orbits.chatter import LONGEST_CHATTER, MOST_BOUNCES
from carom.orbits.shooting import TOLERANCE, Start
from carom.orbits.word import Kind, Segment, Word
from carom.outcome import Outcome, Phase

ARRIVAL_TOLERANCE = 1e-7
"""Relative difference below which the certified next event and the end of a segment count as the same event."""
SHIFT = 1e-4
"""Relative difference up to which they may be the same event if the rotor is on the wall from one to the other."""
AT_REST = 1e-14
"""Radial speed, in ``c_r Ω``, that counts as none: the size of rounding."""
STOPPED = 1e-10
"""Slip at a landing or at the beginning of lasting contact, in ``c_r Ω``, that counts as none."""
INSTANT = 1e-9
"""Time within which a rotor that has just lost its normal force may still be in contact, in ``1/Ω``."""


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


def departure(rotor: Rotor, segment: Segment, node: np.ndarray) -> np.ndarray:
    """Amplitudes just after the beginning of a segment: after the impact, if there is one."""
    if not segment.kind.is_impact:
        return node
    after = node.copy()
    strike(rotor.system.arrays, segment.plane, segment.kind.sense, after, np.empty((0, len(node)), complex))
    return after


def why_virtual(rotor: Rotor, word: Word, start: Start) -> str:
    """Reason why an orbit of this word, nodes and durations is not admissible; empty if it is."""
    nodes = rotor.system.nodes.amplitudes(start.nodes)
    for i, segment in enumerate(word):
        target = word[(i + 1) % len(word)]
        at = rotor, segment, target, nodes[i], float(start.durations[i])
        reason = _why_no_impact(*at) if segment.kind.is_impact else _why_no_such_contact(*at)
        if reason:
            return reason if len(word) == 1 else f"segment {i + 1} of {len(word)}: {reason}"
    return ""


def _why_no_impact(rotor: Rotor, segment: Segment, target: Segment, node: np.ndarray, duration: float) -> str:
    """Reason why an impact and the flight after it are not a motion."""
    contacts, plane = rotor.system.contacts, segment.plane
    wall = contacts[plane].wall
    _, local = contacts[plane].local(node)
    if local.real <= AT_REST:
        return "it would meet the wall from outside (radial speed not above 0)"
    stops = spare_friction(local, wall) >= 0.0
    if segment.kind is Kind.IMPACT_STOPPED:
        if not stops:
            return "friction would not stop the slip during the impact"
    elif wall.friction > 0.0:
        if segment.kind.sense * slip_of(local, wall) < 0.0:
            return "its slip would run the other way, and friction with it"
        if stops:
            return "friction would stop the slip during the impact"
    after = departure(rotor, segment, node)
    if wall.restitution == 0.0:
        if wall_push(rotor.system.arrays, plane, after)[0] >= 0.0:
            return "it would stay on the wall: it does not rebound and is pressed outward"
        if len(contacts) > 1:
            return _why_no_such_contact(rotor, segment, target, node, duration)
    for touched in range(len(contacts)):
        code, time = _first_contact(rotor, plane, touched, after, 1.5 * duration)
        arrives = touched == target.plane and _same_arrival(rotor, touched, after, time, duration)
        if code == Outcome.CLEAR or arrives or (touched != target.plane and time > duration):
            continue
        if code == Outcome.GRAZING:
            return f"it grazes the wall at t = {time:.6g} after the impact"
        return f"it would cross the wall at t = {time:.6g}, before its period is over"
    return ""


def _same_arrival(rotor: Rotor, plane: int, after: np.ndarray, time: float, duration: float) -> bool:
    """Whether the next contact of a flight and its end are one event.

    The nodes are on the wall as closely as Newton's method brings them, which shifts a slow arrival in time by far more.
    """
    apart = abs(time - duration)
    if apart <= ARRIVAL_TOLERANCE * duration or apart > SHIFT * duration:
        return apart <= ARRIVAL_TOLERANCE * duration
    between, _ = rotor.system.at_plane(rotor.system.fly(after, np.array(0.5 * (time + duration))), plane)
    return bool(abs(abs(between) - 1.0) <= TOLERANCE * (1.0 + np.abs(after).max()))


def _first_contact(rotor: Rotor, left: int, plane: int, start: np.ndarray, horizon: float) -> tuple[int, float]:
    """Outcome and time of the first contact of a plane after an impact at a plane."""
    arrays, work = rotor.system.arrays, workspace(len(start))
    if plane != left or rotor.system.contacts[plane].wall.restitution > 0.0:
        leaves = LEAVING if plane == left else INSIDE
        outcome, time = first_crossing(arrays, rotor.system.table, plane, start, horizon, leaves, work)
        return outcome, time
    # Without rebound the radial speed is zero at first: the distance from the wall grows with the square of time.
    amplitudes = start.copy()
    aloft, returned = lift_off(arrays, np.array([Phase.FLIGHT]), amplitudes, horizon, rub_workspace(len(start)))
    if aloft == 0.0:
        return int(Outcome.GRAZING), 0.0
    if returned:
        return int(Outcome.CONTACT), aloft
    outcome, time = first_crossing(arrays, rotor.system.table, plane, amplitudes, horizon - aloft, INSIDE, work)
    return outcome, aloft + time


PHASES = {Kind.SLIDE_FORWARD: 1, Kind.SLIDE_BACKWARD: 2, Kind.ROLL: 3}
"""Phase of a segment that stays at its wall; all others begin in flight."""


def _why_no_such_contact(rotor: Rotor, segment: Segment, target: Segment, node: np.ndarray, duration: float) -> str:
    """Reason why a segment is not what the simulation does from its node, by kind of contact, place and time."""
    if segment.kind is Kind.LAND:
        return _why_no_such_landing(rotor, segment, target, node)
    planes = len(rotor.system.contacts)
    log, amplitudes = EventLog.empty(1, len(node), planes), node.copy()
    contact = np.full(planes, AWAY)
    contact[segment.plane] = PHASES.get(segment.kind, Phase.FLIGHT)
    if not segment.kind.is_impact:
        contact[segment.plane] = _put_on_wall(rotor, segment, amplitudes)
    recollection = memory(len(node), stop_at_landing=True)
    recollection.lifting = (
        segment.plane + 1 if contact[segment.plane] == Phase.FLIGHT and segment.kind is Kind.LIFT else 0
    )
    time, first = 0.0, segment.kind.is_impact
    before = contact.copy()
    stays = segment == target
    for _ in range(MOST_STEPS):
        horizon = duration - time if stays else 2.0 * duration + 1.0
        outcome, elapsed, _ = follow(rotor, amplitudes, horizon, contact, log, recollection)
        time += elapsed
        if outcome is Outcome.EVENT_LIMIT and log.planes[0] == NOWHERE:
            continue  # a step of the flight next to a wall
        if segment.kind is Kind.LIFT and time <= INSTANT:
            continue  # by rounding the rotor may stay at the wall for an instant before it lifts off
        changes = (np.maximum(contact, 0) != np.maximum(before, 0)).any() or segment.kind.flies
        if outcome is not Outcome.EVENT_LIMIT or (changes and not first):
            break
        first = False
    late = abs(time - duration) > ARRIVAL_TOLERANCE * max(duration, 1.0)
    wrong = contact[target.plane] != PHASES.get(target.kind, Phase.FLIGHT) and target.kind is not Kind.LAND
    if late or wrong:
        return f"{segment} would end at t = {time:.6g} in another way than with {target}"
    return ""


def _put_on_wall(rotor: Rotor, segment: Segment, amplitudes: np.ndarray) -> int:
    """Remove from a segment's start, at rest on the wall, what Newton's method leaves of speeds that are zero there; return the phase.

    A rotor that lifts off may still be pressed to the wall for an instant, in which it slides.
    """
    arrays, plane = rotor.system.arrays, segment.plane
    slip = _slip(rotor, plane, amplitudes)
    rest_on_wall(arrays, plane, amplitudes, segment.kind is Kind.ROLL or abs(slip) <= STOPPED)
    if segment.kind is Kind.LIFT and wall_push(arrays, plane, amplitudes)[0] > 0.0:
        return PHASES[Kind.SLIDE_BACKWARD if slip < 0.0 else Kind.SLIDE_FORWARD]
    return PHASES.get(segment.kind, int(Phase.FLIGHT))


def _slip(rotor: Rotor, plane: int, amplitudes: np.ndarray) -> float:
    contact = rotor.system.contacts[plane]
    _, local = contact.local(amplitudes)
    return float(slip_of(local, contact.wall))


def _why_no_such_landing(rotor: Rotor, segment: Segment, target: Segment, node: np.ndarray) -> str:
    """Reason why the lasting contact after a chatter is of another kind; the chatter itself is simulated in any case."""
    planes, landing = len(rotor.system.contacts), node.copy()
    contact = np.full(planes, AWAY)
    contact[segment.plane] = Phase.FLIGHT
    log = EventLog.empty(MOST_BOUNCES, len(node), planes)
    follow(rotor, landing, LONGEST_CHATTER, contact, log, memory(len(node), stop_at_landing=True))
    slip = _slip(rotor, segment.plane, landing)
    wrong = {Kind.SLIDE_FORWARD: -slip, Kind.SLIDE_BACKWARD: slip}.get(target.kind, abs(slip))
    return f"{segment} would end with the slip {slip:.3g}, not with {target}" if wrong > STOPPED else ""
