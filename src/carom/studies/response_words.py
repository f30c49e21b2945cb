"""What a response over speed says about a machine, in sentences."""

from __future__ import annotations

import numpy as np

from carom.closed_forms import SpeedResponse
from carom.outcome import STEADY_WORDS
from carom.parameters.fields import RPM
from carom.parameters.told import number
from carom.studies.critical_speeds import Critical
from carom.studies.response_data import ResponseData, Stretch
from carom.studies.standards import CRITICALLY_DAMPED, vibration_limit
from carom.studies.wording import listed

RUB = STEADY_WORDS["rub"]
_WHY_NO_RUBS = "they are found in one touchdown bearing, at constant speed, where nothing stands in the fixed frame; carom attractors finds on which motions disturbances end."


def rpm(speed: float) -> str:
    """A speed given in rad/s, in rpm: ``1,759 rpm``."""
    return f"{number(speed / RPM, max(4, len(f'{speed / RPM:.0f}')))} rpm" if speed < np.inf else "any speed"


def micrometres(length: float) -> str:
    """A length given in m, in µm: ``134 µm``."""
    return f"{number(1e6 * length, 3 if length < 1e-3 else 4)} µm"


def sentences(response: ResponseData) -> tuple[str, ...]:
    """Present speed, critical speed, separation, limits, and where the rotor touches."""
    free = response.contact_free
    peaks = _peaks(response) if free is None else [_critical(response, free), _separation(response, free)]
    found = [_present(response), *peaks, _limit(response), _saturation(response), *_contact(response)]
    return tuple(sentence for sentence in found if sentence)


def _present(response: ResponseData) -> str:
    speed, now = response.present, response.now
    sizes, allowed = now.touchdowns.major[0], float(vibration_limit(np.array(speed)))
    worst = response.worst
    width, several = 2.0 * float(sizes[worst]), len(sizes) > 1
    where = f" at touchdown bearing {worst + 1}" if several else ""
    sagging = f" beside a sag of {micrometres(float(now.sags[worst]))}" if now.sags[worst] else ""
    if not response.steady_at_present.contact_free:
        return (
            f"At {rpm(speed)}, the present speed, the unbalance would need a contact-free whirl of {micrometres(width)} peak to "
            f"peak{where}{sagging}, and the clearance allows {micrometres(2.0 * float(now.clearances[worst]))}: the rotor touches."
        )
    over, speeds = width / allowed, response.speeds
    inside = speeds[0] <= speed <= speeds[-1]
    lag = response.lags[int(np.abs(speeds - speed).argmin()), worst] if inside else now.lags[0, worst]
    ratio = f", which is exceeded {number(over, 3)} times" if over > 1.0 else ""
    return (
        f"At {rpm(speed)}, the present speed, the rotor levitates with {micrometres(width)} peak to peak{where}{sagging} "
        f"({number(float(now.reach[0, worst]), 3)} of the clearance: zone {response.zone_at(speed)} of ISO 14839-2), "
        f"{number(float(np.degrees(lag)), 3)}° behind the unbalance. API 617 allows {micrometres(allowed)} there{ratio}."
    )


def _peaks(response: ResponseData) -> list[str]:
    """Peaks of a rotor with many modes, as found between the speeds of the curves."""
    place = "sensors of magnetic bearing" if response.whirl.sensors.forward.shape[1] else "touchdown bearing"
    if not response.criticals:
        return [f"The response has no peak between {rpm(response.interval[0])} and {rpm(response.interval[1])}."]
    return [f"Critical speed: {critical_words(each, response.operating, place)}" for each in response.criticals]


def critical_words(critical: Critical, operating: tuple[float, float], place: str = "") -> str:
    """A peak of a response with its separation; ``place`` is what its number counts, by default magnetic bearings."""
    size = micrometres(critical.amplitude)
    at = (
        f"{rpm(critical.speed)}, {size} 0-to-peak at {place} {critical.bearing}"
        if place
        else f"Bearing {critical.bearing}: {rpm(critical.speed)}, {size} at its sensors"
    )
    margin, factor = critical.separation, critical.factor
    if factor is None:
        return f"{at}; the peak is too flat for an amplification factor, so none is required."
    told = f"amplification factor {number(factor, 3)}"
    if factor < CRITICALLY_DAMPED:
        return f"{at}; {told}: critically damped, so no separation is required."
    low, high = operating
    run = rpm(low if margin.side == "below" else high)
    where = f"{number(100.0 * margin.actual, 3)} % {margin.side} {run}" if margin.side != "inside" else f"at {run}"
    return (
        f"{at}; {told}, {where}, required {number(100.0 * margin.required, 3)} %: {'met' if margin.met else 'not met'}."
    )


def _critical(response: ResponseData, free: SpeedResponse) -> str:
    if free.critical_speed is None:
        return (
            f"There is no critical speed: with a damping ratio of {number(free.damping_ratio, 3)} the contact-free response has no "
            "peak."
        )
    text = f"Critical speed, at the peak of the contact-free response: {rpm(free.critical_speed)}"
    if free.peak > 1.0:
        size = f"{number(free.peak, 3)} times the clearance" if free.peak < np.inf else "infinite"
        text += f"; the calculated amplitude there is {size}, so the rotor touches before."
    else:
        width = 2.0 * response.scales.clearance * free.peak
        text += f", with {micrometres(width)} peak to peak ({number(free.peak, 3)} of the clearance)."
    if free.amplification_factor is None:
        return f"{text} The peak is too flat to have an amplification factor."
    if free.half_power is None or free.amplification_factor == np.inf:
        return f"{text} Without damping the amplification factor is infinite."
    below, above = map(rpm, free.half_power)
    return (
        f"{text} Amplification factor {number(free.amplification_factor, 3)}: the critical speed over the width of the peak at 0.707 "
        f"of its height, {below} to {above} (API 617)."
    )


def _separation(response: ResponseData, free: SpeedResponse) -> str:
    margin, factor = response.separation, free.amplification_factor
    if margin is None:
        return ""
    if factor is None or factor < CRITICALLY_DAMPED:
        return f"API 617 requires no separation: an amplification factor below {CRITICALLY_DAMPED:g} counts as critically damped."
    required = f"API 617 requires {number(100.0 * margin.required, 3)} %"
    low, high = response.operating
    run = rpm(low) if low == high else f"{rpm(low)} to {rpm(high)}"
    if margin.side == "inside":
        return f"The critical speed is an operating speed ({run}): {required} of separation, which is not met."
    end = low if margin.side == "below" else high
    return (
        f"The critical speed lies {number(100.0 * margin.actual, 3)} % of {rpm(end)} {margin.side} the operating speed{'' if low == high else 's'}; "
        f"{required}, which is {'met' if margin.met else 'not met'}."
    )


def _limit(response: ResponseData) -> str:
    over = [stretch for stretch in response.exceeds_api_617 if stretch.what]
    if not over:
        return "The limit of API 617 is nowhere exceeded in this range."
    if len(over) == len(response.exceeds_api_617) == 1:
        return "The limit of API 617 is exceeded at every speed of this range."
    return f"The limit of API 617 is exceeded {_from_to(over)}."


def _saturation(response: ResponseData) -> str:
    asking = response.saturating
    if not asking:
        return ""
    over = [stretch for stretch in asking if stretch.what]
    if over:
        return f"The magnetic bearings saturate {_from_to(over)}: there the rotor does not whirl as is calculated here."
    most = float(response.whirl.saturation.max())
    return f"The magnetic bearings saturate nowhere in this range: at most {number(100.0 * most, 3)} % of a limit is asked."


def _contact(response: ResponseData) -> list[str]:
    stretches = response.stretches
    touching = [stretch for stretch in stretches if not stretch.what.contact_free]
    if not touching:
        found = ["Without a disturbance the rotor touches nowhere in this range."]
    else:
        held = [stretch for stretch in touching if stretch.what.stable_rubs]
        free = [stretch for stretch in touching if not stretch.what.stable_rubs]
        found = [f"No levitation is possible {_from_to(touching)}: the response calculated there is virtual."]
        if held:
            found.append(f"In contact, a stable {RUB} can hold the rotor {_from_to(held)}.")
        if free and response.rubs is not None:
            found.append(f"No stable {RUB} exists there {_from_to(free)}: the rotor bounces or whirls backward.")
    both = [stretch for stretch in stretches if stretch.what.contact_free and stretch.what.stable_rubs]
    if both:
        found.append(
            f"Levitation and a stable {RUB} are both possible {_from_to(both)}: which of them the rotor takes "
            "depends on how it came there."
        )
    if response.rubs is None:
        found.append(f"{RUB.capitalize()}s are not part of this: {_WHY_NO_RUBS}")
    elif not response.exact:
        found.append(
            f"{RUB.capitalize()}s were looked for at {len(response.rubs.speeds)} speeds of this range; rolling was not."
        )
    rolls = [stretch for stretch in stretches if stretch.what.rolls]
    if rolls:
        found.append(f"Once begun, {STEADY_WORDS['rolling']} lasts {_from_to(rolls)}.")
    return [*found, "Bouncing motions are not part of this: carom bifurcations --along speed finds them."]


def _from_to(stretches: list[Stretch]) -> str:
    joined: list[tuple[float, float]] = []
    for stretch in stretches:
        if joined and joined[-1][1] == stretch.low:
            joined[-1] = joined[-1][0], stretch.high
        else:
            joined.append((stretch.low, stretch.high))
    return listed([f"from {rpm(low)} to {rpm(high)}" for low, high in joined])
