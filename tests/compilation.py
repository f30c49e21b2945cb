"""How much to try: whether the kernels are compiled, and whether this is a deep run.

Without the compiler (``make coverage``) a kernel takes some hundred times as long: tests that try many cases try fewer
then, enough to go through every line.  Tests that make no sense with few are marked ``jit_only``.

The daily run (``make test``) is one that people wait for.  ``make test-deep`` tries many more cases, and runs the tests
marked ``deep`` too.
"""

from __future__ import annotations

import os
import subprocess
import sys

from numba.core import config

from carom.core.cache_directory import cache_directory

COMPILED = not config.DISABLE_JIT
DEEP = COMPILED and os.environ.get("CAROM_DEEP", "") not in ("", "0")


_FLIGHT = """
import numpy as np
import carom
rotor = carom.parameters.Parameters(0.15, 0.76, 0.3, 0.21, 0.15, 0.95, 57.0)
carom.simulate(rotor, carom.kick(0.3), 20.0, settle=True)
carom.settle(rotor, np.array([0.1 + 0j]), np.array([0.5 + 0j]))
"""
_SHOCK = """
import carom
rotor = carom.parameters.Parameters(0.15, 0.76, 0.3, 0.21, 0.15, 0.95, 57.0)
carom.map_basins(rotor, carom.Grid(carom.BaseShock(1.0, 0.7), (2, 2)))
"""


def compile_kernels() -> None:
    """Compile what most tests call, unless there are kernels already: half of it each in two processes.

    The kernels of a rotor and those of one that is shaken have nothing in common.
    """
    directory = cache_directory()
    if COMPILED and directory is not None and not any(directory.rglob("*.nbi")):
        started = [subprocess.Popen([sys.executable, "-c", program]) for program in (_FLIGHT, _SHOCK)]
        codes = [process.wait() for process in started]
        if any(codes):
            raise RuntimeError("kernels could not be compiled beforehand; the reason stands above")


def sized(compiled: int, interpreted: int, deep: int | None = None) -> int:
    """How many cases to try: with the compiler, without it, and in a deep run."""
    if not COMPILED:
        return interpreted
    return deep if DEEP and deep is not None else compiled
