"""Largest radius, depth and force of a motion, at any touchdown bearing."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.base.outcome import Phase
from carom.motions.trajectories import Trajectory

SAMPLES = 2000


class Extremes(NamedTuple):
    """Largest values on a periodic motion, at any touchdown bearing.

    Attributes
    ----------
    radius, depth : float
        Distance from the centre, and how far this is into a compliant wall, in its clearance.
    force : float
        Normal force while contact lasts, in ``m c_r Ω²`` of the rotor; 0 where it never does.
    """

    radius: float
    depth: float
    force: float


def extremes_of(motion: Trajectory) -> Extremes:
    """Largest radius, depth and force of a motion at any plane; extremes within contact are those of its log where it has one."""
    system, times = motion.rotor.system, np.linspace(0.0, motion.time, SAMPLES)
    times = np.sort(np.append(times, motion.segment_starts))
    amplitudes, phases = motion.amplitudes_at(times)
    radius = depth = force = 0.0
    for plane in range(phases.shape[1]):
        seen, compliant = motion.seen_at(plane), bool(system.arrays["stiffness"][plane])
        far = float(np.abs(system.at_plane(amplitudes, plane)[0]).max())
        if compliant:
            touches = seen.contacts
            far = max(far, 1.0 + float(touches.deepest.max(initial=0.0)) if len(touches.deepest) else 0.0)
            force = max(force, float(touches.peak_force.max(initial=0.0)) / float(system.widths[plane]))
            depth = max(depth, far - 1.0)
        radius = max(radius, far)
        if (phases[:, plane] != Phase.FLIGHT).any():
            normal = seen.forces_of(amplitudes, phases, times)[0]
            force = max(force, float(normal.max()) / float(system.widths[plane]))
    return Extremes(radius, max(depth, 0.0), force)
