"""Whether the kernels are compiled.

Without the compiler (``make coverage``) a kernel takes some hundred times as long: tests that try many cases try fewer
then, enough to go through every line.  Tests that make no sense with few are marked ``jit_only``.
"""

from __future__ import annotations

from numba.core import config

COMPILED = not config.DISABLE_JIT


def sized(compiled: int, interpreted: int) -> int:
    """How many cases to try: with the compiler, and without it."""
    return compiled if COMPILED else interpreted
