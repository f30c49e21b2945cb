"""Load of a touchdown on its bearing: impacts, forces, and the heat of friction."""

from __future__ import annotations

from dataclasses import dataclass

from carom.outcome import Outcome
from carom.parameters import Scales
from carom.results import KINDS, Result

MEASURED = ("impulse", "force", "depth", "power", "heat", "restitution_loss", "contact_time", "lasting_power")
"""Loads that have a unit."""


@dataclass(frozen=True, eq=False, repr=False)
class TouchdownLoads(Result):
    """Loads of a motion at its contact plane, in units of the equations; ``si`` gives them in SI units.

    On a wall that gives way a contact, from entering the wall until leaving it, counts as an impact too.

    Attributes
    ----------
    outcome : Outcome
        Where the motion settled, or why it was stopped.
    impacts : int
        Number of impacts.
    impulse : float
        Largest normal impulse of an impact, ``m c_r Ω``; of a contact that lasts at the end, whose impulse grows on, it is left out.
    force : float
        Largest normal force in lasting contact, ``m c_r Ω²``.  If the motion goes on rolling, that of the planar rotor over a
        whole turn.
    depth : float
        Largest depth in the wall, ``c_r``; 0 if the wall is rigid.
    power : float
        Largest power of friction in lasting contact, ``m c_r² Ω³``.
    heat : float
        Work lost to friction, in impacts and in lasting contact, ``m c_r² Ω²``.
    restitution_loss : float
        Work lost along the normal, in impacts or in a wall that gives way, ``m c_r² Ω²``.
    contact_time : float
        Duration of lasting contact, ``1/Ω``.
    lasting_power : float
        Power of friction with which the motion goes on, ``m c_r² Ω³``: at its end in lasting contact, or averaged over the last
        impacts; 0 if it does not go on in contact.
    scales : Scales or None
    pressure : float or None
        Largest pressure of the most loaded ball on the race, in Pa (:func:`carom.closed_forms.ball_pressure`), if the touchdown bearing
        states its balls.
    """

    outcome: Outcome
    impacts: int
    impulse: float
    force: float
    depth: float
    power: float
    heat: float
    restitution_loss: float
    contact_time: float
    lasting_power: float
    scales: Scales | None = None
    pressure: float | None = None

    @property
    def goes_on(self) -> bool:
        """Whether the motion has settled in contact, so that impacts or heat have no end."""
        return self.outcome.settled and self.outcome is not Outcome.LEVITATED

    @property
    def goes_on_bouncing(self) -> bool:
        """Whether it has settled to bouncing, so that its impacts have no end."""
        return self.outcome in (Outcome.BOUNCING, Outcome.MIXED)

    def si(self) -> dict[str, float] | None:
        """Loads in SI units by name; ``None`` without scales."""
        if self.scales is None:
            return None
        si = {name: getattr(self, name) * getattr(self.scales, KINDS[name]) for name in MEASURED}
        return si if self.pressure is None else {**si, "pressure": self.pressure}
