"""Kinds of disturbances of which the smallest that does not come back is searched, and up to which size none of them can touch."""

from __future__ import annotations

import math

from carom.closed_forms.harmless import harmless_kick, harmless_shock
from carom.disturbances import BaseShock, BladeLoss, Coordinate, Disturbance, KickPlane, VelocityKick
from carom.models import Rotor

UNBALANCE = "unbalance"
"""Quantity of eccentricities that change: people state them as an unbalance, which is that times the mass."""


def has_sizes(model: Disturbance) -> bool:
    """Whether :func:`smallest_loss` can search a model: a loss of a blade, or one by size from 0 and direction."""
    return type(model) in (KickPlane, BladeLoss) or model.size == model.coordinates[0]


def harmless_size(rotor: Rotor, model: Disturbance) -> float:
    """Size up to which contact is proven to be impossible; nothing is proven of a subclass, which may start anywhere."""
    if type(model) is VelocityKick:
        return harmless_kick(rotor)
    return harmless_shock(rotor, model.duration) if type(model) is BaseShock else 0.0


def size_coordinate(model: Disturbance) -> Coordinate:
    """Coordinate with the description and unit of the size of a disturbance."""
    if isinstance(model, BladeLoss):
        return Coordinate("change", "change of the unbalance", 0.0, math.inf, UNBALANCE)
    return model.coordinates[0]
