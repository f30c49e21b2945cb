"""The kinds of disturbances that a machine may have to survive."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from carom.disturbances import BaseShock, BladeLoss, Disturbance, Sample, VelocityKick
from carom.parameters import Required

Kind = Literal["kick", "shock", "blade_loss"]
"""Kinds of disturbances that a machine may have to survive."""
OF_ANOTHER_KIND = 0.2
"""Number of shocks, and of losses of a blade, relative to that of kicks, where such are required."""
LABELS: dict[Kind, str] = {"kick": "Kick", "shock": "Shock", "blade_loss": "Blade loss"}


def required_kinds(required: Required) -> tuple[tuple[Kind, float], ...]:
    """The kinds that must be survived, with their size, in the order of :func:`required_disturbances`."""
    return tuple((kind, size) for kind, size, _ in _required(required))


def required_disturbances(required: Required, count: int, seed: int = 0) -> tuple[Sample, ...]:
    """Kinds of disturbances that a machine must survive, with the number of each; ``count`` is that of kicks.

    Kicks out of levitation, uniform over the disc of their velocities; shocks and losses of a blade where they are required.
    """
    more = max(1, round(OF_ANOTHER_KIND * count))
    return tuple(Sample(model, count if kind == "kick" else more, seed) for kind, _, model in _required(required))


def _required(required: Required) -> Iterator[tuple[Kind, float, Disturbance]]:
    yield "kick", required.kick, VelocityKick(required.kick)
    if required.shock:
        yield "shock", required.shock.peak, BaseShock(required.shock.peak, required.shock.duration)
    if required.blade_loss:
        yield "blade_loss", required.blade_loss, BladeLoss(required.blade_loss, required.blade_loss_node)
