"""Kinds of disturbances as families by size and direction, through which the smallest that is lost is searched."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from carom.closed_forms.harmless import harmless_kick, harmless_shock
from carom.disturbances import (
    BaseShock,
    BladeLoss,
    ContactRelease,
    Coordinate,
    Disturbance,
    KickPlane,
    Starts,
    VelocityKick,
)
from carom.disturbances.coordinates import TURN, complex_of, displaced
from carom.models import Rotor
from carom.outcome import InputError

UNBALANCE = "unbalance"
"""Quantity of eccentricities that change: people state them as an unbalance, which is that times the mass."""
WHIRL = 2.0
"""Largest speed along the wall searched for releases, in ``c_r Ω``: twice that of a whirl in step with the shaft."""


@dataclass(frozen=True)
class Family:
    """Disturbances by size and direction, on some machines also by instant; directions above one turn mean backward whirl."""

    kind: str
    quantity: str
    """Property of the scales by which sizes are converted."""
    largest: float
    harmless: float
    starts: Callable[..., Starts]
    turns: int = 1
    by_area: bool = True
    timed: bool = False
    """Whether starts take instants after sizes and directions."""

    def drawn(self, shares: np.ndarray, below: float) -> np.ndarray:
        """Sizes between the harmless one and another by numbers uniform from 0 to 1: uniform over the area of the ring."""
        low = self.harmless
        if not self.by_area:
            return low + (below - low) * shares
        sizes: np.ndarray = np.sqrt(low**2 + (below**2 - low**2) * shares)
        return sizes


def has_sizes(model: Disturbance) -> bool:
    """Whether :func:`smallest_loss` can search a model: by size and direction, or a kick plane, release or blade loss."""
    return type(model) in (KickPlane, ContactRelease, BladeLoss) or by_size(model)


def by_size(model: Disturbance) -> bool:
    """Whether the coordinates are a size from 0 and a direction over a full turn."""
    axes = model.coordinates
    return len(axes) == 2 and axes[0].low == 0.0 and axes[1].periodic


def family_of(rotor: Rotor, model: Disturbance) -> Family:
    """Family of starts through which a disturbance is searched."""
    return replace(_by_size_and_direction(rotor, model), timed=rotor.depends_on_instant)


def _by_size_and_direction(rotor: Rotor, model: Disturbance) -> Family:
    if type(model) is KickPlane:
        model = VelocityKick(model.fastest)
    if type(model) is ContactRelease:

        def released(sizes: np.ndarray, places: np.ndarray, *instants: np.ndarray) -> Starts:
            cosine, sine = np.cos(places), np.sin(places)
            forward = np.where(np.mod(places, 2.0 * TURN) < TURN, sizes, -sizes)
            speed = forward / (rotor.system.planes_translated.max() or 1.0)
            found = displaced(rotor, complex_of(cosine, sine), complex_of(-speed * sine, speed * cosine))
            return found.at(*instants) if instants else found

        return Family(model.kind, size_coordinate(model).scale, WHIRL, 0.0, released, turns=2, by_area=False)
    if not by_size(model):
        raise InputError("disturbance", model.kind, "one with a size from 0 and a direction, or a release from contact")
    harmless = 0.0  # nothing is proven of a subclass, which may start anywhere
    if type(model) is VelocityKick:
        harmless = harmless_kick(rotor)
    elif type(model) is BaseShock:
        harmless = harmless_shock(rotor, model.duration)
    size = model.coordinates[0]
    return Family(
        model.kind, size.scale, size.high, harmless, lambda *at: model.starts_on(rotor, *at), by_area=size.over_disc
    )


def size_coordinate(model: Disturbance) -> Coordinate:
    """Coordinate with the description and unit of the size of a disturbance."""
    if type(model) is BladeLoss:
        return Coordinate("change", "change of the unbalance", 0.0, math.inf, UNBALANCE)
    if type(model) is ContactRelease:
        return Coordinate("release_speed", "speed along the wall", 0.0, math.inf, "velocity")
    return model.coordinates[0]
