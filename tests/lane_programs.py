"""Kernels made of lines of text, with the functions on lanes at hand, and the same for one lane with NumPy's scalars."""

from collections.abc import Callable, Iterable

import numba
import numpy as np
from compilation import COMPILED

from carom.core import vector
from carom.core.lanes import fly_lanes

FOR_ONE = {
    "where": lambda condition, chosen, other: chosen if condition else other,
    "join": lambda real, imag: np.complex128(complex(real, imag)),
    "fma": lambda a, b, c: a * b + c,
    "sqrt": np.sqrt,
    "truncate": np.trunc,
}
"""What the functions mean to a single motion."""


def program(arguments: str, lines: Iterable[str]) -> Callable[..., object]:
    """A kernel of these lines, compiled as all kernels are where the compiler is on."""
    names = {name: getattr(vector, name) for name in vector.__all__}
    exec("\n    ".join([f"def program({arguments}):", *lines]), names)
    return numba.jit(**fly_lanes.targetoptions)(names["program"]) if COMPILED else names["program"]


def for_one(expression: str) -> Callable[..., object]:
    """A function of named scalars that computes an expression."""
    code = compile(expression, expression, "eval")
    return lambda **values: eval(code, {**FOR_ONE, **values})
