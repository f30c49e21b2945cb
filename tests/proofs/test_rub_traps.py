"""The region around a rub that holds its bounces, beside bounces that a general integrator follows."""

import cmath

import numpy as np
import pytest
from compilation import sized
from flint import arb
from machines import DECIMAL
from rub_bounces import Bouncing
from scipy.integrate import solve_ivp

from carom.proofs.balls import at_precision
from carom.proofs.hypotheses import hypotheses_of
from carom.proofs.patches import Held, Patch
from carom.proofs.rotor import ProvenRotor
from carom.proofs.rub_traps import Bounces, ends_in_rub
from carom.proofs.steady import Rub

PAPER = dict(zip(DECIMAL, (0.3, 0.76, 3 / 7, 0.0, 0.15, 0.95, 57.0), strict=True))
DIFFERENCE = 1e-5
"""Steps of differences of functions along flights: their error is about its square."""


def drawn(random):
    """A machine, often one that has a stable rub."""
    gamma, omega, rho = random.uniform(0.01, 1.0), random.uniform(0.1, 1.2), random.uniform(0.1, 2.0)
    mu, d = random.choice((0.0, 0.02, 0.2, 0.6)), random.choice((0.0, 0.3, 0.7, 0.95))
    return dict(zip(DECIMAL, (gamma, omega, rho, 0.0, mu, d, random.uniform(0.5, 20.0)), strict=True))


def held_of(machine):
    return Held(ProvenRotor(hypotheses_of(machine)).numbers)


def state_of(machine, speed, off, turning):
    """Coordinates ``a, b, ψ`` of a state that leaves the wall, around the angle that a search finds."""
    angle, _ = Bouncing(machine).rub()
    stiffness = complex(machine["omega"] ** 2 - 1, machine["gamma"])
    return [-speed, 1 + turning, -(angle + off) - cmath.phase(stiffness)]


def trapped(machine, speed, off, turning):
    """Whether a single state is proven to end in the rub."""
    exact = [arb(x) for x in state_of(machine, speed, off, turning)]
    return ends_in_rub(held_of(machine), Patch(exact, [[arb(0)] * 3] * 2, [arb(0)] * 3))


def test_states_that_are_held_bounce_into_the_rub():
    random, followed, moved = np.random.default_rng(4), 0, 0
    while followed < sized(12, 4, 300):
        machine = drawn(random)
        speed, off, turning = 10 ** random.uniform(-3, -0.7), random.normal(0, 0.05), random.normal(0, 0.03)
        with at_precision(64):
            held = held_of(machine)
            # The peer searches a rub that is there.
            if not (held.rub.exists and trapped(machine, speed, off, turning)):
                continue
            least = held.rub.force / 16
        peer = Bouncing(machine)
        angle, _ = peer.rub()
        end, _, speeds = peer.rest((1.0, -speed, angle + off, turning))
        force, (last, _) = peer.settled(end)
        assert force > 0
        assert abs(last - angle) < 1e-3 * (abs(off) + abs(turning) + speed)
        assert all(after < 1.1 * speed for after in speeds)
        assert least > 0
        followed, moved = followed + 1, moved + (len(speeds) > 3)
    assert moved


def test_bounds_hold_along_flights():
    """What the lemma bounds, from its definitions and by differences along single flights that stay in the box."""
    random = np.random.default_rng(6)
    peer, (mu, gamma) = Bouncing(PAPER), (PAPER["mu"], PAPER["gamma"])
    angle, _ = peer.rub()
    with at_precision(64):
        rub = Rub.of(ProvenRotor(hypotheses_of(PAPER)).numbers)
        bounces = Bounces(rub, arb(0.2), arb(0.1))
        first, free, fast, fast_rate = bounces._growth
        gain, box, least = float(bounces._gain.upper()), bounces.box, float(bounces._least)
        slide = float(box.slide.upper())

        def parts(state):
            r, v, x, y = state
            q, off = y - mu * v, x - angle
            swing = 2 * (1 + y) / r + mu * mu * (2 + q + y)
            torque = float(rub.torque(arb(off)).mid())
            return np.exp(2 * mu * off), q, swing, torque

        def leading(state):
            factor, q, swing, torque = parts(state)
            return factor * (mu * (mu * q * q + torque) - q * swing)

        def level(state):
            factor, q, _, _ = parts(state)
            return 0.5 * q * q * factor + float(rub.potential(arb(state[2] - angle)).mid())

        for _ in range(sized(20, 8, 300)):
            off, q, v = random.uniform(-0.19, 0.19), random.uniform(-slide, slide) * 0.9, 0.1 * random.random()
            start = (1.0, -v, angle + off, q - mu * v)

            def height(_, y):
                return y[0] - 1

            height.terminal, height.direction = True, 1
            done = solve_ivp(
                peer.flight,
                (0, 10),
                start,
                "DOP853",
                rtol=1e-12,
                atol=1e-14,
                events=height,
                first_step=1e-6,
                dense_output=True,
            )
            time = done.t[-1]
            assert done.y[1, -1] ** 2 < v * v * (1 + gain)
            for share in random.uniform(0.01, 0.99, 4):
                now, h = share * time, min(DIFFERENCE, 0.005 * time)
                state, later, earlier = (done.sol(t) for t in (now, now + h, now - h))
                gap, rate = 1 - state[0], state[1]
                if not abs(state[2] - angle) < 0.2:
                    continue
                factor, slip, _swing, _torque = parts(state)
                assert first.contains(arb(leading(state)))
                assert peer.flight(0, state)[1] > least - 1e-9
                # V' + (γ + 2μ)q²e + … = r'Φ + g q e E₂
                pull = -PAPER["rho"] * np.sin(state[2]) / state[0] + mu * ((1 + state[3]) ** 2 - PAPER["omega"] ** 2)
                rise = (level(later) - level(earlier)) / (2 * h)
                shown = -(gamma + 2 * mu) * slip**2 * factor + rate * leading(state) + gap * slip * factor * pull
                assert rise == pytest.approx(shown, abs=1e-6)
                # Φ' + q e E₂ = C₀ + r'C₁
                change = (leading(later) - leading(earlier)) / (2 * h) + slip * factor * pull
                both = free + arb(rate) * fast
                assert (both + arb(0, 1e-5)).contains(arb(change))
        assert abs(fast_rate) < 100


def test_what_may_leave_is_not_said_to_stay():
    with at_precision(64):
        assert trapped(PAPER, 0.02, 0.01, 0.0)
        assert not trapped(PAPER, 0.5, 0.0, 0.0)
        assert not trapped(PAPER, 0.02, 2.5, 0.0)
        assert not trapped(PAPER, 0.02, 0.0, 0.8)
        # Without a rub nothing is held.
        assert not held_of({**PAPER, "gamma": 0.9}).rub.exists
