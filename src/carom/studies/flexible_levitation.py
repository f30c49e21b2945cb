"""How a flexible machine levitates: its whirls, its response to unbalance, and the sensitivity of its loops; from all its modes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from carom.closed_forms import SynchronousResponse, synchronous_response
from carom.results import Result
from carom.rotors import (
    Campbell,
    FlexibleMachine,
    Sensitivity,
    Whirl,
    campbell,
    find_whirls,
    sensitivity,
)
from carom.rotors.collocation import Collocation, collocations
from carom.studies.critical_speeds import Critical, criticals_of

SLOWEST, FASTEST = 0.05, 1.5
"""Multiples of the speed of the machine between which the response is computed and whirls are followed."""
SPEEDS, FOLLOWED = 300, 40
"""Number of speeds of the response, and of those at which whirls are followed."""
NARROW = 0.2
"""Damping ratio below which the response is computed densely about a whirl."""
WHIRLS = 10


@dataclass(frozen=True, eq=False, repr=False)
class FlexibleLevitation(Result):
    """How a flexible machine levitates without contact.

    Attributes
    ----------
    machine : FlexibleMachine
    whirls : tuple of Whirl
        The slowest ones at the speed of the machine.
    campbell : Campbell
    response : SynchronousResponse or None
        ``None`` without an unbalance.
    at_speed : SynchronousResponse or None
        The same at the speed of the machine.
    criticals : tuple of Critical
    sensitivity : Sensitivity or None
        ``None`` without a magnetic bearing.
    collocations : tuple of Collocation
    """

    machine: FlexibleMachine
    whirls: tuple[Whirl, ...]
    campbell: Campbell
    response: SynchronousResponse | None
    at_speed: SynchronousResponse | None
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
                "touchdowns_si": self.at_speed.touchdowns.major[0].tolist(),
                "sensors_si": self.at_speed.sensors.major[0].tolist(),
                "touchdowns_minor_si": self.at_speed.touchdowns.minor[0].tolist(),
                "currents_a": self.at_speed.currents.major[0].tolist(),
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
        speeds = speeds_of_response(machine, narrow, (SLOWEST * speed, FASTEST * speed))
        response = synchronous_response(machine, speeds.tolist())
        at_speed = synchronous_response(machine, [speed])
    return FlexibleLevitation(
        machine=machine,
        whirls=whirls,
        campbell=campbell(machine, np.linspace(SLOWEST * speed, FASTEST * speed, FOLLOWED).tolist(), WHIRLS),
        response=response,
        at_speed=at_speed,
        criticals=() if response is None else criticals_of(response, (speed, speed)),
        sensitivity=sensitivity(machine) if machine.bearings else None,
        collocations=collocations(machine, whirls),
    )


def speeds_of_response(machine: FlexibleMachine, whirls: Sequence[Whirl], interval: tuple[float, float]) -> np.ndarray:
    """Speeds of the response, rad/s: evenly over the range, and densely about the frequencies of forward whirls, whose peaks may be narrow.

    Anisotropic supports let unbalance excite backward whirls too.
    """
    low, high = interval
    narrow = []
    for whirl in whirls:
        excited = whirl.sense == "forward" or machine.whole.equations.mirrored
        if excited and whirl.damping_ratio < NARROW:
            width = abs(whirl.exponent.real)
            narrow.append(abs(whirl.exponent.imag) + width * np.linspace(-4.0, 4.0, 41))
    speeds = np.concatenate([np.linspace(low, high, SPEEDS), *narrow])
    return np.unique(speeds[(speeds >= low) & (speeds <= high)])
