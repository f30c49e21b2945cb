"""Items of arrays, variables and references in the code that kernels become."""

import operator

import numpy as np
import pytest
from numba.core.registry import cpu_target
from numba.core.runtime import _nrt_python, rtsys
from numba.core.types.functions import BaseFunction

from carom.core.compiling.decorators import kernel
from carom.core.records import record

GRID = np.arange(12.0).reshape(3, 4)


@kernel
def _item(values, i, j):
    return values[i, j]


@kernel
def _fields(packed, i, j):
    return packed.grid[i, j], packed.line[i], packed.line[-1], packed.grid[i][j]


@kernel
def _replace(packed, values, line, i, j):
    packed.grid[i, j] = 7
    packed.line[-1] = line
    values[i, j] = line
    values[i][0] = 1.5


@kernel
def _part_sum(packed, i):
    total = 0.0
    row, rest = packed.grid[i], packed.line[1:]
    for number in row:
        total += number
    for number in rest:
        total += 100.0 * number
    return total


@kernel
def _chosen(first, second, which):
    values = first
    for _ in range(3):
        fresh = np.empty(2)
        fresh[0], fresh[1] = values[0], values[1]
        values = second if which else fresh
    return values


@kernel
def _larger(a, b):
    return a if a > b else b


@kernel
def _largest(a, b, c):
    return _larger(_larger(a, b), c)


def packed():
    return record(grid=GRID, line=np.array([3, -4, 5], np.int8))


@pytest.mark.parametrize("i", [0, 2, -1, -3])
@pytest.mark.parametrize("j", [0, 3, -4])
@pytest.mark.parametrize("values", [GRID, np.asfortranarray(GRID), GRID[::-1], GRID[:, ::2].repeat(2, 1)[:, ::-1]])
def test_an_item_is_found_in_any_layout(values, i, j):
    assert _item(values, i, j) == values[i, j]
    assert _item(values.astype(complex), np.int8(i), np.int32(j)) == values[i, j]


def test_unsigned_indices_are_no_negative_ones():
    assert _item(GRID, np.uint8(2), np.uint64(3)) == 11.0


@pytest.mark.parametrize("i", [0, 2, -2])
@pytest.mark.parametrize("j", [0, -1])
def test_arrays_of_a_record_are_read(i, j):
    line = packed().line
    assert _fields(packed(), i, j) == (GRID[i, j], line[i], line[-1], GRID[i, j])


def test_what_is_written_is_converted_to_the_type_of_the_array():
    target, values = packed(), np.zeros((3, 4), complex)
    _replace(target, values, -2, -1, 1)
    assert target.line.tolist() == [3, -4, -2]
    assert np.argwhere(target.grid != GRID).tolist() == [[2, 1]]
    assert target.grid[2, 1] == 7.0
    assert values[2].tolist() == [1.5, -2.0, 0.0, 0.0]
    assert not values[:2].any()


@pytest.mark.parametrize("i", [1, -1])
def test_rows_and_slices_are_views(i):
    assert _part_sum(packed(), i) == GRID[i].sum() + 100.0


def test_operations_on_numbers_of_several_types():
    assert _largest(1, 2.5, 2) == 2.5
    assert _largest(-1, -2, -3) == -1


@pytest.fixture
def counted_memory():
    """Numba counts what is allocated and freed."""
    rtsys.initialize(cpu_target.target_context)
    _nrt_python.memsys_enable_stats()
    yield
    _nrt_python.memsys_disable_stats()


@pytest.mark.jit_only
@pytest.mark.parametrize("which", [False, True])
def test_each_array_that_a_kernel_makes_is_freed(which, counted_memory):
    first, second = np.array([1.0, 2.0]), np.array([3.0, 4.0])
    _chosen(first, second, which)
    before = rtsys.get_allocation_stats()
    for _ in range(5):
        assert _chosen(first, second, which).tolist() == ([3.0, 4.0] if which else [1.0, 2.0])
    after = rtsys.get_allocation_stats()
    assert after.alloc - before.alloc == after.free - before.free >= 10
    assert after.mi_alloc - before.mi_alloc == after.mi_free - before.mi_free


@pytest.mark.jit_only
def test_types_are_not_inferred_again_for_the_code(monkeypatch):
    @kernel
    def scaled(values, i, factor):
        values[i] = factor * values[i] - factor
        return values[i] / factor

    asked = []
    get = BaseFunction.get_call_type

    def asks(function, context, args, keywords):
        asked.append((function.typing_key, args))
        return get(function, context, args, keywords)

    monkeypatch.setattr(BaseFunction, "get_call_type", asks)
    assert scaled(np.array([4.0]), 0, 2.0) == 3.0
    operations = [question for question in asked if question[0] in (operator.mul, operator.getitem, operator.setitem)]
    assert len(operations) == len(set(operations))
