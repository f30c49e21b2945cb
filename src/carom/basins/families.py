"""Kinds of disturbances of which the smallest that does not come back is searched, and up to which size none of them can touch."""

from __future__ import annotations

import numpy as np

from carom.closed_forms.contact_free import contact_free_blade_loss, contact_free_kick, contact_free_shock
from carom.disturbances import BaseShock, BladeLoss, Coordinate, Disturbance, KickPlane, Starts, VelocityKick
from carom.disturbances.blade_loss import starts_after
from carom.models import Rotor


def size_coordinate(model: Disturbance) -> Coordinate | None:
    """Size of a disturbance that varies by a size from 0 and a direction; of a loss of a blade the change.  ``None`` of others."""
    if isinstance(model, BladeLoss):
        return Coordinate("change", "change of the unbalance", 0.0, model.change, "unbalance", over_disc=True)
    return model.size if type(model) is KickPlane or model.size == model.coordinates[0] else None


def starts_by_size(rotor: Rotor, model: Disturbance, sizes: np.ndarray, *at: np.ndarray) -> Starts:
    """Starts after disturbances of these sizes in these directions, at these instants where they matter."""
    if isinstance(model, BladeLoss):
        phases, *instants = at
        return starts_after(rotor, sizes, phases, model.node, *instants)
    return model.starts_on(rotor, sizes, *at)


def on_few_machines(
    rotor: Rotor, model: Disturbance, sizes: np.ndarray, at: np.ndarray, count: int
) -> tuple[np.ndarray, np.ndarray]:
    """Disturbances close to those of these sizes in these directions ``at[0]``, that lead to so many machines at most.

    The unbalances after losses of a blade, of any rotor that changes along its unbalance, are moved to circles: all of one circle lead
    to the same machine, the frame of which has turned.
    """
    before = rotor.definition.unbalance_along(model.node) if isinstance(model, BladeLoss) else None
    if before is None:
        return sizes, at
    places = before + sizes * np.exp(1j * at[0])
    for some in np.array_split(np.abs(places).argsort(), count):
        if some.size:
            places[some] *= np.abs(places[some[some.size // 2]]) / np.abs(places[some])
    return np.abs(places - before), np.vstack([np.angle(places - before), at[1:]])


def contact_free_size(rotor: Rotor, model: Disturbance) -> float:
    """Size up to which contact is proven to be impossible; nothing is proven of a subclass, which may start anywhere."""
    if type(model) is VelocityKick:
        return contact_free_kick(rotor)
    if isinstance(model, BladeLoss):
        return contact_free_blade_loss(rotor, model.node)
    return contact_free_shock(rotor, model.duration) if type(model) is BaseShock else 0.0
