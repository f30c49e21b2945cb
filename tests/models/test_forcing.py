"""Forces that change with time, against the matrix exponential and known motions."""

from dataclasses import dataclass

import numpy as np
import pytest
from linear_rotors import FixedFrame, planar_rotor, single, tilting, to_fixed, touchdowns
from scipy.linalg import expm

import carom as cm
from carom.base.outcome import InputError
from carom.core.planar import planar_exponents
from carom.core.wall import Wall
from carom.models import Force, from_matrices, second_order_system
from carom.models.forcing import with_forces

WEIGHT = (-1j, 0.01)
FORCES = [
    (0.1, 0.76, [WEIGHT]),
    (0.1, 0.76, [(0.5j, 0.1), (-2.5j, 0.1j)]),
    (1.52, 0.76, [WEIGHT]),
    # Resonance without damping, exact and nearly so.
    (0.0, 0.76, [(-0.24j, 0.02)]),
    (0.0, 0.76, [(-0.24j + 1e-7j, 0.02)]),
    (0.0, 0.76, [(-0.24j + 1e-4j, 0.02), (-1.76j, 0.1)]),
    # Free fall, and with drag.
    (0.0, 0.0, [(-1j, 1e-3)]),
    (0.0, 0.0, [(-1j, 1e-3), (0.3j, 0.02)]),
    (0.1, 0.0, [(-1j, 1e-3)]),
    (0.01, 0.0, [(-1j, 1e-3)]),
]


def planar_system(gamma, omega, rest=0.2):
    return second_order_system(
        exponents=planar_exponents(gamma, omega),
        equilibrium=rest / complex(omega * omega - 1.0, gamma),
        wall=Wall(0.1, 0.9, 20.0),
    )


@pytest.mark.parametrize(("gamma", "omega", "forces"), FORCES)
def test_flights_of_the_planar_rotor(gamma, omega, forces):
    system = with_forces(planar_system(gamma, omega), [Force(rate, np.array([push])) for rate, push in forces])
    rest, count = system.rest[0], len(forces)
    matrix = np.zeros((2 + count, 2 + count), complex)
    matrix[0, 1], matrix[1, :2] = 1.0, (-complex(omega**2 - 1.0, gamma), -(gamma + 2j))
    for place, (rate, push) in enumerate(forces, start=2):
        matrix[1, place], matrix[place, place] = push, rate
    position, velocity = 0.1 + 0.2j, 0.3 - 0.1j
    for begins in (0.0, 0.8):
        amplitudes = system.amplitudes(position, velocity, begins)
        assert np.allclose(system.state(amplitudes), (position, velocity), rtol=0, atol=1e-12)
        started = np.exp(begins * matrix.diagonal()[2:])
        for time in (0.01, 0.3, 2.0, 40.0):
            exact = expm(matrix * time) @ np.array([position - rest, velocity, *started])
            moved = system.state(system.fly(amplitudes, np.array(time)))
            size = np.abs(exact).max()
            assert np.allclose(moved, (exact[0] + rest, exact[1]), rtol=0, atol=1e-12 * size)


def test_flights_of_a_rotor_of_two_coordinates():
    model = tilting().model
    forces = (Force(-1j, np.array([0.01, 0.002j])), Force(0.4j, np.array([0.0, 0.1])))
    system = model.under(*forces).system
    assert system.modes == 8
    assert np.array_equal(system.exponents, model.system.exponents)
    accelerations = np.linalg.solve(
        model.equations.mass, np.concatenate([model.equations.stiffness, model.equations.damping], axis=1)
    )
    matrix = np.zeros((6, 6), complex)
    matrix[:2, 2:4], matrix[2:4, :4] = np.eye(2), -accelerations
    matrix[2:4, 4:] = np.transpose([force.accelerations for force in forces])
    matrix[4, 4], matrix[5, 5] = (force.exponent for force in forces)
    state = np.array([0.1, 0.2j, 0.05, -0.1])
    amplitudes = system.amplitudes(state[:2], state[2:])
    for time in (0.3, 2.0, 40.0):
        exact = expm(matrix * time) @ np.array([*(state - np.append(system.rest, [0.0, 0.0])), 1.0, 1.0])
        position, velocity = system.state(system.fly(amplitudes, np.array(time)))
        assert np.allclose(position - system.rest, exact[:2], rtol=0, atol=1e-12)
        assert np.allclose(velocity, exact[2:4], rtol=0, atol=1e-12)


@pytest.mark.parametrize("pushes", [(0.02, 0.0), (0.02, 0.01j), (0.0, 0.0)])
def test_a_free_rotor_of_two_coordinates_falls(pushes):
    """Levitation lost at both: four equal exponents, and the weight in resonance with all of them."""
    model = from_matrices(
        mass=np.diag([1.0, 0.4]),
        damping=np.zeros((2, 2)),
        stiffness=np.zeros((2, 2)),
        forcing=[0.01, 0.02],
        touchdowns=touchdowns([[1.0, 0.8], [1.0, -0.7]], [0.1, 0.1], [0.5, 0.5], [9.0, 9.0]),
    )
    system = model.under(Force(-1j, np.array(pushes))).system
    state = np.array([0.1, -0.05j, 0.02, 0.1j])
    rest = model.system.rest
    for time in (0.5, 3.0):
        fixed = (state[:2] - rest) + (state[2:] + 1j * (state[:2] - rest)) * time + 0.5 * np.array(pushes) * time**2
        position, _ = system.state(system.fly(system.amplitudes(state[:2], state[2:]), np.array(time)))
        assert np.allclose((position - rest) * np.exp(1j * time), fixed, rtol=0, atol=1e-12)


def test_what_needs_rest_or_repetition_is_refused():
    shaken = tilting().model.under(Force(-0.5j, np.array([0.01, 0.0])))
    with pytest.raises(InputError, match="forces that change with time"):
        cm.find_equilibria(shaken)
    calls = (
        lambda: cm.find_orbits(shaken, impacts=1),
        lambda: cm.orbits.lyapunov_exponents(shaken, cm.kick(3.0), impacts=50),
    )
    for call in calls:
        with pytest.raises(InputError, match="forces that change in the fixed frame"):
            call()


@pytest.mark.parametrize("damping", [0.0, 1e-18])
def test_unbalance_in_undamped_resonance_drives_the_mode(damping):
    """``z̈ + z = ρe^{it}`` grows without bound, as the matrix exponential says."""
    rotor = planar_rotor(damping, 1.0, 0.02, touchdowns([[1.0]], [0.1], [0.5], [9.0]))
    motion = cm.simulate(rotor, cm.State(0.0), 120.0)
    matrix = np.array([[0.0, 1.0, 0.0], [0.0, -2.0j, 0.02], [0.0, 0.0, 0.0]])
    for time in (1.0, 20.0, motion.contacts.time[0]):
        place, speed, _ = expm(matrix * time) @ np.array([0.0, 0.0, 1.0])
        found = motion.at_plane(time - 1e-12)
        assert found[0] == pytest.approx(place, abs=1e-10)
        assert found[1] == pytest.approx(speed, abs=1e-10)
    assert abs(motion.at_plane(motion.contacts.time[0])[0]) == pytest.approx(1.0, abs=1e-12)


@dataclass(frozen=True, eq=False)
class Heavy(FixedFrame):
    """A rotor that weighs something, by its equations in the fixed frame."""

    def free(self, time, position, velocity):
        return super().free(time, position, velocity) - 0.06j * self.translation


NO_SPRINGS = {"damping": np.zeros((2, 2)), "stiffness": np.zeros((2, 2))}


@pytest.mark.jit_only
@pytest.mark.parametrize(
    "rotor",
    [
        single(planes=1),
        tilting(),
        tilting(damping=np.zeros((2, 2)), gyroscopic=np.zeros((2, 2))),
        tilting(**NO_SPRINGS),
    ],
    ids=["one coordinate", "tilting", "undamped", "falling"],
)
def test_impacts_of_a_heavy_rotor_against_a_general_solver(rotor):
    has_mass = Heavy(**vars(rotor))
    model = rotor.model.under(Force(-1j, -0.06j * rotor.translation))
    random, impacts, n = np.random.default_rng(0), 0, len(rotor.mass)
    for _ in range(2):
        position, velocity = random.normal(size=(2, n)) + 1j * random.normal(size=(2, n))
        position *= 0.8 / np.abs(rotor.planes @ position).max()
        met = has_mass.bounces(position, velocity + 1j * position, 20.0, 6)
        start = (position, velocity) if n > 1 else (complex(position[0]), complex(velocity[0]))
        motion = cm.simulate(model, cm.State(*start), 20.0)
        struck = np.flatnonzero(motion.is_impact)
        assert len(struck) >= len(met)
        for event, (time, plane, place, speed) in zip(struck.tolist(), met, strict=False):
            found = motion.segment_starts[1 + event]
            assert found == pytest.approx(time, abs=1e-9)
            assert motion.event_planes[event] == plane
            state = to_fixed(found, *map(np.atleast_1d, model.system.state(motion.event_amplitudes[event])))
            assert np.allclose(state[0], place, rtol=0, atol=1e-9)
            assert np.allclose(state[1], speed, rtol=0, atol=1e-9)
            impacts += 1
    assert impacts > 1
