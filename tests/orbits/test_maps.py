"""The impact map against simulation, matrix exponentials, many digits and finite differences."""

import cmath
import math

import mpmath
import numpy as np
import pytest
from compilation import sized
from machines import ExactMotion, fly, path, random_parameters, rest_position, strike

from carom import simulate
from carom.base.outcome import Outcome
from carom.models import jeffcott
from carom.orbits import Section, impact_map, multipliers
from carom.parameters import Parameters

LONGEST = 60.0
"""Of random flights: most that return do so earlier."""


def random_section(random: np.random.Generator) -> Section:
    return Section(float(random.uniform(-3, 3)), float(10 ** random.uniform(-1.5, 0.3)), float(random.normal()))


def coordinates(section: Section) -> np.ndarray:
    return np.array([section.angle, section.radial_speed, section.angular_speed])


def turned(angle: float) -> float:
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


def rebound(parameters: Parameters, section: Section) -> tuple[complex, complex]:
    radial, angular = strike(parameters, section.radial_speed, section.angular_speed)
    position = cmath.rect(1.0, section.angle)
    return position, complex(radial, angular) * position


def test_section_and_state_are_the_same_thing():
    random = np.random.default_rng(30)
    for _ in range(20):
        section = random_section(random)
        state = section.state
        assert abs(state.position) == pytest.approx(1.0, abs=1e-15)
        back = Section.from_state(state.position, state.velocity)
        np.testing.assert_allclose(coordinates(back), coordinates(section), atol=1e-14)
        # dr/dt and dθ/dt by a short straight step.
        step = 1e-7
        moved = state.position + step * state.velocity
        assert (abs(moved) - 1.0) / step == pytest.approx(section.radial_speed, abs=1e-5)
        assert turned(cmath.phase(moved) - section.angle) / step == pytest.approx(section.angular_speed, abs=1e-5)


# ------------------------------------------------------------------------------------------------- impact map


def test_image_agrees_with_matrix_exponential_and_is_the_first_arrival():
    random = np.random.default_rng(31)
    outcomes = []
    count = sized(70, 70, 200)
    for _ in range(count):
        parameters = random_parameters(random)
        rotor = jeffcott(parameters)
        section = random_section(random)
        mapped = impact_map(rotor, section, LONGEST)
        outcomes.append(mapped.outcome)
        if mapped.outcome is not Outcome.CONTACT:
            assert mapped.image is None
            assert mapped.jacobian is None
            continue
        position, velocity = rebound(parameters, section)
        end, speed = fly(parameters, position, velocity, mapped.duration)
        image = mapped.image.state
        size = 1.0 + abs(velocity) + abs(rest_position(parameters))
        # The time of a slow arrival is less certain than the place.
        assert abs(end - image.position) < 1e-10 * size
        assert abs(speed - image.velocity) < 1e-10 * size
        assert mapped.image.radial_speed > 0.0
        if abs(parameters.gamma / parameters.omega - 2.0) > 1e-3 and parameters.d > 0.0:
            times = np.linspace(0.0, mapped.duration, 1000)[1:-1]
            assert (np.abs(path(parameters, position, velocity, times)) < 1.0 + 1e-10).all()
    assert outcomes.count(Outcome.CONTACT) > 0.3 * count
    assert outcomes.count(Outcome.CLEAR) > 0.1 * count


def test_image_agrees_with_simulation():
    random = np.random.default_rng(32)
    for _ in range(40):
        parameters = random_parameters(random, d=float(random.uniform(0.3, 1.0)))
        rotor = jeffcott(parameters)
        section = random_section(random)
        mapped = impact_map(rotor, section, LONGEST)
        if mapped.outcome is not Outcome.CONTACT:
            continue
        # A start on the wall with outward speed strikes at once.
        contacts = simulate(rotor, section.state, mapped.duration * 1.001).contacts
        np.testing.assert_allclose(contacts.time[:2], [0.0, mapped.duration], rtol=1e-12)
        found = [contacts.angle[1], contacts.radial_speed[1], contacts.angular_speed[1]]
        np.testing.assert_allclose(found, coordinates(mapped.image), atol=1e-12)


def test_jacobian_agrees_with_many_digits():
    random = np.random.default_rng(33)
    compared = 0
    with mpmath.workdps(40):
        for _ in range(80):
            parameters = random_parameters(random, radius_ratio=50.0)
            section = random_section(random)
            mapped = impact_map(jeffcott(parameters), section, LONGEST)
            if mapped.outcome is not Outcome.CONTACT or parameters.gamma == 2.0 * parameters.omega:
                continue
            exact = ExactMotion(parameters).jacobian(tuple(coordinates(section)), 1, mapped.duration)
            # What rounding does to the arrival is magnified by one over its speed.
            size = np.abs(exact).max() * (1.0 + 1e-3 / mapped.image.radial_speed)
            np.testing.assert_allclose(mapped.jacobian, exact, rtol=0, atol=1e-10 * size)
            compared += 1
    assert compared > 25


def differences(rotor, section: Section, step: float) -> np.ndarray:
    """Central differences of the map, extrapolated to the fourth order."""

    def image(point: np.ndarray) -> np.ndarray:
        return coordinates(impact_map(rotor, Section(*point)).image)

    def central(move: float) -> np.ndarray:
        at = coordinates(section)
        columns = []
        for direction in move * np.eye(3):
            change = image(at + direction) - image(at - direction)
            change[0] = turned(change[0])
            columns.append(change / (2.0 * move))
        return np.array(columns).T

    return (4.0 * central(step / 2) - central(step)) / 3.0


def matrix_with(values: list[complex], seed: int = 0) -> np.ndarray:
    """Real matrix with these eigenvalues (complex ones in conjugate pairs, upper first), in a random basis."""
    blocks = np.zeros((len(values), len(values)))
    place = 0
    while place < len(values):
        value = complex(values[place])
        if value.imag:
            blocks[place : place + 2, place : place + 2] = [[value.real, value.imag], [-value.imag, value.real]]
            place += 2
        else:
            blocks[place, place] = value.real
            place += 1
    basis = np.random.default_rng(seed).normal(size=blocks.shape) + 2.0 * np.eye(len(values))
    return basis @ blocks @ np.linalg.inv(basis)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize(
    "values",
    [
        [0.9, 0.5, -0.1],
        [-1.3, 1.2, 0.1],
        [0.6 + 0.7j, 0.6 - 0.7j, 0.5],
        [1.4, -0.2 + 0.8j, -0.2 - 0.8j],
        [3.0, 1.0, 0.0],
        [0.84, -0.488 + 0.606j, -0.488 - 0.606j],
    ],
    ids=str,
)
def test_largest_first_and_upper_of_a_pair_first(values, seed):
    found = multipliers(matrix_with(values, seed))
    np.testing.assert_allclose(found.values, values, atol=1e-11)
    assert found.values.dtype == complex
    assert found.spectral_radius == pytest.approx(abs(values[0]), abs=1e-11)
    assert found.stable == (abs(values[0]) < 1.0)


def test_a_defective_matrix():
    found = multipliers(np.array([[0.5, 1.0, 0.0], [0.0, 0.5, 1.0], [0.0, 0.0, 0.5]]))
    np.testing.assert_allclose(found.values, 0.5, atol=1e-4)
    assert found.stable
