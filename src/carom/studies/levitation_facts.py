"""How a machine levitates, in words: speeds in rpm, frequencies in Hz, lengths in µm, in the fixed frame."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from carom.parameters.formats import number
from carom.rotors import Campbell, WhirlMode
from carom.rotors.synchronous import SynchronousResponse
from carom.studies.facts import Fact
from carom.studies.levitating import Levitating, LoopPeak
from carom.studies.response_words import critical_words, micrometres, rpm
from carom.studies.wording import listed

SENSITIVITY_LIMITS = "ISO 14839-3: zone A up to 3 (9.5 dB), B up to 4 (12 dB), C up to 5 (14 dB), D above"
RULE = (
    "Amplification factors and separations are those of API 617 (API RP 684, SP6.8.2.1 and SP6.8.2.10), by the half-power width; its annex on magnetic "
    "bearings may state others."
)
_HERTZ = 2.0 * math.pi


def levitation_facts(found: Levitating) -> Iterator[Fact]:
    """Whirls at the speed of the machine, and of a flexible machine at others, and its response to unbalance."""
    worst = found.least_damped
    if worst is None:
        yield Fact("Levitation", "All that is free fades before it goes round once.", "Whirls")
    else:
        text = whirl_words(found.speed, found.whirls, dimensionless=found.dimensionless)
        yield Fact("Levitation", text, "Whirls", "closed form", {"damping_ratio": worst.damping_ratio})
    if found.campbell is not None:
        yield Fact("Levitation", other_speeds_words(found.campbell), "Other speeds")
    if found.at_speed is not None and found.machine is not None:
        yield Fact("Levitation", response_words(found.at_speed), "Unbalance response")


def whirl_words(speed: float, whirls: Sequence[WhirlMode], *, dimensionless: bool = False) -> str:
    """The least damped of the whirls at a speed, rad/s; without dimensions in units of the speed."""
    worst = min(whirls, key=lambda each: each.damping_ratio)
    kind = f"the {len(whirls)} slowest whirls" if worst.damping_ratio >= 0.0 else "all whirls"
    often = frequency_words(worst, dimensionless=dimensionless)
    return (
        f"At {'its speed Ω' if dimensionless else rpm(speed)} the least damped of {kind} is one of {often}, {worst.sense}, with a "
        f"damping ratio of {number(worst.damping_ratio, 2)}."
    )


def frequency_words(whirl: WhirlMode, *, dimensionless: bool) -> str:
    """How often it goes round: in Hz, or in units of the speed of the shaft."""
    return f"{number(abs(whirl.exponent.imag), 3)} Ω" if dimensionless else f"{number(whirl.frequency, 3)} Hz"


def other_speeds_words(found: Campbell) -> str:
    """Whether a free motion grows at other speeds of the shaft, with the same gains and supports."""
    looked = f"{len(found.speeds)} speeds from {rpm(found.speeds[0])} to {rpm(found.speeds[-1])}"
    if found.levitates.all():
        return f"No free motion of the machine grows at any of {looked}."
    grows = found.speeds[~found.levitates]
    return f"Of {looked}, a free motion grows at {len(grows)} between {rpm(grows[0])} and {rpm(grows[-1])}: the rotor does not levitate there."


def response_words(at_speed: SynchronousResponse) -> str:
    """The whirl by unbalance at one speed."""
    planes = [
        f"{micrometres(each)} at touchdown bearing {place}"
        for place, each in enumerate(at_speed.touchdowns.major[0], start=1)
    ]
    sensors = [
        f"{micrometres(each)} at the sensors of bearing {place}"
        for place, each in enumerate(at_speed.sensors.major[0], start=1)
    ]
    sizes = "longer half axes" if at_speed.touchdowns.backward.any() else "radii"
    reached = f"{listed(planes)}, and {listed(sensors)}" if sensors else listed(planes)
    return f"Its unbalance makes it whirl with {sizes} of {reached}."


def critical_speed_facts(found: Levitating) -> Iterator[Fact]:
    """Peaks of the response to unbalance, with their separation from the speed of the machine."""
    if found.machine is not None and found.response is None:
        yield Fact("Critical speeds", "Without an unbalance there is no response whose peaks could be stated.")
    for each in found.criticals:
        text = critical_words(each, (found.speed, found.speed), found.measured_at)
        yield Fact("Critical speeds", text, values={"speed_si": each.speed, "met": each.separation.met})
    if found.response is not None:
        low, high = (rpm(found.response.speeds[end]) for end in (0, -1))
        none = "" if found.criticals else "The response has no peak. "
        yield Fact("Critical speeds", f"{none}Searched from {low} to {high}.")
    if found.criticals:
        yield Fact("Critical speeds", RULE)


def bearing_facts(found: Levitating) -> Iterator[Fact]:
    """Sensitivity of the loops, and whirls of which a node lies at a bearing."""
    if any(each.zone is None for each in found.loops):
        text = "No sensitivity is stated of a loop that is unstable: it measures how far a stable one is from that."
        yield Fact("Magnetic bearings", text, "Sensitivity")
    elif found.loops:
        shown = listed([f"{_peak(each)}, zone {each.zone}, of bearing {each.bearing}" for each in found.loops])
        yield Fact("Magnetic bearings", f"Largest sensitivity: {shown} ({SENSITIVITY_LIMITS}).", "Sensitivity")
    doubtful = [each for each in found.collocations if each.opposed or each.hardly]
    for each in doubtful:
        name = f"the {each.whirl.sense} whirl of {number(each.whirl.frequency, 3)} Hz (damping ratio {number(each.whirl.damping_ratio, 2)})"
        what = "at its sensors" if abs(each.sensor) <= abs(each.magnet) else "at its actuator"
        text = f"Bearing {each.bearing}: {name} has a node {what}: the bearing cannot damp it."
        if each.opposed:
            text = f"A node of {name} lies between the sensors and the magnet of bearing {each.bearing}: they move against each other, so damping by the controller feeds it."
        yield Fact("Magnetic bearings", text, "Non-collocation")
    if found.collocations and not doubtful:
        text = f"In none of the {len(found.whirls)} slowest whirls a node lies between sensors and magnet."
        yield Fact("Magnetic bearings", text, "Non-collocation")


def _peak(loop: LoopPeak) -> str:
    decibels = number(20.0 * math.log10(loop.peak), 3)
    at = f" at {number(loop.frequency / _HERTZ, 3)} Hz" if loop.frequency < math.inf else ", at high frequencies"
    return f"{number(loop.peak, 3)} ({decibels} dB){at}"
