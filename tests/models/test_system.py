"""Systems: arrays of any linear rotor, and the way between states and amplitudes."""

import numpy as np
import pytest
from linear_rotors import tilting
from machines import PAPER, random_parameters
from scipy.linalg import expm

from carom.core.layout import rotor_record
from carom.core.wall import Wall
from carom.models import Force, Rotor, System, jeffcott, second_order_system


def modal(random, count):
    """A system with that many coordinates, of random modes in pairs and singles, and one contact plane."""
    modes = 2 * count
    exponents = -random.uniform(0.02, 0.6, modes) + 1j * random.uniform(-3.0, 3.0, modes)
    driven = np.zeros(modes, bool)
    driven[1] = True
    exponents[1] = complex(max(exponents[:2].real), exponents[1].imag)
    shapes = random.normal(size=(count, modes)) + 1j * random.normal(size=(count, modes))
    rest = random.normal(size=count) + 1j * random.normal(size=count)
    reading = random.normal(size=(1, count))
    arrays = rotor_record(
        exponents=exponents,
        driven=driven,
        offsets=reading @ rest,
        rows=reading @ shapes,
        columns=random.normal(size=(modes, 1)) + 0j,
        friction=np.array([0.1]),
        restitution=np.array([0.8]),
        surface_speed=np.array([30.0]),
    )
    basis = np.concatenate([shapes, shapes * exponents])
    basis[count:, :-1] += shapes[:, 1:] * driven[1:]
    return System(arrays, rest, shapes, np.linalg.inv(basis)), reading


@pytest.mark.parametrize("count", [1, 2, 4, 8])
def test_states_and_amplitudes_are_one_another(count):
    random = np.random.default_rng(count)
    system, reading = modal(random, count)
    position, velocity = random.normal(size=(2, count)) + 1j * random.normal(size=(2, count))
    given = (position, velocity) if count > 1 else (complex(position[0]), complex(velocity[0]))
    amplitudes = system.amplitudes(*given)

    found = system.state(amplitudes)
    np.testing.assert_allclose(found, given, atol=1e-11)
    plane_position, plane_velocity = system.at_plane(amplitudes, 0)
    np.testing.assert_allclose([plane_position], reading @ position, atol=1e-11)
    np.testing.assert_allclose([plane_velocity], reading @ velocity, atol=1e-11)


@pytest.mark.parametrize("count", [1, 2, 4])
def test_flight_is_the_matrix_exponential(count):
    random = np.random.default_rng(10 + count)
    system, _ = modal(random, count)
    amplitudes = random.normal(size=2 * count) + 1j * random.normal(size=2 * count)
    times = np.array([0.0, 0.3, 2.0, 7.0])
    expected = [expm(system.generator * time) @ amplitudes for time in times]
    np.testing.assert_allclose(system.fly(amplitudes, times), expected, atol=1e-11)


def test_a_second_order_system_keeps_its_equation():
    """``ü + αu̇ + βu = Γ`` for the rates that the generator gives."""
    for seed in range(20):
        random = np.random.default_rng(seed)
        alpha, beta, force = random.normal(size=3) + 1j * random.normal(size=3)
        roots = np.roots([1.0, alpha, beta])
        lower, upper = sorted(map(complex, roots), key=lambda root: root.real)
        system = second_order_system(exponents=(lower, upper), equilibrium=force / beta, wall=Wall(0.1, 0.5, 3.0))
        position, velocity = random.normal(size=2) + 1j * random.normal(size=2)
        amplitudes = system.amplitudes(complex(position), complex(velocity))
        acceleration = system.arrays.acceleration_rows[0] @ amplitudes
        assert acceleration + alpha * velocity + beta * position == pytest.approx(force, abs=1e-11)


def test_amplitudes_of_the_planar_rotor_are_those_of_its_equation():
    """``b = U̇ − λ₊(U − U*)`` and ``a = U − U*``, to the last bit: other numbers would follow other bounces."""
    random = np.random.default_rng(5)
    for _ in range(200):
        rotor = jeffcott(random_parameters(random))
        position, velocity = (complex(*random.normal(size=2)) for _ in range(2))
        change = position - rotor.equilibrium
        expected = [velocity - complex(rotor.system.exponents[1]) * change, change]
        np.testing.assert_array_equal(rotor.system.amplitudes(position, velocity), expected)


ROTORS = {
    "planar": jeffcott(PAPER),
    "heavy": jeffcott(PAPER).under(Force(-1j, np.array([0.1 - 0.2j]))),
    "of two coordinates": tilting().model.under(Force(-1j, np.array([0.3, 0.1j]))),
    "pulled twice": Rotor(tilting().model, (Force(-1j, np.array([0.3, 0.1j])),)).under(
        Force(-1j, np.array([0.0, 0.2]))
    ),
}


@pytest.mark.parametrize("name", ROTORS)
def test_nodes_and_amplitudes_follow_from_each_other(name):
    system, random = ROTORS[name].system, np.random.default_rng(2)
    states = random.normal(size=(5, 2 * len(system.rest), 2)) @ [1.0, 1j]
    for time in (0.0, 2.3):
        amplitudes = system.amplitudes_of(states, time)
        nodes = system.nodes.of(amplitudes)
        assert nodes[:, : states.shape[1]] == pytest.approx(states, abs=1e-12)
        assert system.nodes.amplitudes(nodes) == pytest.approx(amplitudes, abs=1e-12)
        if system.forced is None:
            assert nodes.shape == states.shape
        else:
            assert nodes[:, -1] == pytest.approx(np.exp(-1j * time), abs=1e-12)
