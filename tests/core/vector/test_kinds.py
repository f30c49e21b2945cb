"""What makes no sense on lanes is refused by the compiler."""

import numpy as np
import pytest
from lane_programs import program
from numba.core.errors import TypingError

from carom.core.layout import LANE_NODES, WIDTH

pytestmark = pytest.mark.jit_only

REFUSED = {
    "complex numbers have no order": ["z < z", "z <= a", "a > z", "1j < a", "z == z"],
    "nor a quotient, a root or a whole part here": [
        "z / z", "z / a", "a / z", "z / 2.0", "2j / a", "abs(z)", "sqrt(z)", "truncate(z)",
    ],
    "there is no such operation": ["a ** 2", "a // a", "a % a", "a != a", "a[0]", "a.conjugate()", "+a", "not a", "a + 'a'"],
    "a condition is no number": [
        "(a < a) + a", "-(a < a)", "(a < a) * 2.0", "abs(a < a)", "join(a < a, a)", "fma(z, a < a, z)", "(a < a) < a",
        "where(a < a, a < a, a)", "store(out, 0, a < a)", "take(row, a < a)", "load(out, a < a)",
    ],
    "a number is no condition": [
        "a & a", "~a", "(a < a) & True", "(a < a) | 1", "where(a, a, a)", "where(1.0, a, a)", "where(True, a, a)",
        "lanes_of(a)", "lanes_of(3)",
    ],
    "lanes are two real parts": ["join(a, z)", "join(z, a)", "join(a, 0.0)", "join(1.0, a)"],
    "there are products and sums for the rest": ["fma(a, a, a)", "fma(2.0, a, 1.0)", "fma(2.0, 1.0, 1j)"],
    "a place is a real number": ["take(row, z)", "take(row, 0)", "take(matrix, a)", "choose(row, z)", "choose(whole, a)"],
    "an array holds reals side by side": [
        "load(complexes, 0)", "load(whole, 0)", "load(matrix, 0)", "load(strided, 0)", "load(2.0, 0)", "load(out, 0.0)",
    ],
    "and takes such": [
        "store(out, 0, z)", "store(out, 0, 1j)", "store(complexes, 0, a)", "store(complexes, 0, z)", "store(matrix, 0, a)",
        "store(strided, 0, a)", "store(whole, 0, a)", "store(whole, 0, 1)", "store(out, 0.0, a)", "store(out, a, a)",
    ],
}  # fmt: skip


def given():
    return (
        np.ones(WIDTH),
        np.ones(LANE_NODES),
        np.ones((WIDTH, WIDTH)),
        np.ones(2 * WIDTH)[::2],
        np.ones(WIDTH, np.complex128),
        np.ones(WIDTH, np.int64),
    )


def compiled(expression):
    lines = ["a = load(out, 0)", "z = join(a, a)", expression]
    return program("out, row, matrix, strided, complexes, whole", lines)


@pytest.mark.parametrize(
    ("reason", "expression"), [(reason, each) for reason, all_ in REFUSED.items() for each in all_]
)
def test_refused(reason, expression):
    with pytest.raises(TypingError):
        compiled(expression)(*given())


def test_what_is_right_is_not_refused():
    """The same frame, so what is refused above is refused for what it says."""
    arrays = given()
    compiled("store(out, 0, take(row, where(a < a, a, 0.0)) + z.real)")(*arrays)
    np.testing.assert_array_equal(arrays[0], np.full(WIDTH, 2.0))
