"""What is measured of where many disturbances end, declared once for gain maps and sweeps."""

from __future__ import annotations

from typing import NamedTuple

from carom.disturbances.coordinates import INSTANT


class Quantity(NamedTuple):
    """Unit and words of what is measured, and the property of the scales that converts it to SI units, if that is not 1."""

    unit: str
    words: str
    scale: str = ""


SHARES = {
    "recovered": Quantity("1", "share of the disturbances that comes back to levitation, by area"),
    "recovered_low": Quantity("1", "lower end of its 95 % confidence interval (of a grid: the share)"),
    "recovered_high": Quantity("1", "upper end of its 95 % confidence interval (of a grid: the share)"),
    "unresolved": Quantity("1", "share whose end is unknown: given up, or beyond the model"),
}
SMALLEST = "smallest_unrecovered_kick"
KICKS = {
    SMALLEST: Quantity("c_r Omega", "smallest kick tried that does not come back", "velocity"),
    f"{SMALLEST}_angle": Quantity("rad", "its direction, from the real axis of the co-rotating frame"),
    f"{SMALLEST}_instant": Quantity("rad", INSTANT.words),
}
