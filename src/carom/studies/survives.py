"""What a machine survives: kicks, shocks and losses of a blade, in absolute sizes.

For each kind of disturbance three sizes matter: up to the first contact is proven to be impossible, up to the second every one
tried came back, and the third is the smallest found that is lost (:func:`carom.basins.smallest_unrecovered`).  They do not depend on
what the machine must survive; whether that is met follows from them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from carom.attractors import AttractorSet
from carom.base.progress import Reporter
from carom.base.results import Result, record
from carom.basins import Share, SmallestUnrecovered, smallest_unrecovered
from carom.basins.families import contact_free_size
from carom.closed_forms.contact_free import shift_by_unbalance
from carom.disturbances import BaseShock, BladeLoss, VelocityKick
from carom.disturbances.kicks_and_shocks import LONGEST_SHOCK
from carom.models import Rotor
from carom.motions.budget import Budget
from carom.parameters import DIMENSIONLESS_FIELDS, SHOCK_DURATION, Required, Scales
from carom.studies.full_size import FullSize
from carom.studies.kinds import Kind, required_kinds
from carom.studies.questions import FEWEST, SMALLEST, events_for
from carom.studies.trials import Check
from carom.studies.wording import SIZES as SIZES_OF

REACH = 4.0
"""Largest kick and shock searched, as a multiple of what must be survived or is proven to be contact-free."""
BELOW = 0.999
"""Largest unbalance after a loss of a blade, relative to that with which levitation would fill the clearance."""
SURVIVED = (
    "harmless_up_to=contact_free:{kind} all_up_to=all_back:{kind} smallest_lost=size:{kind} searched_up_to=largest:{kind} "
    "tried fresh angle instant neighbours neighbours_lost complete"
)


@dataclass(frozen=True, eq=False, repr=False)
class Survives(Result):
    """What a machine survives of each kind of disturbance.

    Attributes
    ----------
    kick : SmallestUnrecovered
        Kicks out of levitation; sizes in ``c_r Ω``.
    shock : SmallestUnrecovered or None
        Half-sine shocks of the base of ``duration``; sizes are peaks in ``c_r Ω²``.  ``None`` where none is required and the
        usual duration is not known in turns, or is too many, or where the state after a shock is more than places and speeds.
    duration : float
        Duration of the shocks, in ``1/Ω``.
    blade_loss : SmallestUnrecovered or None
        Sizes are changes of the unbalance by the loss of a blade, as eccentricities in ``c_r``, at the worst phase.
    """

    kick: SmallestUnrecovered
    shock: SmallestUnrecovered | None
    duration: float
    blade_loss: SmallestUnrecovered | None

    @property
    def known_scales(self) -> Scales | None:
        """Scales of the machine."""
        return self.kick.scales

    def items(self) -> tuple[tuple[Kind, SmallestUnrecovered], ...]:
        """The kinds that were searched, by name."""
        found: dict[Kind, SmallestUnrecovered | None] = {
            "kick": self.kick,
            "shock": self.shock,
            "blade_loss": self.blade_loss,
        }
        return tuple((name, entry) for name, entry in found.items() if entry is not None)

    def document(self) -> dict[Kind, dict[str, Any]]:
        """What of each kind is survived, as plain data for JSON."""
        document: dict[Kind, dict[str, Any]] = {}
        for name, found in self.items():
            columns = SURVIVED.format(kind=SIZES_OF[name])
            ended = None if found.outcome is None else found.outcome.label
            document[name] = record(found, columns, found.scales) | {"lost_to": ended}
            document[name] |= {"duration": self.duration} if name == "shock" else {}
        return document


def survives(rotor: Rotor, required: Required, budget: Budget, tell: Reporter) -> Survives | None:
    """Search for the smallest disturbance of each kind that is lost; ``None`` where there is no levitation to come back to."""
    if not comes_to_rest(rotor):
        return None
    words = SMALLEST.format("kick")
    tell(0.0, words)
    with budget.question(words, events_for(rotor, words)):
        kick = _reaching(rotor, VelocityKick(required.kick))
    shock, duration = None, _duration(rotor, required)
    if duration:
        words = SMALLEST.format("shock")
        tell(0.4, words)
        peak = required.shock.peak if required.shock else math.pi * required.kick / (2.0 * duration)
        with budget.question(words, events_for(rotor, words)):
            shock = _reaching(rotor, BaseShock(peak, duration))
    words, blade_loss, largest = SMALLEST.format("loss of a blade"), None, largest_change(rotor)
    tell(0.9, words)
    if largest > 0.0:
        with budget.question(words, events_for(rotor, words)):
            blade_loss = smallest_unrecovered(rotor, BladeLoss(largest))
    return Survives(kick, shock, duration, blade_loss)


def comes_to_rest(rotor: Rotor) -> bool:
    """Whether there is stable levitation inside the wall, to which a disturbed rotor can come back."""
    return rotor.system.rest_radius < 1.0 and rotor.system.decay > 0.0


def largest_change(rotor: Rotor) -> float:
    """Largest change of the unbalance, in ``c_r``, after which the rotor can levitate at any phase.

    Larger ones that add to the unbalance before lead to no levitation inside the wall; just below it motions do not settle.  Zero for a model whose
    unbalance is not known by one number, and of a shaft whose speed changes.
    """
    system, before = rotor.system, rotor.definition.unbalance_along() if "rho" in rotor.varied else None
    if before is None or system.is_anisotropic or system.shaft is not None:
        return 0.0
    sags = np.abs(system.arrays["rows"] @ system.outer)
    shifts = np.abs(system.planes @ shift_by_unbalance(rotor))
    return min(float((BELOW * (1.0 - sags) / shifts).min()), DIMENSIONLESS_FIELDS["rho"].highest) - before


def _duration(rotor: Rotor, required: Required) -> float:
    """Duration of the shocks: that required, otherwise the usual one where times are known; else 0."""
    if required.shock:
        return required.shock.duration
    if rotor.system.why_not_stationary is not None:
        return 0.0
    usual = SHOCK_DURATION / rotor.scales.time if rotor.scales else 0.0
    return usual if usual <= LONGEST_SHOCK else 0.0


def _reaching(rotor: Rotor, model: VelocityKick | BaseShock) -> SmallestUnrecovered:
    """Search up to a multiple of a disturbance, or of what is proven to be contact-free if that is more."""
    largest = _times(model, REACH * max(1.0, contact_free_size(rotor, model) / model.coordinates[0].high))
    return smallest_unrecovered(rotor, largest)


def _times(model: VelocityKick | BaseShock, factor: float) -> VelocityKick | BaseShock:
    """A kick or shock that many times as large."""
    if isinstance(model, VelocityKick):
        return VelocityKick(factor * model.fastest)
    return replace(model, peak=factor * model.peak)


def has_unrecovered(found: SmallestUnrecovered, size: float) -> bool:
    """Whether some disturbances up to a size are lost, or it is larger than all that are possible."""
    return (found.size is not None and found.size <= size) or (found.complete and size > found.largest)


def decides(present: Check | None) -> bool:
    """Whether enough of what must be survived was followed to say that it came back, where none is lost."""
    return present is not None and min(each.total for each in present.returned) >= FEWEST


def unrecovered_kinds(
    required: Required,
    survives: Survives | None,
    present: Check | None,
    attractors: AttractorSet,
    full_size: Sequence[FullSize] = (),
) -> list[tuple[Kind, Share | None]]:
    """The kinds that must be survived and of which some were lost, with the share of them that came back, if any were drawn.

    Drawn ones count, those at their full size all around, those that the search for the smallest has found, and kicks among the disturbances whose
    ends are described.
    """
    if survives is None or present is None:
        return []
    lost: list[tuple[Kind, Share | None]] = []
    described = attractors.smallest_unrecovered_kick
    for place, (kind, size) in enumerate(required_kinds(required)):
        drawn, largest, entry = present.returned[place], present.largest[place], getattr(survives, kind)
        seen = drawn.count < drawn.total or largest.count < largest.total
        seen |= kind == "kick" and described is not None and described <= size
        seen |= any(each.lost for each in full_size if each.kind == kind)
        if seen or (entry is not None and has_unrecovered(entry, size)):
            lost.append((kind, drawn if drawn.total else None))
    return lost
