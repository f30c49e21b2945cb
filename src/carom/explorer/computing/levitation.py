"""How a machine levitates, at once: whether it does, its slowest whirls, and its whirl by unbalance; then its response over the speed."""

from __future__ import annotations

import math

from carom.base.outcome import InputError
from carom.base.progress import Reporter, ShowProgress
from carom.models import rotor_of
from carom.parameters import Case
from carom.parameters.fields import RPM
from carom.parameters.formats import number
from carom.rotors.reduced_machine import UNHELD
from carom.rotors.synchronous import SynchronousResponse, synchronous_response
from carom.studies import unbalance_response
from carom.studies.findings import reduction_words
from carom.studies.levitating import (
    WHIRLS,
    bearing_facts,
    frequency_words,
    levitating,
    response_words,
    whirl_words,
    whirls_of,
)
from carom.studies.wording import micrometres

ALONG = "Along a motion the error may be larger: carom simulate and carom drop follow it again with twice as many vectors, and tell what that changes."
ALL = 1000
"""More whirls than any machine has."""
GROWS = -1e-9
"""Damping ratio below which a whirl grows, beyond rounding."""


def levitation_of(case: Case) -> dict[str, object]:
    """How a machine levitates, in words and rows: whether it does (``lead``), its whirls, its whirl by unbalance with its zone (``more``), and its speed in rpm.

    It ``holds`` where every free motion fades and the rotor stays clear of its touchdown bearings.
    """
    rotor, why = rotor_of(case), _why_unheld(case)
    every = whirls_of(rotor, ALL)
    listed = tuple(each for rank, each in enumerate(every) if rank < WHIRLS or each.damping_ratio < GROWS)
    worst = min(listed, key=lambda each: each.damping_ratio, default=None)
    share, bare = math.inf if why else rotor.system.rest_radius, rotor.scales is None
    zone = f"zone {case.zones.zone(min(share, 1.0))} of ISO 14839-2"
    clearance = f"{number(100.0 * share, 3)} %" if share < math.inf else "–"
    at_speed = synchronous_response(case, [rotor.scales.speed]) if rotor.scales and not why else None
    more = []
    if worst is not None:
        more.append(whirl_words(rotor.scales.speed if rotor.scales else 1.0, listed, dimensionless=bare))
    if at_speed is not None:
        more.append(response_words(at_speed))
    if share < math.inf:
        more.append(f"With the static sag that is {clearance} of the clearance at the worst touchdown bearing: {zone}.")
    return {
        "lead": _lead(why, share),
        "more": " ".join(more),
        "holds": not why and share < 1.0,
        "damping": "–" if worst is None else number(worst.damping_ratio, 3),
        "damping_remark": "all that is free fades"
        if worst is None
        else f"of the {worst.sense} whirl of {frequency_words(worst, dimensionless=bare)}",
        "clearance": clearance,
        "clearance_remark": "a motion grows"
        if why
        else f"sag and whirl by unbalance at the worst touchdown bearing: {zone}",
        "whirls": [
            {
                "frequency": frequency_words(each, dimensionless=bare),
                "sense": each.sense,
                "damping": number(each.damping_ratio, 3),
                "ratio": each.damping_ratio,
            }
            for each in listed
        ],
        "places": [] if at_speed is None else _places(at_speed),
        "speed": rotor.scales.speed / RPM if rotor.scales else 1.0,
    }


def _why_unheld(case: Case) -> str:
    """Why a machine does not levitate, in words; empty where every free motion fades."""
    rotor = rotor_of(case)
    if rotor.finite_elements is None:
        return "" if rotor.system.decay >= 0.0 else "a free motion grows"
    try:
        _ = rotor.finite_elements.linear
    except InputError as problem:
        return str(problem.value).removeprefix("unstable: ") if problem.field == UNHELD else str(problem)
    return ""


def _lead(why: str, share: float) -> str:
    if why:
        return f"It does not levitate: {why}."
    if share >= 1.0:
        return "Cannot run without contact: its sag and whirl from unbalance would reach a touchdown bearing."
    return "It levitates: every free motion fades, and it stays clear of its touchdown bearings."


def _places(at_speed: SynchronousResponse) -> list[dict[str, str]]:
    """The largest radius of the whirl by unbalance at each bearing, and its share of the clearance where there is one."""
    sizes = zip(at_speed.touchdowns.major[0], at_speed.clearances, strict=True)
    shares = [(each, f"{number(100.0 * each / clearance, 3)} %") for each, clearance in sizes]
    places = {
        "touchdown bearing": shares,
        "sensors of magnetic bearing": [(each, "") for each in at_speed.sensors.major[0]],
    }
    return [
        {"place": f"{words} {place}", "radius": micrometres(each), "share": share}
        for words, rows in places.items()
        for place, (each, share) in enumerate(rows, start=1)
    ]


def response_of(case: Case, progress: ShowProgress = None) -> tuple[SynchronousResponse, dict[str, tuple[str, ...]]]:
    """Compute the response to unbalance, with sentences on it, on the loops of the bearings, and on the reduction, by their headings.

    Refuse a rotor without scales, or one of which a free motion grows.
    """
    tell = Reporter.of(progress, "response to unbalance")
    rotor = rotor_of(case)
    if why := _why_unheld(case):
        raise InputError("machine", why, "one of which every free motion fades: there is no response else")
    found = unbalance_response(case)
    tell(0.5)
    loops = tuple(fact.text for fact in bearing_facts(levitating(case, rotor)))
    shown = {"Response to unbalance": found.words, **({"Magnetic bearings": loops} if loops else {})}
    if rotor.finite_elements is not None:
        shown["Accuracy"] = (reduction_words(rotor.finite_elements), ALONG)
    return found.whirl, shown
