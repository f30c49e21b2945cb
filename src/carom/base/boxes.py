"""Packages that stand above those that ask for them: the layers forbid imports from above, so they are named here as data."""

from __future__ import annotations

from importlib import import_module
from typing import Any, Literal

BOXES = {"figures": "carom.plots", "proofs": "carom.proofs"}


def box(name: Literal["figures", "proofs"]) -> Any:
    """The package that draws results, or the one that proves; the second needs the extra ``carom[proof]``."""
    return import_module(BOXES[name])
