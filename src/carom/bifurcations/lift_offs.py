"""The map from one lift-off to the next: a rotor leaves the wall, bounces, chatters into lasting contact and lifts off.

At a lift-off ``r = 1``, ``ṙ = 0`` and ``N = ρ cos x + (1 + θ̇)² − ω² = 0`` with ``x = θ − φ``, so the angle and the
direction of whirl determine the state.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from carom.models import Jeffcott, jeffcott_of
from carom.motions.starts import State
from carom.motions.trajectories import Trajectory, simulate
from carom.outcome import CaromError, Phase

Whirl = Literal[1, -1]

LONGEST = 8.0 * math.pi
"""Longest time to the next lift-off, in ``1/Ω``: four turns of the shaft."""
MOST_EVENTS = 4000
TOLERANCE = 1e-9
"""Largest angle between two lift-offs that count as the same."""
DIFFERENCE = 1e-6
FINEST = 1e-11
"""Relative step of the parameter at which the search for the end of a branch stops."""


@dataclass(frozen=True)
class LiftOff:
    """The next lift-off after a given one, and the motion in between."""

    angle: float
    """``x = θ − φ`` of the lift-off, rad."""
    whirl: Whirl
    """Sign of ``1 + θ̇``: forward or backward in the fixed frame."""
    time: float
    """Time since the previous lift-off, in ``1/Ω``."""
    impacts: int
    """Number of bounces in between, without those replaced by the completion of the chatter."""
    contact_time: float
    """Duration of the lasting contact, in ``1/Ω``."""
    landing_force: float
    """Normal force at the beginning of the lasting contact, in ``m c_r Ω²``; it vanishes at the onset."""


def lift_off_state(rotor: Jeffcott, whirl: Whirl, angle: float) -> State | None:
    """State of a rotor that lifts off at ``x = θ − φ``; ``None`` if the normal force does not fall through zero."""
    gamma, omega, rho = rotor.parameters.gamma, rotor.parameters.omega, rotor.parameters.rho
    square = omega * omega - rho * math.cos(angle)
    if not square > 0.0:
        return None
    turning = whirl * math.sqrt(square)
    # Ṅ with θ̈ = −γ(1 + θ̇) − ρ sin x, as there is no friction without a normal force.
    pull = rho * math.sin(angle)
    if -pull * (turning - 1.0) - 2.0 * turning * (gamma * turning + pull) >= 0.0:
        return None
    position = cmath.rect(1.0, angle + rotor.parameters.phi)
    return State(position, 1j * (turning - 1.0) * position)


def next_lift_off(rotor: Jeffcott, whirl: Whirl, angle: float, longest: float = LONGEST) -> LiftOff | None:
    """Follow a rotor from a lift-off to the next; ``None`` if there is none within the time ``longest``."""
    start = lift_off_state(rotor, whirl, angle)
    if start is None:
        return None
    # Most periods are short: simulate one turn first.
    reach = min(longest, math.tau)
    while reach < longest:
        found = _first_lift_off(simulate(rotor, start, reach, max_events=MOST_EVENTS))
        if found is not None:
            return found
        reach *= 2.0
    return _first_lift_off(simulate(rotor, start, longest, max_events=MOST_EVENTS))


def _first_lift_off(motion: Trajectory) -> LiftOff | None:
    """The first lift-off of a motion that begins with one."""
    rotor = jeffcott_of(motion.rotor)
    flying = motion.segment_phases[:, 0] == Phase.FLIGHT
    # By rounding the rotor may stay on the wall for an instant before it lifts off.
    first = int(np.argmax(flying))
    landing = first + int(np.argmin(flying[first:]))
    lifting = landing + int(np.argmax(flying[landing:]))
    if flying[landing] or not flying[lifting] or not flying[first]:
        return None
    position, velocity = motion.rotor.system.state(motion.segment_amplitudes[lifting])
    times = motion.segment_starts
    return LiftOff(
        angle=cmath.phase(complex(position) * cmath.exp(-1j * rotor.parameters.phi)),
        whirl=1 if (np.conj(position) * velocity).imag > -1.0 else -1,
        time=float(times[lifting]),
        impacts=landing - first - 1,
        contact_time=float(times[lifting] - times[landing]),
        landing_force=float(motion.forces(times[landing : landing + 1])[0][0]),
    )


def shift_of(found: LiftOff | None, whirl: Whirl, angle: float) -> float:
    """Angle from a lift-off to the next, in rad; ``nan`` if there is none with the same direction of whirl."""
    if found is None or found.whirl != whirl:
        return math.nan
    return math.remainder(found.angle - angle, math.tau)


def known(found: LiftOff | None) -> LiftOff:
    """Return a lift-off that must exist because its motion was followed; an error if it does not."""
    if found is None:
        raise CaromError("a motion that was followed has no lift-off any more")
    return found


def slope(function: Callable[[float], float], x: float) -> float:
    """Derivative of a function of simulations, by a central difference."""
    return (function(x + DIFFERENCE) - function(x - DIFFERENCE)) / (2.0 * DIFFERENCE)


def end_of_motions(
    residual: Callable[[float, float], float],
    start: tuple[float, float],
    lean: float,
    step: float,
    by_angle: float,
    finest: float,
) -> tuple[float, float]:
    """Last angle and value of a parameter at which the motion exists.

    The equations end there, so they have no derivative at that point.  The predictor is a straight line; the corrector
    uses the slope of the residual at a point before the end.  The step is doubled until it fails for the first time;
    after each failure it is halved.

    Parameters
    ----------
    residual : callable
        Function of angle and value; ``nan`` where there is no such motion.
    start : tuple of float
        Angle and value of a motion near the end.
    lean : float
        Change of the angle with the value.
    step : float
        First change of the value, towards the end.
    by_angle : float
        Derivative of the residual with respect to the angle.
    finest : float
        Step of the value at which the search stops.
    """
    angle, value = start
    passed = False
    while abs(step) > finest:
        trial, p = angle + lean * step, value + step
        left = math.nan
        for _ in range(6):
            left = residual(trial, p)
            if not abs(left) > TOLERANCE:
                break
            trial -= left / by_angle
        if abs(left) <= TOLERANCE:
            angle, value = trial, p
            step *= 1.0 if passed else 2.0
        else:
            passed = True
            step *= 0.5
    return angle, value


def end_of_branch(residual: Callable[[float, float], float], points: np.ndarray, size: float) -> tuple[float, float]:
    """:func:`end_of_motions` from the points of a branch, shape (m, 2), the last of which is next to the end."""
    angle, value = points[-1].tolist()
    far = np.flatnonzero(np.abs(points[:, 1] - value) > 1e-6 * size)
    if not len(far):
        return angle, value
    x, p = points[far[-1]].tolist()
    by_angle = slope(lambda turned: residual(turned, p), x)
    lean = (angle - x) / (value - p)
    return end_of_motions(
        residual, (angle, value), lean, math.copysign(1e-5 * size, value - p), by_angle, FINEST * size
    )
