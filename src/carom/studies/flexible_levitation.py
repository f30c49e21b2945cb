"""How a flexible machine levitates: its whirls, its response to unbalance, and the sensitivity of its loops; from all its modes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from carom.results import Result
from carom.rotors import (
    Campbell,
    FlexibleMachine,
    FlexibleResponse,
    Sensitivity,
    Whirl,
    campbell,
    find_whirls,
    sensitivity,
    unbalance_response,
)
from carom.rotors.collocation import Collocation, collocations
from carom.studies.response_data import Separation
from carom.studies.standards import Side, required_margin

SLOWEST, FASTEST = 0.05, 1.5
"""Multiples of the speed of the machine between which the response is computed and whirls are followed."""
SPEEDS, FOLLOWED = 300, 40
"""Number of speeds of the response, and of those at which whirls are followed."""
NARROW = 0.2
"""Damping ratio below which the response is computed densely about a whirl."""
WHIRLS = 10
HALF_POWER = math.sqrt(0.5)


@dataclass(frozen=True)
class Critical:
    """A peak of the response to unbalance, as the sensors of a magnetic bearing measure it.

    Attributes
    ----------
    bearing : int
        From 1.
    speed : float
        rad/s.
    amplitude : float
        Radius of the whirl that is measured there, m.
    factor : float or None
        Amplification factor: speed over the width of the peak at 0.707 of its height (API 617); ``None`` of a peak that is flatter than that, or cut
        off by the range.
    separation : Separation
        Of the speed of the machine.
    """

    bearing: int
    speed: float
    amplitude: float
    factor: float | None
    separation: Separation


@dataclass(frozen=True, eq=False, repr=False)
class FlexibleLevitation(Result):
    """How a flexible machine levitates without contact.

    Attributes
    ----------
    machine : FlexibleMachine
    whirls : tuple of Whirl
        The slowest ones at the speed of the machine.
    campbell : Campbell
    response : FlexibleResponse or None
        ``None`` without an unbalance.
    at_speed : FlexibleResponse or None
        The same at the speed of the machine.
    criticals : tuple of Critical
    sensitivity : Sensitivity or None
        ``None`` without a magnetic bearing.
    collocations : tuple of Collocation
    """

    machine: FlexibleMachine
    whirls: tuple[Whirl, ...]
    campbell: Campbell
    response: FlexibleResponse | None
    at_speed: FlexibleResponse | None
    criticals: tuple[Critical, ...]
    sensitivity: Sensitivity | None
    collocations: tuple[Collocation, ...]

    @property
    def least_damped(self) -> Whirl:
        """The whirl with the smallest damping ratio of those listed."""
        return min(self.whirls, key=lambda each: each.damping_ratio)

    @property
    def met(self) -> bool:
        """Whether every separation that API 617 requires is kept."""
        return all(each.separation.met for each in self.criticals)

    def document(self) -> dict[str, Any]:
        """As plain data for JSON, in SI units; planes and bearings count from 1."""
        found: dict[str, Any] = {
            "whirls": [
                {"frequency_hz": each.frequency, "sense": each.sense, "damping_ratio": each.damping_ratio}
                for each in self.whirls
            ],
            "levitates_over_speed": [
                {"speed_rpm": speed * 30.0 / math.pi, "levitates": bool(holds)}
                for speed, holds in zip(self.campbell.speeds.tolist(), self.campbell.levitates, strict=True)
            ],
            "critical_speeds": [
                {
                    "bearing": each.bearing,
                    "speed_rpm": each.speed * 30.0 / math.pi,
                    "amplitude_si": each.amplitude,
                    "amplification_factor": each.factor,
                    "side": each.separation.side,
                    "separation": each.separation.actual,
                    "required": each.separation.required,
                    "met": each.separation.met,
                }
                for each in self.criticals
            ],
            "collocation": [
                {
                    "bearing": each.bearing,
                    "frequency_hz": each.whirl.frequency,
                    "sense": each.whirl.sense,
                    "sensor": abs(each.sensor),
                    "magnet": abs(each.magnet),
                    "node_between": each.opposed,
                    "node_at": each.hardly,
                }
                for each in self.collocations
            ],
        }
        if self.at_speed is not None:
            found["unbalance_response"] = {
                "touchdowns_si": self.at_speed.touchdown_ellipses.major[0].tolist(),
                "sensors_si": self.at_speed.sensor_ellipses.major[0].tolist(),
                "touchdowns_minor_si": self.at_speed.touchdown_ellipses.minor[0].tolist(),
                "currents_a": self.at_speed.current_ellipses.major[0].tolist(),
                "zone": self.at_speed.zones[0],
            }
        if self.sensitivity is not None:
            count = len(self.sensitivity.peaks)
            found["sensitivity"] = [
                {"bearing": number, "peak": float(peak), "frequency_hz": float(at) / (2.0 * math.pi), "zone": zone}
                for number, (peak, at, zone) in enumerate(
                    zip(
                        self.sensitivity.peaks,
                        self.sensitivity.peak_frequencies,
                        self.sensitivity.zones or [None] * count,
                        strict=True,
                    ),
                    start=1,
                )
            ]
        return found


def levitation_of_machine(machine: FlexibleMachine) -> FlexibleLevitation:
    """Compute how a flexible machine levitates."""
    speed, whirls = machine.speed, find_whirls(machine, count=WHIRLS)
    response = at_speed = None
    if machine.unbalances:
        narrow = find_whirls(machine, count=4 * WHIRLS)
        response = unbalance_response(machine, speeds_of_response(machine, narrow).tolist())
        at_speed = unbalance_response(machine, [speed])
    return FlexibleLevitation(
        machine=machine,
        whirls=whirls,
        campbell=campbell(machine, np.linspace(SLOWEST * speed, FASTEST * speed, FOLLOWED).tolist(), WHIRLS),
        response=response,
        at_speed=at_speed,
        criticals=() if response is None else _criticals(response),
        sensitivity=sensitivity(machine) if machine.bearings else None,
        collocations=collocations(machine, whirls),
    )


def speeds_of_response(machine: FlexibleMachine, whirls: Sequence[Whirl], top: float | None = None) -> np.ndarray:
    """Speeds of the response, rad/s: evenly up to the top, and densely about the frequencies of forward whirls, whose peaks may be narrow.

    Supports that act differently in two directions let unbalance excite backward whirls too.
    """
    low, high = SLOWEST * machine.speed, FASTEST * machine.speed if top is None else top
    narrow = []
    for whirl in whirls:
        excited = whirl.sense == "forward" or machine.whole.equations.mirrored
        if excited and whirl.damping_ratio < NARROW:
            width = abs(whirl.exponent.real)
            narrow.append(abs(whirl.exponent.imag) + width * np.linspace(-4.0, 4.0, 41))
    speeds = np.concatenate([np.linspace(low, high, SPEEDS), *narrow])
    return np.unique(speeds[(speeds >= low) & (speeds <= high)])


def _criticals(response: FlexibleResponse) -> tuple[Critical, ...]:
    """Peaks of what each sensor measures, with the speeds at which they fall to 0.707 of their height."""
    found = []
    for bearing, sizes in enumerate(response.sensor_ellipses.major.T, start=1):
        inner = (sizes[1:-1] > sizes[:-2]) & (sizes[1:-1] >= sizes[2:])
        for place in (np.flatnonzero(inner) + 1).tolist():
            factor = _factor(response.speeds, sizes, place)
            at = float(response.speeds[place])
            found.append(
                Critical(bearing, at, float(sizes[place]), factor, _separation(response.machine.speed, at, factor))
            )
    return tuple(found)


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


def _separation(speed: float, critical: float, factor: float | None) -> Separation:
    side: Side = "below" if critical < speed else "above" if critical > speed else "inside"
    return Separation(side, abs(critical / speed - 1.0), required_margin(factor, side))
