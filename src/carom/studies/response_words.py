"""What a response over speed says about a machine, in sentences."""

from __future__ import annotations

import numpy as np

from carom.outcome import STEADY_WORDS
from carom.parameters.fields import RPM
from carom.parameters.told import number
from carom.studies.response_data import ResponseData, Stretch
from carom.studies.standards import CRITICALLY_DAMPED, vibration_limit
from carom.studies.wording import listed

RUB = STEADY_WORDS["rub"]


def rpm(speed: float) -> str:
    """A speed given in rad/s, in rpm: ``1,759 rpm``."""
    return f"{number(speed / RPM, max(4, len(f'{speed / RPM:.0f}')))} rpm" if speed < np.inf else "any speed"


def micrometres(length: float) -> str:
    """A length given in m, in µm: ``134 µm``."""
    return f"{number(1e6 * length, 3 if length < 1e-3 else 4)} µm"


def sentences(response: ResponseData) -> tuple[str, ...]:
    """Present speed, critical speed, separation, and where the rotor touches."""
    found = [_present(response), _critical(response), _separation(response), _limit(response), *_contact(response)]
    return tuple(sentence for sentence in found if sentence)


def _present(response: ResponseData) -> str:
    speed, clearance = response.present, response.scales.clearance
    place = complex(response.contact_free.displacement(np.array(speed)))
    width, allowed = 2.0 * clearance * abs(place), float(vibration_limit(np.array(speed)))
    if not response.steady_at_present.contact_free:
        return (
            f"At {rpm(speed)}, the present speed, the unbalance would need a contact-free whirl of {micrometres(width)} peak to "
            f"peak, and the clearance allows {micrometres(2.0 * clearance)}: the rotor touches."
        )
    lag = number(np.degrees(-np.angle(place)), 3)
    over = width / allowed
    ratio = f", which is exceeded {number(over, 3)} times" if over > 1.0 else ""
    return (
        f"At {rpm(speed)}, the present speed, the rotor levitates with {micrometres(width)} peak to peak "
        f"({number(abs(place), 3)} of the clearance: zone {response.zone_at(speed)} of ISO 14839-2), {lag}° behind the unbalance. "
        f"API 617 allows {micrometres(allowed)} there{ratio}."
    )


def _critical(response: ResponseData) -> str:
    free = response.contact_free
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


def _separation(response: ResponseData) -> str:
    margin, factor = response.separation, response.contact_free.amplification_factor
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
        if free:
            found.append(f"No stable {RUB} exists there {_from_to(free)}: the rotor bounces or whirls backward.")
    both = [stretch for stretch in stretches if stretch.what.contact_free and stretch.what.stable_rubs]
    if both:
        found.append(
            f"Levitation and a stable {RUB} are both possible {_from_to(both)}: which of them the rotor takes "
            "depends on how it came there."
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
