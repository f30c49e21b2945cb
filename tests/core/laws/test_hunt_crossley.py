"""A Hunt–Crossley wall: force, series, energy and the parabola at the onset against the power in many digits."""

from math import factorial

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from carom.core.laws import choice, hunt_crossley
from carom.core.laws.hunt_crossley import ONSET
from carom.core.layout import ORDER
from carom.core.wall import Wall

EXPONENTS = [1.0, 10 / 9, 1.5, 2.0]
NUMBER = choice.LAWS.index("hunt_crossley")


def wall_of(exponent, stiffness=3e4, loss=0.7):
    return Wall(0.2, 0.0, 5.0, NUMBER, exponent, stiffness, loss)


def power(wall, depth, rate):
    """The force of the power, in many digits."""
    return mpf(wall.stiffness) * depth ** mpf(wall.law_number) * (1 + mpf(wall.loss) * rate)


def parabola(wall, depth):
    """The parabola through zero with the value of the power at the onset, and its work up to there."""
    exponent, end = mpf(wall.law_number), mpf(ONSET)
    value, work = end**exponent, end ** (exponent + 1) / (exponent + 1)
    # α + β and α/2 + β/3, for the parabola αx + βx² of the share x of the onset.
    shares = mpmath.lu_solve(mpmath.matrix([[1, 1], [mpf(1) / 2, mpf(1) / 3]]), mpmath.matrix([value, work / end]))
    part = depth / end
    return mpf(wall.stiffness) * (shares[0] * part + shares[1] * part**2)


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_the_force_is_the_power_above_the_onset_and_a_parabola_below(exponent):
    wall = wall_of(exponent)
    with mpmath.workdps(40):
        for depth in (1.01e-9, 1e-6, 0.02, 0.7):
            assert choice.force(depth, -0.4, wall) == pytest.approx(float(power(wall, mpf(depth), -0.4)), rel=1e-14)
        for share in (0.0, 1e-4, 0.3, 0.99):
            depth = share * ONSET
            expected = parabola(wall, mpf(depth)) if exponent != 1.0 else power(wall, mpf(depth), 0)
            found = choice.force(depth, 0.3, wall)
            assert found == pytest.approx(float(expected * (1 + mpf(wall.loss) * mpf(0.3))), rel=1e-13)
            assert found >= 0.0
        assert choice.force(-1e-3, 0.3, wall) == 0.0


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_the_parabola_meets_the_power_and_does_its_work(exponent):
    wall = wall_of(exponent, loss=0.0)
    below, above = (choice.force(ONSET * (1.0 + side * 1e-12), 0.0, wall) for side in (-1, 1))
    assert below == pytest.approx(above, rel=1e-11)
    points, weights = np.polynomial.legendre.leggauss(4)
    forces = [choice.force(0.5 * ONSET * (1.0 + point), 0.0, wall) for point in points]
    assert 0.5 * ONSET * weights @ forces == pytest.approx(choice.stored_energy(ONSET, wall), rel=1e-13)
    # It pushes more the deeper, as the power does: a wall without a soft spot.
    assert (np.diff([choice.force(share * ONSET, 0.0, wall) for share in np.linspace(0.0, 2.0, 201)]) > 0.0).all()


@pytest.mark.parametrize("exponent", [10 / 9, 1.5])
@pytest.mark.parametrize("speed", [1.0, 1e-2, 1e-4])
def test_an_entry_is_delayed_by_far_less_than_a_rounding_error(exponent, speed):
    """A mass through the first depths, from its energy: the same speed at the onset, and when, with both forces."""
    stiffness = 1e8
    wall = wall_of(exponent, stiffness, loss=0.0)
    with mpmath.workdps(30):
        end, number = mpf(ONSET), mpf(exponent)
        value, mean = parabola(wall, end), 4 * parabola(wall, end / 2)
        linear, square = mean - value, 2 * value - mean  # of the parabola, from its values at one half and one
        works = (
            lambda share: stiffness * (share * end) ** (number + 1) / (number + 1),
            lambda share: end * (linear * share**2 / 2 + square * share**3 / 3),
        )
        assert abs(works[0](1) - works[1](1)) < mpf(10) ** -25 * works[0](1)
        # The speed is v√(1 − 2w/v²); this is the difference of the times, without cancellation.
        early, late = (
            lambda share, work=work: 1 / mpmath.sqrt(1 - 2 * work(share) / mpf(speed) ** 2) for work in works
        )
        delay = end / speed * mpmath.quad(lambda share: late(share) - early(share), [0, 0.01, 0.3, 1])
        assert abs(delay) < 0.1 * stiffness * end ** (number + 2) / mpf(speed) ** 3
        # The rotor's own forces are of the order of one, and these change its speed by as much.
        assert abs(delay) < 1e-15 or speed < 1e-2


@pytest.mark.parametrize("depth", [0.3 * ONSET, 2.0 * ONSET, 1e-3, 0.2])
@pytest.mark.parametrize("exponent", EXPONENTS)
def test_coefficients_are_those_of_the_composed_functions(exponent, depth):
    """For a motion ``δ = d(1 + a t + b t²)``, by numerical derivatives with many digits."""
    wall = wall_of(exponent)
    with mpmath.workdps(120):

        def moves(time):
            return mpf(depth) * (1 + mpf("0.5") * time + mpf("0.25") * time**2)

        def pushes(time):
            rate = mpf(depth) * (mpf("0.5") + mpf("0.5") * time)
            if depth < ONSET and exponent != 1.0:
                return parabola(wall, moves(time)) * (1 + mpf(wall.loss) * rate)
            return power(wall, moves(time), rate)

        expected = [float(each) for each in mpmath.taylor(pushes, 0, ORDER)]
    depths, rates, powers = np.zeros((3, ORDER + 1))
    depths[:3] = depth, 0.5 * depth, 0.25 * depth
    rates[:2] = 0.5 * depth, 0.5 * depth
    found = [choice.force_coefficient(k, depths, rates, powers, wall) for k in range(ORDER + 1)]
    # The depth has its zeros at distance 2: the terms are of one size there.
    np.testing.assert_allclose(
        found * 2.0 ** np.arange(ORDER + 1),
        expected * 2.0 ** np.arange(ORDER + 1),
        rtol=1e-13,
        atol=1e-12 * abs(expected[0]),
    )
    assert found[0] == pytest.approx(choice.force(depth, 0.5 * depth, wall), rel=1e-14)


def test_what_vanishes_with_the_force_is_the_factor_of_the_rate():
    wall = wall_of(1.5)
    rates = np.array([-3.0, 0.2, *np.zeros(ORDER - 1)])
    found = [choice.press_coefficient(k, rates, rates, wall) for k in range(3)]
    assert found == pytest.approx([1.0 - 0.7 * 3.0, 0.7 * 0.2, 0.0], rel=1e-15)
    assert choice.press_rounding(1e-3, 1e-14, wall) == pytest.approx(0.7e-14, rel=1e-15)


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_the_series_changes_its_form_only_at_the_onset(exponent):
    wall = wall_of(exponent)
    edges = [
        choice.edge(depth, rate, wall) for depth, rate in ((0.5e-9, 1.0), (ONSET, -1.0), (ONSET, 1.0), (0.1, -1.0))
    ]
    assert edges == ([0.0] * 4 if exponent == 1.0 else [ONSET, ONSET, -ONSET, -ONSET])


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_it_stores_the_work_of_its_spring(exponent):
    wall = wall_of(exponent)
    with mpmath.workdps(30):
        for depth in (1e-7, 0.003, 0.4):
            work = mpf(wall.stiffness) * mpmath.quad(lambda at: at ** mpf(exponent), [0, mpf(depth) / 100, mpf(depth)])
            assert choice.stored_energy(depth, wall) == pytest.approx(float(work), rel=1e-12)
    assert choice.stored_energy(-0.1, wall) == 0.0


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_rounding_errors_of_depth_and_rate_change_the_force_by_less_than_the_bound(exponent):
    wall = wall_of(exponent, loss=2.0)
    random = np.random.default_rng(1)
    with mpmath.workdps(40):
        for _ in range(300):
            depth, rate = mpf(10.0 ** random.uniform(-8, -0.5)), mpf(random.normal() * 5.0)
            errors = 10.0 ** random.uniform(-16, -12, 2)
            # An error of the place turns the normal against the velocity.
            errors[1] = max(errors[1], float(abs(rate)) * errors[0])
            moved = max(
                abs(power(wall, depth + i * errors[0], rate + j * errors[1]) - power(wall, depth, rate))
                for i in (-1, 1)
                for j in (-1, 1)
            )
            assert moved <= choice.force_rounding(*errors, wall) * (1.0 + 1e-9)


def test_an_arrival_has_no_impulse():
    wall = wall_of(1.5)
    for function in (choice.impulse, choice.impulse_by_speed, choice.impulse_by_restitution, hunt_crossley.impulse):
        assert function(1.3, wall) == 0.0


def test_exponents_have_their_series_in_closed_form():
    """``(1 + t)ⁿ`` has the binomial coefficients; the onset does not matter at this depth."""
    wall = wall_of(1.5, stiffness=1.0, loss=0.0)
    depths, rates, powers = np.zeros((3, ORDER + 1))
    depths[:2], rates[0] = 1.0, 1.0
    found = [choice.force_coefficient(k, depths, rates, powers, wall) for k in range(6)]
    expected = [float(mpmath.ff(1.5, k)) / factorial(k) for k in range(6)]
    assert found == pytest.approx(expected, rel=1e-14)
