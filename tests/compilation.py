"""How much to try: whether the kernels are compiled, and whether this is a deep run.

Without the compiler (``make test-plain``) a kernel takes some hundred times as long: tests that try many cases try fewer
then, enough to go through every line.  Tests that make no sense with few are marked ``jit_only``.

The daily run (``make test``) is one that people wait for.  ``make test-deep`` tries many more cases, and runs the tests
marked ``deep`` too.
"""

import os
import subprocess
import sys
from pathlib import Path

from numba.core import config

from carom.core.compiling.cache_directory import cache_directory

COMPILED = not config.DISABLE_JIT
DEEP = COMPILED and os.environ.get("CAROM_DEEP", "") not in ("", "0")


def compile_kernels() -> None:
    """Compile what most tests call, unless it is in the cache already."""
    if COMPILED and cache_directory() is not None:
        subprocess.run([sys.executable, Path(__file__).parents[1] / "tools" / "kernels"], check=True)


def sized(compiled: int, interpreted: int, deep: int | None = None) -> int:
    """How many cases to try: with the compiler, without it, and in a deep run."""
    if not COMPILED:
        return interpreted
    return deep if DEEP and deep is not None else compiled
