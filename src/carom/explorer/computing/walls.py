"""Loads of contact of a rotor: impulses at a rigid wall, forces and depths in a compliant one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.models import Rotor
from carom.motions import ContactLog
from carom.motions.kinematics import is_compliant
from carom.parameters import LoadLimits, Scales
from carom.parameters.formats import number
from carom.studies import Wording


def peak_loads(log: ContactLog) -> np.ndarray:
    """How hard each contact is: normal impulse of an impact in ``m c_r Ω``, or peak force in ``m c_r Ω²``."""
    return np.where(log.is_impact, log.normal_impulse, log.peak_force)


def hardest_load(log: ContactLog) -> float:
    """The hardest of them, a contact in which the motion begins among them; 0 without any."""
    return float(peak_loads(log).max(initial=0.0))


@dataclass(frozen=True)
class ContactWords:
    """What the page calls contacts with a wall, and the load that it tells of them.

    Attributes
    ----------
    compliant : bool
        Whether forces have peaks there, and the rotor goes in; a rigid wall gives impulses.
    noun, one : str
        A contact, in a count and with its article.
    title, section, shaded : str
        Heading of the hardest impact, what the figure of all shows, and what is shaded over time.
    """

    compliant: bool
    noun: str
    one: str
    title: str
    section: str
    shaded: str

    def load(self, hardest: float, scales: Scales | None) -> str:
        """Write a load with its unit."""
        return Wording(scales).force(hardest) if self.compliant else Wording(scales).impulse(hardest)

    def stated(self, log: ContactLog) -> str:
        """The load of a motion in words."""
        load = self.load(hardest_load(log), log.scales)
        if not self.compliant:
            return f"hardest impulse {load}"
        deepest = float(log.deepest.max(initial=0.0))
        depth = f"{Wording(log.scales).length(deepest)}, {number(100.0 * deepest, 2)} % of the clearance"
        return f"largest force {load}, largest depth {depth}"

    def beside(self, hardest: float, limits: LoadLimits, scales: Scales | None) -> str:
        """What follows the hardest impact of many motions: whether a limit of the force is kept."""
        if not self.compliant or limits.force is None or scales is None:
            return ""
        kept = "kept" if hardest * scales.force <= limits.force else "exceeded"
        return f"; limit {LoadLimits.format('force', limits.force)}: {kept}"


RIGID = ContactWords(
    False,
    "impact",
    "an impact",
    "hardest impulse",
    "Angle and radial speed at each impact.",
    "lasting contact",
)
COMPLIANT = ContactWords(
    True,
    "contact",
    "contact",
    "largest force",
    "Angle and radial speed on entering it.",
    "contact",
)


def wall_at(rotor: Rotor, place: int) -> ContactWords:
    """What the page says of a touchdown bearing of a rotor."""
    return COMPLIANT if is_compliant(rotor.system, place) else RIGID
