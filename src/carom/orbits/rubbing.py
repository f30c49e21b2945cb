"""Search for periodic motions with lasting contact: bounces, a chatter, sliding or rolling, and a lift-off once a period.

At a lift-off ``r = 1``, ``ṙ = 0`` and ``N = ρ cos x + (1 + θ̇)² − ω² = 0`` with ``x = θ − φ``, so the angle and the
direction of whirl determine the state, and a simulated motion from one lift-off to the next is a map of one variable.  Its fixed
points are found from changes of sign between evenly spaced angles, and closed as orbits of their words.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise
from typing import Annotated, Literal

import numpy as np

from carom.arguments import Count, checked
from carom.arguments import Kind as ArgumentKind
from carom.continuation.roots import bracketed_root, sign_change
from carom.models import Rotor, Subject, exact_rotor_of
from carom.motions.simulation import simulate
from carom.motions.starts import State
from carom.motions.trajectories import Trajectory
from carom.orbits.names import RubbingName
from carom.orbits.orbit import Orbit, orbit_near, same_orbit
from carom.orbits.recognising import segments_of
from carom.orbits.word import Kind
from carom.outcome import CaromError, Phase
from carom.results import Result

Whirl = Literal[1, -1]

LONGEST_PERIOD = 8.0 * math.pi
"""Longest period, in ``1/Ω``: four turns of the shaft."""
Longest = Annotated[float, ArgumentKind(lambda time: 0.0 < time <= 1e5, "a time above 0, up to 1e5, in 1/Omega")]
"""Longest period of the orbits that are searched."""
SAMPLES = 48
HALVINGS = 10
"""Bisections between an angle that has a next lift-off and a neighbouring one that has none."""
MOST_EVENTS = 4000
CLOSE = 1e-8
"""Accuracy of the angle of a lift-off from which Newton's method starts, in rad."""
SAME_PERIOD = 0.02
"""Relative change of the period beyond which Newton's method has gone to another motion."""


@dataclass(frozen=True, eq=False, repr=False)
class LiftOff(Result):
    """The lift-off of a periodic motion with one stretch of lasting contact, and what follows up to the next.

    Attributes
    ----------
    angle : float
        ``x = θ − φ``, rad.
    whirl : {1, -1}
        Sign of ``1 + θ̇``: forward or backward in the fixed frame.
    impacts : int
        Number of bounces, without those replaced by the completion of the chatter.
    contact_time : float
        Duration of the lasting contact, in ``1/Ω``.
    landing_force : float
        Normal force at its beginning, in ``m c_r Ω²``; it vanishes at the onset.
    """

    angle: float
    whirl: Whirl
    impacts: int
    contact_time: float
    landing_force: float


@checked
def rubbing_orbits(machine: Subject, longest: Longest = LONGEST_PERIOD, samples: Count = SAMPLES) -> tuple[Orbit, ...]:
    """Periodic motions with one stretch of lasting contact a period, found from evenly spaced angles of lift-off.

    Stable and unstable ones are found; two whose angles lie closer than ``2π/samples`` may be missed.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    longest : float
        Longest period, in ``1/Ω``.
    samples : int
        Number of angles tried in each direction of whirl.

    See Also
    --------
    carom.continue_orbit : follow one along a parameter
    """
    rotor = exact_rotor_of(machine)
    angles = np.linspace(-math.pi, math.pi, samples + 1).tolist()
    found: list[Orbit] = []
    whirls: tuple[Whirl, Whirl] = (1, -1)
    for whirl in whirls:

        @cache
        def shift(angle: float, whirl: Whirl = whirl) -> float:
            return _shift(rotor, whirl, angle, longest)

        for neighbours in pairwise(angles):
            bracket = sign_change(shift, *neighbours, HALVINGS)
            # A change of sign through ±π, or a jump, is no fixed point.
            if bracket is None or abs(shift(bracket[0])) + abs(shift(bracket[1])) >= math.pi:
                continue
            try:
                angle = bracketed_root(shift, *bracket, CLOSE)
            except CaromError:
                continue
            orbit = _closed(rotor, whirl, angle, longest)
            if orbit is not None and not any(same_orbit(orbit, known) for known in found):
                found.append(orbit)
    return tuple(replace(orbit, name=RubbingName(orbit.impacts, k)) for k, orbit in enumerate(found, start=1))


def lift_off_state(rotor: Rotor, whirl: Whirl, angle: float) -> State | None:
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


@checked
def lift_off_of(orbit: Orbit) -> LiftOff:
    """The lift-off of an orbit with lasting contact.

    Raises
    ------
    CaromError
        It never lifts off.
    """
    lifts = np.flatnonzero(orbit.word.kinds == Kind.LIFT)
    if not len(lifts):
        raise CaromError(f"the orbit {orbit.word} never lifts off")
    section = orbit.sections[lifts[0]]
    # On the wall to the last bit, where a simulation may begin.
    motion = simulate(orbit.rotor, section.state, orbit.period)
    return LiftOff(
        angle=math.remainder(section.angle - orbit.rotor.parameters.phi, math.tau),
        whirl=1 if section.angular_speed > -1.0 else -1,
        impacts=int(motion.is_impact.sum()),
        contact_time=float(orbit.durations[[segment.kind.lasts for segment in orbit.word]].sum()),
        landing_force=orbit.margins.normal_force,
    )


def _next(rotor: Rotor, whirl: Whirl, angle: float, longest: float) -> tuple[Trajectory, int, int] | None:
    """Motion from a lift-off to the end of the flight after the next; and the events at which both flights end."""
    start = lift_off_state(rotor, whirl, angle)
    if start is None:
        return None
    # Most periods are short: simulate one turn first.
    reach = min(longest, math.tau)
    while True:
        motion = simulate(rotor, start, reach, max_events=MOST_EVENTS)
        flying = motion.segment_phases[:, 0] == Phase.FLIGHT
        # By rounding the rotor may stay on the wall for an instant before it lifts off.
        first = int(np.argmax(flying))
        landing = first + int(np.argmin(flying[first:]))
        lifting = landing + int(np.argmax(flying[landing:]))
        if flying[first] and not flying[landing] and flying[lifting]:
            return motion, first, lifting
        if reach >= longest:
            return None
        reach = min(2.0 * reach, longest)


def _shift(rotor: Rotor, whirl: Whirl, angle: float, longest: float) -> float:
    """Angle from a lift-off to the next, in rad; ``nan`` if there is none with the same direction of whirl."""
    found = _next(rotor, whirl, angle, longest)
    if found is None:
        return math.nan
    motion, _, lifting = found
    position, velocity = rotor.system.state(motion.segment_amplitudes[lifting])
    if (1 if (np.conj(position) * velocity).imag > -1.0 else -1) != whirl:
        return math.nan
    return math.remainder(cmath.phase(complex(position)) - rotor.parameters.phi - angle, math.tau)


def _closed(rotor: Rotor, whirl: Whirl, angle: float, longest: float) -> Orbit | None:
    """Orbit of the motion that lifts off near an angle, by Newton's method; ``None`` if it does not close."""
    found = _next(rotor, whirl, angle, longest)
    if found is None:
        return None
    motion, first, lifting = found
    period = float(motion.segment_starts[lifting] - motion.segment_starts[first])
    # The flight after the second lift-off takes as long as that after the first.
    motion = simulate(rotor, motion.start, motion.segment_starts[lifting] + period, max_events=MOST_EVENTS)
    if lifting >= len(motion.event_planes):
        return None
    orbit = orbit_near(rotor, *segments_of(motion, first, lifting))
    if orbit is None or not orbit.admissible or abs(orbit.period - period) > SAME_PERIOD * period:
        return None
    return orbit
