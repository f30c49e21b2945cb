"""The processor that kernels are compiled for."""

from __future__ import annotations

import os
import platform
from functools import cache

_VECTORS = ("sse", "ssse", "avx", "fma", "f16c", "neon", "fullfp16", "sve", "altivec", "vsx", "lsx", "lasx")
"""Prefixes of the names of processor features for vectors and fused operations."""
_CHOSEN = ("NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES")


@cache
def processor() -> str:
    """Kind of this processor: architecture and vector features; the last bits of results depend on them.

    Environment variables that make Numba compile for another processor are included.
    """
    from llvmlite.binding import get_host_cpu_features  # imported here: storing results needs no compiler

    able = sorted(name for name, there in get_host_cpu_features().items() if there and name.startswith(_VECTORS))
    chosen = [f"{name}={os.environ[name]}" for name in _CHOSEN if name in os.environ]
    return " ".join([platform.machine(), *able, *chosen])


def has_wide_registers() -> bool:
    """Whether kernels are compiled for vector registers of eight doubles (AVX-512)."""
    from numba.core.registry import cpu_target  # imported here, for the same reason

    return "+avx512f" in cpu_target.target_context.codegen().magic_tuple()[2]
