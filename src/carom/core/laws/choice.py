"""The law of a wall along its normal, by its number."""

from __future__ import annotations

import pkgutil
from collections.abc import Callable
from importlib import import_module
from typing import Any

from carom.compiling.decorators import formula
from carom.core import laws

_FOUND = [module.name for module in pkgutil.iter_modules(laws.__path__) if module.name not in ("rigid", "choice")]
LAWS = ("rigid", *sorted(_FOUND))
"""Names of the laws; each has its place as its number."""


def _chosen(name: str) -> Callable[[Any, Any], Any]:
    """The function of this name of the law that a wall has."""
    first, *others = (getattr(import_module(f"{laws.__name__}.{law}"), name) for law in LAWS)
    function: Callable[[Any, Any], Any] = first
    for number, other in enumerate(others, 1):
        function = _one_of(number, other, function)
    return function


def _one_of(
    number: int, mine: Callable[[Any, Any], Any], others: Callable[[Any, Any], Any]
) -> Callable[[Any, Any], Any]:
    @formula
    def function(speed, wall):
        if wall.law == number:
            return mine(speed, wall)
        return others(speed, wall)

    return function


impulse, impulse_by_speed, impulse_by_restitution = map(
    _chosen, ("impulse", "impulse_by_speed", "impulse_by_restitution")
)
