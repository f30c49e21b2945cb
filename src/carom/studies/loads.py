"""Loads of the wall as JSON: what steel would give way by under them, and the force of rolling."""

from __future__ import annotations

from typing import Any

from carom.closed_forms.whirl import rolling
from carom.models import Jeffcott
from carom.parameters.indentation import gives_way, indentation_of_force

__all__ = ["rolling_document", "wall_document"]


def wall_document(indentation: float) -> dict[str, Any]:
    """Least indentation of a wall of solid steel, in clearances, and whether a rigid wall is a model there."""
    return {"indentation": indentation, "rigid_wall": not gives_way(indentation)}


def rolling_document(rotor: Jeffcott) -> dict[str, Any]:
    """Rolling backward whirl: whether it goes on once it is there, and its force."""
    roll, scales = rolling(rotor), rotor.scales
    document: dict[str, Any] = {"holds": roll.holds, "speed": roll.speed, "largest_force": roll.largest_force}
    if scales is not None:
        document["largest_force_si"] = roll.largest_force * scales.force
        document |= wall_document(indentation_of_force(rotor.parameters, roll.largest_force))
    return document
