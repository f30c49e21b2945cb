"""Orbits in ball arithmetic with derivatives, beside the closed forms in balls, the kernels and differences."""

from dataclasses import replace

import numpy as np
import pytest
from compilation import sized
from flint import acb, arb, arb_series
from machines import random_parameters

from carom.bifurcations.conditions import conditions_at, jacobian_at, profile_at
from carom.orbits import find_orbits
from carom.parameters import Numbers as Doubles
from carom.proofs.balls import at_precision, hyperbolic, short_return, squared, terms
from carom.proofs.courses import OrbitCourse, Return, period_condition
from carom.proofs.hypotheses import hypotheses_of
from carom.proofs.lines import LineNumbers
from carom.proofs.rotor import ProvenRotor


def balls(parameters) -> LineNumbers:
    return ProvenRotor(hypotheses_of(parameters)).numbers


def response(gamma, split, time):
    """Response to an impulse ``h`` and its rate, of ``ḧ + γḣ + ω²h = 0``, by functions of ``split`` = ``γ²/4 − ω²``."""
    half, square = gamma * time / 2, split * time * time
    if split > 0 and square > 1:
        # No growing exponential: the slower rate is a quotient, not a difference.
        rate = split.sqrt()
        slow, fast = (-(half - rate * time)).exp(), (-(half + rate * time)).exp()
        return (slow - fast) / (2 * rate), (slow + fast) / 2 - gamma * (slow - fast) / (4 * rate)
    decay = (-half).exp()
    cosine = (square / 4).hypgeom_0f1(arb(1) / 2)
    value = time * (square / 4).hypgeom_0f1(arb(3) / 2)
    return decay * value, decay * (cosine - gamma * value / 2)


def turned_response(numbers, time):
    """``f`` and ``f'`` of :mod:`carom.proofs.rotor` at a time."""
    value, slope = response(numbers.gamma, numbers.split, time)
    sine, cosine = time.sin_cos()
    turn = acb(cosine, -sine)
    return turn * value, turn * acb(slope, -value)


class Written:
    """An impact at a period and a radial speed by the response to an impulse, ``f`` of :mod:`carom.proofs.rotor`."""

    def __init__(self, numbers, period, speed) -> None:
        self.numbers, self.period, self.speed = numbers, period, speed
        self.drag = acb(numbers.gamma, 2)
        (f, slope), shrink = turned_response(numbers, period), (-self.drag * period).exp()
        determinant = 1 - 2 * slope - self.drag * f + shrink
        self.lever = numbers.q * f / determinant
        self.turn = numbers.q * (slope - shrink) / determinant
        self.velocity = acb(1, -self.turn.imag)

    def discriminant(self):
        return self.lever.real**2 - squared(self.lever) * (1 - self.numbers.levitation**2)

    def moved(self, place, rate, time):
        """Place and rate after a flight from a deviation from the contact-free equilibrium and its rate."""
        numbers, (f, slope) = self.numbers, turned_response(self.numbers, time)
        # The solution with the value 1 and no slope at first is f' + (γ + 2i) f.
        return place * (slope + self.drag * f) + rate * f, -numbers.product * place * f + rate * slope

    def radius_series(self, time, length):
        """Taylor coefficients of ``|U|² − 1``."""
        place, rate = -self.lever * self.speed, self.speed * (self.velocity - self.numbers.q)
        coefficients = [*self.moved(place, rate, time)]
        for k in range(length - 2):
            fall = self.drag * coefficients[-1] / (k + 2) + self.numbers.product * coefficients[-2] / (
                (k + 1) * (k + 2)
            )
            coefficients.append(-fall)
        coefficients[0] = coefficients[0] + 1 - place
        parts = (arb_series([getattr(z, part) for z in coefficients], length) for part in ("real", "imag"))
        excess = sum(part * part for part in parts) - 1
        return [excess[k] for k in range(length)]

    def jacobian(self):
        """Derivative of the impact map over ``(θ, ṙ, θ̇)``, as in :mod:`carom.core.planar`."""
        numbers, turned_by = self.numbers, acb(0, 1)
        force = numbers.product * self.lever - self.drag * self.velocity
        starts = (
            (turned_by, turned_by * self.speed * (self.velocity - numbers.q)),
            (acb(0), 1 - numbers.q),
            (acb(0), turned_by),
        )
        columns = []
        for place, rate in starts:
            moved, change = self.moved(place, rate, self.period)
            late = -moved.real
            turned = (moved + self.velocity * late).imag
            change = change + force * late
            spin = turned * self.speed
            columns.append((turned, change.real + spin * self.velocity.imag, change.imag - spin))
        return [[columns[j][i] for j in range(3)] for i in range(3)]


def machines(seed: int, count: int):
    random = np.random.default_rng(seed)
    while count:
        parameters = random_parameters(random)
        if parameters.gamma < 2.5:
            count -= 1
            yield parameters, random


def test_values_agree_with_closed_forms_written_a_second_time():
    with at_precision(120):
        for parameters, random in machines(1, sized(30, 5, 2000)):
            numbers, period = balls(parameters), arb(random.uniform(0.05, 12.0))
            back, speed = Return(numbers, period), arb(random.uniform(-1.0, 2.0))
            written = Written(numbers, period, speed)
            assert back.lever.overlaps(written.lever)
            assert back.turn.overlaps(written.turn)
            assert back.discriminant.overlaps(written.discriminant())
            # Anywhere, also off the orbits, both are derivatives of the same map only where F1 = 0.
            assert back.closing.overlaps(1 + written.turn.real)
            course = OrbitCourse(back, speed)
            for row, other in zip(course.jacobian(), written.jacobian(), strict=True):
                assert all(a.overlaps(b) and a.rad() < 1e-15 * (1 + abs(a)) for a, b in zip(row, other, strict=True))
            time = arb(random.uniform(0.0, 1.0)) * period
            with terms(8):
                heights = course.height(arb_series([time, 1]))[0]
            for ours, theirs in zip(heights, written.radius_series(time, 8), strict=True):
                assert (ours * speed).overlaps(theirs)
                assert ours.rad() < 1e-15 * (1 + abs(ours))


def test_tests_of_orbits_agree_with_the_kernels():
    compared = 0
    # At 53 bits balls near critical damping are wider than the rounding of the kernels.
    with at_precision(120):
        for parameters, _ in machines(2, sized(15, 3, 500)):
            for orbit in list(find_orbits(parameters))[:4] if parameters.gamma > 0.05 else ():
                if orbit.slip < 0 or abs(orbit.radial_speed) > 20.0:
                    continue
                at = Doubles.of(parameters), orbit.period, orbit.radial_speed
                known, course = conditions_at(*at), OrbitCourse(Return(balls(parameters), arb(at[1])), arb(at[2]))
                scale = 1.0 + np.abs(jacobian_at(*at)).max() ** 3
                assert float(course.invariants.at_minus_one) == pytest.approx(known.period_doubling, abs=1e-9 * scale)
                assert float(course.invariants.of_pairs) == pytest.approx(-known.neimark_sacker, abs=1e-9 * scale)
                assert float(course.speed_fold) == pytest.approx(known.speed_fold, rel=1e-9, abs=1e-9)
                assert float(course.back.closing_rate) == pytest.approx(known.period_fold, rel=1e-8, abs=1e-9)
                assert float(course.slip_after) == pytest.approx(known.slip_stop, rel=1e-9, abs=1e-9)
                top = profile_at(*at)
                if np.isfinite(top.height):
                    touch = course.height(arb(top.top))[0] * course.speed
                    assert float(touch) == pytest.approx(top.height, abs=1e-9 * (1.0 + abs(top.height)))
                compared += 1
    assert compared > 5


def test_characteristic_polynomial_at_one_is_a_product_of_slopes():
    """``det(1 − J) = |det(1 − e^{MT})|² F₁' (Re(q a₁₂) + |q a₁₂|²ṙ)`` on orbits, which names stability by letters."""
    compared = 0
    with at_precision(160):
        for parameters, _ in machines(3, sized(12, 3, 300)):
            for orbit in list(find_orbits(parameters))[:6] if parameters.gamma > 0.05 else ():
                if orbit.slip < 0:
                    continue
                numbers, period = balls(parameters), arb(orbit.period)
                for _ in range(6):
                    back = Return(numbers, period)
                    period = (period - back.closing / back.closing_rate).mid()
                back = Return(numbers, period)
                speed = min(back.speeds(), key=lambda v: abs(float(v) - orbit.radial_speed))
                course = OrbitCourse(back, speed)
                even, _, growth = back.over
                gap = 1 - 2 * even + growth * growth
                trace, minors, determinant = course.invariants
                product = (gap.real**2 + gap.imag**2) * back.closing_rate * course.speed_fold
                found = 1 - trace + minors - determinant
                assert abs(found - product) < 1e-25 * (1 + abs(product))
                compared += 1
    assert compared > 5


def test_series_are_derivatives():
    # A difference over 2^-60 leaves 60 bits fewer, and critical damping takes some more.
    with at_precision(300):
        step = arb(2) ** -60
        for parameters, random in machines(4, sized(10, 2, 300)):
            numbers, period = balls(parameters), arb(random.uniform(0.3, 6.0))
            if not parameters.gamma > 0.01:
                continue

            def value(late, numbers=numbers, period=period):
                moved = replace(numbers, gamma=numbers.gamma + late, d=numbers.d + late)
                course = OrbitCourse(Return(moved, period + late), arb(1) / 2 + late)
                return [
                    course.invariants.at_minus_one,
                    course.invariants.of_pairs,
                    course.balance,
                    course.back.closing,
                    course.height(period / 2)[0],
                ]

            with terms(2):
                series = value(arb_series([0, 1]))
            for found, low, high in zip(series, value(-step), value(step), strict=True):
                slope = (high - low) / (2 * step)
                assert abs(found[1] - slope) < 1e-25 * (1 + abs(slope)) * (1 + abs(found[0]))


def test_short_return_agrees_with_the_exponentials_and_bounds_what_it_leaves_out():
    with at_precision(100):
        random, compared = np.random.default_rng(5), 0
        for _ in range(sized(40, 5, 2000)):
            half, split = acb(-random.uniform(0, 0.5), -1), arb(random.uniform(-1.5, 1.5))
            period = arb(random.uniform(0.02, 1.6))
            with terms(3):
                found = short_return(half, split, arb_series([period, 1]))
                root = (acb(1) * split).sqrt()
                up, down = half + root, half - root
                one, other = (1 / ((-x * arb_series([period, 1])).exp() - 1) for x in (up, down))
                exact = (one - other) / (root * 2), (up * one - down * other) / (root * 2)
            if found is None:
                continue
            compared += 1
            for mine, peer in zip(found, exact, strict=True):
                for k in range(3):
                    assert mine[k].overlaps(peer[k])
                    assert mine[k].rad() < 1e-18 * (1 + abs(mine[k]))
        assert compared > 2


@pytest.mark.parametrize("split", ["0", "1e-40", "-1e-40", "0.04", "-0.04"])
def test_hyperbolic_functions_at_critical_damping(split):
    with at_precision(120):
        time, centre = arb("1.7"), arb(split)
        for wide in (centre, centre + arb(0, 1e-30), centre + arb(0, 0.01)):
            with terms(3):
                even, odd = hyperbolic(arb_series([wide, 1]), time)
            root = acb(centre).sqrt() if not centre.is_zero() else acb("1e-50")
            assert even[0].overlaps((root * time).cosh().real + arb(0, 1e-90))
            assert odd[0].overlaps(((root * time).sinh() / root).real + arb(0, 1e-90))
            # d cosh(√D t)/dD = t sinh(√D t)/(2√D).
            assert even[1].overlaps(time * odd[0] / 2)


def test_period_condition_has_the_sign_of_the_closing_condition():
    for parameters, random in machines(6, sized(20, 4, 500)):
        numbers = balls(parameters)
        if not parameters.gamma > 0.01:
            continue
        for period in random.uniform(0.05, 8.0, 5).tolist():
            condition = period_condition(numbers, arb(period))(numbers, arb(period))
            closing = Return(numbers, arb(period)).closing
            assert not condition * closing < 0
