"""Levitation that is regained begins with controllers as their bearings say: against matrix exponentials of the finite elements."""

import math

import numpy as np
import pytest
from scipy.linalg import expm

import carom as cm
from carom.base.outcome import InputError
from carom.parameters import Gravity, TouchdownBearing
from carom.rotors import PID, FlexibleRotor, MagneticBearing, Material, ProportionalDamping, ShaftSection, Unbalance
from tests.flexible_machines import symmetric

pytestmark = pytest.mark.jit_only

LOST, END, GRAVITY = 3e-3, 5e-3, 9.81
SHAFT = [ShaftSection(length, 0.03, 0.0, Material(2.1e11, 7800.0)) for length in (0.1, 0.4, 0.1)]


def machine(at_regain, integral, speed=300.0):
    bearings = [
        MagneticBearing(node, 50.0, -1e5, PID(9000.0, integral, 20.0, 3e-4), delay=2e-5, at_regain=at_regain)
        for node in (1, 2)
    ]
    return symmetric(
        touchdown=TouchdownBearing("kelvin-voigt", stiffness=2e7, damping=0.0),
        rotor=FlexibleRotor(SHAFT, [], ProportionalDamping(10.0, 3e-6), 0.5),
        bearings=bearings,
        unbalances=[Unbalance(1, "20 g mm", 0.3)],
        speed=speed,
        gravity=Gravity(carried_by="stiffness"),
    )


def generator(given, levitates):
    """Rates of displacements, velocities and states of controllers, then of what turns with the shaft and of a constant."""
    rotor, n = given.rotor, len(given.rotor.matrices.mass)
    sizes = [each.loop.states for each in given.bearings]
    matrix = np.zeros((2 * n + sum(sizes) + 2,) * 2, complex)
    spin = rotor.damping_matrix - 1j * given.speed * rotor.matrices.gyroscopic
    forces = np.zeros((n, len(matrix)), complex)
    forces[:, :n], forces[:, n : 2 * n] = -rotor.matrices.stiffness, -spin
    first = 2 * n
    for bearing, size in zip(given.bearings, sizes, strict=True):
        node, own, loop = 2 * rotor.place_of(bearing.node), slice(first, first + size), bearing.loop
        if levitates:
            forces[node, own] -= bearing.ki * loop.C[0]
            forces[node, node] -= bearing.ki * loop.D[0, 0] + bearing.ks
        if levitates or bearing.at_regain == "running":
            matrix[own, own], matrix[own, node] = loop.A, loop.B[:, 0]
        first = own.stop
    (unbalance,) = given.unbalances
    forces[2 * rotor.place_of(unbalance.node), -2] = unbalance.size * given.speed**2 * np.exp(1j * unbalance.angle)
    forces[:, -1] = -1j * GRAVITY * rotor.matrices.mass @ rotor.translation
    matrix[:n, n : 2 * n], matrix[n : 2 * n] = np.eye(n), np.linalg.solve(rotor.matrices.mass, forces)
    matrix[-2, -2] = 1j * given.speed
    return matrix


@pytest.mark.parametrize("speed", [6.28, 300.0])
@pytest.mark.parametrize(
    ("at_regain", "integral"), [("reset", 20000.0), ("hold", 20000.0), ("hold", 0.0), ("running", 0.0)]
)
def test_controllers_begin_again_as_their_bearings_say(at_regain, integral, speed):
    given = machine(at_regain, integral, speed)
    reduced = given.with_modes(8)
    motion = cm.simulate(reduced.model, cm.drop(regained_after=f"{LOST} s"), f"{END} s")
    falls, levitates = motion.parts
    assert not any(len(part.seen_at(plane).contacts) for part in motion.parts for plane in (0, 1))

    scales, shapes, n = reduced.scales, reduced.basis.shapes, 8
    unit = scales.length * math.sqrt(scales.mass)
    place, moving = (np.asarray(each) for each in (falls.start.position, falls.start.velocity))
    velocity = (moving + 1j * place)[:n] * unit * scales.speed
    state = np.concatenate([shapes @ (place[:n] * unit), shapes @ velocity, place[n:] * unit, [1.0, 1.0]])
    state = expm(LOST * generator(given, levitates=False)) @ state
    if at_regain == "reset":
        state[2 * n : -2] = 0.0
    state = expm((END - LOST) * generator(given, levitates=True)) @ state
    for plane, touchdown in enumerate(given.touchdowns):
        own = levitates.seen_at(plane).end()[0] * scales.length
        # Both solve linear equations exactly; exponents up to 400 cost SciPy's exponential up to 7e-11, as 40 digits show, and of
        # controllers that run the modes of the fall up to 4e-11.
        assert abs(own - state[2 * given.rotor.place_of(touchdown.node)]) < 2e-10 * scales.length


def test_what_cannot_be_is_refused():
    with pytest.raises(InputError, match="at_regain = on: one of reset, hold, running"):
        machine("on", 0.0)
    with pytest.raises(InputError, match="reset or hold for a controller that integrates"):
        machine("running", 20000.0)
