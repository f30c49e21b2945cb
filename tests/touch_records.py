"""Records of a planar rotor that strikes a rigid wall, by a general integrator with events, with noise."""

import numpy as np
from scipy.integrate import solve_ivp

MASS, CLEARANCE, RADIUS, SPEED = 3.2, 0.25e-3, 15e-3, 24000 * np.pi / 30
"""Of examples/spindle.toml, in SI units."""


def struck(values, kick, seconds, rate, phase=0.0, start=0j, gravity=0.0):
    """Times, displacements in the fixed frame and instants of impacts of a rotor with these values that begins with a velocity."""
    damping, stiffness, eccentricity = (values[name] for name in ("damping", "stiffness", "eccentricity"))

    def rates(time, y):
        z, v = y[0] + 1j * y[1], y[2] + 1j * y[3]
        push = MASS * eccentricity * SPEED**2 * np.exp(1j * (SPEED * time + phase)) - 1j * MASS * gravity
        a = (push - damping * v - stiffness * z) / MASS
        return [v.real, v.imag, a.real, a.imag]

    def strikes(time, y):
        return y[0] ** 2 + y[1] ** 2 - CLEARANCE**2

    strikes.terminal, strikes.direction = True, 1
    times, time = np.arange(0.0, seconds, 1.0 / rate), 0.0
    places, impacts = np.zeros(len(times), complex), []
    y = np.array([start.real, start.imag, kick.real, kick.imag])
    while time < seconds and len(impacts) < 60:
        found = solve_ivp(
            rates, (time, seconds), y, method="DOP853", rtol=1e-11, atol=1e-14, events=strikes, dense_output=True
        )
        here = (times >= time) & (times <= found.t[-1])
        if here.any():
            seen = found.sol(times[here])
            places[here] = seen[0] + 1j * seen[1]
        time, y = found.t[-1], found.y[:, -1]
        if found.status != 1:
            break
        impacts.append(time)
        y = after_impact(y, values)
    return times, places, np.array(impacts)


def after_impact(y, values):
    """State after an impact: restitution along the normal, Coulomb friction until the slip has ended."""
    z = y[0] + 1j * y[1]
    normal = z / abs(z)
    local = (y[2] + 1j * y[3]) / normal
    pressed = (1.0 + values["restitution"]) * local.real
    slip = local.imag + RADIUS * SPEED
    rubbed = min(values["friction"] * pressed, abs(slip)) * np.sign(slip)
    velocity = normal * (local - pressed - 1j * rubbed)
    place = z * (1.0 - 1e-13) * CLEARANCE / abs(z)
    return np.array([place.real, place.imag, velocity.real, velocity.imag])
