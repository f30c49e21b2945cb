"""Loads on the wall as JSON: the indentation of steel under them, and the force of rolling."""

from __future__ import annotations

from typing import Any

from carom.closed_forms.whirl import rolling
from carom.models import Jeffcott
from carom.parameters.indentation import gives_way, indentation_of_force

__all__ = ["rolling_document", "wall_document"]


def wall_document(indentation: float) -> dict[str, Any]:
    """Return the least indentation of a wall of solid steel, in clearances, and whether the rigid wall is valid."""
    return {"indentation": indentation, "rigid_wall": not gives_way(indentation)}


def rolling_document(rotor: Jeffcott) -> dict[str, Any]:
    """Return whether rolling backward whirl sustains itself, with its speed and force."""
    roll, scales = rolling(rotor), rotor.scales
    document: dict[str, Any] = {"holds": roll.holds, "speed": roll.speed, "largest_force": roll.largest_force}
    if scales is not None:
        document["largest_force_si"] = roll.largest_force * scales.force
        document |= wall_document(indentation_of_force(rotor.parameters, roll.largest_force))
    return document
