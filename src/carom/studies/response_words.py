"""What a response over speed says about a machine, in sentences."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from carom.base.outcome import STEADY_WORDS
from carom.parameters.fields import RPM
from carom.parameters.formats import number
from carom.studies.critical_speeds import Critical
from carom.studies.response_data import ResponseData, SpeedStretch, Steady
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
    """Present speed, critical speeds with their separation, limits, and where the rotor touches."""
    place = "sensors of magnetic bearing" if response.whirl.sensors.forward.shape[1] else "touchdown bearing"
    peaks = [f"Critical speed: {critical_words(each, response.operating, place)}" for each in response.criticals]
    if not peaks:
        peaks = [f"The response has no peak between {rpm(response.interval[0])} and {rpm(response.interval[1])}."]
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


def critical_words(critical: Critical, operating: tuple[float, float], place: str) -> str:
    """A peak of a response with its separation (API 617); ``place`` is what its number counts."""
    margin, factor = critical.separation, critical.factor
    if factor == math.inf:
        return f"{rpm(critical.speed)}; without damping the amplification factor is infinite."
    at = f"{rpm(critical.speed)}, {micrometres(critical.amplitude)} 0-to-peak at {place} {critical.bearing}"
    if factor is None:
        return f"{at}; critically damped peak: API 617 requires no separation margin."
    shown = f"amplification factor {number(factor, 3)}"
    if factor < CRITICALLY_DAMPED:
        return f"{at}; {shown}: critically damped: API 617 requires no separation margin."
    low, high = operating
    run = rpm(low if margin.side == "below" else high)
    where = f"{number(100.0 * margin.actual, 3)} % {margin.side} {run}" if margin.side != "inside" else f"at {run}"
    return f"{at}; {shown}, {where}, required {number(100.0 * margin.required, 3)} %: {'met' if margin.met else 'not met'}."


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
    """Where it touches, and which motions in contact are possible."""

    def where(holds: Callable[[Steady], Any]) -> str:
        return _from_to([stretch for stretch in response.stretches if holds(stretch.what)])

    said = [
        (
            where(lambda it: not it.contact_free),
            "No levitation is possible {}: the response calculated there is virtual.",
        ),
        (
            where(lambda it: not it.contact_free and it.stable_rubs),
            f"In contact, a stable {RUB} can hold the rotor {{}}.",
        ),
        (
            where(lambda it: not it.contact_free and it.stable_rubs == 0),
            f"No stable {RUB} exists there {{}}: the rotor bounces or whirls backward.",
        ),
        (
            where(lambda it: it.contact_free and it.stable_rubs),
            f"Levitation and a stable {RUB} are both possible {{}}: which of them the rotor takes depends on how it came there.",
        ),
        (where(lambda it: it.rolls), f"Once begun, {STEADY_WORDS['rolling']} lasts {{}}."),
    ]
    found = [sentence.format(speeds) for speeds, sentence in said if speeds]
    if not said[0][0]:
        found.insert(0, "Without a disturbance the rotor touches nowhere in this range.")
    if response.rubs is None:
        found.append(f"{RUB.capitalize()}s are not part of this: {_WHY_NO_RUBS}")
    elif not response.exact:
        found.append(f"{RUB.capitalize()}s were looked for at {len(response.rubs.speeds)} speeds; rolling was not.")
    return [*found, "Bouncing motions are not part of this: carom bifurcations --along speed finds them."]


def _from_to(stretches: list[SpeedStretch]) -> str:
    """Ranges of speeds in words, with neighbours joined; empty where there are none."""
    joined: list[tuple[float, float]] = []
    for stretch in stretches:
        if joined and joined[-1][1] == stretch.low:
            joined[-1] = joined[-1][0], stretch.high
        else:
            joined.append((stretch.low, stretch.high))
    return listed([f"from {rpm(low)} to {rpm(high)}" for low, high in joined]) if joined else ""
