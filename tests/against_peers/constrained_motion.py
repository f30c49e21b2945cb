"""Peers for motion on the wall: general-purpose integrators with events, in the one coordinate that is left.

On the wall the rotor has an angle ``x`` and a rate ``w`` in the co-rotating frame.  Newton's law along and across the
wall, with the contact point slipping at ``v = s + 1 + w``, reads

    N = ρ cos(x − φ) + (1 + w)² − ω²,      ẇ = P − μN sgn v,      P = −γ(1 + w) − ρ sin(x − φ);

rolling keeps ``v = 0`` by a friction force ``−P`` and lasts while ``|P| ≤ μN``.  carom integrates complex mode
amplitudes by its own Taylor series instead, so nothing is shared but the physics.
"""

import math
from dataclasses import dataclass
from functools import cache

import numpy as np

from carom.base.outcome import Phase
from carom.parameters import Parameters

SIGN = {Phase.FORWARD_SLIP: 1.0, Phase.BACKWARD_SLIP: -1.0, Phase.ROLLING: 0.0}
LEAD = 1e-5
"""Time at the start of a segment without events: a margin that starts at zero and grows is not at its end."""
LIFT_OFF, SLIP_STOP = 0, 1


@dataclass(frozen=True)
class Segment:
    """A stretch of one kind of contact: nine even times from start to end, with angle and rate there."""

    phase: Phase
    times: np.ndarray
    angles: np.ndarray
    rates: np.ndarray
    event: int | None


def push(parameters: Parameters, angle: float, rate: float) -> float:
    """Normal force ``N``."""
    return parameters.rho * np.cos(angle - parameters.phi) + (1.0 + rate) ** 2 - parameters.omega**2


def pull(parameters: Parameters, angle: float, rate: float) -> float:
    """Force along the wall without friction, ``P``."""
    return -parameters.gamma * (1.0 + rate) - parameters.rho * np.sin(angle - parameters.phi)


def friction(parameters: Parameters, phase: Phase, angle: float, rate: float) -> float:
    """Friction force along growing angle."""
    if phase is Phase.ROLLING:
        return -pull(parameters, angle, rate)
    return -SIGN[phase] * parameters.mu * push(parameters, angle, rate)


def contact_phases(integrator, parameters: Parameters, angle: float, rate: float, until: float) -> list[Segment]:
    """Follow a contact through sliding and rolling until it lifts off or the time is up."""
    phase, time, segments = None, 0.0, []
    while True:
        phase = next_phase(parameters, angle, rate, phase)
        segment = integrator.segment(parameters, phase, angle, rate, time, until)
        segments.append(segment)
        if segment.event is None or (segment.event == LIFT_OFF and phase is not Phase.ROLLING):
            return segments
        time, angle, rate = segment.times[-1], segment.angles[-1], -1.0 - parameters.radius_ratio


def next_phase(parameters: Parameters, angle: float, rate: float, last: Phase | None) -> Phase:
    """How a contact goes on: Coulomb's law."""
    slip = parameters.radius_ratio + 1.0 + rate
    across, along = push(parameters, angle, rate), pull(parameters, angle, rate)
    if slip == 0.0 and last is not Phase.ROLLING and abs(along) <= parameters.mu * across:
        return Phase.ROLLING
    return Phase.FORWARD_SLIP if (slip or along) > 0.0 else Phase.BACKWARD_SLIP


@cache
def _heyoka_integrator(phase: Phase, with_events: bool):
    import heyoka as hy

    angle, rate = hy.make_vars("angle", "rate")
    gamma, omega, rho, phi, mu, ratio = (hy.par[i] for i in range(6))
    across = rho * hy.cos(angle - phi) + (1.0 + rate) ** 2 - omega**2
    along = -gamma * (1.0 + rate) - rho * hy.sin(angle - phi)
    if phase is Phase.ROLLING:
        bend, margins = 0.0 * rate, [mu * across - along, mu * across + along]
    else:
        sign = SIGN[phase]
        bend, margins = along - sign * mu * across, [across, sign * (ratio + 1.0 + rate)]
    falling = hy.event_direction.negative
    events = [hy.t_event(margin, direction=falling) for margin in margins] if with_events else []
    return hy.taylor_adaptive([(angle, rate), (rate, bend)], [0.0, 0.0], t_events=events, tol=1e-18)


def set_out(integrator, values: list[float], time: float, state: np.ndarray):
    """A heyoka integrator made ready for a machine and a state."""
    integrator.pars[:] = values[: len(integrator.pars)]
    integrator.time = time
    integrator.state[:] = state
    if integrator.with_events:
        integrator.reset_cooldowns()
    return integrator


class HeyokaIntegrator:
    """Adaptive Taylor integration to machine precision; events are roots of its polynomials (Biscani and Izzo 2021)."""

    precision = 1e-12

    def segment(
        self, parameters: Parameters, phase: Phase, angle: float, rate: float, time: float, until: float
    ) -> Segment:
        values = [getattr(parameters, name) for name in ("gamma", "omega", "rho", "phi", "mu", "radius_ratio")]
        state = np.array([angle, rate])
        lead = set_out(_heyoka_integrator(phase, False), values, time, state)
        lead.propagate_until(min(time + LEAD, until))
        main = set_out(_heyoka_integrator(phase, True), values, lead.time, lead.state)
        code = int(main.propagate_until(until)[0])
        times = np.linspace(time, main.time, 9)
        path = set_out(_heyoka_integrator(phase, False), values, time, state).propagate_grid(times)[-1]
        # heyoka numbers terminal events −1, −2, …
        return Segment(phase, times, path[:, 0], path[:, 1], -1 - code if -100 < code < 0 else None)


def random_contact(random: np.random.Generator) -> tuple[Parameters, float, float]:
    """A machine and a start on its wall that is pressed outward."""
    while True:
        ratio = random.uniform(0.3, 3.0)
        parameters = Parameters(
            gamma=random.uniform(0.01, 0.6),
            omega=random.uniform(0.3, 1.5),
            rho=random.uniform(0.05, 1.5),
            phi=random.uniform(-3.0, 3.0),
            mu=random.uniform(0.05, 0.6),
            d=random.uniform(0.0, 1.0),
            radius_ratio=ratio,
        )
        angle, rate = random.uniform(-math.pi, math.pi), random.uniform(-2.0 * (ratio + 1.0), 2.0)
        if push(parameters, angle, rate) > 0.02:
            return parameters, angle, rate
