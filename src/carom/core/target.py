"""What kernels are compiled for."""

from __future__ import annotations

import os
import platform
from functools import cache

__all__ = ["processor"]

_VECTORS = ("sse", "ssse", "avx", "fma", "f16c", "neon", "fullfp16", "sve", "altivec", "vsx", "lsx", "lasx")
"""How the names begin of what a processor can do to several numbers at once, or in one step with one rounding."""
_CHOSEN = ("NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES")


@cache
def processor() -> str:
    """Kind of this processor: architecture and vector features, on which the last bits of results depend.

    Where the environment makes Numba compile for another processor, that is told too.
    """
    from llvmlite.binding import get_host_cpu_features  # here: whoever only stores results does without the compiler

    able = sorted(name for name, there in get_host_cpu_features().items() if there and name.startswith(_VECTORS))
    chosen = [f"{name}={os.environ[name]}" for name in _CHOSEN if name in os.environ]
    return " ".join([platform.machine(), *able, *chosen])
