"""Impacts of a free mass on walls that give way, against a general integrator."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

from carom.closed_forms import hunt_crossley_impact, kelvin_voigt_impact
from carom.outcome import InputError

ERROR = 1e-11
"""Of the integrator with a relative tolerance of 1e-13: the onset of a force with a broken power is not smooth."""


def flown(push, leaves, speed, longest):
    """Speed back, depth, largest force and time of contact, by integration."""

    def end(time, state):
        return leaves(*state) if time > 0.0 else 1.0

    end.terminal, end.direction = True, -1.0
    rates = lambda _time, state: [state[1], -push(*state)]  # noqa: E731
    done = solve_ivp(
        rates,
        (0.0, longest),
        [0.0, speed],
        "DOP853",
        rtol=1e-13,
        atol=1e-16 * speed,
        events=end,
        dense_output=True,
        max_step=longest / 200,
    )
    last = done.t[-1]

    def largest(value):
        times = np.linspace(0.0, last, 401)
        best = max(range(401), key=lambda i: value(*done.sol(times[i])))
        low, high = times[max(best - 1, 0)], times[min(best + 1, 400)]
        found = minimize_scalar(lambda time: -value(*done.sol(time)), bounds=(low, high), method="bounded")
        return max(-found.fun, value(*done.sol(times[best])))

    return -done.y[1, -1] / speed, largest(lambda depth, _rate: depth), largest(push), last


@pytest.mark.parametrize(
    ("stiffness", "damping", "speed"),
    [(1e4, 0.0, 2.0), (1e4, 10.0, 1.5), (1e4, 150.0, 1.0), (400.0, 20.0, 0.3), (400.0, 40.0, 0.3), (100.0, 80.0, 1.0)],
)
def test_impact_on_a_spring_and_a_dashpot(stiffness, damping, speed):
    def push(depth, rate):
        return stiffness * depth + damping * rate

    impact = kelvin_voigt_impact(stiffness, damping, speed)
    back, depth, force, time = flown(push, push, speed, 10.0 / math.sqrt(stiffness))

    assert impact.restitution == pytest.approx(back, rel=ERROR)
    # Extremes are found to half of the digits in time, and to all in value.
    assert impact.depth == pytest.approx(depth, rel=ERROR)
    assert impact.peak_force == pytest.approx(force, rel=ERROR)
    assert impact.duration == pytest.approx(time, rel=ERROR)


@pytest.mark.parametrize(
    ("stiffness", "dissipation", "exponent", "speed"),
    [
        (1e4, 0.0, 1.5, 2.0),
        (1e4, 1e-7, 1.0, 2.0),
        (1e4, 0.01, 10 / 9, 1.5),
        (1e4, 1.5, 1.0, 1.0),
        (400.0, 10.0, 1.5, 1.3),
    ],
)
def test_impact_on_a_hunt_crossley_wall(stiffness, dissipation, exponent, speed):
    def push(depth, rate):
        return stiffness * max(depth, 0.0) ** exponent * (1.0 + dissipation * rate)

    impact = hunt_crossley_impact(stiffness, dissipation, exponent, speed)
    longest = 10.0 * (1.0 + dissipation * speed) * impact.depth / speed
    back, depth, force, _ = flown(push, lambda depth, _rate: depth, speed, longest)

    # The event ends a flight on the dense output, whose error is that of a few steps.
    assert impact.restitution == pytest.approx(back, rel=1e-10)
    assert impact.depth == pytest.approx(depth, rel=1e-10)
    assert impact.peak_force == pytest.approx(force, rel=1e-10)
    assert impact.duration is None


def test_a_spring_alone_is_the_same_by_both_laws():
    one, other = kelvin_voigt_impact(250.0, 0.0, 0.7), hunt_crossley_impact(250.0, 0.0, 1.0, 0.7)

    assert (one.restitution, other.restitution) == (1.0, 1.0)
    assert one.depth == pytest.approx(other.depth, rel=1e-15)
    assert one.peak_force == pytest.approx(other.peak_force, rel=1e-15)


def test_what_the_laws_do_not_allow_is_refused():
    with pytest.raises(InputError, match=r"stiffness = -1\.0: a finite number above 0"):
        kelvin_voigt_impact(-1.0, 0.0, 1.0)
    with pytest.raises(InputError, match=r"exponent = 0\.5: a number of at least 1"):
        hunt_crossley_impact(1.0, 0.0, 0.5, 1.0)
