"""Any linear rotor: its modes, and that it is the planar rotor where it has the same matrices."""

import mpmath
import numpy as np
import pytest
from compilation import sized
from linear_rotors import bending, single, tilting, touchdowns
from machines import PAPER, random_parameters
from scipy.linalg import expm

from carom.base.outcome import InputError
from carom.models import from_matrices
from carom.models.from_modes import modes_of
from carom.motions import State, simulate


def planar(parameters, beside=None):
    """The planar rotor by its matrices, with another coordinate that it does not feel if ``beside`` is a stiffness."""
    n = 1 if beside is None else 2
    return from_matrices(
        mass=np.eye(n),
        damping=parameters.gamma * np.eye(n),
        stiffness=np.diag([parameters.omega**2, beside][:n]),
        forcing=np.array([parameters.rho * np.exp(1j * parameters.phi), 0.3][:n]),
        touchdowns=touchdowns(np.eye(1, n), [parameters.mu], [parameters.d], [parameters.radius_ratio + 1.0]),
        translation=np.eye(1, n)[0],
    )


@pytest.mark.parametrize("rotor", [single(), tilting(), bending()], ids=["single", "tilting", "bending"])
def test_flights_are_those_of_the_matrices(rotor):
    model = rotor.model
    n = len(model.equations.mass)
    companion = np.block(
        [
            [np.zeros((n, n)), np.eye(n)],
            [
                -np.linalg.solve(model.equations.mass, model.equations.stiffness),
                -np.linalg.solve(model.equations.mass, model.equations.damping),
            ],
        ]
    )
    rest = np.linalg.solve(model.equations.stiffness, model.equations.forcing)
    random = np.random.default_rng(0)
    state = random.normal(size=2 * n) + 1j * random.normal(size=2 * n)
    position, velocity = (part if n > 1 else part[0] for part in (state[:n], state[n:]))
    flown = model.system.fly(model.system.amplitudes(position, velocity), np.array(1.7))
    expected = expm(1.7 * companion) @ (state - np.append(rest, np.zeros(n))) + np.append(rest, np.zeros(n))
    assert np.allclose(np.ravel(model.system.state(flown)), expected, rtol=0, atol=1e-11)
    shown = np.array([model.system.at_plane(flown, plane)[0] for plane in range(len(model.equations.planes))])
    assert np.allclose(shown, model.equations.planes @ expected[:n], rtol=0, atol=1e-11)


@pytest.mark.parametrize("split", [0.0, 1e-14, 1e-9, 1e-5, 1e-2, 1.0])
def test_modes_stay_accurate_where_two_coincide(split):
    """A critically damped oscillator, or nearly so, beside another one."""
    random = np.random.default_rng(1)
    turn = np.linalg.qr(random.normal(size=(4, 4)) + 1j * random.normal(size=(4, 4)))[0]
    critical = np.array([[-0.6, 1.0], [0.0, -0.6 - split]])
    matrix = turn @ np.block([[critical, np.zeros((2, 2))], [np.zeros((2, 2)), np.diag([-0.2 + 1j, -0.1 - 2j])]])
    matrix = matrix @ turn.conj().T
    found = modes_of(matrix)
    generator = np.diag(found.exponents) + np.diag(found.driven[1:].astype(complex), -1)
    assert np.allclose(matrix @ found.basis, found.basis @ generator, rtol=0, atol=1e-13)
    assert np.linalg.cond(found.basis) < 1e5
    assert (found.exponents.real[1:] >= found.exponents.real[:-1])[found.driven[1:]].all()
    assert found.driven.any() == (split < 1e-3)


def exact(model, time, state):
    """State after a free flight, less the equilibrium, by the matrix exponential in 50 digits."""
    n = len(model.equations.mass)
    with mpmath.workdps(50):
        mass, stiffness, damping = (
            mpmath.matrix(matrix.tolist())
            for matrix in (model.equations.mass, model.equations.stiffness, model.equations.damping)
        )
        inverse, generator = mass**-1, mpmath.zeros(2 * n)
        for i in range(n):
            generator[i, n + i] = 1
        for i, j in np.ndindex(n, n):
            generator[n + i, j], generator[n + i, n + j] = -(inverse * stiffness)[i, j], -(inverse * damping)[i, j]
        return np.array([complex(value) for value in mpmath.expm(generator * time) * mpmath.matrix(state.tolist())])


@pytest.mark.parametrize("split", [0.0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3, 0.1])
@pytest.mark.parametrize(
    ("damping", "stiffness"),
    [([0, 1], [0, 0]), ([0, 0], [0, 1]), ([0, 1, 0], [0, 0, 1]), ([0, 0, -1], [0, 1, -1])],
    ids=["damping", "stiffness", "three", "mixed"],
)
def test_coordinates_that_are_critically_damped_alike(split, damping, stiffness):
    """Two or three independent coordinates, the same or nearly so, seen in coordinates in which they are mixed."""
    random = np.random.default_rng(len(damping))
    n = len(damping)
    mix = np.eye(n) + 0.4 * random.normal(size=(n, n))
    model = from_matrices(
        mass=mix.T @ mix,
        damping=mix.T @ np.diag(1.5 + split * np.array(damping)) @ mix,
        stiffness=mix.T @ np.diag(0.5625 + split * np.array(stiffness)) @ mix,
        forcing=random.normal(size=n),
        touchdowns=touchdowns(random.normal(size=(1, n)), [0.1], [0.9], [30.0]),
    )
    state = random.normal(size=2 * n) + 1j * random.normal(size=2 * n)
    system = model.system
    flown = system.fly(system.amplitudes(state[:n] + system.rest, state[n:]), np.array(2.3))
    position, velocity = system.state(flown)
    got = np.concatenate([position - system.rest, velocity])
    assert np.abs(got - exact(model, 2.3, state)).max() < 5e-12 * np.abs(state).max()


@pytest.mark.jit_only
def test_it_moves_as_the_planar_rotor_does_beside_a_coordinate_that_it_does_not_feel():
    random = np.random.default_rng(3)
    for number in range(sized(6, 2, 40)):
        parameters = PAPER if number == 0 else random_parameters(random)
        # Critically damped, too.
        parameters = parameters.replace(gamma=2.0 * parameters.omega) if number == 1 else parameters
        position, velocity = 0.3 + 0.1j, 0.9 - 0.4j
        one = simulate(parameters, State(position, velocity), 20.0, max_events=400)
        two = simulate(
            planar(parameters, 0.7), State(np.array([position, 0.1]), np.array([velocity, 0.0])), 20.0, max_events=400
        )
        count = min(len(one.contacts), len(two.contacts), 6)
        assert np.allclose(one.contacts.time[:count], two.contacts.time[:count], rtol=0, atol=1e-8)
        assert np.allclose(one.contacts.normal_impulse[:count], two.contacts.normal_impulse[:count], rtol=0, atol=1e-7)


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"mass": np.zeros((2, 2))}, "mass"),
        ({"touchdowns": ()}, "touchdowns"),
        ({"touchdowns": touchdowns([[1.0]], [0.1], [0.5], [2.0])}, "touchdowns"),
        ({"friction": -0.1}, "friction"),
        ({"restitution": 1.2}, "restitution"),
        ({"forcing": [np.nan, 0.0]}, "forcing"),
        ({"touchdowns": touchdowns([[0.0, 0.0]], [0.1], [0.5], [2.0])}, "mass, planes"),
        ({"stiffnes": np.eye(2)}, "parameter"),
        ({"forcing": [[1.0, 2.0], [3.0]]}, "forcing"),
    ],
)
def test_bad_matrices_are_refused(changes, named):
    with pytest.raises(InputError, match=named):
        assert tilting().model.replace(**changes).system


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"stiffness": 3.0}, "stiffness"),
        ({"gyroscopic": 0.3}, "gyroscopic"),
        ({"gyroscopic": np.eye(3)}, "gyroscopic"),
        ({"mass": [1.0, 2.0]}, "mass"),
    ],
)
def test_matrices_of_the_fixed_frame_are_not_stretched_to_shape(changes, named):
    numbers = {"mass": np.eye(2), "damping": 0.1 * np.eye(2), "stiffness": np.eye(2), "forcing": [0.2, 0.0]}
    plane = {"touchdowns": touchdowns([[1.0, 0.5]], [0.1], [0.9], [10.0])}
    with pytest.raises(InputError, match=f"^{named} = "):
        from_matrices(**numbers | plane | changes)
