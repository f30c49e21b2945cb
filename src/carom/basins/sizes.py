"""Which kinds of disturbances have sizes, up to which size none of them can touch, and the bracket that a search for the smallest unrecovered one finds."""

from __future__ import annotations

import math
from dataclasses import dataclass

from carom.attractors.following import CONFIDENCE
from carom.base.outcome import Outcome
from carom.base.results import Result
from carom.closed_forms import contact_free_blade_loss, contact_free_kick, contact_free_shock
from carom.disturbances import BaseShock, BladeLoss, Coordinate, Disturbance, KickPlane, VelocityKick
from carom.models import Rotor
from carom.parameters import Scales

BESIDE_LOST = 1e-9
"""How far from the smallest unrecovered one, relative to its size, others are followed to see whether it does not come back for itself."""


def size_coordinate(model: Disturbance) -> Coordinate | None:
    """Size of a disturbance that varies by a size from 0 and a direction; of a loss of a blade the change.  ``None`` of others."""
    if isinstance(model, BladeLoss):
        return Coordinate("change", "change of the unbalance", 0.0, model.change, "unbalance", over_disc=True)
    return model.size if type(model) is KickPlane or model.size == model.coordinates[0] else None


def contact_free_size(rotor: Rotor, model: Disturbance) -> float:
    """Size up to which contact is proven to be impossible; nothing is proven of a subclass, which may start anywhere."""
    if type(model) is VelocityKick:
        return contact_free_kick(rotor)
    if isinstance(model, BladeLoss):
        return contact_free_blade_loss(rotor, model.node)
    return contact_free_shock(rotor, model.duration) if type(model) is BaseShock and model.pulses == 1 else 0.0


@dataclass(frozen=True, repr=False)
class SmallestUnrecovered(Result):
    """Bracket of the size at which disturbances begin not to come back.

    Attributes
    ----------
    kind : str
        Kind of the disturbance: ``"kick"``, ``"shock"``, ``"blade-loss"``, or that of
        another model; of a kick plane ``"kick"``.
    size : float or None
        Smallest unrecovered size found: change of velocity in ``c_r Ω``, peak acceleration in ``c_r Ω²``, change of the
        unbalance as an eccentricity in ``c_r``, or first coordinate of another model.  ``None`` where none was found.
    angle : float or None
        Its direction in rad.  For a kick or shock as in :mod:`carom.disturbances`; for the loss of a blade the phase of the
        change relative to the unbalance before it.
    instant : float or None
        Angle in rad by which the shaft has turned when it comes, since the co-rotating frame coincided with the fixed one; ``None`` where
        the instant does not matter.
    outcome : Outcome or None
        Outcome of the motion after it.
    recovered : float
        A smaller size in this direction, within the tolerance, that comes back.
    all_back : float or None
        Largest size up to which all starts tried came back: those of the search and ``fresh`` ones.  ``None`` where the
        smallest starts do not come back already.
    fresh : int
        Number of starts up to ``all_back`` that are independent of the search: ``drawn`` ones, and directions over a full turn at
        that size; where the instant matters each at one of its own.
    drawn : int
        How many of them were drawn uniformly over the area of the disc beyond the contact-free size.
    neighbours_lost, neighbours : int
        Of so many disturbances beside the smallest unrecovered one, up to ``beside`` of its size away in any direction, how many do not come back either.
        Fewer than all: beside a basin boundary of fine structure, where rounding decides.
    contact_free : float
        Size up to which contact is proven to be impossible in any direction; 0 where nothing is proven.
    largest : float
        Largest size searched.
    tolerance : float
        Relative width to which the smallest is bisected.
    tried : int
        Number of starts followed.
    complete : bool
        Whether the search came to its end.  Otherwise the budget of a study ended it (:mod:`carom.motions.budget`): smaller sizes may not
        come back, and ``all_back`` is that of the directions scanned alone.
    quantity : str
        Property of the scales by which sizes are converted to SI units.
    scales : Scales or None
        Those of the machine.
    """

    kind: str
    size: float | None
    angle: float | None
    instant: float | None
    outcome: Outcome | None
    recovered: float
    all_back: float | None
    fresh: int
    drawn: int
    contact_free: float
    largest: float
    tolerance: float
    tried: int
    quantity: str = ""
    scales: Scales | None = None
    neighbours_lost: int = 0
    neighbours: int = 0
    complete: bool = True

    @property
    def bracket(self) -> tuple[float | None, float | None]:
        """Both ends: up to where all came back, and where one did not."""
        return self.all_back, self.size

    @property
    def words(self) -> str:
        """The bracket in a line."""
        sizes = ("size", "all_back", "contact_free", "largest")
        shown = {name: self.line_of(name, getattr(self, name)) for name in sizes}
        up_to = f" up to {shown['largest']}" if self.complete else ""
        none = f"none{up_to} that does not come back"
        found = none if self.size is None else f"smallest that does not come back {shown['size']}"
        found += "" if self.instant is None else " at the worst instant of the turn"
        back = "" if self.all_back is None else f", all back up to {shown['all_back']}"
        found += f" ({self.sensitivity})" if self.sensitivity else ""
        ended = "" if self.complete else ", search not finished"
        return f"{found}{back}, cannot touch up to {shown['contact_free']}{ended}"

    def kind_of(self, name: str) -> str:
        """Sizes are of one kind."""
        sizes = ("size", "recovered", "all_back", "contact_free", "largest")
        return self.quantity if name in sizes else super().kind_of(name)

    @property
    def sensitivity(self) -> str:
        """How many of its neighbours come back in spite of it; empty if none does."""
        back = self.neighbours - self.neighbours_lost
        return f"sensitive: {back} of {self.neighbours} within {BESIDE_LOST:.0e} of it come back" if back else ""

    @property
    def share_below(self) -> float:
        """Share of the disturbances beyond the contact-free size and up to ``all_back``, by area, that may not come back: a bound at 95 %.

        ``1 − 0.05^{1/n}`` for ``n`` starts all of which come back (Clopper and Pearson, one-sided).
        """
        return -math.expm1(math.log(1.0 - CONFIDENCE) / self.drawn) if self.drawn else 1.0
