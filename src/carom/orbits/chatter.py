"""A chatter as one segment of an orbit: its end and its derivatives, and whether it is interrupted."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from carom.core.event_log import EventLog
from carom.core.fate import memory
from carom.core.rub import wall_push
from carom.core.segments import carry_through_chatter
from carom.core.variation import strike
from carom.models import Rotor
from carom.motions.simulation import follow
from carom.orbits.landings import NO_RETURN, distance_from_onset, slip_at_landing
from carom.orbits.word import Segment
from carom.outcome import Outcome, Phase

MOST_BOUNCES = 4096
"""Bounces of the longest chatter."""
LONGEST_CHATTER = 1e3
"""Longest chatter, in ``1/Ω``: a guess from which the rotor does not come back to the wall has to end too."""
"""The last impact of a chatter, by the direction of the slip at the landing."""
SLOW = 1e-5
"""Speed of a bounce, in ``c_r Ω``, below which a flight without return at once interrupts a chatter."""


def follow_chatter(
    rotor: Rotor, following: Segment, node: np.ndarray, arrival: np.ndarray, slopes: np.ndarray
) -> tuple[float, float, float]:
    """Follow a chatter and write its end and derivatives; return its duration, its distance from the onset, and its slip.

    The duration is ``nan`` if it does not end as it should.  If friction stops the slip of a chatter before sliding, it is completed at the
    bounce at which this happens, with the slip carried on beyond zero: so its slip at the landing is smooth.
    """
    system, size, plane = rotor.system, len(arrival), following.plane
    modes = system.modes
    basis, to_modes, rest = system.nodes
    contact = np.full(len(system.arrays.rows), -1)
    contact[plane] = Phase.FLIGHT
    log = EventLog.empty(MOST_BOUNCES, modes, len(contact))
    landing, changes = _on_wall(rotor, plane, to_modes @ (node - rest), np.concatenate([to_modes.T, 1j * to_modes.T]))
    slopes[:] = 0.0
    outcome, time, count = follow(rotor, landing, LONGEST_CHATTER, contact, log, memory(modes, stop_at_landing=True))
    bounces = log.first(count)
    last = _interruption(rotor, plane, bounces)
    if last is not None:
        bounces = bounces.first(last + 1)
        landing, time, outcome = bounces.after[last].copy(), float(bounces.times[last]), Outcome.CHATTER
    if outcome is not Outcome.CHATTER or not count or (bounces.planes != plane).any():
        arrival[:] = node
        return float("nan"), float("nan"), float("nan")
    distance = _distance(rotor, plane, bounces.after[-1])
    slip = following.kind.sense
    left, stops = slip_at_landing(rotor, plane, slip, bounces)
    if stops is not None:
        bounces = bounces.first(stops + 1)
        landing, time = bounces.before[stops].copy(), float(bounces.times[stops])
        strike(system.arrays, plane, slip, landing, np.empty((0, modes), complex))
    delays = np.empty(2 * size)
    at = plane, bounces.before, np.diff(bounces.times), landing, slip
    carry_through_chatter(system.arrays, *at, changes, delays)
    arrival[:] = basis @ landing + rest
    moved = basis @ changes.T
    slopes[:size, :-1], slopes[size:-1, :-1] = moved.real, moved.imag
    slopes[-1, :-1], slopes[-1, -1] = -delays, 1.0
    return time, distance, left


def _on_wall(rotor: Rotor, plane: int, amplitudes: np.ndarray, changes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Amplitudes with a plane moved onto its wall, and what small changes (k, N) of them become."""
    arrays = rotor.system.arrays
    row, lever = arrays.rows[plane], arrays.free * arrays.rows[plane].conj() / arrays.weights[plane]
    position = amplitudes @ row + arrays.offsets[plane]
    normal, moved = position / abs(position), changes @ row
    along = 1j * normal * (np.conj(normal) * moved).imag / abs(position)
    return amplitudes + lever * (normal - position), changes + np.outer(along - moved, lever)


def _distance(rotor: Rotor, plane: int, bounce: np.ndarray) -> float:
    """Distance from the onset of lasting contact of a chatter with a state at the beginning of one of its last bounces."""
    position, velocity = rotor.system.at_plane(bounce, plane)
    push, rate = wall_push(rotor.system.arrays, plane, bounce)
    speed = -float((np.conj(position) * velocity).real)
    # Where the force has vanished already, the bounce is one from which the rotor does not return.
    ratio = -rate * speed / push**2 if push > 0.0 else NO_RETURN
    return distance_from_onset(rotor.system.contacts[plane].wall.restitution, push, ratio)


def _interruption(rotor: Rotor, plane: int, bounces: EventLog) -> int | None:
    """Last bounce but one of a chatter that is interrupted just before it is complete."""
    gone = next(slow_departures(rotor, plane, bounces.after, bounces.planes == plane), None)
    return None if gone is None else max(gone - 1, 0)


def slow_departures(rotor: Rotor, plane: int, after: np.ndarray, chosen: np.ndarray | None = None) -> Iterator[int]:
    """Bounces, of states (n, N) just after them, that are slow and from which the rotor does not return at once.

    They interrupt a chatter, graze the wall, or have no rebound.
    """
    position, velocity = rotor.system.at_planes(after, np.full(len(after), plane))
    speeds = -(position.conj() * velocity).real
    slow = speeds < SLOW if chosen is None else (speeds < SLOW) & chosen
    for k in np.flatnonzero(slow).tolist():
        push, rate = wall_push(rotor.system.arrays, plane, after[k])
        if push <= 0.0 or -rate * speeds[k] > NO_RETURN * push * push:
            yield k
