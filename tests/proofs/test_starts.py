"""Responses of a rotor to disturbances of the unit size, against a general integrator in the fixed frame."""

import math

import numpy as np
import pytest
from compilation import sized
from flint import arb
from scipy.integrate import solve_ivp

from carom.proofs.balls import at_precision
from carom.proofs.hypotheses import hypotheses_of
from carom.proofs.patches import Held
from carom.proofs.rotor import ProvenRotor
from carom.proofs.starts import KickStart, Pulse, Step

MACHINES = {"light damping": (0.05, 0.14), "paper": (0.3, 0.76), "overdamped": (1.2, 0.5)}
INTEGRATED = 1e-8
"""Of responses by the integrator, whose tolerance is a hundredth of it; they are of the size 1."""


def held_of(name, start):
    gamma, omega = MACHINES[name]
    numbers = {"gamma": gamma, "omega": omega, "rho": 0.1, "phi": 0, "mu": 0.1, "d": 0.5, "radius_ratio": 50}
    return Held(ProvenRotor(hypotheses_of(numbers)).numbers, start)


def integrated(name, start, force, times, longest=np.inf):
    """Place and rate at some times, of a start and a force."""
    gamma, omega = MACHINES[name]

    def rates(t, y):
        return [y[1], force(t) - gamma * y[1] - omega**2 * y[0]]

    done = solve_ivp(
        rates, (0, times[-1]), np.array(start, complex), "DOP853", times, rtol=1e-11, atol=1e-13, max_step=longest
    )
    return done.y


@pytest.mark.parametrize("name", MACHINES)
@pytest.mark.parametrize("duration", [0.02, 0.7, 5.0])
def test_pulses_move_a_rotor_as_an_integrator_says(name, duration):
    times, nu = np.sort(np.random.default_rng(3).uniform(0, 3 * duration + 2, sized(12, 6, 60))), math.pi / duration
    places, rates = integrated(
        name, (0, 0), lambda t: nu / 2 * math.sin(nu * t) * (t < duration), times, longest=duration / 8
    )
    with at_precision(64):
        held = held_of(name, Pulse(arb(duration)))
        for time, place, rate in zip(times, places, rates, strict=True):
            response = held.start.response(held, arb(time))
            assert abs(response[0] - place.real) < INTEGRATED
            assert abs(response[1] - rate.real) < INTEGRATED
            # The acceleration is the force less damping and spring.
            force = nu / 2 * math.sin(nu * time) * (time < duration)
            gamma, omega = MACHINES[name]
            assert abs(response[2] - (force - gamma * rate - omega**2 * place).real) < 10 * INTEGRATED * (1 + nu)
            assert held.start.plain_response(held, time) == pytest.approx(
                [float(x.mid()) for x in response], abs=1e-9 * (1 + nu)
            )


def test_a_pulse_on_an_interval_of_times_holds_all_of_it():
    """Also where it ends within."""
    random = np.random.default_rng(5)
    with at_precision(64):
        held = held_of("paper", Pulse(arb(1.5)))
        for _ in range(sized(30, 8, 300)):
            begin, width = random.uniform(0, 2), 10 ** random.uniform(-3, 0)
            wide = held.start.response(held, arb(begin).union(arb(begin + width)))
            for time in random.uniform(begin, begin + width, 5):
                narrow = held.start.response(held, arb(time))
                assert all(one.contains(other.mid()) for one, other in zip(wide, narrow, strict=True))


def test_a_short_pulse_is_a_blow():
    with at_precision(64):
        short, blow = held_of("paper", Pulse(arb("1e-6"))), held_of("paper", KickStart())
        for one, other in zip(*(held.start.response(held, arb(2)) for held in (short, blow)), strict=True):
            # The pulse acts half its duration later.
            assert abs(one - other) < 1e-6


@pytest.mark.parametrize("name", MACHINES)
def test_a_step_is_the_levitation_before_it(name):
    times = np.array([0.0, 0.5, 3.0, 9.0])
    places, rates = integrated(name, (1, 1j), lambda _: 0, times)
    with at_precision(64):
        held = held_of(name, Step())
        for time, place, rate in zip(times, places, rates, strict=True):
            found = [complex(x) for x in held.start.response(held, arb(time))[:2]]
            assert found == pytest.approx([place, rate], abs=INTEGRATED)
            assert held.start.plain_response(held, time)[:2] == pytest.approx(found, abs=1e-12)
