"""Complex numbers, loops over ranges, largest and smallest numbers, as Python computes them."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from carom.core.compiling.decorators import kernel

numbers = st.complex_numbers(max_magnitude=1e6, allow_nan=False, allow_infinity=False)


@kernel
def _combined(z, w):
    total = z + w
    total -= z.conjugate()
    total *= w
    return total - w * z, (z * w).real, (z - w).imag


@kernel
def _visited(start, stop):
    seen = np.zeros(40, np.int64)
    count, last = 0, -99
    for i in range(start, stop):
        seen[count], last = i, i
        count += 1
    for i in range(stop):
        for j in range(i, 3):
            count += 100 * j + 10_000
            last = i
    return seen, count, last


@kernel
def _by_steps(start, stop, step):
    total, count = 0, 0
    for i in range(start, stop, step):
        total += i
        count += 1
    return total, count


@kernel
def _interrupted(stop):
    found = 0
    for i in range(stop):
        if i == 2:
            continue
        if i == 5:
            break
        found += i
    return found


@kernel
def _extremes(a, b, c):
    return max(a, b), min(a, b), max(a, b, c), min(a, b, c), max(a, 0.0), min(0.0, a)


@kernel
def _whole_extremes(i, j):
    return max(i, j, 3), min(i, j), max(i, 2.5)


@given(numbers, numbers)
def test_complex_numbers(z, w):
    value, real, imaginary = _combined(z, w)
    rounding = 1e-14 * (1.0 + abs(z) + abs(w)) ** 2
    assert abs(value - ((z + w - z.conjugate()) * w - w * z)) <= rounding
    assert abs(real - (z * w).real) <= rounding
    assert imaginary == z.imag - w.imag


@pytest.mark.parametrize(("start", "stop"), [(0, 5), (-3, 2), (4, 4), (5, 1), (2, -7)])
def test_loops_over_ranges(start, stop):
    count, last = 0, -99
    for i in range(start, stop):
        count, last = count + 1, i
    for i in range(stop):
        for j in range(i, 3):
            count, last = count + 100 * j + 10_000, i
    seen, *found = _visited(start, stop)
    assert found == [count, last]
    assert seen[: max(stop - start, 0)].tolist() == list(range(start, stop))


@pytest.mark.parametrize("steps", [(0, 10, 3), (10, 0, -4), (0, 10, -1), (3, 3, 2)])
def test_ranges_in_other_steps(steps):
    assert _by_steps(*steps) == (sum(range(*steps)), len(range(*steps)))


def test_a_loop_that_is_left_early():
    assert [_interrupted(stop) for stop in (0, 2, 4, 100)] == [0, 1, 4, 8]


@pytest.mark.parametrize("numbers", [(1.0, 2.0, 3.0), (3.0, -2.0, 1.0), (math.inf, 0.0, -math.inf), (1.0, 1.0, 1.0)])
def test_largest_and_smallest_numbers(numbers):
    a, b, c = numbers
    assert _extremes(a, b, c) == (max(a, b), min(a, b), max(a, b, c), min(a, b, c), max(a, 0.0), min(0.0, a))


@pytest.mark.parametrize("numbers", [(math.nan, 1.0, 2.0), (1.0, math.nan, 2.0), (1.0, 2.0, math.nan)])
def test_what_is_no_number_is_never_larger_or_smaller(numbers):
    a, b, c = numbers
    expected = (max(a, b), min(a, b), max(a, b, c), min(a, b, c), max(a, 0.0), min(0.0, a))
    np.testing.assert_array_equal(_extremes(a, b, c), expected)


@pytest.mark.parametrize(("i", "j"), [(1, 2), (7, -4)])
def test_largest_and_smallest_whole_numbers(i, j):
    assert _whole_extremes(i, j) == (max(i, j, 3), min(i, j), max(i, 2.5))
