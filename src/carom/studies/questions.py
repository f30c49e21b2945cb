"""What a machine may have to survive, the questions of a study, and how many events each may take.

An event, an impact or a step of lasting contact, takes some 10 microseconds, of a rotor of 64 modes 70; a motion without contact counts as
60.  Motions of planar rotors on a rigid wall do not count (:mod:`carom.motions.budget`).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from carom.disturbances import BaseShock, BladeLoss, Disturbance, Sample, VelocityKick
from carom.models import Rotor
from carom.parameters import Required

Kind = Literal["kick", "shock", "blade_loss"]
"""Kinds of disturbances that a machine may have to survive."""
OF_ANOTHER_KIND = 0.2
"""Number of shocks, and of losses of a blade, relative to that of kicks, where such are required."""
LABELS: dict[Kind, str] = {"kick": "Kick", "shock": "Shock", "blade_loss": "Blade loss"}
DESCRIBED, PRESENT = "the outcomes of disturbances", "the share of {} that comes back"
SMALLEST = "the smallest {} that do not come back"
ALONG = "recovery along {}"
CHANGE = "the least change"
FULL_SIZE, DROP = "required disturbances at full size, in all directions", "the drop"
EVENTS = {
    DESCRIBED: 100_000,
    PRESENT: 300_000,
    SMALLEST.format(VelocityKick.noun): 200_000,
    SMALLEST.format(BaseShock.noun): 150_000,
    SMALLEST.format(BladeLoss.noun): 100_000,
    ALONG: 120_000,
    CHANGE: 100_000,
    FULL_SIZE: 100_000,
    DROP: 20_000,
}
"""Events of each question, some 1.3 million in all; the kinds of disturbances that must be survived share the second and the last but one equally."""
UNFINISHED = "question=words followed asked"
FEW_MODES, MANY_MODES = 4, 16
"""Modes up to which an event costs about the same, of more it costs in proportion, and so many fewer are followed; and modes above which searches are coarser."""
FEWEST = 60
"""Disturbances of a kind of which none is lost for a verdict that they came back: otherwise one in twenty might be lost unseen."""


def required_disturbances(required: Required, count: int, seed: int = 0) -> tuple[Sample, ...]:
    """Kinds of disturbances that a machine must survive, with the number of each; ``count`` is that of kicks.

    Kicks out of levitation, uniform over the disc of their velocities; shocks and losses of a blade where they are required.
    """
    more = max(1, round(OF_ANOTHER_KIND * count))
    kinds = required_kinds(required)
    return tuple(Sample(model, count if kind == "kick" else more, seed) for kind, _, model in kinds)


def required_kinds(required: Required) -> Iterator[tuple[Kind, float, Disturbance]]:
    """The kinds that must be survived, with their size, in the order of :func:`required_disturbances`."""
    yield "kick", required.kick, VelocityKick(required.kick)
    if required.shock:
        yield "shock", required.shock.peak, BaseShock(required.shock.peak, required.shock.duration)
    if required.blade_loss:
        yield "blade_loss", required.blade_loss, BladeLoss(required.blade_loss, required.blade_loss_node)


def events_for(rotor: Rotor, question: str) -> int:
    """Events of a question for a rotor."""
    return round(EVENTS[question] * min(1.0, FEW_MODES / rotor.system.modes))
