"""What the page wishes to see of a machine: kind of disturbances, range, and those that are drawn."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

SLOTS = ("motion", "beside")
"""Answers with the motions after both disturbances: the first is meant to come back, the second to be lost."""
_LARGEST = 1e12
"""Numbers beyond this are no sizes."""


@dataclass(frozen=True)
class View:
    """A view; what is not given is chosen for the machine.

    Attributes
    ----------
    kind : str
    largest : float or None
        Range of the picture, in the unit that people see.
    kicks : tuple of pairs of float, or None
        Components of the disturbances that are drawn, in this unit.
    active : int
        Which of them was chosen last: the one that is copied.
    """

    kind: str = "kick"
    largest: float | None = None
    kicks: tuple[tuple[float, float], ...] | None = None
    active: int = 0


def read_view(given: object) -> View:
    """Read what the page sends; what cannot be read counts as not given."""
    given = given if isinstance(given, Mapping) else {}
    largest = _number(given.get("largest"))
    kicks = given.get("kicks")
    pairs = [read_kick(*pair) for pair in kicks if len(pair) == 2] if isinstance(kicks, list | tuple) else []
    return View(
        str(given.get("kind", "kick")),
        largest if largest is not None and largest > 0.0 else None,
        tuple(pair for pair in pairs if pair is not None) if pairs and None not in pairs else None,
        1 if given.get("active") == 1 else 0,
    )


def read_kick(first: object, second: object) -> tuple[float, float] | None:
    """Read two components; ``None`` where they are no numbers."""
    one, other = _number(first), _number(second)
    return None if one is None or other is None else (one, other)


def _number(given: object) -> float | None:
    if isinstance(given, bool) or not isinstance(given, int | float) or not math.isfinite(given):
        return None
    return float(given) if abs(given) < _LARGEST else None
