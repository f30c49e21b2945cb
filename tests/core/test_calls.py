"""Calls from one kernel to another: results, and exceptions that Numba raises on the way."""

import numpy as np
import pytest

from carom.core.layout import kernel, part


@kernel
def _room(length):
    return np.empty(length), length


@part
def _filled(length, number):
    room, count = _room(length)
    for i in range(count):
        room[i] = number
    return room


@kernel
def _sum(length, number):
    total = 0.0
    for term in _filled(length, number):
        total += term
    return total


@kernel
def _quotient(a, b):
    if b == 0.0:
        return None
    return a / b


@kernel
def _quotient_or_zero(a, b):
    found = _quotient(a, b)
    return 0.0 if found is None else found


@kernel
def _set_first(values, number):
    values[0] = number


@kernel
def _first_after(values, number):
    _set_first(values, number)
    return values[0]


def test_results_of_several_kinds():
    assert _sum(3, 2.0) == 6.0
    assert [_quotient_or_zero(1.0, b) for b in (4.0, 0.0)] == [0.25, 0.0]
    assert _first_after(np.zeros(2), 7.0) == 7.0


def test_an_exception_reaches_the_outermost_caller_and_leaves_it_usable():
    with pytest.raises(ValueError, match="negative dimensions"):
        _sum(-1, 2.0)
    assert _sum(2, 1.0) == 2.0
