"""What a limit is said to be: no digit more than is known, and which disturbances it holds for."""

import pytest
from scipy.stats import binom

from carom.attractors import DisturbanceSet, MotionName
from carom.attractors.names import SYNCHRONOUS_RUB
from carom.orbits.names import OrbitName
from carom.outcome import Outcome
from carom.parameters import Parameters, Scales
from carom.studies.safety import DampingCheck, DampingLimit, SafeDamping
from carom.studies.safety.limits import _rounded_up, share_words

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
        0.02,
        2.0,
        sample,
        tuple(DampingCheck(gamma, 0, sample) for gamma in checks),
        DampingCheck(checks[0], 7, DisturbanceSet(1250, 1, 4.0)) if checks else None,
    )


def test_limit_is_the_exact_one_unless_a_disturbance_was_lost_above_it():
    assert safe(DampingLimit(ROLLS, 0.36, 0.6, "simulation")).within_reach == RUB
    assert safe(DampingLimit(ROLLS, 0.38, 0.6, "simulation")).within_reach.motion == "rolling backward whirl"


def test_simulated_limit_has_the_digits_of_its_bracket():
    narrow = safe(DampingLimit(ROLLS, 0.50113, 0.50614, "simulation"))
    wide = safe(DampingLimit(ROLLS, 0.5011, 0.53141, "simulation"))

    assert (narrow.within_reach.digits, wide.within_reach.digits) == (3, 2)
    assert narrow.words.startswith(
        "All fresh disturbances came back above 4,670 N s/m; the last that was found to be lost, at 4,620 N s/m, ended in "
        "rolling backward whirl. "
    )
    assert "came back above 4,900 N s/m; the last that was found to be lost, at 4,600 N s/m" in wide.words


def test_words_name_the_disturbances_their_speed_and_the_confidence():
    words = safe(DampingLimit(SYNCHRONOUS_RUB, 0.36, 0.6, "simulation")).words

    assert words == (
        "The last motion to vanish as the damping grows is the synchronous rub, at 3,408 N s/m. None of 5,000 fresh disturbances (kicks of the "
        "levitating rotor and starts within the clearance, of up to 258 mm/s) was lost at any of 3 values of damping from "
        "5,526 N s/m to 18,420 N s/m: with 95 % confidence fewer than 1 in 640 are lost at any of these. Of 1,250 of up to "
        "516 mm/s, 7 were lost at 5,526 N s/m."
    )


def test_irregular_bouncing_is_not_called_an_end():
    words = safe(DampingLimit(MotionName(Outcome.BOUNCING), 0.50113, 0.50614, "simulation")).words

    assert "at 4,620 N s/m, was in irregular bouncing, not seen to come back in 20,000 impacts." in words


@pytest.mark.parametrize(("lost", "chance"), [(0, (0.05, 0.0501)), (1, (0.005, 0.05)), (700, (0.02, 0.03))])
def test_share_that_may_be_lost_would_seldom_show_so_few(lost, chance):
    bound = DampingCheck(0.5, lost, DisturbanceSet(5000)).share_below

    low, high = chance
    assert low * (1.0 - 1e-9) <= binom.cdf(lost, 5000, bound) <= high


def test_nothing_is_claimed_without_checks():
    words = safe(DampingLimit(ROLLS, 2.0, float("inf"), "simulation"), checks=(), rolling=None).words

    assert (
        words
        == "Some disturbances of up to 258 mm/s did not come back even at the largest damping tried (18,420 N s/m)."
    )


def test_numbers_without_scales():
    words = safe(DampingLimit(ROLLS, 0.5011, 0.5061, "simulation"), scales=None).words

    assert words.startswith(
        "All fresh disturbances came back above 0.507; the last that was found to be lost, at 0.501, "
    )
    assert "N s/m" not in words


@pytest.mark.parametrize(
    ("value", "digits", "up"),
    [(0.50614, 3, 0.507), (0.5, 3, 0.5), (0.9991, 3, 1.0), (12345.0, 2, 13000.0), (0.1 + 0.2, 1, 0.4), (9.95, 2, 10.0)],
)
def test_rounding_up_never_goes_below(value, digits, up):
    assert _rounded_up(value, digits) == pytest.approx(up, rel=1e-15)
    assert _rounded_up(value, digits) >= value


def test_share_in_words():
    assert share_words(7.7e-4) == "fewer than 1 in 1,200 are lost"
    assert share_words(0.37) == "less than 37 % are lost"
