"""Lyapunov exponents: volumes, multipliers of orbits, nearby motions, and a variational integration written down again."""

import math

import numpy as np
import pytest

from carom.base.outcome import CaromError, Outcome
from carom.models import Rotor, jeffcott
from carom.motions import State, settle, simulate
from carom.orbits import find_orbits, lyapunov_exponents, orbit_exponents, orbit_of_motion
from carom.parameters import Parameters
from tests.compilation import sized
from tests.machines import PAPER, random_parameters

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
    ends = settle(rotor, State(np.sqrt(place) * turn, 2.0 * np.sqrt(speed) * way), patience=1000)
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
