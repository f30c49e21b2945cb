"""What a limit is said to be: no digit more than is known, and which disturbances it holds for."""

import pytest
from scipy.stats import binom

from carom.attractors import DisturbanceSet, MotionName
from carom.attractors.names import SYNCHRONOUS_RUB
from carom.closed_forms.whirl import runaway_speed
from carom.models import Jeffcott
from carom.orbits.names import OrbitName
from carom.outcome import Outcome
from carom.parameters import Parameters, Scales
from carom.studies.safety import DampingCheck, DampingLimit, SafeDamping
from carom.studies.safety.limits import rounded_up, share_words

SOURCE = Parameters(gamma=0.1, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=400 / 7)
SCALES = Scales(mass=50.0, clearance=0.7e-3, speed=184.2)
ROLLS = MotionName(Outcome.ROLLING)
RUB = DampingLimit(SYNCHRONOUS_RUB, 0.3700060375, 0.3700060375, "closed form")
ORBITS = DampingLimit(
    MotionName(Outcome.BOUNCING, 1, orbit=OrbitName(1, True, True)), 0.1780277257, 0.1780277258, "search"
)
ROLLING = DampingLimit(ROLLS, 8.56, 8.57, "closed form")


def safe(simulated, checks=(0.6, 1.0, 2.0), rolling=ROLLING, scales=SCALES):
    sample = DisturbanceSet(5000, 0, 2.0)
    return SafeDamping(
        SOURCE.replace(scales=scales),
        RUB,
        ORBITS,
        simulated,
        rolling,
        runaway_speed(Jeffcott(SOURCE)),
        0.02,
        2.0,
        sample,
        tuple(DampingCheck(gamma, 0, sample) for gamma in checks),
        DampingCheck(checks[0], 7, DisturbanceSet(1250, 1, 4.0)) if checks else None,
    )


def test_limit_is_the_exact_one_unless_a_disturbance_was_lost_above_it():
    assert safe(DampingLimit(ROLLS, 0.36, 0.6, "simulation")).within_reach == RUB
    assert safe(DampingLimit(ROLLS, 0.38, 0.6, "simulation")).within_reach.motion == "rolling"


def test_simulated_limit_has_the_digits_of_its_bracket():
    narrow = safe(DampingLimit(ROLLS, 0.50113, 0.50614, "simulation"))
    wide = safe(DampingLimit(ROLLS, 0.5011, 0.53141, "simulation"))

    assert (narrow.within_reach.digits, wide.within_reach.digits) == (3, 2)
    assert "Above gamma = 0.507 (4670 N s/m) all fresh disturbances tried came back" in narrow.words
    assert "one was found to be lost is gamma = 0.501 (4620 N s/m) (ends in rolling)" in narrow.words
    assert "Above gamma = 0.54 (4900 N s/m) all fresh" in wide.words


def test_words_name_the_disturbances_their_speed_and_the_confidence():
    words = safe(DampingLimit(SYNCHRONOUS_RUB, 0.36, 0.6, "simulation")).words

    assert words.startswith(
        "The last motion to vanish is the synchronous rub, at gamma = 0.37001 (3408 N s/m), known by a closed form. "
    )
    assert "At each of 3 dampings from gamma = 0.6 (5526 N s/m) to gamma = 2 (18420 N s/m) none of 5000" in words
    assert "with 95 % confidence fewer than 1 in 640 are lost at any of these" in words
    assert "3000 velocity kicks of the levitating rotor" in words
    assert "2000 starts spread over the clearance at up to 2 c_r Omega (0.258 m/s)" in words
    assert "Of 1250 disturbances up to 4 c_r Omega (0.516 m/s) 7 were lost at gamma = 0.6" in words
    assert "none of the disturbances tried got there" in words


def test_irregular_bouncing_is_not_called_an_end():
    words = safe(DampingLimit(MotionName(Outcome.BOUNCING), 0.50113, 0.50614, "simulation")).words

    assert "gamma = 0.501 (4620 N s/m) (irregular bouncing, not seen to come back in 20,000 impacts)." in words


@pytest.mark.parametrize(("lost", "chance"), [(0, (0.05, 0.0501)), (1, (0.005, 0.05)), (700, (0.02, 0.03))])
def test_share_that_may_be_lost_would_seldom_show_so_few(lost, chance):
    bound = DampingCheck(0.5, lost, DisturbanceSet(5000)).share_below

    low, high = chance
    assert low * (1.0 - 1e-9) <= binom.cdf(lost, 5000, bound) <= high


def test_nothing_is_claimed_without_checks():
    words = safe(DampingLimit(ROLLS, 2.0, float("inf"), "simulation"), checks=(), rolling=None).words

    assert words == (
        "Contact motions survive up to the highest damping looked at, gamma = 2 (18420 N s/m). "
        "Rolling in backward whirl cannot sustain itself at any damping."
    )


def test_numbers_without_scales():
    assert " N s/m" not in safe(DampingLimit(ROLLS, 0.501, 0.506, "simulation"), scales=None).words


@pytest.mark.parametrize(
    ("value", "digits", "up"),
    [(0.50614, 3, 0.507), (0.5, 3, 0.5), (0.9991, 3, 1.0), (12345.0, 2, 13000.0), (0.1 + 0.2, 1, 0.4), (9.95, 2, 10.0)],
)
def test_rounding_up_never_goes_below(value, digits, up):
    assert rounded_up(value, digits) == pytest.approx(up, rel=1e-15)
    assert rounded_up(value, digits) >= value


def test_share_in_words():
    assert share_words(7.7e-4) == "fewer than 1 in 1,200 are lost"
    assert share_words(0.37) == "less than 37 % are lost"
