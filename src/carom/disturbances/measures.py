"""What is measured of where many disturbances end, declared once for gain maps and sweeps."""

from __future__ import annotations

from typing import NamedTuple

from carom.disturbances.coordinates import INSTANT


class Told(NamedTuple):
    """Unit and words of what is measured, and the property of the scales that converts it to SI units, if that is not 1."""

    unit: str
    words: str
    scale: str = ""


SHARES = {
    "recovered": Told("1", "share of the disturbances that comes back to levitation, by area"),
    "recovered_low": Told("1", "lower end of its 95 % confidence interval (of a grid: the share)"),
    "recovered_high": Told("1", "upper end of its 95 % confidence interval (of a grid: the share)"),
    "unresolved": Told("1", "share given up, or gone beyond the model, before it was known where it ends"),
}
SMALLEST = "smallest_unrecovered_kick"
KICKS = {
    SMALLEST: Told("c_r Omega", "smallest kick tried that does not come back", "velocity"),
    f"{SMALLEST}_angle": Told("rad", "its direction, from the real axis of the co-rotating frame"),
    f"{SMALLEST}_instant": Told("rad", INSTANT.words),
}
