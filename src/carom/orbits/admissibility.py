"""Whether a single-impact orbit is a motion of the machine, or why it is not."""

from __future__ import annotations

import numpy as np

from carom.core.events import INSIDE, LEAVING, first_crossing
from carom.core.layout import rub_workspace, workspace
from carom.core.rub import lift_off
from carom.models import Jeffcott
from carom.motions.starts import State
from carom.orbits.maps import Section
from carom.orbits.names import Slip
from carom.outcome import Outcome, Phase
from carom.parameters import Parameters

ARRIVAL_TOLERANCE = 1e-7
"""Relative difference below which the certified first return and the period count as the same event."""


def slip_stays_forward(rotor: Jeffcott) -> bool:
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


def slip_speed(parameters: Parameters, section: Section) -> float:
    """Slip velocity just before the impact in ``c_r Ω``."""
    return parameters.radius_ratio + 1.0 + section.angular_speed


def departure(parameters: Parameters, section: Section, slip: Slip) -> State:
    """State just after an impact that does not stop the slip, which has the given direction."""
    before = section.state
    change = -(1.0 + parameters.d) * complex(1.0, slip * parameters.mu) * section.radial_speed * before.position
    return State(before.position, before.velocity + change)


def why_virtual(rotor: Jeffcott, period: float, section: Section, slip: Slip) -> str:
    """Reason why an orbit is not admissible; empty if it is.

    The section is the state just before the impact, to which the flight returns after the period, in ``1/Ω``; ``slip``
    is the direction of the slip that the orbit assumes.
    """
    parameters = rotor.parameters
    if section.radial_speed <= 0.0:
        return "it would meet the wall from outside (radial speed not above 0)"
    if parameters.mu > 0.0:
        speed = slip * slip_speed(parameters, section)
        if speed < 0.0:
            return "its slip would run the other way, and friction with it"
        if parameters.mu * (1.0 + parameters.d) * section.radial_speed >= speed:
            return "friction would stop the slip during the impact"
    after = departure(parameters, section, slip)
    start = rotor.system.amplitudes(after.position, after.velocity)
    if parameters.d == 0.0:
        force = start @ rotor.system.arrays.acceleration_rows[0]
        if (after.position.conjugate() * force).real + abs(after.velocity) ** 2 >= 0.0:
            return "it would stay on the wall: it does not rebound and is pressed outward"
    code, time = _first_return(rotor, start, 1.5 * period)
    if code == Outcome.CLEAR or abs(time - period) <= ARRIVAL_TOLERANCE * period:
        return ""
    if code == Outcome.GRAZING:
        return f"it grazes the wall at t = {time:.6g} after the impact"
    return f"it would cross the wall at t = {time:.6g}, before its period is over"


def _first_return(rotor: Jeffcott, start: np.ndarray, horizon: float) -> tuple[int, float]:
    """Outcome and time of the first return to the wall after an impact."""
    arrays, work = rotor.system.arrays, workspace(len(start))
    if rotor.parameters.d > 0.0:
        outcome, time = first_crossing(arrays, rotor.system.table, 0, start, horizon, LEAVING, work)
        return outcome, time
    # Without rebound the radial speed is zero at first: the distance from the wall grows with the square of time.
    amplitudes = start.copy()
    aloft, returned = lift_off(arrays, np.array([Phase.FLIGHT]), amplitudes, horizon, rub_workspace(len(start)))
    if aloft == 0.0:
        return int(Outcome.GRAZING), 0.0
    if returned:
        return int(Outcome.CONTACT), aloft
    outcome, time = first_crossing(arrays, rotor.system.table, 0, amplitudes, horizon - aloft, INSIDE, work)
    return outcome, aloft + time
