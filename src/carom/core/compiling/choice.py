"""Whether kernels are compiled in carom's way, or as Numba compiles everything."""

from __future__ import annotations

import os
import warnings
from functools import cache

import numba

from carom.base.outcome import CaromWarning, InputError

VARIABLE = "CAROM_COMPILER"
"""Environment variable that chooses how kernels are compiled."""
PLAIN = "plain"
TRIED = ("0.62", "0.68")
"""Versions of Numba with which all of carom's tests have passed; carom's way rests on internals that may change with each."""


@cache
def compiles_plainly() -> bool:
    """Whether Numba compiles kernels by itself: the results are the same within rounding, the first call of each takes longer.

    It does so where the environment asks for it, and with a version that has not been tried, of which a warning tells once.

    Raises
    ------
    InputError
        If the environment asks for something else.
    """
    chosen = os.environ.get(VARIABLE, "")
    if chosen not in ("", PLAIN):
        raise InputError(VARIABLE, chosen, f"{PLAIN}, or not set")
    if chosen == PLAIN:
        return True
    if ".".join(numba.__version__.split(".")[:2]) in TRIED:
        return False
    warnings.warn(
        f"Numba {numba.__version__} has not been tried with carom, so its kernels take several times as long to compile "
        f"when they are first called; set {VARIABLE}={PLAIN} to silence this, or install Numba {TRIED[-1]}",
        CaromWarning,
        stacklevel=2,
    )
    return True
