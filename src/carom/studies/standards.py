"""Limits of vibration of rotors from standards: what they state, and what is assumed of them here.

*API 617* (axial and centrifugal compressors; the rules for lateral analysis are explained in API RP 684).  Amplification
factor: speed of the peak of the response over the width of the peak at 0.707 of its height.  Below 2.5 the response counts
as critically damped and no separation is required.  Otherwise a critical speed below the operating speeds keeps a distance
of ``17(1 − 1/(AF − 1.5))`` %, at most 16 %, of the lowest of them, one above them ``10 + 17(1 − 1/(AF − 1.5))`` %, at most
26 %, of the highest.  Shaft vibration at speed: ``25.4 µm √(12000 rpm/N)`` peak to peak (``√(12000/N)`` mil), at most 25.4 µm.
The standard applies this to the vibration that is measured beside the bearings at the maximum continuous speed; here it is
compared with the motion of the calculated unbalance response at each speed.  Paragraphs: the factor is SP6.8.2.1 of API RP 684, the separation
SP6.8.2.10, the vibration SP6.8.2.11, which is 4.8.2.11 of API 617; numbers as the report of the program ROSS cites them, since the standard was not at hand.

*ISO 14839-2* (rotors on active magnetic bearings): zones A to D of the largest displacement of the rotor from the centre of
the clearance, with limits of 0.3, 0.4 and 0.5 of the smallest radial clearance.  Here the clearance of the touchdown bearing is
taken as the smallest, and the displacement is that of the static sag and of the whirl from unbalance together.  The limits are those of
the machine file (:class:`~carom.parameters.Zones`).
"""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

Side = Literal["below", "inside", "above"]

LARGEST = 25.4e-6
"""Largest shaft vibration that API 617 allows, m peak to peak."""
FULL_SPEED = 12_000.0 * math.pi / 30.0
"""Speed in rad/s beyond which less is allowed."""
CRITICALLY_DAMPED = 2.5
"""Amplification factor below which no separation is required."""

ASSUMPTIONS = (
    "Amplification factor: critical speed over the width of the peak at 0.707 (1/√2) of its height (API RP 684, SP6.8.2.1); separation by SP6.8.2.10.",
    "API 617 limit (4.8.2.11): 25.4 µm √(12000 rpm/N) peak to peak, at most 25.4 µm, compared with the calculated response at each speed.",
    "Editions of API 617, and its annex on magnetic bearings, may state other limits.",
    "Zones of ISO 14839-2: sag and whirl together, as a share of the smallest radial clearance, assumed to be that of the touchdown bearing.",
    "Mass, damping, stiffness, eccentricity, friction and restitution are held constant over speed.",
)
"""What is taken from the standards, and what is assumed."""


def vibration_limit(speeds: np.ndarray) -> np.ndarray:
    """Largest shaft vibration of API 617 at speeds in rad/s, in m peak to peak."""
    return np.asarray(LARGEST * np.minimum(1.0, np.sqrt(FULL_SPEED / np.asarray(speeds, float))))


def required_margin(factor: float | None, side: Side) -> float:
    """Separation that API 617 requires of a critical speed on one side of the operating speeds, as a share of them.

    The amplification factor is ``None`` if the peak is critically damped.  For a critical speed inside the operating
    speeds the separation of one above them is returned, which it does not keep.
    """
    if factor is None or factor < CRITICALLY_DAMPED:
        return 0.0
    share = 0.17 * (1.0 - 1.0 / (factor - 1.5))
    return min(0.16, share) if side == "below" else min(0.26, 0.10 + share)
