"""How a machine levitates: its whirls, its response to unbalance, and the sensitivity of its loops.

Of a flexible machine all this is of all its modes, without the vectors that only contact needs.  Of other rotors the whirls are those of the
exponents of the equations, and the sensitivity is known in closed form where magnetic bearings with a proportional and a derivative gain hold one
mass.  With ``F = -(ki P - ks) x - ki D x'`` of all bearings together, ``k = ki P - ks`` and ``c = ki D``, it is ``|S|² = (m y + ks)²/((k - m y)² + c² y)`` with
the square ``y`` of the frequency.  Its derivative vanishes at one ``y`` alone.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from carom.base.results import Result, record
from carom.models import Rotor
from carom.parameters import Case
from carom.parameters.fields import RPM
from carom.rotors import (
    Campbell,
    FlexibleMachine,
    Sensitivity,
    WhirlMode,
    campbell,
    find_whirls,
    sensitivity,
)
from carom.rotors.collocation import Collocation, collocations
from carom.rotors.loop_sensitivity import zone_of
from carom.rotors.synchronous import SynchronousResponse, synchronous_response
from carom.rotors.whirls import turns
from carom.studies.critical_speeds import Critical, response_curve, usual_range

SLOWEST, FASTEST, FOLLOWED = 0.05, 1.5, 40
"""Multiples of the speed of the machine between which whirls are followed, and the number of speeds."""
WHIRLS = 10
COLLOCATION = "bearing frequency_hz=whirl.frequency sense=whirl.sense node_between=opposed node_at=hardly"


@dataclass(frozen=True)
class LoopPeak:
    """Largest sensitivity of the loop of a magnetic bearing, which counts from 1, at a frequency in rad/s, and its zone of ISO 14839-3; ``None`` of an unstable loop."""

    bearing: int
    peak: float
    frequency: float
    zone: str | None


@dataclass(frozen=True, eq=False, repr=False)
class Levitating(Result):
    """How a machine levitates without contact.

    Attributes
    ----------
    speed : float
        rad/s.
    dimensionless : bool
        Whether no scales are known: then the speed is 1, and whirls are in units of it.
    whirls : tuple of WhirlMode
        The slowest ones at the speed of the machine; none where all that is free fades before it goes round.
    loops : tuple of LoopPeak
        One for each magnetic bearing whose loop is known; one for all equal bearings of one mass.
    response : SynchronousResponse or None
        ``None`` without an unbalance or scales.
    at_speed : SynchronousResponse or None
        The same at the speed of the machine.
    criticals : tuple of Critical
    machine : FlexibleMachine or None
        What follows is known of a flexible machine alone.
    campbell : Campbell or None
    sensitivity : Sensitivity or None
        ``None`` without a magnetic bearing too.
    collocations : tuple of Collocation
    """

    speed: float
    dimensionless: bool
    whirls: tuple[WhirlMode, ...]
    loops: tuple[LoopPeak, ...]
    response: SynchronousResponse | None = None
    at_speed: SynchronousResponse | None = None
    criticals: tuple[Critical, ...] = ()
    machine: FlexibleMachine | None = None
    campbell: Campbell | None = None
    sensitivity: Sensitivity | None = None
    collocations: tuple[Collocation, ...] = ()

    @property
    def least_damped(self) -> WhirlMode | None:
        """The whirl with the smallest damping ratio of those listed."""
        return min(self.whirls, key=lambda each: each.damping_ratio, default=None)

    @property
    def measured_at(self) -> str:
        """Where peaks of the response are measured."""
        sensors = self.response is not None and self.response.sensors.forward.shape[1]
        return "sensors of magnetic bearing" if sensors else "touchdown bearing"

    @property
    def met(self) -> bool:
        """Whether every separation that API 617 requires is kept."""
        return all(each.separation.met for each in self.criticals)

    def document(self) -> dict[str, Any]:
        """As plain data for JSON, in SI units; planes and bearings count from 1."""
        known, now = self.campbell, self.at_speed
        found: dict[str, Any] = {
            "whirls": [record(each, "frequency_hz=frequency sense damping_ratio") for each in self.whirls],
            "levitates_over_speed": [
                {"speed_rpm": speed / RPM, "levitates": bool(holds)}
                for speed, holds in (zip(known.speeds.tolist(), known.levitates, strict=True) if known else ())
            ],
            "critical_speeds": [each.document() for each in self.criticals],
            "collocation": [
                record(each, COLLOCATION) | {"sensor": abs(each.sensor), "magnet": abs(each.magnet)}
                for each in self.collocations
            ],
            "sensitivity": [
                record(each, "bearing peak zone") | {"frequency_hz": each.frequency / (2.0 * math.pi)}
                for each in self.loops
            ],
        }
        if now is not None:
            sizes = {"touchdowns_si": now.touchdowns.major, "sensors_si": now.sensors.major}
            sizes |= {"touchdowns_minor_si": now.touchdowns.minor, "currents_a": now.currents.major}
            response = {name: size[0].tolist() for name, size in sizes.items()}
            found["unbalance_response"] = response | {"zone": now.zones[0]}
        return found


def levitating(case: Case, rotor: Rotor) -> Levitating:
    """Compute how a machine levitates; of a flexible one from all its modes."""
    machine = rotor.finite_elements.machine if rotor.finite_elements else None
    speed, whirls = rotor.scales.speed if rotor.scales else 1.0, whirls_of(rotor, 4 * WHIRLS)
    found = Levitating(speed, rotor.scales is None, whirls[:WHIRLS], ())
    if rotor.scales and (rotor.value("rho") if machine is None else machine.unbalances):
        run = speed, speed
        response, criticals = response_curve(case, whirls, usual_range(whirls, run), run)
        found = replace(found, response=response, at_speed=synchronous_response(case, [speed]), criticals=criticals)
    if machine is None:
        loop = _loop_of_mass(case.si)
        return replace(found, loops=(loop,) if loop else ())
    seen, speeds = sensitivity(machine) if machine.bearings else None, np.linspace(SLOWEST, FASTEST, FOLLOWED) * speed
    return replace(
        found,
        loops=() if seen is None else _loops(seen),
        machine=machine,
        campbell=campbell(machine, speeds.tolist(), WHIRLS),
        sensitivity=seen,
        collocations=collocations(machine, found.whirls),
    )


def whirls_of(rotor: Rotor, count: int = WHIRLS) -> tuple[WhirlMode, ...]:
    """The slowest whirls of the levitating rotor: of a flexible machine of all its modes."""
    reduced = rotor.finite_elements
    if reduced is not None:
        return find_whirls(reduced.machine, count=count)
    exponents = (rotor.scales.speed if rotor.scales else 1.0) * (np.asarray(rotor.system.exponents) + 1j)
    still = np.ones(1, complex)
    slowest = exponents[np.argsort(np.abs(exponents.imag))]
    return tuple([WhirlMode(complex(each), still, 0.0 * still) for each in slowest if turns(each)][:count])


def _loop_of_mass(si: Mapping[str, float]) -> LoopPeak | None:
    """Largest sensitivity of equal magnetic bearings that hold one mass; ``None`` where their negative stiffness is not stated."""
    if "negative_stiffness" not in si:
        return None
    mass, damping, stiffness = si["mass"], si["damping"], si["stiffness"]
    pull = si["magnetic_bearings"] * si["negative_stiffness"]

    def size(square: float) -> float:
        return (mass * square + pull) / math.hypot(stiffness - mass * square, damping * math.sqrt(square))

    top = 2.0 * mass * stiffness * (stiffness + pull) - pull * damping**2
    below = mass * (2.0 * mass * (stiffness + pull) - damping**2)
    square = max(top, 0.0) / below if below > 0.0 else math.inf
    peak = size(square) if square < math.inf else 1.0
    if pull / stiffness > peak:
        square, peak = 0.0, pull / stiffness
    return LoopPeak(1, peak, math.sqrt(square), zone_of(peak))


def _loops(found: Sensitivity) -> tuple[LoopPeak, ...]:
    zones = found.zones or [None] * len(found.peaks)
    rows = zip(found.peaks.tolist(), found.peak_frequencies.tolist(), zones, strict=True)
    return tuple(LoopPeak(place, *row) for place, row in enumerate(rows, start=1))
