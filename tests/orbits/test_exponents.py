"""Lyapunov exponents: volumes, multipliers of orbits, nearby motions, and a variational integration written down again."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import brentq

from carom.base.outcome import CaromError, Outcome
from carom.models import Rotor, jeffcott
from carom.motions import State, settle, simulate
from carom.orbits import find_orbits
from carom.orbits.exponents import lyapunov_exponents, orbit_exponents
from carom.orbits.recognising import orbit_of_motion
from carom.parameters import Parameters
from tests.compilation import sized
from tests.machines import PAPER, flight_matrix, random_parameters, rest_position, strike

# Hundreds of impacts with their derivatives.
pytestmark = pytest.mark.jit_only

CHAOTIC = Parameters(0.0772, 1.098, 0.615, 0.0, 0.1356, 0.95, 3.04)
STOPPING = Parameters(0.047, 0.745, 0.78, 0.0, 0.34, 0.95, 0.786)
LANDING = Parameters(0.0274, 1.0566, 0.42048, 0.0, 0.35408, 0.0269, 1.0477)
WITHOUT_REBOUND = Parameters(0.0245, 0.837, 0.0621, 0.0, 0.349, 0.0, 6.71)
ROLLING = Parameters(0.11455, 0.40645, 0.21684, 0.0, 0.39103, 0.0, 0.7208)


def lively(rng: np.random.Generator) -> Rotor:
    """A machine on which many motions keep bouncing."""
    return jeffcott(
        random_parameters(
            rng,
            omega=rng.uniform(0.3, 1.5),
            gamma=10 ** rng.uniform(-1.7, -0.3),
            rho=rng.uniform(0.05, 0.8),
            mu=rng.uniform(0.0, 0.4),
            d=rng.choice([0.95, *rng.uniform(0.3, 1.0, 5)]),
            radius_ratio=10 ** rng.uniform(0.0, 2.0),
        )
    )


def bouncing_from(rotor, starts: int, seed: int = 0, wanted=(Outcome.BOUNCING, Outcome.MIXED)) -> list[State]:
    """States just before an impact of motions that keep hitting the wall, from random starts."""
    rng = np.random.default_rng(seed)
    place, speed = rng.uniform(size=(2, starts))
    turn, way = np.exp(2j * np.pi * rng.uniform(size=(2, starts)))
    ends = settle(rotor, np.sqrt(place) * turn, 2.0 * np.sqrt(speed) * way, patience=1000)
    chosen = np.isin(ends.outcomes, wanted)
    return [State(complex(u), complex(v)) for u, v in zip(ends.positions[chosen], ends.velocities[chosen], strict=True)]


def test_exponents_add_up_to_the_growth_of_volumes():
    rng, compared, lost = np.random.default_rng(5), 0, 0
    for _ in range(sized(120, 1, 1500)):
        rotor = lively(rng)
        for state in bouncing_from(rotor, 30, wanted=(Outcome.BOUNCING,))[:2]:
            try:
                found = lyapunov_exponents(rotor, state, 300, transient=50)
            except CaromError:  # a transient that is over
                continue
            lost += found.lost > 0
            if not found.lost:
                compared += 1
                # The promised accuracy; rounding of some hundred factors gives 1e-11.
                assert abs(found.values.sum() - found.volume) < 1e-9 * (1.0 + abs(found.volume))
            else:
                assert found.volume == -math.inf
            assert np.isneginf(found.values).sum() == found.lost
    assert compared > 10
    assert lost > 0


@pytest.mark.parametrize("parameters", [PAPER, PAPER.replace(gamma=0.083), LANDING, WITHOUT_REBOUND, ROLLING])
def test_exponents_of_orbits_are_those_of_their_multipliers(parameters):
    if parameters.mu == PAPER.mu:
        one = find_orbits(parameters)["B1,d"].departure
        start = State(one.position, 1.0001 * one.velocity)
    else:
        start = bouncing_from(jeffcott(parameters), 60)[0]
    orbit = orbit_of_motion(simulate(parameters, start, settle=True))
    exact = orbit_exponents(orbit)
    impacts = 20_000 if not exact.landings else 300
    found = lyapunov_exponents(parameters, orbit.departure, impacts, transient=impacts // 5)
    assert found.lost == exact.lost
    finite = np.isfinite(exact.values)
    # Conjugate pairs oscillate, so that their errors fall like one over the time.
    assert np.abs(found.values[finite] - exact.values[finite]).max() < 5.0 / found.time
    assert exact.across[0] == exact.values[1]
    if exact.lost:
        return
    assert abs(exact.values.sum() - exact.volume) < 1e-9
    if abs(orbit.multipliers.values[0].imag) == 0.0:
        assert abs(found.across[0] - exact.across[0]) < 1e-6


def test_directions_that_contact_takes_away_have_no_finite_exponent():
    """Counted by hand: sliding keeps the angle at which it ends, rolling keeps nothing, a stopped slip two of three."""
    for parameters, wanted, lost in (
        (STOPPING, Outcome.BOUNCING, 1),
        (LANDING, Outcome.MIXED, 2),
        (WITHOUT_REBOUND, Outcome.BOUNCING, 1),
        (ROLLING, Outcome.MIXED, 3),
    ):
        state = bouncing_from(jeffcott(parameters), sized(60, 10), wanted=(wanted,))[0]
        found = lyapunov_exponents(parameters, state, sized(100, 30), transient=sized(50, 10))
        assert found.lost == lost
        assert (found.landings > 0) == (wanted is Outcome.MIXED)


def nearby_growth(rotor, state: State, time: float, count: int) -> tuple[float, float]:
    """Growth rate of the distance of a second motion that is brought back to 1e-8 again and again, and its error."""
    near, rates = 1e-8, []
    other = State(state.position * (1.0 - near), state.velocity)
    for _ in range(count):
        first, second = (simulate(rotor, one, time).final for one in (state, other))
        apart = math.hypot(abs(second.position - first.position), abs(second.velocity - first.velocity))
        if 0.0 < apart < 1e-3:  # otherwise only one of them has just hit the wall
            rates.append(math.log(apart / near) / time)
        else:
            apart = near
            second = State(first.position * (1.0 - near), first.velocity)
        other = State(
            first.position + (second.position - first.position) * near / apart,
            first.velocity + (second.velocity - first.velocity) * near / apart,
        )
        if abs(other.position) > 1.0:
            other = State(other.position / abs(other.position) * (1.0 - 1e-9), other.velocity)
        state = first
    return float(np.mean(rates[10:])), float(np.std(rates[10:]) / math.sqrt(len(rates) - 10))


def test_all_exponents_agree_with_a_variational_integration():
    """Matrix exponentials, root finding, and the derivative of the impact law and of the time of impact by hand."""
    state = bouncing_from(jeffcott(CHAOTIC), 20, wanted=(Outcome.BOUNCING,))[0]
    transient, impacts = 10, sized(40, 5)
    found = lyapunov_exponents(CHAOTIC, state, impacts, transient=transient, batches=2)
    position, velocity = state.position, state.velocity
    directions, grown, lasted = np.eye(4)[:, 1:], np.zeros(3), 0.0
    for impact in range(transient + impacts):
        passage, time, position, velocity = _to_next_impact(CHAOTIC, position, velocity)
        directions, triangle = np.linalg.qr(passage @ directions)
        if impact >= transient:
            grown += np.log(np.abs(np.diag(triangle)))
            lasted += time
    assert abs(lasted - found.time) < 1e-6 * lasted
    expected = np.sort(grown / lasted)[::-1]
    others = found.values[found.values != found.along]
    # The error of the root finding grows with the motion.
    np.testing.assert_allclose(others, expected, atol=1e-6)


def _to_next_impact(parameters: Parameters, position: complex, velocity: complex):
    """Derivative from just before an impact to just before the next, in real and then imaginary parts."""

    def struck(values: np.ndarray) -> np.ndarray:
        place, speed = values[0] + 1j * values[2], values[1] + 1j * values[3]
        normal = place / abs(place)
        local = speed / normal
        after = normal * complex(*strike(parameters, local.real, local.imag))
        return np.array([place.real, after.real, place.imag, after.imag])

    matrix, rest = flight_matrix(parameters), rest_position(parameters)
    whole = np.block([[matrix.real, -matrix.imag], [matrix.imag, matrix.real]])
    offset = np.array([rest.real, 0.0, rest.imag, 0.0])

    def flown(values: np.ndarray, time: float) -> np.ndarray:
        return offset + expm(whole * time) @ (values - offset)

    before = np.array([position.real, velocity.real, position.imag, velocity.imag])
    step = 1e-5
    # Differences of fourth order: their error is far below that of the integration.
    jumps = np.array(
        [
            (8.0 * (struck(before + h) - struck(before - h)) - struck(before + 2 * h) + struck(before - 2 * h))
            / (12.0 * step)
            for h in step * np.eye(4)
        ]
    ).T
    after = struck(before)
    times = np.linspace(1e-6, 20.0, 2001)
    propagate, state, heights = expm(whole * (times[1] - times[0])), flown(after, times[0]), []
    for _ in times:
        heights.append(state[0] ** 2 + state[2] ** 2 - 1.0)
        state = offset + propagate @ (state - offset)
    first = int(np.flatnonzero((np.array(heights[:-1]) < 0.0) & (np.array(heights[1:]) >= 0.0))[0])

    def height(time: float) -> float:
        there = flown(after, time)
        return float(there[0] ** 2 + there[2] ** 2 - 1.0)

    time = brentq(height, times[first], times[first + 1], xtol=1e-15, rtol=1e-14)
    end = flown(after, time)
    rate, normal = whole @ (end - offset), np.array([end[0], 0.0, end[2], 0.0])
    carried = expm(whole * time) @ jumps
    carried -= np.outer(rate, normal @ carried) / (normal @ rate)
    return carried, time, complex(end[0], end[2]), complex(end[1], end[3])
