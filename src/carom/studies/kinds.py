"""The kinds of disturbances that a machine may have to survive."""

from __future__ import annotations

from typing import Literal

from carom.parameters import Required

Kind = Literal["kick", "shock", "blade_loss"]
"""Kinds of disturbances that a machine may have to survive."""
LABELS: dict[Kind, str] = {"kick": "Kick", "shock": "Shock", "blade_loss": "Blade loss"}


def required_kinds(required: Required) -> tuple[tuple[Kind, float], ...]:
    """The kinds that must be survived, with their size, in the order of :func:`required_disturbances`."""
    kinds: list[tuple[Kind, float]] = [("kick", required.kick)]
    kinds += [("shock", required.shock.peak)] if required.shock else []
    kinds += [("blade_loss", required.blade_loss)] if required.blade_loss else []
    return tuple(kinds)
