"""A counter shared by threads: kernels that run on several threads use it to divide one list of tasks."""

from __future__ import annotations

import threading

import numpy as np
from llvmlite import ir
from numba.core import types
from numba.extending import lower_builtin, type_callable

from carom.core.records import record

_LOCK = threading.Lock()


def fresh_counter() -> np.record:
    """A new counter, with the value zero."""
    return record(numbers=np.zeros(1, np.int64))


def next_number(numbers):
    """Atomic fetch-and-add: return a counter and increase it by one, so no two threads get the same number."""
    with _LOCK:
        number = int(numbers[0])
        numbers[0] = number + 1
    return number


@type_callable(next_number)
def _kind_of_next_number(context):
    return lambda numbers: types.int64 if isinstance(numbers, types.Array) else None


@lower_builtin(next_number, types.Array)
def _next_number(context, build, signature, values):
    place = context.make_array(signature.args[0])(context, build, values[0]).data
    return build.atomic_rmw("add", place, ir.Constant(ir.IntType(64), 1), "monotonic")
