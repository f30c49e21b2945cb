"""Restitution and what a compliant wall dissipates, against high precision and other forms of the same equations."""

import math

import mpmath
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mp, mpf

from carom.base.outcome import InputError
from carom.parameters.restitution import damping_ratio_of, dissipation_of, half_contact

BELOW_ONE = 1.0 - 2.0**-53
RATIOS = [1e-300, 1e-12, 0.02, 0.3, 0.5, 0.9, 1.0 - 1e-8, BELOW_ONE, 1.0, 1.0 + 2.0**-52, 1.0 + 1e-9, 1.1, 40.0, 1e5]
SHARES = [BELOW_ONE, 1.0 - 1e-10, 0.999, 0.95, 0.5, 0.1354, 0.13533528323661, 0.1353, 0.01, 1e-5, 1e-12]
ROUNDING = 4e-15
"""Some rounding errors; an exponent of 30 multiplies its own by that."""


@pytest.fixture(autouse=True)
def _digits():
    with mp.workdps(80):
        yield


def thrown_back(ratio):
    """Speed at the first zero of the force of ``δ̈ + 2ζδ̇ + δ = 0`` from the wall at the speed one, from the roots of its polynomial."""
    ratio = mpf(ratio)
    if ratio == 1:
        return mp.exp(-2)
    root = mp.sqrt(mpmath.mpc(ratio * ratio - 1))
    slow, fast = -ratio + root, -ratio - root
    time = mp.log((fast / slow) ** 2) / (slow - fast)
    if ratio < 1:
        # The logarithm of a number of the modulus one, on the branch of the first time after the arrival.
        time = (2 * mp.acos(ratio)) / root.imag
    assert abs((slow**2 * mp.exp(slow * time) - fast**2 * mp.exp(fast * time)) / slow**2) < mpf(10) ** -40
    return -((slow * mp.exp(slow * time) - fast * mp.exp(fast * time)) / (slow - fast)).real


def thrown_back_by(product):
    """Second real solution ``w = 1 − χdv`` of ``w e^{−w} = a e^{−a}`` with ``a = 1 + χv``, by Lambert's function."""
    above = 1 + mpf(product)
    return (1 + mp.lambertw(-above * mp.exp(-above), 0).real) / mpf(product)


# ------------------------------------------------------------------------------------------------ Kelvin–Voigt


@pytest.mark.parametrize("ratio", RATIOS)
def test_restitution_of_a_spring_and_a_dashpot(ratio):
    with mp.workdps(700 if ratio < 1e-100 else 80):
        exact = float(thrown_back(ratio))
        assert math.exp(-2.0 * ratio * half_contact(ratio)) == pytest.approx(exact, rel=ROUNDING)


@pytest.mark.parametrize("share", SHARES)
def test_damping_of_a_restitution_is_right_to_the_last_digits(share):
    found = damping_ratio_of(share)
    exact = mpmath.findroot(
        lambda ratio: mp.log(thrown_back(ratio)) - mp.log(mpf(share)), mpf(found) * (1 + mpf(10) ** -9)
    )

    assert found == pytest.approx(float(exact), rel=ROUNDING)


def test_damping_at_the_ends():
    assert damping_ratio_of(1.0) == 0.0
    assert damping_ratio_of(float(mp.exp(-2))) == pytest.approx(1.0, rel=ROUNDING)
    # Of a strong dashpot d → 1/(2ζ)², and its exponent of 690 has as many times the rounding error.
    assert damping_ratio_of(1e-300) == pytest.approx(5e149, rel=1e-12)
    with pytest.raises(InputError, match=r"restitution = 0\.0: a number above 0, at most 1"):
        damping_ratio_of(0.0)


def test_a_wall_that_stops_pulling_gives_back_more_than_one_that_holds_on():
    for ratio in (0.01, 0.1, 0.5, 0.9):
        assert float(thrown_back(ratio)) > float(mp.exp(-mp.pi * ratio / mp.sqrt(1 - ratio * ratio)))


@given(share=st.floats(1e-9, 1.0))
def test_damping_and_restitution_invert_each_other(share):
    # An exponent of 20 has as many times the rounding error.
    assert float(thrown_back(damping_ratio_of(share))) == pytest.approx(share, rel=1e-14)


# ------------------------------------------------------------------------------------------------ Hunt–Crossley


@pytest.mark.parametrize("share", SHARES)
def test_dissipation_of_a_restitution_is_right_to_the_last_digits(share):
    found, d = dissipation_of(share, 1.0), mpf(share)

    def residual(size):
        return mp.log1p(size) - mp.log1p(-d * size) - (1 + d) * size

    # A zero is at the pole and one at zero: the step of Newton's method from the solution is its error.
    size = mpf(found)
    slope = 1 / (1 + size) + d / (1 - d * size) - (1 + d)
    if share > 0.02:
        assert abs(residual(size) / slope / size) < ROUNDING
    else:
        # 1 − χdv < e^{−1/d}: the pole, to all digits.
        assert found == pytest.approx(1.0 / share, rel=ROUNDING)


def test_dissipation_of_hardly_less_than_everything_keeps_its_digits():
    # d = 1 − 2p/3 + …, so that 1 − d has few digits where d has all.
    assert dissipation_of(1.0 - 2.0**-40, 1.0) == pytest.approx(1.5 * 2.0**-40, rel=1e-12)
    assert dissipation_of(1.0, 3.0) == 0.0


@given(share=st.floats(1e-9, 1.0), speed=st.floats(1e-6, 1e6))
def test_dissipation_and_restitution_invert_each_other(share, speed):
    back = thrown_back_by(mpf(dissipation_of(share, speed)) * mpf(speed)) if share < 1.0 else mpf(1)
    assert float(back) == pytest.approx(share, rel=ROUNDING)


def test_a_wall_of_no_restitution_and_an_arrival_without_speed_are_refused():
    with pytest.raises(InputError, match=r"restitution = 0\.0: a number above 0, at most 1"):
        dissipation_of(0.0, 1.0)
    with pytest.raises(InputError, match=r"restitution = 1\.2: a number above 0, at most 1"):
        dissipation_of(1.2, 1.0)
    with pytest.raises(InputError, match=r"speed = 0\.0: a finite number above 0"):
        dissipation_of(0.5, 0.0)
