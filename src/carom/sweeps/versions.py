"""The versions that decide the bits of a result."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.metadata import version

__all__ = ["other_version", "versions"]


def versions() -> dict[str, str]:
    """Of carom, and of what its kernels are compiled by and its numbers are drawn by."""
    return {name: version(name) for name in ("carom", "numpy", "numba")}


def other_version(there: Mapping[str, str], here: Mapping[str, str]) -> tuple[str, str, str] | None:
    """The first name under which the versions differ, and both of them."""
    return next(((name, there.get(name, "?"), own) for name, own in here.items() if there.get(name) != own), None)
