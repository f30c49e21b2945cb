"""What a machine survives: kicks, shocks and losses of a blade, in absolute sizes.

For each kind of disturbance three sizes matter: up to the first contact is proven to be impossible, up to the second every one
tried came back, and the third is the smallest found that is lost (:func:`carom.basins.smallest_loss`).  They do not depend on
what the machine must survive; whether that is met follows from them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from carom.attractors.starts import KICKS_SHARE
from carom.basins import SmallestLoss, smallest_loss
from carom.closed_forms.harmless import shift_by_unbalance
from carom.disturbances import AnyState, BaseShock, BladeLoss, Disturbance, Sample, VelocityKick
from carom.disturbances.blows import LONGEST_SHOCK
from carom.models import Model
from carom.models.unbalance import unbalance_along
from carom.parameters import DIMENSIONLESS_FIELDS, SHOCK_DURATION, Required, Scales
from carom.progress import Reporter
from carom.results import Result

Kind = Literal["kick", "shock", "blade_loss"]
"""Kinds of disturbances that a machine may have to survive."""
REACH = 4.0
"""Largest kick and shock searched, as a multiple of what must be survived or is proven to be harmless."""
BELOW = 0.999
"""Largest unbalance after a loss of a blade, relative to that with which levitation would fill the clearance."""
OF_ANOTHER_KIND = 0.2
"""Number of shocks, and of losses of a blade, relative to that of kicks and other starts, where such are required."""


@dataclass(frozen=True, eq=False, repr=False)
class Survives(Result):
    """What a machine survives of each kind of disturbance.

    Attributes
    ----------
    kick : SmallestLoss
        Kicks out of levitation; sizes in ``c_r Ω``.
    shock : SmallestLoss or None
        Half-sine shocks of the base of ``duration``; sizes are peaks in ``c_r Ω²``.  ``None`` where none is required and the
        usual duration is not known in turns, or is too many, or where the state after a shock is more than places and speeds.
    duration : float
        Duration of the shocks, in ``1/Ω``.
    blade_loss : SmallestLoss or None
        Sizes are changes of the unbalance by the loss of a blade, as eccentricities in ``c_r``, at the worst phase.
    """

    kick: SmallestLoss
    shock: SmallestLoss | None
    duration: float
    blade_loss: SmallestLoss | None

    @property
    def known_scales(self) -> Scales | None:
        """Scales of the machine."""
        return self.kick.scales

    def items(self) -> tuple[tuple[Kind, SmallestLoss], ...]:
        """The kinds that were searched, by name."""
        found: dict[Kind, SmallestLoss | None] = {"kick": self.kick, "shock": self.shock, "blade_loss": self.blade_loss}
        return tuple((name, entry) for name, entry in found.items() if entry is not None)


def survives(rotor: Model, required: Required, tell: Reporter) -> Survives | None:
    """Search for the smallest disturbance of each kind that is lost; ``None`` where there is no levitation to come back to."""
    if not comes_to_rest(rotor):
        return None
    tell(0.0, "the smallest kick that is lost")
    kick = _reaching(rotor, VelocityKick(required.kick))
    shock, duration = None, _duration(rotor, required)
    if duration:
        tell(0.4, "the smallest shock that is lost")
        peak = required.shock.peak if required.shock else math.pi * required.kick / (2.0 * duration)
        shock = _reaching(rotor, BaseShock(peak, duration))
    tell(0.9, "the smallest loss of a blade that is lost")
    blade_loss, largest = None, largest_change(rotor)
    if largest > 0.0:
        blade_loss = smallest_loss(rotor, BladeLoss(largest))
    return Survives(kick, shock, duration, blade_loss)


def comes_to_rest(rotor: Model) -> bool:
    """Whether there is stable levitation inside the wall, to which a disturbed rotor can come back."""
    return rotor.system.rest_radius < 1.0 and rotor.system.decay > 0.0


def largest_change(rotor: Model) -> float:
    """Largest change of the unbalance, in ``c_r``, after which the rotor can levitate at any phase.

    Larger ones that add to the unbalance before lead to no levitation inside the wall; just below it motions do not settle.  Zero for a model whose
    unbalance is not known by one number.
    """
    system, before = rotor.system, unbalance_along(rotor) if "rho" in rotor.varied else None
    if before is None or system.mirrored is not None:
        return 0.0
    sags = np.abs(system.arrays["rows"] @ system.outer)
    shifts = np.abs(system.planes @ shift_by_unbalance(rotor))
    return min(float((BELOW * (1.0 - sags) / shifts).min()), DIMENSIONLESS_FIELDS["rho"].highest) - before


def _duration(rotor: Model, required: Required) -> float:
    """Duration of the shocks: that required, otherwise the usual one where times are known; else 0."""
    if required.shock:
        return required.shock.duration
    if rotor.system.unsteady is not None:
        return 0.0
    usual = SHOCK_DURATION / rotor.scales.time if rotor.scales else 0.0
    return usual if usual <= LONGEST_SHOCK else 0.0


def _reaching(rotor: Model, model: VelocityKick | BaseShock) -> SmallestLoss:
    """Search up to a multiple of a disturbance, and farther where that is proven to be harmless."""
    found = smallest_loss(rotor, _times(model, REACH))
    times = found.harmless / found.largest
    return found if times * REACH < 1.0 else smallest_loss(rotor, _times(model, REACH * REACH * times))


def _times(model: VelocityKick | BaseShock, factor: float) -> VelocityKick | BaseShock:
    """A kick or shock that many times as large."""
    if isinstance(model, VelocityKick):
        return VelocityKick(factor * model.fastest)
    return replace(model, peak=factor * model.peak)


def meets(found: SmallestLoss, size: float) -> bool:
    """Whether no disturbance up to a size was lost."""
    return size <= found.largest and (found.size is None or found.size > size)


def required_disturbances(required: Required, count: int, seed: int = 0) -> tuple[Sample, ...]:
    """Kinds of disturbances that a machine must survive, with the number of each in a sample of about ``count``.

    Kicks out of levitation, uniform over the disc of their velocities; starts elsewhere in the clearance, no faster than these
    in the fixed frame; shocks and losses of a blade where they are required.
    """
    kicks = round(KICKS_SHARE * count)
    models: list[tuple[Disturbance, int]] = [
        (VelocityKick(required.kick), kicks),
        (AnyState(required.kick), count - kicks),
    ]
    more = max(1, round(OF_ANOTHER_KIND * count))
    if required.shock:
        models.append((BaseShock(required.shock.peak, required.shock.duration), more))
    if required.blade_loss:
        models.append((BladeLoss(required.blade_loss, required.blade_loss_node), more))
    return tuple(Sample(model, number, seed) for model, number in models)
