"""Rolling in bounces that fade, against simulated motions."""

import cmath

import numpy as np
import pytest
from compilation import sized
from machines import PAPER

from carom.closed_forms import fading_speed, rolling
from carom.models import jeffcott
from carom.motions import State, simulate
from carom.parameters import Parameters

NEARLY_ELASTIC = Parameters(
    gamma=0.05071695, omega=0.77359473, rho=0.20472252, phi=1.08396837, mu=0.34598246, d=0.9999, radius_ratio=99.134234
)


def drawn(random: np.random.Generator) -> Parameters:
    """A machine with all kinds of walls, whose rolling need not last."""
    return Parameters(
        gamma=random.choice([0.0, 10.0 ** random.uniform(-4.0, 0.0)]),
        omega=10.0 ** random.uniform(-0.7, 0.5),
        rho=10.0 ** random.uniform(-3.0, 0.0),
        phi=random.uniform(-3.0, 3.0),
        mu=random.uniform(0.0, 1.0),
        d=random.choice([1.0, 1.0 - 10.0 ** random.uniform(-5.0, 0.0), random.uniform()]),
        radius_ratio=10.0 ** random.uniform(0.1, 2.5),
    )


@pytest.mark.parametrize("seed", range(sized(8, 1, 60)))
def test_bounces_up_to_the_fading_speed_stop_their_slip_and_fade(seed):
    random, tried = np.random.default_rng(seed), 0
    while tried < sized(8, 1):
        parameters = drawn(random)
        fastest = fading_speed(parameters)
        if not fastest:
            continue
        tried += 1
        for speed in (fastest, fastest * 10.0 ** random.uniform(-3.0, 0.0)):
            wall = cmath.exp(1j * random.uniform(-3.0, 3.0))
            start = State(wall, complex(-speed, -1.0 - parameters.radius_ratio) * wall)
            motion = simulate(jeffcott(parameters), start, 1e4, max_events=sized(300, 50))
            log = motion.log_of(motion.is_impact)
            event_amplitudes = log.radial_speed[log.radial_speed > 1e-6]  # far above rounding
            slip = log.angular_speed[: len(event_amplitudes)] + 1.0 + parameters.radius_ratio
            assert (np.abs(slip) <= parameters.mu * (1.0 + parameters.d) * event_amplitudes).all()
            # The bounds are strict; 1e-10 is a rounding error of speeds of 1 + θ̇ of some hundreds.
            assert (np.diff(parameters.d * event_amplitudes, prepend=speed) < 1e-10 * speed).all()


def test_where_nothing_is_proven():
    assert fading_speed(PAPER) > 0.0
    assert fading_speed(PAPER.replace(mu=0.0)) == 0.0
    assert fading_speed(PAPER.replace(gamma=-0.01)) == 0.0
    slow = PAPER.replace(radius_ratio=1.0)  # rolls off the wall
    assert not rolling(slow).holds
    assert fading_speed(slow) == 0.0
    # An elastic wall takes nothing: damping has to outweigh the unbalance.
    elastic = NEARLY_ELASTIC.replace(d=1.0)
    assert fading_speed(elastic) > 1.0
    assert fading_speed(elastic.replace(gamma=1e-4)) == 0.0
    assert fading_speed(elastic.replace(gamma=1e-4, rho=1e-4)) > 1.0
    assert fading_speed(NEARLY_ELASTIC.replace(gamma=1e-4)) > 0.0


def test_bounces_of_an_elastic_wall_fade_at_the_rate_of_the_damping():
    """Averaged over a turn ``v̇ = −γ(1/3 + 2s²/(3N)) v`` with ``N = s² − ω²``, to the order of the height of a bounce."""
    at = NEARLY_ELASTIC.replace(d=1.0)
    start = State(1.0, complex(-0.1, -1.0 - at.radius_ratio))
    motion = simulate(jeffcott(at), start, sized(200, 2) / 100.0)
    log = motion.log_of(motion.is_impact)
    push = at.radius_ratio**2 - at.omega**2
    rate = at.gamma * (1.0 / 3.0 + 2.0 * at.radius_ratio**2 / (3.0 * push))
    assert np.log(0.1 / log.radial_speed[-1]) / log.time[-1] == pytest.approx(rate, rel=0.02)
