"""Single-impact orbits against independent routes: matrix exponentials, simulation, many digits, dense sampling."""

import cmath
import math

import mpmath
import numpy as np
import pytest
from compilation import sized
from hypothesis import given, settings
from hypothesis import strategies as st
from machines import (
    PAPER,
    ExactMotion,
    flight_matrix,
    fly,
    path,
    random_parameters,
    rest_position,
    strike,
)
from scipy.optimize import brentq, fsolve

from carom import State, find_orbits, simulate
from carom.models import jeffcott
from carom.orbits import Orbit, OrbitSet
from carom.parameters import Parameters

SETS = sized(80, 80, 200)


def orbits_of(parameters: Parameters) -> OrbitSet:
    return find_orbits(jeffcott(parameters))


@st.composite
def parameter_sets(draw: st.DrawFn) -> Parameters:
    """Parameters at which orbits are not rare: light to strong damping, rough to smooth walls, small to large rotors."""

    def power(low: float, high: float) -> float:
        return 10.0 ** draw(st.floats(low, high))

    return Parameters(
        gamma=power(-2.0, 0.3),
        omega=power(-1.0, 0.48),
        rho=power(-1.5, 0.5),
        phi=draw(st.floats(-math.pi, math.pi)),
        mu=draw(st.one_of(st.just(0.0), st.floats(0.02, 2.0))),
        d=draw(st.one_of(st.just(1.0), st.floats(0.0, 1.0), st.floats(0.8, 1.0))),
        radius_ratio=power(-1.5, 2.5),
    )


def after_impact(orbit: Orbit, *, limited: bool) -> tuple[complex, complex]:
    radial, angular = strike(
        orbit.rotor.parameters, orbit.radial_speed, orbit.angular_speed, slip=orbit.slip, limited=limited
    )
    position = cmath.rect(1.0, orbit.angle)
    return position, complex(radial, angular) * position


def assert_returns_by_matrix_exponential(orbit: Orbit) -> None:
    """The flight after the impact, taken for as long as the period, ends in the state before the impact."""
    position, velocity = after_impact(orbit, limited=False)
    end, speed = fly(orbit.rotor.parameters, position, velocity, orbit.period)
    before = complex(orbit.radial_speed, orbit.angular_speed) * position
    size = 1.0 + abs(velocity) + abs(rest_position(orbit.rotor.parameters))
    assert abs(end - position) <= 1e-9 * size
    assert abs(speed - before) <= 1e-9 * size


def assert_returns_by_simulation(orbit: Orbit) -> None:
    """The simulated motion strikes next after one period, in the same state."""
    motion = simulate(orbit.rotor, State(*after_impact(orbit, limited=True)), 1.2 * orbit.period)
    growth = max(1.0, orbit.multipliers.spectral_radius)
    contacts = motion.contacts
    assert len(contacts) >= 1
    first = [values[0] for values in (contacts.time, contacts.radial_speed, contacts.angular_speed)]
    exact = [orbit.period, orbit.radial_speed, orbit.angular_speed]
    # An error of position at arrival is one of time divided by the radial speed.
    np.testing.assert_allclose(first, exact, rtol=1e-9 * growth, atol=1e-9 * growth)
    assert abs(cmath.exp(1j * (contacts.angle[0] - orbit.angle)) - 1.0) <= 1e-9 * growth
    assert not contacts.sticks[0]
    assert contacts.slip_before[0] * orbit.slip > 0 or orbit.rotor.parameters.mu == 0.0


def test_orbits_that_have_shrunk_to_levitation_on_the_wall_are_limits():
    machine = Parameters(gamma=1.0, omega=1.0, rho=1.0, phi=1.0, mu=1.0, d=1.0, radius_ratio=1.0)
    assert abs(jeffcott(machine).equilibrium) == 1.0
    shrunk = [orbit for orbit in find_orbits(jeffcott(machine)) if orbit.radial_speed == 0.0]
    assert shrunk
    beside = find_orbits(jeffcott(machine.replace(rho=1.0 - 1e-9)))
    for orbit in shrunk:
        assert not orbit.admissible
        assert orbit.position == pytest.approx(orbit.rotor.equilibrium, abs=1e-12)
        near = np.sort_complex(beside[orbit.name].multipliers.values)
        np.testing.assert_allclose(np.sort_complex(orbit.multipliers.values), near, rtol=1e-6, atol=1e-6)


@settings(max_examples=SETS, derandomize=True, database=None)
@given(parameter_sets())
def test_orbits_agree_with_matrix_exponential_and_simulation(parameters):
    for orbit in orbits_of(parameters)[:24]:
        assert_returns_by_matrix_exponential(orbit)
        if orbit.admissible:
            assert_returns_by_simulation(orbit)


# ------------------------------------------------------------------------------------------------ multipliers


@pytest.mark.parametrize("gamma", [0.02, 0.065, 0.08, 0.1, 0.1779, 0.7])
def test_multipliers_agree_with_many_digits(gamma):
    for changes in ({}, {"omega": 1.3, "mu": 0.6}, {"radius_ratio": 0.4, "mu": 0.5}, {"d": 0.6, "mu": 1.5}):
        assert_multipliers(orbits_of(PAPER.replace(gamma=gamma, **changes)))


def assert_multipliers(orbits: OrbitSet) -> int:
    """Compare characteristic polynomials, which stay smooth where multipliers meet; virtual orbits too."""
    with mpmath.workdps(50):
        parameters = orbits.rotor.parameters
        # The derivative of the matrix exponential needs distinct eigenvalues.
        if parameters.gamma == 2.0 * parameters.omega:
            return 0
        motion = ExactMotion(parameters)
        chosen = [orbit for orbit in orbits[:6] if 1e-6 < abs(orbit.radial_speed) < 1e6]
        for orbit in chosen:
            section = (orbit.angle, orbit.radial_speed, orbit.angular_speed)
            exact = np.poly(motion.jacobian(section, orbit.slip, orbit.period))
            found = np.poly(orbit.multipliers.values)
            # Rounding of the orbit itself, magnified by the shear of the flow and by a slow arrival.
            size = np.abs(exact).max() * (1.0 + 1e-3 / abs(orbit.radial_speed))
            np.testing.assert_allclose(found, exact, rtol=0, atol=1e-9 * size, err_msg=str((parameters, orbit.name)))
        return len(chosen)


# ----------------------------------------------------------------------------------------------- admissibility


def highest_radius(orbit: Orbit) -> tuple[float, float]:
    """Largest radius strictly inside the period, by dense sampling, and the radius soon after the impact.

    Local maxima are those of parabolas through three points.
    """
    parameters = orbit.rotor.parameters
    fastest = np.abs(np.linalg.eigvals(flight_matrix(parameters))).max()
    times = np.linspace(0.0, orbit.period, int(2000 + 300 * fastest * orbit.period))
    squares = np.abs(path(parameters, *after_impact(orbit, limited=False), times)) ** 2
    left, middle, right = squares[:-2], squares[1:-1], squares[2:]
    top = (middle >= left) & (middle >= right)
    bend = left - 2.0 * middle + right
    vertices = middle[top] - (right - left)[top] ** 2 / (8.0 * np.where(bend == 0, np.inf, bend)[top])
    # Leaving through the wall at once is no local maximum.
    return math.sqrt(max([*vertices, squares[1]])), math.sqrt(squares[1])


def expected_reason(orbit: Orbit) -> str:
    """Why an orbit cannot be a motion of the machine, from the laws of contact and from its path."""
    parameters = orbit.rotor.parameters
    if orbit.radial_speed <= 0.0:
        return "reach the wall from outside"
    if parameters.mu > 0.0:
        slip = orbit.slip * (parameters.radius_ratio + 1.0 + orbit.angular_speed)
        if slip < 0.0:
            return "slip, and so friction, would"
        if parameters.mu * (1.0 + parameters.d) * orbit.radial_speed >= slip:
            return "friction would stop the slip"
    highest, first = highest_radius(orbit)
    if parameters.d == 0.0 and first > 1.0:
        return "stay on the wall"
    if abs(highest - 1.0) < 1e-9:
        return "undecided"
    return "cross the wall" if highest > 1.0 else ""


def test_reasons_agree_with_the_laws_of_contact_and_dense_sampling():
    random = np.random.default_rng(12)
    seen = dict.fromkeys(
        ["", "reach the wall", "slip, and", "friction would", "cross the wall", "stay on", "undecided"], 0
    )
    machines = [random_parameters(random) for _ in range(SETS)]
    machines += [PAPER.replace(radius_ratio=ratio, mu=mu) for ratio in (0.05, 0.3, 1.0) for mu in (0.3, 1.0, 2.0)]
    for parameters in machines:
        if abs(parameters.gamma / parameters.omega - 2.0) < 1e-6:
            continue
        for orbit in orbits_of(parameters)[:24]:
            expected = expected_reason(orbit)
            assert expected == "undecided" or expected in orbit.reason, (parameters, orbit.name)
            assert orbit.admissible == (not orbit.reason)
            if not expected:
                assert orbit.admissible
            seen[next(key for key in reversed(seen) if expected.startswith(key) or key in expected)] += 1
    assert seen["undecided"] == 0
    assert min(count for key, count in seen.items() if key != "undecided") >= 5, seen


def grazing_damping() -> float:
    """Damping at which the path of B1,d touches the wall between impacts, from sampled radii."""
    return brentq(
        lambda gamma: highest_radius(orbits_of(PAPER.replace(gamma=gamma))["B1,d"])[0] - 1.0, 0.06, 0.066, xtol=1e-15
    )


def test_admissibility_changes_exactly_at_grazing():
    grazing = grazing_damping()
    for distance in (1e-3, 1e-6, 1e-8):
        assert orbits_of(PAPER.replace(gamma=grazing * (1.0 + distance)))["B1,d"].admissible
        below = orbits_of(PAPER.replace(gamma=grazing * (1.0 - distance)))["B1,d"]
        assert "would cross the wall at t = " in below.reason


def test_admissibility_without_rebound_changes_exactly_where_the_pull_off_the_wall_vanishes():
    """Just beyond, the rotor leaves the wall with no radial speed and next to no acceleration."""
    machine = Parameters(gamma=0.125, omega=0.0663, rho=0.04516, phi=1.18, mu=1.38, d=0.0, radius_ratio=186.0)

    def orbit_at(gamma: float) -> Orbit:
        return orbits_of(machine.replace(gamma=gamma))["B1,b"]

    def pull(gamma: float) -> float:
        orbit = orbit_at(gamma)
        position, velocity = after_impact(orbit, limited=False)
        rest = rest_position(orbit.rotor.parameters)
        force = (flight_matrix(orbit.rotor.parameters) @ np.array([position - rest, velocity]))[1]
        return -(position.conjugate() * force).real - abs(velocity) ** 2

    onset = brentq(pull, 0.12, 0.1275, xtol=1e-15)
    for distance in (1e-3, 1e-6, 1e-8):
        assert "stay on the wall" in orbit_at(onset * (1.0 + distance)).reason
        leaves = orbit_at(onset * (1.0 - distance))
        assert leaves.reason == ""
        with mpmath.workdps(50):
            motion = ExactMotion(leaves.rotor.parameters)
            start = mpmath.expj(leaves.angle)
            _, speed = strike(leaves.rotor.parameters, leaves.radial_speed, leaves.angular_speed)
            for time in np.geomspace(1e-9, 0.999 * leaves.period, 300):
                position, _ = motion.fly(start, 1j * mpmath.mpf(speed) * start, mpmath.mpf(time))
                assert abs(position) < 1


# ------------------------------------------------------------------------------------------------ completeness


def test_newton_from_anywhere_finds_no_other_orbit():
    """Solve the return conditions from many random starts; every solution must be in the list."""
    random = np.random.default_rng(13)
    for parameters in (PAPER, PAPER.replace(gamma=0.05), PAPER.replace(mu=0.5, omega=1.2)):
        orbits = orbits_of(parameters)
        known = np.array([[orbit.period, orbit.radial_speed, orbit.angular_speed] for orbit in orbits])
        found = set()
        for _ in range(150):
            guess = [
                random.uniform(-3, 3),
                random.normal(),
                random.normal(),
                random.uniform(0.2, orbits.longest_period),
            ]
            solution, info, status, _ = fsolve(misses, guess, (parameters,), full_output=True, xtol=1e-13)
            if status != 1 or np.abs(info["fvec"]).max() > 1e-10 or solution[3] <= 1e-3 or abs(solution[1]) < 1e-8:
                continue
            distance = np.abs(known - [solution[3], solution[1], solution[2]]).max(axis=1)
            assert distance.min() < 1e-6 * (1.0 + np.abs(solution).max()), solution
            found.add(int(distance.argmin()))
        assert len(found) >= min(4, len(orbits))


def misses(unknowns: np.ndarray, parameters: Parameters) -> list[float]:
    """By how much a flight of a given duration misses the state before the impact."""
    angle, radial, angular, period = unknowns
    position = cmath.rect(1.0, angle)
    rebound = complex(*strike(parameters, radial, angular, slip=1, limited=False)) * position
    end, speed = fly(parameters, position, rebound, period)
    difference = end - position, speed - complex(radial, angular) * position
    return [part for value in difference for part in (value.real, value.imag)]


def test_the_argument_says_what_was_proven():
    orbits = orbits_of(PAPER)
    assert orbits.complete
    assert orbits.slip_stays_forward
    assert orbits.argument.startswith(f"F1 has 2 roots for 0 < T ≤ {orbits.longest_period:.4g}/Ω, isolated by a bound")
    some = find_orbits(jeffcott(PAPER.replace(radius_ratio=0.3)), longest_period=1.0)
    assert not some.complete
    assert [orbit.name for orbit in some] == ["B1,a", "B1,c"]
    assert "F1 has 1 root for 0 < T ≤ 1/Ω" in some.argument
    assert "longer periods were not searched; orbits whose impacts stop the slip were not searched." in some.argument
