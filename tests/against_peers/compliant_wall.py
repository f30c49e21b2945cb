"""Peer with another contact model: a wall of springs and dashpots, integrated as an ordinary differential equation.

In the fixed frame the rotor centre ``z`` obeys ``z̈ + γż + ω²z = ρe^{i(t+φ)} − (P − iF) z/|z|``.  Where it has passed
``|z| = 1`` by ``δ`` the wall pushes with ``P = kδ + cδ̇``; it can only push, so the contact ends where ``P`` vanishes.
Friction is Coulomb's without any regularisation: ``F = −μP sgn v`` while the contact point slips with
``v = s + Im(z̄ż)/|z|``, and while it rolls whatever keeps ``v = 0``, up to ``μP``.

As ``k`` grows this becomes the rigid wall with a coefficient of restitution that ``c`` sets.  With ``c = 2 cos ψ √k`` an
impact takes the time ``2ψ/(sin ψ √k)`` and gives back the share ``d = e^{−2ψ cot ψ}`` of the speed: ``δ`` is then a multiple
of ``Im e^{λt}`` with ``λ = √k e^{i(π−ψ)}``, the push one of ``Im λ²e^{λt}``.  So all errors are of the order ``1/√k``.
"""

import math
from dataclasses import dataclass, field
from functools import cache

import heyoka as hy
import numpy as np

from carom.parameters import Parameters

from .constrained_motion import set_out

FLIGHT, FORWARD, BACKWARD, ROLLING, RELEASED = range(5)
NAMES = ("gamma", "omega", "rho", "phi", "mu", "radius_ratio")
MOST_EVENTS = 10_000


def restitution(angle: float) -> float:
    """Coefficient of restitution for the damping angle ``ψ``."""
    return math.exp(-2.0 * angle / math.tan(angle))


def dashpot(angle: float, stiffness: float) -> float:
    """Dashpot constant ``c`` for the damping angle ``ψ``."""
    return 2.0 * math.cos(angle) * math.sqrt(stiffness)


@dataclass(frozen=True)
class Motion:
    """States at given times in the fixed frame, and the kinds of motion that followed each other."""

    position: np.ndarray
    velocity: np.ndarray
    phases: list[int] = field(default_factory=list)


def follow(
    parameters: Parameters, stiffness: float, damping: float, position: complex, velocity: complex, times: np.ndarray
) -> Motion:
    """Follow a start inside the wall (fixed frame) and note its state at growing times."""
    values = np.array([*(getattr(parameters, name) for name in NAMES), stiffness, damping])
    state = np.array([position.real, position.imag, velocity.real, velocity.imag])
    time, phase, phases, noted = 0.0, FLIGHT, [FLIGHT], []
    while len(phases) < MOST_EVENTS:
        # heyoka misses an event when its margin is exactly zero at the start: leave that zero without events.
        lead = set_out(_integrator(phase, False), values, time, state)
        lead.propagate_until(min(time + _lead_time(phase, state, stiffness), times[len(noted)]))
        integrator = set_out(_integrator(phase, True), values, lead.time, lead.state)
        while len(noted) < len(times):
            code = int(integrator.propagate_until(times[len(noted)])[0])
            if -100 < code < 0:
                break
            noted.append(integrator.state.copy())
        if len(noted) == len(times):
            path = np.array(noted)
            return Motion(path[:, 0] + 1j * path[:, 1], path[:, 2] + 1j * path[:, 3], phases)
        time, state = integrator.time, integrator.state.copy()
        phase = _phase_after(phase, -1 - code, values, time, state)
        phases.append(phase)
    raise RuntimeError(f"more than {MOST_EVENTS} events")


def _lead_time(phase: int, state: np.ndarray, stiffness: float) -> float:
    """A time within which the next event cannot come: a small share of a bounce or of the wall's own time."""
    x, y, u, v = state
    return 0.01 * abs(x * u + y * v) if phase == FLIGHT else 1e-3 / math.sqrt(stiffness)


def _phase_after(phase: int, event: int, values: np.ndarray, time: float, state: np.ndarray) -> int:
    slip, push, need = _forces()(state, pars=values, time=time)
    if phase == RELEASED and event == 0:
        return FLIGHT
    if phase in (FLIGHT, RELEASED):
        return FORWARD if slip > 0.0 else BACKWARD
    if event == 0:
        return RELEASED
    if phase == ROLLING:
        return BACKWARD if event == 1 else FORWARD
    if abs(need) <= values[4] * push:
        return ROLLING
    return BACKWARD if need > 0.0 else FORWARD


def _expressions():
    """Variables, free acceleration, and what decides events: gap, push, slip and the friction that rolling needs."""
    x, y, u, v = hy.make_vars("x", "y", "u", "v")
    gamma, omega, rho, phi, _, ratio, stiffness, damping = (hy.par[i] for i in range(8))
    radius = hy.sqrt(x * x + y * y)
    outward, along = (x * u + y * v) / radius, (x * v - y * u) / radius
    pull_x = rho * hy.cos(hy.time + phi) - gamma * u - omega**2 * x
    pull_y = rho * hy.sin(hy.time + phi) - gamma * v - omega**2 * y
    need = outward * along / radius - (x * pull_y - y * pull_x) / radius
    push = stiffness * (radius - 1.0) + damping * outward
    return (x, y, u, v), (pull_x, pull_y), radius - 1.0, push, ratio + along, need


@cache
def _forces():
    variables, _, _, push, slip, need = _expressions()
    return hy.cfunc([slip, push, need], variables)


@cache
def _integrator(phase: int, with_events: bool):
    (x, y, u, v), (pull_x, pull_y), gap, push, slip, need = _expressions()
    mu, rising, falling = hy.par[4], hy.event_direction.positive, hy.event_direction.negative
    normal, grip = push, need
    margins = [push, mu * push - need, mu * push + need]
    if phase in (FORWARD, BACKWARD):
        sign = 1.0 if phase == FORWARD else -1.0
        grip, margins = -sign * mu * push, [push, sign * slip]
    events = [hy.t_event(margin, direction=falling) for margin in margins]
    if phase in (FLIGHT, RELEASED):
        normal = grip = 0.0
        events = [hy.t_event(gap, direction=rising)]
        if phase == RELEASED:
            events = [hy.t_event(gap, direction=falling), hy.t_event(push, direction=rising)]
    radius = gap + 1.0
    force_x, force_y = -(normal * x + grip * y) / radius, (grip * x - normal * y) / radius
    return hy.taylor_adaptive(
        [(x, u), (y, v), (u, pull_x + force_x), (v, pull_y + force_y)],
        [0.5, 0.0, 0.0, 0.0],
        t_events=events if with_events else [],
        tol=1e-15,
        compact_mode=True,
    )
