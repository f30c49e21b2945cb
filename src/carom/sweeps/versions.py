"""What the last bits of a result depend on: versions of software."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.metadata import version


def versions() -> dict[str, str]:
    """Return the versions of carom, of its compiler (Numba, llvmlite) and of its random numbers (NumPy)."""
    return {name: version(name) for name in ("carom", "numpy", "numba", "llvmlite")}


def other_version(there: Mapping[str, str], here: Mapping[str, str]) -> tuple[str, str, str] | None:
    """Return the first package whose versions differ, with both versions, or None."""
    return next(((name, there.get(name, "?"), own) for name, own in here.items() if there.get(name) != own), None)
