"""Critical speeds: peaks of the response to unbalance, and their separation from the operating speeds."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from carom.closed_forms import SpeedResponse
from carom.rotors.synchronous import SynchronousResponse
from carom.studies.standards import Side, required_margin

HALF_POWER = math.sqrt(0.5)


@dataclass(frozen=True)
class Separation:
    """Separation of the operating speeds from the critical speed (API 617).

    Attributes
    ----------
    side : {"below", "inside", "above"}
        Where the critical speed lies: below the operating speeds, among them or above.
    actual, required : float
        Distance as a share of the nearest operating speed, and the least that is required.
    """

    side: Side
    actual: float
    required: float

    @classmethod
    def of(cls, critical: float, operating: tuple[float, float], factor: float | None) -> Separation:
        """Separation of a critical speed with this amplification factor, rad/s."""
        low, high = operating
        side: Side = "below" if critical < low else "above" if critical > high else "inside"
        actual = {"below": 1.0 - critical / low, "inside": 0.0, "above": critical / high - 1.0}[side]
        return cls(side, actual, required_margin(factor, side))

    @property
    def met(self) -> bool:
        """Whether the distance is large enough."""
        return self.required == 0.0 or (self.side != "inside" and self.actual >= self.required)


@dataclass(frozen=True)
class Critical:
    """A peak of the response to unbalance.

    Attributes
    ----------
    bearing : int
        Where, from 1: the magnetic bearing whose sensors measure it, or the touchdown bearing of a machine without sensors.
    speed : float
        rad/s.
    amplitude : float
        There, 0-to-peak, m.
    factor : float or None
        Amplification factor: speed over the width of the peak at 0.707 of its height (API 617); ``None`` of a peak that is flatter than that, or cut
        off by the range.
    separation : Separation
        From the operating speeds.
    """

    bearing: int
    speed: float
    amplitude: float
    factor: float | None
    separation: Separation


def exact_criticals(free: SpeedResponse, clearance: float, operating: tuple[float, float]) -> tuple[Critical, ...]:
    """The critical speed of a rotor with one mass, if there is one."""
    if free.critical_speed is None:
        return ()
    margin = Separation.of(free.critical_speed, operating, free.amplification_factor)
    return (Critical(1, free.critical_speed, clearance * free.peak, free.amplification_factor, margin),)


def criticals_of(found: SynchronousResponse, operating: tuple[float, float]) -> tuple[Critical, ...]:
    """Peaks of what the sensors measure, or of the whirl at the touchdown bearings of a machine without sensors, with the speeds at which they fall to 0.707."""
    measured = found.sensors if found.sensors.forward.shape[1] else found.touchdowns
    criticals = []
    for bearing, sizes in enumerate(measured.major.T, start=1):
        inner = (sizes[1:-1] > sizes[:-2]) & (sizes[1:-1] >= sizes[2:])
        for place in (np.flatnonzero(inner) + 1).tolist():
            factor, at = _factor(found.speeds, sizes, place), float(found.speeds[place])
            criticals.append(Critical(bearing, at, float(sizes[place]), factor, Separation.of(at, operating, factor)))
    return tuple(criticals)


def _factor(speeds: np.ndarray, sizes: np.ndarray, place: int) -> float | None:
    """Amplification factor of a peak; ``None`` if it does not fall to 0.707 of its height on both sides before it rises again."""
    half, ends = HALF_POWER * sizes[place], []
    for step in (-1, 1):
        here = place
        while 0 <= here + step < len(sizes) and sizes[here] > half:
            if sizes[here + step] > sizes[place]:
                return None
            here += step
        if sizes[here] > half:
            return None
        inside = here - step
        share = (half - sizes[here]) / (sizes[inside] - sizes[here])
        ends.append(float(speeds[here] + share * (speeds[inside] - speeds[here])))
    return float(speeds[place]) / (ends[1] - ends[0])
