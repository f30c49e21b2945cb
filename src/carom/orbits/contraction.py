"""How fast walls that give way shrink volumes of the state space."""

from __future__ import annotations

import numpy as np

from carom.core.laws.choice import force
from carom.motions.contacts import presses
from carom.motions.quadrature import NODES, WEIGHTS
from carom.motions.trajectories import Trajectory
from carom.outcome import Phase


def contraction(motion: Trajectory, first: int, last: int) -> float:
    """Integral of ``∂N/∂δ̇`` over the contacts of a motion between two events; ``nan`` if a slip reverses there without rolling.

    The force ``−(1 ± iμ) N n`` of a plane on its own mass has that trace, as ``δ̇ = Re(n̄ẏ)``.  Where contact begins and ends the
    surface that is crossed depends on the position, or the force is continuous: nothing is added.  A slip that reverses
    in the wall adds a factor that depends on how fast it does on both sides.

    Parameters
    ----------
    first, last : int
        Events of the motion; 0 to one more than all are the whole of it.
    """
    system, bounds = motion.rotor.system, np.append(motion.segment_starts, motion.time)
    # The segment after an event begins with it.
    begin = first + 1 if last <= len(motion.arrivals) else 0
    segments = np.arange(begin, min(last + 1, len(motion.segment_starts)))
    total = 0.0
    for plane in np.flatnonzero(system.arrays["stiffness"] > 0.0).tolist():
        phases = motion.segment_phases[segments, plane]
        if (np.abs(np.diff(phases)) == 1)[_slides(phases[1:]) & _slides(phases[:-1])].any():
            return float("nan")
        pressed = segments[presses(phases)]
        halves = 0.5 * (bounds[pressed + 1] - bounds[pressed])
        elapsed = halves[:, None] * (1.0 + NODES)
        amplitudes, _ = motion.amplitudes_in(np.broadcast_to(pressed[:, None], elapsed.shape), elapsed)
        depths, wall = np.abs(system.at_plane(amplitudes, plane)[0]) - 1.0, system.contacts[plane].wall
        # The forces of all laws are linear in the rate.
        rates = [[force(depth, 1.0, wall) - force(depth, 0.0, wall) for depth in row] for row in depths.tolist()]
        total += float(halves @ (np.array(rates).reshape(elapsed.shape) @ WEIGHTS))
    return total


def _slides(phases: np.ndarray) -> np.ndarray:
    """Which phases are sliding, bool."""
    return np.isin(phases, (Phase.FORWARD_SLIP, Phase.BACKWARD_SLIP))
