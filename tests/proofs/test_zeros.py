"""Krawczyk's operator shows zeros where they are, and none where there is none."""

from flint import arb

from carom.proofs.balls import at_precision
from carom.proofs.zeros import derivatives, enclosed_zero, newton


def circle_and_line(x, y):
    return x * x + y * y - 2, x - y


def test_zero_is_enclosed_with_most_digits():
    with at_precision(128):
        found = enclosed_zero(circle_and_line, newton(circle_and_line, (0.8, 1.3)))
        assert all(ball.contains(1) and ball.rad() < 1e-35 for ball in found[0])


def test_derivatives_of_a_system():
    values, jacobian = derivatives(circle_and_line, [arb(3), arb(1)])
    assert [float(value) for value in values] == [8, 2]
    assert [[float(jacobian[i, j]) for j in range(2)] for i in range(2)] == [[6, 2], [1, -1]]


def test_where_there_is_no_zero_or_a_double_one_nothing_is_shown():
    assert enclosed_zero(circle_and_line, [arb("1.1"), arb("1.1")], width=8) is None
    assert enclosed_zero(lambda x: (x * x,), [arb(0)]) is None
    assert enclosed_zero(lambda x: (x * x + arb(10) ** -30,), [arb(0)]) is None
    assert enclosed_zero(lambda x: (1 / x,), [arb(0)]) is None
    assert newton(lambda x: (x * x + 1,), [0.3]) is None
    assert newton(lambda x: (x * 0 + 1,), [0.3]) is None


def test_box_with_two_zeros_is_not_shown_to_have_one():
    two = [arb(1), 2**-6]
    assert enclosed_zero(lambda x: ((x - 1) * (x - 1) - two[1] ** 2 / 4,), [arb(1) + two[1] / 2], width=4) is None
