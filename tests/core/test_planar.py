"""Closed forms of the planar rotor against many digits and dense sampling."""

import mpmath
import numpy as np
import pytest
from compilation import sized
from machines import PAPER, ExactMotion, random_parameters

from carom import find_orbits
from carom.core.planar import orbit_conditions, radial_course, radial_profile, radial_rates
from carom.models import jeffcott


def machines(count: int, seed: int):
    random = np.random.default_rng(seed)
    return [random_parameters(random) for _ in range(count)]


def conditions(parameters, period, speed):
    return orbit_conditions(
        parameters.gamma,
        parameters.omega,
        parameters.rho,
        parameters.mu,
        parameters.d,
        parameters.radius_ratio + 1.0,
        period,
        speed,
    )


def test_orbits_fulfil_the_conditions_and_have_these_multipliers():
    seen = 0
    for parameters in [PAPER, *machines(60, 7)]:
        rest = abs(jeffcott(parameters).equilibrium)
        for orbit in find_orbits(jeffcott(parameters), 20.0):
            if orbit.slip < 0 or not 1e-6 < abs(orbit.radial_speed) < 1e3 or orbit.period < 1e-3:
                continue
            seen += 1
            values = conditions(parameters, orbit.period, orbit.radial_speed)
            lever, turn = values[-2:]
            assert values[0] == pytest.approx(0.0, abs=1e-12 * (1.0 + abs(turn)) * (1.0 + abs(values[2])))
            assert values[1] == pytest.approx(0.0, abs=1e-11 * max(1.0, rest**2, abs(lever * orbit.radial_speed) ** 2))
            assert orbit.angular_speed == pytest.approx(-turn.imag * orbit.radial_speed, rel=1e-9, abs=1e-12)
            arrays = orbit.rotor.system.arrays
            loss = arrays.friction[0] * (1.0 + arrays.restitution[0]) * orbit.radial_speed
            scale = 1.0 + abs(orbit.angular_speed) + parameters.radius_ratio
            assert values[5] == pytest.approx(arrays.surface_speed[0] + orbit.angular_speed - loss, abs=1e-9 * scale)
            if min(values[5], arrays.surface_speed[0] + orbit.angular_speed) <= 0.0:
                continue
            section = (orbit.angle, orbit.radial_speed, orbit.angular_speed)
            with mpmath.workdps(40):
                jacobian = ExactMotion(parameters).jacobian(section, 1, orbit.period)
            eigenvalues = np.linalg.eigvals(jacobian)
            size = (1.0 + np.abs(jacobian).max()) ** 3
            assert values[6] == pytest.approx(np.prod(eigenvalues + 1.0).real, abs=1e-9 * size)
            one, two, three = eigenvalues
            pairs = (one * two - 1.0) * (one * three - 1.0) * (two * three - 1.0)
            assert values[7] == pytest.approx(pairs.real, abs=1e-9 * size**2)
    assert seen > 3


def test_radial_profile_agrees_with_dense_sampling():
    seen = 0
    for parameters in [PAPER, PAPER.replace(gamma=0.06), PAPER.replace(gamma=0.02), *machines(sized(30, 0), 8)]:
        for orbit in find_orbits(jeffcott(parameters), 15.0):
            if orbit.slip < 0 or not 1e-3 < abs(orbit.radial_speed) < 30.0 or orbit.period < 1e-2:
                continue
            speed = orbit.radial_speed
            numbers = (parameters.gamma, parameters.omega, parameters.mu, parameters.d, orbit.period, speed)
            height, top, _ = radial_profile(*numbers)
            outward, excess = radial_course(*numbers, 0.4 * orbit.period)
            assert radial_rates(*numbers, np.array([0.4 * orbit.period])) == pytest.approx(
                [outward], rel=1e-12, abs=1e-14
            )
            times = np.linspace(0.0, orbit.period, sized(20_001, 5_001))[1:-1]
            square = np.abs(orbit.path(times)) ** 2
            assert excess == pytest.approx(np.interp(0.4 * orbit.period, times, square) - 1.0, abs=1e-5 * square.max())
            h = times[1] - times[0]
            middle = int(np.searchsorted(times, 0.4 * orbit.period))
            slope = 0.25 * (square[middle + 1] - square[middle - 1]) / h
            assert outward == pytest.approx(slope, abs=1e-3 * (1.0 + np.abs(np.gradient(square, h)).max()))
            peaks = np.flatnonzero((square[1:-1] > square[:-2]) & (square[1:-1] > square[2:])) + 1
            if not len(peaks):
                assert np.isnan(height)
                continue
            seen += 1
            best = peaks[np.argmax(square[peaks])]
            assert height == pytest.approx(square[best] - 1.0, abs=1e-6 * square.max())
            assert np.interp(top, times, square) == pytest.approx(square[best], abs=1e-6 * square.max())
    assert seen > 5


def test_the_departure_of_an_orbit_without_rebound_is_no_maximum_of_the_radius():
    """The radial speed is exactly zero there; rounding once made it a maximum on the wall."""
    seen = 0
    random = np.random.default_rng(12)
    for _ in range(sized(40, 40, 1000)):
        parameters = random_parameters(random, d=0.0, gamma=float(10 ** random.uniform(-1.5, 0.0)))
        for orbit in find_orbits(jeffcott(parameters), 15.0):
            if orbit.admissible and orbit.slip > 0:
                seen += 1
                numbers = parameters.gamma, parameters.omega, parameters.mu, 0.0, orbit.period, orbit.radial_speed
                height, top, _ = radial_profile(*numbers)
                assert np.isnan(height) or (height < 0.0 and top > 1e-6 * orbit.period)
    assert seen > 5


def test_a_pair_of_extrema_of_the_radius_is_born_where_the_flattest_slope_vanishes():
    """On the branch of the source paper's figure 5b with the diamonds, B1,d."""

    def at(gamma):
        orbit = find_orbits(jeffcott(PAPER.replace(gamma=gamma)))["B1,d"]
        square = np.abs(orbit.path(np.linspace(0.0, orbit.period, 4001)[:-1])) ** 2
        extrema = int((np.diff(np.sign(np.diff(square))) != 0).sum())
        speed = orbit.radial_speed
        return extrema, radial_profile(gamma, PAPER.omega, PAPER.mu, PAPER.d, orbit.period, speed)[2]

    fewer, more = at(0.082), at(0.075)
    assert abs(fewer[0] - more[0]) == 2
    assert fewer[1] * more[1] < 0.0
