"""Kernels that other kernels call are not compiled to machine code for that."""

from __future__ import annotations

import numpy as np
import pytest

from carom.core.cache import KernelCache
from carom.core.layout import kernel, part, record

pytestmark = pytest.mark.jit_only


@pytest.fixture
def caller_and_called(tmp_path):
    """A kernel that calls a kernel and a part, each with a cache in the directory of the test."""

    @kernel
    def doubled(x):
        return 2.0 * x

    @part
    def squared(x):
        return x * x

    @kernel
    def both(x):
        return doubled(x) + squared(x)

    for function in (doubled, squared, both):
        function._cache = KernelCache(function.py_func, tmp_path)
    return both, [doubled, squared]


def test_only_what_python_calls_becomes_machine_code(caller_and_called, tmp_path):
    both, called = caller_and_called

    assert both(3.0) == 15.0
    assert [function.signatures for function in called] == [[], []]
    assert len(list(tmp_path.iterdir())) == 1


def test_what_kernels_call_can_still_be_called_from_python(caller_and_called):
    both, (doubled, squared) = caller_and_called
    assert both(3.0) == 15.0

    assert (doubled(3.0), squared(3.0)) == (6.0, 9.0)
    assert (doubled(3), squared(2j)) == (6.0, -4.0)


def test_what_python_has_called_can_still_be_called_by_kernels(caller_and_called):
    both, (doubled, squared) = caller_and_called
    assert (doubled(3.0), squared(3.0)) == (6.0, 9.0)

    assert both(3.0) == 15.0


def test_a_kernel_is_linked_although_its_first_caller_never_calls_it(tmp_path):
    """The first caller's call is removed as dead code, the second one's is not."""

    @kernel
    def root(x):
        total = x
        for _ in range(10):
            total = 0.5 * (total + x / total)
        return total

    @kernel
    def first(values):
        return root(values[0]) if values.shape[0] > 1 else values[0]

    @kernel
    def outer(record):
        return first(record.values)

    @kernel
    def second(values):
        return root(values[0])

    @kernel
    def both(record):
        return outer(record) + second(record.values)

    for function in (root, first, outer, second, both):
        function._cache = KernelCache(function.py_func, tmp_path)
    assert both(record(values=np.array([4.0]))) == 6.0
