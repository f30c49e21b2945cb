"""The decorators that define how kernels are compiled."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import numba
from numba.extending import register_jitable

from carom.core.compiling.cache import keep
from carom.core.compiling.choice import compiles_plainly
from carom.core.compiling.names import NamingCompiler

Kernel = TypeVar("Kernel", bound=Callable[..., object])

_OPTIONS: dict[str, str | set[str]] = {"error_model": "numpy", "fastmath": {"contract", "nsz"}}
"""Arithmetic of kernels."""


def kernel(function: Kernel) -> Kernel:
    """Compile a kernel: no Python objects, no global interpreter lock, cached on disk (:mod:`carom.core.compiling.cache`).

    Arithmetic follows IEEE 754, but products and sums may be fused, and the sign of zero is undefined.

    Conditions on the shapes of a record's arrays, like ``if rotor.rows.shape[0] > 1:``, are decided before compilation.
    """
    return _compile(function)


def separate(function: Kernel) -> Kernel:
    """Compile a large kernel, a function of a module, once for Python and for all kernels: these call its machine code."""
    return _compile(function, share=True)


def inlined(function: Kernel) -> Kernel:
    """Compile a small kernel inline into each of its callers: no call, and code a caller does not need is dropped."""
    return _compile(function, forceinline=True)


def formula(function: Kernel) -> Kernel:
    """Let kernels call a function of numbers, inline; for Python, and for arrays, it stays the function that it is."""
    formula_in_kernels: Kernel = register_jitable(**_OPTIONS, forceinline=True)(function)
    return formula_in_kernels


def expanded(function: Kernel) -> Kernel:
    """Insert a section of a kernel where it is called, in one place; it is a separate function for readability only."""
    return _compile(function, inline="always")


def _compile(function: Kernel, share: bool = False, **more: bool | str) -> Kernel:
    options = {**_OPTIONS, "nopython": True, "nogil": True, "no_cfunc_wrapper": True, **more}
    if numba.config.DISABLE_JIT:
        return function
    if compiles_plainly():
        compiled: Kernel = numba.jit(**options, pipeline_class=NamingCompiler)(function)
    else:
        from carom.core.compiling.intermediate import (
            compile_once,  # imported here: another version of Numba may lack what it uses
        )

        compiled = compile_once(function, options, share)
    keep(compiled)
    return compiled
