"""Works of lasting contact in each segment of a motion, and energies that compliant touchdown bearings hold and lose."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom.base.outcome import Phase
from carom.core.wall_work import COLUMNS, contact_works_all, stored_energies_all
from carom.motions.kinematics import presses

if TYPE_CHECKING:
    from carom.motions.trajectories import Trajectory


class ContactWorks(NamedTuple):
    """What contact does in the segments of a motion in which a plane is at its wall, by the columns of :mod:`carom.core.wall_work`."""

    segments: np.ndarray
    """Numbers of these segments, shape (k,)."""
    found: np.ndarray
    """For each of them and each plane, shape (k, P, 9)."""


def contact_works(motion: Trajectory) -> ContactWorks:
    """Add up the contact at all planes over each segment of a motion."""
    segments = np.flatnonzero((motion.segment_phases != Phase.FLIGHT).any(axis=1))
    found = np.empty((len(segments), motion.segment_phases.shape[1], COLUMNS))
    contact_works_all(
        motion.rotor.system.arrays,
        segments,
        motion.segment_amplitudes,
        motion.segment_phases,
        motion.segment_limits,
        np.fmod(motion.begins + motion.segment_starts[segments], 2.0 * np.pi),
        motion.durations[segments],
        motion.workspace(),
        found,
    )
    return ContactWorks(segments, found)


def stored(motion: Trajectory, amplitudes: np.ndarray, phases: np.ndarray) -> np.ndarray:
    """Energy that the spring of the plane's wall holds in states (n, N) with phases (n,) there; none where there is no contact."""
    position, _ = motion.rotor.system.at_plane(amplitudes, motion.plane)
    held = presses(phases)
    energy = np.zeros(len(amplitudes))
    energy[held] = stored_energies_all(motion.rotor.system.arrays, motion.plane, np.abs(position[held]) - 1.0)
    return energy


def lost_on_parting(motion: Trajectory) -> np.ndarray:
    """Energy of the wall's spring that is lost in each event, (n,): where plane and wall part, less what it holds where they meet again."""
    phases = motion.segment_phases[:, motion.plane]
    parted = phases == Phase.SEPARATED
    lost = stored(motion, motion.event_amplitudes, phases[:-1]) - stored(
        motion, motion.segment_amplitudes[1:], phases[1:]
    )
    return np.where(parted[:-1] | parted[1:], lost, 0.0)
