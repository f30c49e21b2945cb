"""Impulses at the touchdown bearings in the events of a motion."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom.base.outcome import Phase
from carom.motions.kinematics import polar, shaft_speed

if TYPE_CHECKING:
    from carom.models import System
    from carom.motions.trajectories import Trajectory

AT_WALL = 1e-9
"""Distance from its wall up to which a plane may have had its impact together with another (:data:`carom.core.joint.ONE_INSTANT`), with
a margin for the rounding of states: of a plane without impact the equations give none but a rounding error."""
NONE, ROUNDING = 1e-12, 1e-14
"""Impulse, relative to the largest in the event and to the terms of velocities, below which a plane at its wall had no impact."""


class Impulses(NamedTuple):
    """Impulses at planes; arrays of shape (k,)."""

    events: np.ndarray
    """Number of the event."""
    planes: np.ndarray
    """Contact plane."""
    sizes: np.ndarray
    """Impulse on the rotor per effective mass of the plane, ``−P + iF``: outward, and along growing angle.  Complex."""

    def at(self, plane: int) -> Impulses:
        """Those at one plane."""
        here = self.planes == plane
        return Impulses(*(part[here] for part in self))


def impulses_of(motion: Trajectory, events: np.ndarray) -> Impulses:
    """Impulses that have changed the amplitudes of a rotor in some events, by their numbers, shape (n,).

    Of a plane alone the impulse is the change of its own velocity.  Where others are at their walls too, the impulses
    follow from the changes of velocity at all of these: ``Δu_p = Σ_q A_pq π_q`` (:mod:`carom.core.joint`), less those by the unbalance of
    a shaft whose speed jumps.  Of planes that always
    move alike only the sum of their impulses counts, which is given to them in equal parts.
    """
    system, planes = motion.rotor.system, motion.event_planes[events]
    lasting = motion.segment_phases[events] != Phase.FLIGHT
    before, after = motion.event_amplitudes[events], motion.segment_amplitudes[events + 1]
    arrays, places, count = system.arrays, np.arange(len(events)), lasting.shape[1]
    pushed = (before, _without_jolt(system, before, after))
    states = [[system.at_planes(each, np.full(len(events), p)) for p in range(count)] for each in pushed]
    position = np.stack([place for place, _ in states[0]], axis=-1)
    normal = position / np.abs(position)
    speeds = [
        np.stack([radial + 1j * along for _, radial, along in (polar(*at) for at in each)], axis=-1) for each in states
    ]
    changes = speeds[1] - speeds[0]
    at_wall = (lasting | (np.abs(position) >= 1.0 - AT_WALL)) & (arrays.stiffness == 0.0)
    at_wall[places, planes] = True
    impulses = np.where(at_wall, changes, 0.0)
    for event in np.flatnonzero(at_wall.sum(axis=1) > 1):
        here = np.flatnonzero(at_wall[event])
        couplings = normal[event, here].conj()[:, None] * arrays.mobility[np.ix_(here, here)] * normal[event, here]
        impulses[event, here] = np.linalg.lstsq(couplings, changes[event, here])[0]
    sizes, terms = np.abs(impulses), np.abs(before) @ np.abs(arrays.rate_rows).T
    has_impact = sizes > NONE * sizes.max(axis=1, initial=0.0, keepdims=True) + ROUNDING * terms
    has_impact[places, planes] |= ~has_impact.any(axis=1)
    rows, columns = np.nonzero(has_impact)
    return Impulses(events[rows], columns, impulses[rows, columns])


def _without_jolt(system: System, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Amplitudes after events without the impulse of the unbalance, which moves the rotor as the speed of its shaft jumps."""
    if system.shaft is None:
        return after
    direction = before[:, int(system.arrays.shaft[0]), None]
    jump = shaft_speed(system, after) - shaft_speed(system, before)
    freed: np.ndarray = after + 1j * jump[:, None] * direction * system.arrays.unbalance
    return freed
