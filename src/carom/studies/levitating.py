"""How a machine levitates: its whirls, its response to unbalance, and the sensitivity of its loops.

Of a flexible machine all this is of all its modes, without the vectors that only contact needs.  Of other rotors the whirls are those of the
exponents of the equations, and the sensitivity is known in closed form where magnetic bearings with a proportional and a derivative gain hold one
mass.  With ``F = -(ki P - ks) x - ki D x'`` of all bearings together, ``k = ki P - ks`` and ``c = ki D``, it is ``|S|² = (m y + ks)²/((k - m y)² + c² y)`` with
the square ``y`` of the frequency.  Its derivative vanishes at one ``y`` alone.  In words speeds are in rpm, frequencies in Hz, lengths in µm, in the fixed frame.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from operator import itemgetter

import numpy as np

from carom.base.results import Result, record
from carom.models import Rotor
from carom.parameters import Case
from carom.parameters.fields import RPM
from carom.parameters.formats import number
from carom.rotors import (
    Campbell,
    FlexibleMachine,
    Sensitivity,
    SynchronousResponse,
    WhirlMode,
    campbell,
    find_whirls,
    sensitivity,
    synchronous_response,
)
from carom.rotors.free_motions import StabilityLimit, stability_limits
from carom.rotors.loop_sensitivity import Collocation, collocations, zone_of
from carom.rotors.synchronous import whole_of
from carom.rotors.whirls import turns
from carom.studies.critical_speeds import Critical, known_speeds, response_curve, usual_range
from carom.studies.questions import Fact
from carom.studies.wording import listed, micrometres, rpm

SLOWEST, FASTEST, FOLLOWED = 0.05, 1.5, 40
"""Multiples of the speed of the machine between which whirls are followed, and the number of speeds."""
WHIRLS = 10
COLLOCATION = "bearing frequency_hz=whirl.frequency sense=whirl.sense node_between=opposed node_at=hardly"
SENSITIVITY_LIMITS = "ISO 14839-3: zone A up to 3 (9.5 dB), B up to 4 (12 dB), C up to 5 (14 dB), D above"
RULE = "By API 617 (API RP 684, SP6.8.2.1 and SP6.8.2.10) with the half-power width; its annex on magnetic bearings may differ."


@dataclass(frozen=True)
class LoopPeak:
    """Largest sensitivity of the loop of a magnetic bearing, which counts from 1, at a frequency in rad/s, and its zone of ISO 14839-3; ``None`` of an unstable loop."""

    bearing: int
    peak: float
    frequency: float
    zone: str | None

    @property
    def hertz(self) -> float:
        """The frequency in Hz."""
        return self.frequency / math.tau


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
    limits : tuple of StabilityLimit
        Speeds at which levitation begins or ceases to be stable.
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
    limits: tuple[StabilityLimit, ...] = ()
    sensitivity: Sensitivity | None = None
    collocations: tuple[Collocation, ...] = ()

    def document(self) -> dict[str, object]:
        """As plain data for JSON, in SI units; planes and bearings count from 1."""
        known, now = self.campbell, self.at_speed
        speeds = zip(known.speeds.tolist(), known.levitates.tolist(), strict=True) if known else ()
        found: dict[str, object] = {
            "whirls": [record(each, "frequency_hz=frequency sense damping_ratio") for each in self.whirls],
            "levitates_over_speed": [{"speed_rpm": speed / RPM, "levitates": holds} for speed, holds in speeds],
            "stability_limits": [
                {"speed_rpm": each.speed / RPM, "frequency_hz": each.hertz, "stable_below": each.stable_below}
                for each in self.limits
            ],
            "critical_speeds": [each.document() for each in self.criticals],
            "collocation": [
                record(each, COLLOCATION) | {"sensor": abs(each.sensor), "magnet": abs(each.magnet)}
                for each in self.collocations
            ],
            "sensitivity": [record(each, "bearing peak zone frequency_hz=hertz") for each in self.loops],
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
        response, criticals = response_curve(case, whirls, usual_range(rotor, whirls, run), run)
        found = replace(found, response=response, at_speed=synchronous_response(case, [speed]), criticals=criticals)
    if machine is None:
        return replace(found, loops=_loop_of_mass(case.si), limits=_limits_of(rotor))
    seen = sensitivity(machine) if machine.bearings else None
    low, high = known_speeds(rotor)
    speeds = np.linspace(max(SLOWEST * speed, low), min(FASTEST * speed, high), FOLLOWED).tolist()
    known = campbell(machine, speeds, WHIRLS)
    return replace(
        found,
        loops=() if seen is None else _loops(seen),
        machine=machine,
        campbell=known,
        limits=known.limits,
        sensitivity=seen,
        collocations=collocations(machine, found.whirls),
    )


def _limits_of(rotor: Rotor) -> tuple[StabilityLimit, ...]:
    """Speeds at which the levitation of a planar rotor with internal damping begins or ceases to be stable."""
    if rotor.scales is None or rotor.definition.rotating is None:
        return ()
    found = stability_limits(whole_of(rotor).equations, np.linspace(SLOWEST, FASTEST, FOLLOWED).tolist())
    unit = rotor.scales.speed
    return tuple(each._replace(speed=unit * each.speed, exponent=unit * each.exponent) for each in found)


def whirls_of(rotor: Rotor, count: int = WHIRLS) -> tuple[WhirlMode, ...]:
    """The slowest whirls of the levitating rotor: of a flexible machine of all its modes."""
    reduced = rotor.finite_elements
    if reduced is not None:
        return find_whirls(reduced.machine, count=count)
    exponents = (rotor.scales.speed if rotor.scales else 1.0) * (np.asarray(rotor.system.exponents) + 1j)
    still = np.ones(1, complex)
    slowest = exponents[np.argsort(np.abs(exponents.imag))]
    return tuple([WhirlMode(complex(each), still, 0.0 * still) for each in slowest if turns(each)][:count])


def _loop_of_mass(si: Mapping[str, float]) -> tuple[LoopPeak, ...]:
    """Largest sensitivity of equal magnetic bearings that hold one mass; nothing where their negative stiffness is not stated."""
    if "negative_stiffness" not in si:
        return ()
    mass, damping, stiffness = si["mass"], si["damping"], si["stiffness"]
    pull = si["magnetic_bearings"] * si["negative_stiffness"]

    def size(square: float) -> float:
        return (mass * square + pull) / math.hypot(stiffness - mass * square, damping * math.sqrt(square))

    top = 2.0 * mass * stiffness * (stiffness + pull) - pull * damping**2
    below = mass * (2.0 * mass * (stiffness + pull) - damping**2)
    sizes = {square: size(square) for square in ([max(top, 0.0) / below, 0.0] if below > 0.0 else [0.0])}
    square, peak = max({**sizes, math.inf: 1.0}.items(), key=itemgetter(1))
    return (LoopPeak(1, peak, math.sqrt(square), zone_of(peak)),)


def _loops(found: Sensitivity) -> tuple[LoopPeak, ...]:
    zones = found.zones or [None] * len(found.peaks)
    rows = zip(found.peaks.tolist(), found.peak_frequencies.tolist(), zones, strict=True)
    return tuple(LoopPeak(place, *row) for place, row in enumerate(rows, start=1))


def levitation_facts(found: Levitating) -> Iterator[Fact]:
    """Whirls at the speed of the machine, and of a flexible machine at others, its response to unbalance, and the peaks of that with their separation."""
    if found.whirls:
        text = whirl_words(found.speed, found.whirls, dimensionless=found.dimensionless)
        least = min(each.damping_ratio for each in found.whirls)
        yield Fact("Levitation", text, "Whirls", "closed form", {"damping_ratio": least})
    else:
        yield Fact("Levitation", "Every free motion decays within one revolution of its own.", "Whirls")
    if found.campbell is not None:
        yield Fact("Levitation", other_speeds_words(found.campbell), "Other speeds")
    for limit in found.limits:
        values = {"speed_si": limit.speed, "stable_below": limit.stable_below}
        yield Fact("Levitation", limit_words(limit), "Limit of speed", "closed form", values)
    if found.at_speed is not None and found.machine is not None:
        yield Fact("Levitation", response_words(found.at_speed), "Unbalance response")
    if found.machine is not None and found.response is None:
        yield Fact("Critical speeds", "Without unbalance there is no response and no critical speed.")
    for each in found.criticals:
        yield Fact("Critical speeds", each.words, values={"speed_si": each.speed, "met": each.separation.met})
    if found.response is not None:
        low, high = (rpm(found.response.speeds[end]) for end in (0, -1))
        none = "" if found.criticals else "The response has no peak. "
        yield Fact(
            "Critical speeds", f"{none}Searched from {low} to {high}. {RULE if found.criticals else ''}".rstrip()
        )


def whirl_words(speed: float, whirls: Sequence[WhirlMode], *, dimensionless: bool = False) -> str:
    """The least damped of the whirls at a speed, rad/s; without dimensions in units of the speed."""
    worst = min(whirls, key=lambda each: each.damping_ratio)
    kind = f"the {len(whirls)} lowest whirl modes" if worst.damping_ratio >= 0.0 else "all whirl modes"
    often = frequency_words(worst, dimensionless=dimensionless)
    return (
        f"At {'its speed Ω' if dimensionless else rpm(speed)}, the least damped of {kind} is {worst.sense} at {often}, with a "
        f"damping ratio of {number(worst.damping_ratio, 2)}."
    )


def frequency_words(whirl: WhirlMode, *, dimensionless: bool) -> str:
    """How often it goes round: in Hz, or in units of the speed of the shaft."""
    return f"{number(abs(whirl.exponent.imag), 3)} Ω" if dimensionless else f"{number(whirl.frequency, 3)} Hz"


def other_speeds_words(found: Campbell) -> str:
    """Whether a free motion grows at other speeds of the shaft, with the same gains and supports."""
    looked = f"{len(found.speeds)} speeds from {rpm(found.speeds[0])} to {rpm(found.speeds[-1])}"
    if found.levitates.all():
        return f"Levitation is stable at all {looked}."
    grows = found.speeds[~found.levitates]
    return f"Of {looked}, levitation is unstable at {len(grows)}, between {rpm(grows[0])} and {rpm(grows[-1])}: the rotor cannot levitate there."


def limit_words(limit: StabilityLimit) -> str:
    """Where levitation begins or ceases to be stable, and which motion grows beyond."""
    turning = f"whirl of {number(limit.hertz, 4)} Hz" if turns(np.array(limit.exponent)) else "displacement to one side"
    sense = "forward " if limit.exponent.imag > 0.0 else "backward "
    side, other = ("below", "faster") if limit.stable_below else ("above", "slower")
    motion = f"a {sense if limit.hertz and turning.startswith('w') else ''}{turning}"
    return f"Levitation is stable {side} {number(limit.speed / RPM, 6)} rpm: {other}, {motion} grows."


def response_words(at_speed: SynchronousResponse) -> str:
    """The whirl by unbalance at one speed."""
    places = {"touchdown bearing": at_speed.touchdowns, "the sensors of bearing": at_speed.sensors}
    words = [
        [f"{micrometres(each)} at {place} {count}" for count, each in enumerate(sizes.major[0], start=1)]
        for place, sizes in places.items()
    ]
    reached = ", and ".join(listed(each) for each in words if each)
    sizes = "semi-major axes" if at_speed.touchdowns.backward.any() else "radii"
    return f"Unbalance makes the rotor whirl with {sizes} of {reached}."


def bearing_facts(found: Levitating) -> Iterator[Fact]:
    """Sensitivity of the loops, and whirls of which a node lies at a bearing."""
    if any(each.zone is None for each in found.loops):
        text = "No sensitivity is stated for an unstable loop: it measures how far a stable loop is from instability."
        yield Fact("Magnetic bearings", text, "Sensitivity")
    elif found.loops:
        shown = listed([f"{_peak(each)}, zone {each.zone}, of bearing {each.bearing}" for each in found.loops])
        yield Fact("Magnetic bearings", f"Largest sensitivity: {shown} ({SENSITIVITY_LIMITS}).", "Sensitivity")
    texts = []
    for each in (each for each in found.collocations if each.opposed or each.hardly):
        whirl = each.whirl
        often, ratio = number(whirl.frequency, 3), number(whirl.damping_ratio, 2)
        name = f"{often} Hz {whirl.sense} whirl mode (damping ratio {ratio})"
        what = "at its sensors" if abs(each.sensor) <= abs(each.magnet) else "at its actuator"
        text = f"Magnetic bearing {each.bearing}: the {name} has a node {what}, so the bearing cannot damp it."
        if each.opposed:
            text = f"Magnetic bearing {each.bearing}: the {name} has a node between sensors and actuator. They move in antiphase, so derivative action destabilises this mode."
        texts.append(text)
    if found.collocations:
        texts = texts or [f"None of the {len(found.whirls)} lowest whirl modes has a node between sensor and actuator."]
    yield from (Fact("Magnetic bearings", text, "Non-collocation") for text in texts)


def _peak(loop: LoopPeak) -> str:
    at = f" at {number(loop.hertz, 3)} Hz" if loop.frequency < math.inf else ", at high frequencies"
    return f"{number(loop.peak, 3)} ({number(20.0 * math.log10(loop.peak), 3)} dB){at}"
