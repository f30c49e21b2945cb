"""Figure 2: levitation, an orbit near grazing, and an orbit with small bounces, in both frames."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.base.results import Result
from carom.models import Rotor, jeffcott
from carom.orbits.orbit import Orbit
from carom.orbits.single_impact import find_orbits
from carom.reproductions.mora2014.source import machine_at

TURNS = 2.0
"""Turns of the shaft over which levitation is drawn."""


@dataclass(frozen=True, eq=False, repr=False)
class ShownMotion(Result):
    """A periodic motion of the machine.

    Attributes
    ----------
    panel : {"a", "b", "c"}
    words : str
        Description of the motion.
    orbit : Orbit or None
        ``None`` for levitation, which is a point of the co-rotating frame.
    """

    panel: str
    gamma: float
    words: str
    rotor: Rotor
    orbit: Orbit | None

    @property
    def span(self) -> float:
        """Time drawn, in ``1/Ω``."""
        return TURNS * 2.0 * np.pi


def shown_motions() -> tuple[ShownMotion, ...]:
    """Compute levitation at ``γ = 0.3``, ``B1,d`` near grazing at 0.065 and ``B1,a`` near its birth at 0.1: panels a to c."""
    levitating = jeffcott(machine_at(0.3))
    shown = [ShownMotion("a", 0.3, "levitation", levitating, None)]
    for panel, gamma, name, words in (
        ("b", 0.065, "B1,d", "impacting orbit near grazing"),
        ("c", 0.1, "B1,a", "impacting orbit near the non-smooth Hopf bifurcation"),
    ):
        rotor = jeffcott(machine_at(gamma))
        shown.append(ShownMotion(panel, gamma, words, rotor, find_orbits(rotor)[name]))
    return tuple(shown)
