"""Linear rotors with coordinates without mass, as the states of a controller are, and what is left of them without levitation."""

import numpy as np
import pytest
from linear_rotors import touchdowns
from scipy.linalg import expm

from carom.base.outcome import InputError
from carom.models import from_matrices
from carom.parameters import Gravity, Scales

ENDS = np.array([[1.0, 0.8], [1.0, -0.7]])
MASS, GYROSCOPIC = np.diag([1.0, 0.4]), np.diag([0.0, 0.3])
PULL = -0.1
"""Stiffness of both bearings without control."""
SCALES = Scales(5.0, 0.25e-3, 1000.0)
SLOW = 2e-4
"""Gain of the integrators: they settle within thousands of turns."""


def controlled(ki=SLOW, scales=SCALES, **others):
    """Rigid rotor with displacement and tilt; each bearing has a differentiating filter ``q̇ = (y − q)/T`` and an integrator ``ẋ = y``.

    The force on a bearing is ``−(kp + kd/T) y + (kd/T) q − ki x − PULL y``.
    """
    kp, kd, filtering = 0.9, 0.3, 0.25
    n = 6
    mass, damping, stiffness = np.zeros((3, n, n))
    mass[:2, :2] = MASS
    damping[2:, 2:] = np.eye(4)
    stiffness[:2, :2] = (kp + kd / filtering + PULL) * ENDS.T @ ENDS
    stiffness[:2, 2:4], stiffness[:2, 4:] = -kd / filtering * ENDS.T, ki * ENDS.T
    stiffness[2:4, :2], stiffness[2:4, 2:4] = -ENDS / filtering, np.eye(2) / filtering
    stiffness[4:, :2] = -ENDS
    left = np.zeros((2, n, n))
    left[0, 2:, 2:] = left[1, 2:, 2:] = np.eye(4)
    gyroscopic = np.zeros((n, n))
    gyroscopic[:2, :2] = GYROSCOPIC
    planes = np.hstack([ENDS, np.zeros((2, 4))])
    return from_matrices(
        **{
            "mass": mass,
            "damping": damping,
            "stiffness": stiffness,
            "gyroscopic": gyroscopic,
            "forcing": np.array([0.1 * np.exp(0.2j), 0.03, 0, 0, 0, 0]),
            "touchdowns": touchdowns(planes, [0.15, 0.15], [0.5, 0.5], [21.0, 21.0]),
            "translation": np.eye(n)[0],
            "scales": scales,
            "unlevitated": left,
            **others,
        }
    )


def by_first_order(model, time, state, force):
    """State (coordinates, rates of those with mass) in the fixed frame, by the matrix exponential of first-order equations written anew."""
    n, has_mass = len(model.equations.mass), np.flatnonzero(model.equations.has_mass)
    mass, damping, gyroscopic, stiffness, forcing = model.matrices
    size = n + len(has_mass)
    matrix = np.zeros((size + 2, size + 2), complex)
    matrix[has_mass, n + np.arange(len(has_mass))] = 1.0
    matrix[len(has_mass) : n, :n] = -stiffness[len(has_mass) :]
    inverse = np.linalg.inv(mass[: len(has_mass), : len(has_mass)])
    matrix[n:size, :n] = -inverse @ stiffness[has_mass]
    matrix[n:size, n:size] = -inverse @ (damping - 1j * gyroscopic)[np.ix_(has_mass, has_mass)]
    matrix[n:size, size] = inverse @ forcing[has_mass]
    matrix[n:size, size + 1] = force[has_mass]
    matrix[size, size] = 1j
    return (expm(time * matrix) @ np.append(state, [1.0, 1.0]))[:size]


def by_size(exponents):
    """Exponents in an order that rounding does not change."""
    return np.array(sorted(exponents, key=lambda each: (round(abs(each), 6), each.imag)))


@pytest.mark.parametrize("levitates", [True, False])
@pytest.mark.parametrize("has_mass", [True, False])
def test_flights_are_those_of_first_order_equations(levitates, has_mass):
    model = controlled() if levitates else controlled().without_levitation()
    pull = Gravity().pull(SCALES) if has_mass else 0.0
    system = model.under_gravity(Gravity(carried_by="stiffness")).system if has_mass else model.system
    random = np.random.default_rng(0)
    state = random.normal(size=8) + 1j * random.normal(size=8)
    # In the frame that turns: rates of coordinates without mass do not count.
    rates = np.zeros(6, complex)
    rates[:2] = state[6:] - 1j * state[:2]
    for time in (0.4, 7.0):
        position, velocity = system.state(system.fly(system.amplitudes(state[:6], rates), np.array(time)))
        expected = by_first_order(model, time, state, pull * np.eye(6)[0])
        turn = np.exp(1j * time)
        assert np.allclose(position * turn, expected[:6], rtol=0, atol=1e-11)
        assert np.allclose((velocity + 1j * position)[:2] * turn, expected[6:], rtol=0, atol=1e-11)


def test_without_levitation_nothing_holds_it_and_its_controller_stands_by_itself():
    rotor = controlled()
    free = rotor.without_levitation()
    assert not free.matrices.stiffness[:2].any()
    assert not free.matrices.damping[:2].any()
    assert np.array_equal(free.matrices.stiffness[2:, 2:], np.eye(4))
    assert np.allclose(free.matrices.gyroscopic, rotor.matrices.gyroscopic, rtol=0, atol=1e-15)
    # Displacement twice, which double precision tells apart by the root of its rounding, tilt, and the precession of a free top.
    assert by_size(free.system.exponents + 1j) == pytest.approx(np.array([0, 0, 0, 0.75j, -1, -1, -1, -1]), abs=1e-7)


def test_another_speed_is_the_same_machine_in_other_units():
    """Exponents in 1/s do not change but for the gyroscopic ones, and what is left falls as before."""
    flat = {"gyroscopic": np.zeros((6, 6))}
    one, other = controlled(**flat), controlled(**flat).replace(speed=700.0)
    expected = by_size((one.system.exponents + 1j) * 1000.0)
    assert by_size((other.system.exponents + 1j) * 700.0) == pytest.approx(expected, abs=1e-8)
    free = by_size((other.without_levitation().system.exponents + 1j) * 700.0)
    assert free == pytest.approx(np.repeat([0.0, -1000.0], 4), abs=700.0 * 1e-7)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"mass": np.zeros((6, 6))}, r"^mass = singular: a matrix that can be inverted, but for rows and columns"),
        (
            {"damping": np.zeros((6, 6))},
            r"^damping = singular: a matrix that gives the rates of all coordinates without",
        ),
        ({"forcing": np.ones(6)}, r"^forcing = .*: 0 for coordinates without mass$"),
        ({"unlevitated": np.zeros((6, 6))}, r"^unlevitated = .*: finite numbers of shape \(2, 6, 6\)$"),
        ({"unlevitated": np.full((2, 6, 6), np.nan)}, r"^unlevitated = .*: finite numbers of shape \(2, 6, 6\)$"),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_line(changes, says):
    with pytest.raises(InputError, match=says):
        assert controlled(**changes).system
