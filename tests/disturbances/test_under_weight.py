"""Shocks and losses of a blade of machines that weigh something, against a general solver in SI units."""

import cmath
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import carom as cm
from carom.base.outcome import InputError
from carom.disturbances import BladeLoss

MACHINE = "examples/dropped-rotor.toml"
MASS, DAMPING, STIFFNESS, SPEED = 5.0, 900.0, 5e5, 300.0 * math.pi
PEAK, LASTS, DIRECTION = 0.3 * 9.80665, 0.011, 0.7


def whirl(eccentricity, phase=0.0):
    """Displacement at time zero of the levitating rotor by its unbalance, m."""
    dynamic = STIFFNESS - MASS * SPEED**2 + 1j * DAMPING * SPEED
    return MASS * eccentricity * SPEED**2 * cmath.rect(1.0, phase) / dynamic


def base(time):
    return PEAK * math.sin(math.pi * time / LASTS) * cmath.rect(1.0, DIRECTION) if time < LASTS else 0.0


def solved(rates, start, end):
    # The pulse has a kink at its end.
    options = {"rtol": 1e-12, "atol": 1e-18, "method": "DOP853"}
    first = solve_ivp(rates, (0.0, LASTS), start, **options)
    return solve_ivp(rates, (LASTS, end), first.y[:, -1], **options).y[0, -1]


def test_a_shock_begins_at_levitation_about_the_sag():
    machine = cm.load(MACHINE)
    eccentricity = machine.machine.eccentricity
    motion = cm.simulate(*cm.BaseShock.of(machine, f"{PEAK} m/s^2", f"{LASTS} s").apply(machine, DIRECTION), "60 ms")

    def rates(time, state):
        push = MASS * eccentricity * SPEED**2 * cmath.rect(1.0, SPEED * time)
        force = push - DAMPING * state[1] - STIFFNESS * state[0] - 9.81j * MASS
        return [state[1], force / MASS - base(time)]

    start = [whirl(eccentricity) - 9.81j * MASS / STIFFNESS, 1j * SPEED * whirl(eccentricity)]
    clearance = machine.parameters.scales.length
    place = complex(motion.position(motion.time, "fixed")) * clearance
    assert [len(part.contacts) for part in motion.parts] == [0, 0]
    assert abs(place - solved(rates, start, 0.06)) < 1e-10 * clearance


def test_a_blade_is_lost_at_levitation_about_the_sag():
    machine = cm.load(MACHINE)
    scales, phase = machine.parameters.scales, 0.9
    loss = BladeLoss.of(machine, "12 um")
    after, state = loss.apply(machine, phase)
    turned = cmath.phase(machine.machine.eccentricity + 12e-6 * cmath.exp(1j * phase))
    before = whirl(machine.machine.eccentricity, 0.0) - 9.81j * MASS / STIFFNESS
    # The frame has turned with the unbalance after the loss, and the fixed frame is seen from there.
    assert state.time == pytest.approx(turned)
    assert state.position * scales.length == pytest.approx(before * cmath.exp(-1j * turned), rel=1e-12)
    # In the fixed frame the sag stands still, and only the whirl moves.
    moving = (state.velocity + 1j * state.position) * scales.velocity
    assert moving == pytest.approx(1j * SPEED * whirl(machine.machine.eccentricity, -turned), rel=1e-9)
    assert after.value("rho") * scales.length == pytest.approx(
        abs(machine.machine.eccentricity + 12e-6 * cmath.exp(1j * phase))
    )


def test_what_sags_to_the_wall_is_refused():
    machine = cm.load(MACHINE, ["stiffness=1e5 N/m"])
    with pytest.raises(InputError, match="levitation = up to"):
        cm.BaseShock.of(machine, "1 g", "1 ms").apply(machine)
    with pytest.raises(InputError, match="needs levitation inside the wall before a disturbance"):
        BladeLoss(0.1).apply(machine)
    assert not BladeLoss(0.1).starts(cm.models.rotor_of(machine), np.array([0.0, 1.0])).exists.any()
