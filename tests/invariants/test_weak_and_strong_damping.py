"""Damping towards none and beyond critical, each a limit in which theory says what must happen.

Everywhere ``U`` is the position in the co-rotating frame, ``Z = Ue^{it}`` that in the fixed one, ``W = 1 + θ̇`` the whirl
speed in the fixed frame and ``x = θ − φ``.
"""

import math

import numpy as np
import pytest
from limiting_motions import START, on_wall
from machines import PAPER

from carom.base.outcome import Outcome
from carom.models import jeffcott
from carom.motions import State, Trajectory, simulate

# ------------------------------------------------------------------------------------------------ γ → 0: undamped


@pytest.mark.parametrize("mu", [0.0, 0.15])
def test_little_damping_is_a_little_change(mu):
    """Flights depend analytically on ``γ``, and transversal impacts too: the change of a motion is linear in ``γ``."""
    times = np.array([0.5, 3.0, 7.0])

    def positions(gamma: float) -> np.ndarray:
        motion = simulate(jeffcott(PAPER.replace(gamma=gamma, mu=mu)), START, 8.0)
        assert len(motion.contacts) >= 4
        return motion.position(times)

    undamped = positions(0.0)
    apart = [np.abs(positions(gamma) - undamped) for gamma in (1e-5, 1e-6, 1e-7, 1e-9)]
    assert np.allclose(apart[0] / apart[1], 10.0, rtol=1e-3)
    assert np.allclose(apart[1] / apart[2], 10.0, rtol=1e-4)
    # From below as from above.
    assert np.allclose(positions(-1e-7) - undamped, undamped - positions(1e-7), rtol=1e-4, atol=1e-12)
    assert apart[3].max() < 1e-6


def flight_reach(motion: Trajectory) -> float:
    """Largest radius that the motion can reach on its last flight: the sum of the moduli of its modes."""
    parameters, rotor = motion.rotor.parameters, motion.rotor
    # Without damping and unbalance apart, U − U* = a e^{−i(1−ω)t} + b e^{−i(1+ω)t}.
    offset, speed = motion.final.position - rotor.equilibrium, motion.final.velocity
    slow, fast = -1j * (1.0 - parameters.omega), -1j * (1.0 + parameters.omega)
    first = (speed - fast * offset) / (slow - fast)
    return abs(rotor.equilibrium) + abs(first) + abs(offset - first)


def test_an_undamped_balanced_rotor_ends_grazing():
    """Impacts take energy, flights do not.

    In flight the centre runs through an ellipse of half-axes ``A > B`` about the bearing's.  Each impact that finds
    ``A > 1`` lowers it, so in the end ``A = 1``: the ellipse touches the wall for ever, and no finite precision decides
    whether it strikes.  That is the outcome ``grazing``, and not a fault.
    """
    rotor = jeffcott(PAPER.replace(gamma=0.0, rho=0.0, mu=0.15, omega=1.3, d=0.5))
    for start in (State(0.5, 2.0 + 1.0j), State(0.1j, 1.5), State(-0.4 + 0.2j, -2.0 - 0.3j)):
        motion = simulate(rotor, start, 1e5, settle=True)
        assert motion.outcome is Outcome.GRAZING
        assert len(motion.contacts) > 3
        assert motion.contacts.radial_speed[-1] < 1e-5
        assert flight_reach(motion) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.jit_only
def test_an_undamped_unbalanced_rotor_touches_ever_more_rarely():
    """With unbalance a flight has two frequencies, and comes near its reach only now and then.

    Impacts lower the reach towards 1 and become rarer without end.  Nothing settles: the outcome is ``time-reached``.
    """
    rotor = jeffcott(PAPER.replace(gamma=0.0, omega=math.sqrt(3.6), d=0.3))
    start = State(0.5, 2.0 + 1.0j)
    short, long = (simulate(rotor, start, until, settle=True) for until in (1e2, 1e5))
    for motion in (short, long):
        assert motion.outcome is Outcome.TIME_REACHED
        assert flight_reach(motion) > 1.0
    assert flight_reach(long) - 1.0 < 0.1 * (flight_reach(short) - 1.0)
    waits = np.diff(long.contacts.time)
    assert waits[-1] > 10.0 * np.median(waits)
    assert long.contacts.radial_speed[-1] < 0.1 * np.median(long.contacts.radial_speed)


@pytest.mark.jit_only
@pytest.mark.parametrize("gamma", [1e-3, 1e-5])
@pytest.mark.parametrize("rho", [0.0, 3 / 7])
def test_with_the_least_damping_the_same_motions_settle(gamma, rho):
    """Then the reach falls below 1 for good, within a few times ``1/γ``."""
    rotor = jeffcott(PAPER.replace(gamma=gamma, rho=rho, omega=1.9, d=0.3))
    for start in (State(0.5, 2.0 + 1.0j), State(0.1j, 1.5), State(-0.4 + 0.2j, -2.0 - 0.3j)):
        motion = simulate(rotor, start, 1e3 / gamma, settle=True)
        assert motion.outcome is Outcome.LEVITATED
        assert motion.time < 20.0 / gamma


# ------------------------------------------------------------------------------------------------ strong damping


@pytest.mark.parametrize("gamma", [1.52, 1.52 * (1 + 1e-7), 3.0, 30.0])
def test_an_overdamped_rotor_swings_out_once(gamma):
    """From rest in the centre ``Z = v(e^{−at} − e^{−bt})/(b − a)`` with ``a, b = (γ ∓ √(γ² − 4ω²))/2``.

    It turns back at ``t = ln(b/a)/(b − a)``, where ``|Z| = (v/b)(a/b)^{a/(b−a)}``.  So the speed that just reaches the wall
    is known, and the rotor that does not reach it the first time never does.
    """
    parameters = PAPER.replace(rho=0.0, gamma=gamma)
    rotor = jeffcott(parameters)
    root = math.sqrt(max(gamma**2 - 4.0 * parameters.omega**2, 0.0))
    b = 0.5 * (gamma + root)
    a = parameters.omega**2 / b
    share = math.exp(-1.0) if root == 0.0 else math.exp(-a / root * math.log1p(root / a))
    speed = b / share
    # Z' = v in the fixed frame is U' = v in the co-rotating one, at the centre.
    below, above = (simulate(rotor, State(0j, speed * (1.0 + change)), 1e4, settle=True) for change in (-1e-6, 1e-6))
    assert below.outcome is Outcome.LEVITATED
    assert len(below.contacts) == 0
    assert len(above.contacts) > 0
    turn = math.log1p(root / a) / root if root > 0.0 else 1.0 / b
    # |Z| lies above the wall for a time that goes with the square root of the excess.
    assert above.contacts.time[0] == pytest.approx(turn, rel=0.01)


def test_strong_damping_stops_a_rebound_at_once():
    """After an impact with ``ṙ`` the rotor leaves at ``dṙ``, and where ``γ`` is large gets as far as ``dṙ/γ``."""
    for gamma in (100.0, 1000.0):
        parameters = PAPER.replace(gamma=gamma, omega=0.1, rho=0.0)
        motion = simulate(jeffcott(parameters), on_wall(0.0, 0.0, 1.0), 20.0 / gamma)
        gap = 1.0 - abs(motion.final.position)
        assert gap == pytest.approx(parameters.d / gamma, rel=0.2 / gamma)  # the pull to the centre is left out
