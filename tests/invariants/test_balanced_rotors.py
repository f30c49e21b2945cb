"""No unbalance, a limit in which theory says what must happen.

Everywhere ``U`` is the position in the co-rotating frame, ``Z = Ue^{it}`` that in the fixed one, ``W = 1 + θ̇`` the whirl
speed in the fixed frame and ``x = θ − φ``.
"""

import cmath
import math

import numpy as np
import pytest
from limiting_motions import EPSILON, angular_momentum, on_wall, starts
from machines import PAPER

from carom.base.outcome import Outcome, Phase
from carom.models import jeffcott
from carom.motions import State, Trajectory, simulate
from carom.parameters import Parameters


@pytest.mark.jit_only
@pytest.mark.parametrize("turn", [0.3, 1.5, -2.9])
def test_of_a_balanced_rotor_results_turn_with_the_start(turn):
    """Nothing in the co-rotating frame has a direction then."""
    rotor = jeffcott(PAPER.replace(rho=0.0, gamma=0.05))
    around = cmath.rect(1.0, turn)
    times = np.linspace(0.0, 12.0, 200)
    for start in starts(5, 10):
        plain = simulate(rotor, start, 12.0)
        turned = simulate(rotor, State(start.position * around, start.velocity * around), 12.0)
        assert turned.segment_phases.tolist() == plain.segment_phases.tolist()
        # Rounding errors grow with the impacts: by a factor of about 1 + 2/ṙ each.
        growth = np.prod(1.0 + 2.0 / np.maximum(plain.contacts.radial_speed, 0.5))
        apart = np.array(plain.at(times)) * around - np.array(turned.at(times))
        assert np.abs(apart[:, away_from_impacts(plain, times)]).max() < 100 * EPSILON * growth


def away_from_impacts(motion: Trajectory, times: np.ndarray) -> np.ndarray:
    """Times not next to an impact, whose own time is rounded."""
    return np.all(np.abs(times[:, None] - motion.segment_starts[None, 1:]) > 1e-6, axis=1)


@pytest.mark.parametrize("gamma", [0.0, 1e-6, 0.1, 1.52, 4.0])
def test_angular_momentum_of_a_balanced_rotor_decays_like_its_damping(gamma):
    """``Z̈ + γŻ + ω²Z = 0`` gives ``(Im Z̄Ż)' = −γ Im Z̄Ż`` in flight, under-, over- and critically damped alike."""
    rotor = jeffcott(PAPER.replace(rho=0.0, gamma=gamma, mu=0.0))
    for start in starts(6, 10):
        motion = simulate(rotor, start, 10.0)
        times = np.linspace(0.0, 10.0, 100)
        momentum = angular_momentum(*motion.at(times))
        # A smooth wall does not change it either, nor does sliding along it: W' = −γW.
        expected = momentum[0] * np.exp(-gamma * times)
        size = 1.0 + abs(start.velocity)
        assert np.abs(momentum - expected).max() < 50 * EPSILON * size * (1 + len(motion.contacts))


def test_a_damped_balanced_rotor_comes_to_rest_in_the_centre():
    rotor = jeffcott(PAPER.replace(rho=0.0, gamma=0.3))
    assert rotor.equilibrium == 0.0
    for start in starts(7, 10):
        assert simulate(rotor, start, 1e4, settle=True).outcome is Outcome.LEVITATED
        assert abs(simulate(rotor, start, 300.0).final.position) < 1e-12


def forward_slide_time(parameters: Parameters, start: float, end: float) -> float:
    """Time of sliding forward from whirl ``start`` down to ``end`` without unbalance.

    ``W' = −γW − μ(W² − ω²) = −μ(W − w₊)(W − w₋)`` with the roots ``w±`` of ``μW² + γW − μω²``, hence
    ``t = ln[(W₀ − w₊)(W − w₋)/((W − w₊)(W₀ − w₋))]/(μ(w₊ − w₋))`` up to the sign both logarithms share.
    """
    gamma, mu = parameters.gamma, parameters.mu
    root = math.sqrt(gamma**2 + 4.0 * mu**2 * parameters.omega**2)
    upper, lower = (-gamma + root) / (2.0 * mu), (-gamma - root) / (2.0 * mu)

    def level(whirl: float) -> float:
        return math.log((whirl - upper) / (whirl - lower))

    return (level(start) - level(end)) / (mu * (upper - lower))


def test_a_balanced_slide_ends_where_the_whirl_is_too_slow_to_press():
    """``N = W² − ω²`` vanishes at ``W = ω``, at a time known in closed form; the rotor lifts off and does not come back."""
    parameters = PAPER.replace(rho=0.0, gamma=0.3)
    rotor = jeffcott(parameters)
    for whirl in (0.8, 1.5, 20.0):
        for angle in (0.0, 2.0):
            motion = simulate(rotor, on_wall(angle, whirl), 1e3, settle=True)
            (contact,) = motion.lasting_contacts
            assert contact.phase is Phase.FORWARD_SLIP
            # Where N goes through zero its rounding error shifts the time by that over N' = 2WW'.
            assert contact.end == pytest.approx(
                forward_slide_time(parameters, whirl, parameters.omega), rel=1e-12, abs=1e-12
            )
            assert motion.outcome is Outcome.LEVITATED
            assert len(motion.contacts) == 0
