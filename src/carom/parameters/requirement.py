"""What a machine must survive."""

from __future__ import annotations

import math

from carom.parameters.scaling import Scales

GRAVITY = 9.80665
"""Standard acceleration of free fall, m/s²."""


def usual_kick(scales: Scales | None) -> float:
    """Return the kick that a rotor must survive where nothing is stated, in ``c_r Ω`` of the fixed frame.

    It is the speed of a fall through the diametral clearance, ``sqrt(4 g c_r)`` in m/s whatever the running speed; 1
    where the scales are not known.
    """
    return math.sqrt(4.0 * GRAVITY * scales.clearance) / scales.velocity if scales else 1.0
