"""A counter that threads share: kernels on several threads deal out one list of tasks by it."""

from __future__ import annotations

import threading

import numpy as np
from llvmlite import ir
from numba.core import types
from numba.extending import lower_builtin, type_callable

from carom.core.layout import record

__all__ = ["fresh_counter", "next_number"]

_LOCK = threading.Lock()


def fresh_counter() -> np.record:
    """A counter that begins with zero."""
    return record(numbers=np.zeros(1, np.int64))


def next_number(numbers):
    """The number a counter has come to, which then moves on: no two threads are told the same one."""
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
