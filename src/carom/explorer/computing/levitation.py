"""How a machine levitates, at once: whether it does, its slowest whirls, and its whirl by unbalance; then its response over the speed."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from carom.closed_forms import SynchronousResponse, synchronous_response
from carom.models import rotor_of
from carom.outcome import InputError
from carom.parameters import Case
from carom.parameters.told import number
from carom.progress import Reporter, ShowProgress
from carom.rotors.reduced_machine import UNHELD
from carom.studies import unbalance_response
from carom.studies.levitating import WHIRLS, levitating, whirls_of
from carom.studies.levitation_facts import bearing_facts, response_words, whirl_words, zone_words
from carom.studies.response_words import micrometres
from carom.studies.touchdown_facts import reduction_words

ALONG = "Along a motion the error may be larger: carom simulate and carom drop follow it again with twice as many vectors, and tell what that changes."
ALL = 1000
"""More whirls than any machine has."""
GROWS = -1e-9
"""Damping ratio below which a whirl grows, beyond rounding."""


@dataclass(frozen=True)
class WhirlRow:
    """A whirl as a row of a table; the damping ratio as a number too."""

    frequency: str
    sense: str
    damping: str
    ratio: float


@dataclass(frozen=True)
class Place:
    """The largest radius of the whirl by unbalance at one place, and its share of the clearance where there is one."""

    place: str
    radius: str
    share: str


@dataclass(frozen=True, eq=False)
class Levitation:
    """How a machine levitates, in words and rows.

    Attributes
    ----------
    lead, more : str
        Whether it does, and the whirl by unbalance with its zone.
    holds : bool
        Whether every free motion fades and the rotor stays clear of its touchdown bearings.
    damping, damping_remark, clearance, clearance_remark : str
        The smallest damping ratio, and the share of the clearance that sag and whirl take.
    whirls : tuple of WhirlRow
    places : tuple of Place
        None without scales.
    """

    lead: str
    more: str
    holds: bool
    damping: str
    damping_remark: str
    clearance: str
    clearance_remark: str
    whirls: tuple[WhirlRow, ...]
    places: tuple[Place, ...]


@dataclass(frozen=True, eq=False)
class ResponseCurves:
    """The whirl by unbalance over the speed, 0-to-peak, with what is said of it.

    Attributes
    ----------
    speeds : ndarray
        rad/s.
    touchdowns, sensors : ndarray, shape (m, P) and (m, B)
        m.
    clearances : ndarray, shape (P,)
        m.
    told : dict
        Sentences by their headings.
    """

    speeds: np.ndarray
    touchdowns: np.ndarray
    sensors: np.ndarray
    clearances: np.ndarray
    told: dict[str, tuple[str, ...]]


def levitation_of(case: Case) -> Levitation:
    """Compute how a machine levitates."""
    rotor, why = rotor_of(case), _why_unheld(case)
    every = whirls_of(rotor, ALL)
    listed = tuple(each for rank, each in enumerate(every) if rank < WHIRLS or each.damping_ratio < GROWS)
    worst = min(listed, key=lambda each: each.damping_ratio, default=None)
    share = math.inf if why else rotor.system.rest_radius
    zone = case.zones.zone(min(share, 1.0))
    at_speed = synchronous_response(case, [rotor.scales.speed]) if rotor.scales and not why else None
    more = []
    if worst is not None:
        speed = rotor.scales.speed if rotor.scales else 1.0
        more.append(whirl_words(speed, listed, dimensionless=rotor.scales is None))
    if at_speed is not None:
        more.append(response_words(at_speed))
    if share < math.inf:
        more.append(zone_words(share, zone))
    often = "" if worst is None else f"{number(worst.frequency, 3)} Hz" if rotor.scales else "the slowest"
    return Levitation(
        lead=_lead(why, share),
        more=" ".join(more),
        holds=not why and share < 1.0,
        damping="–" if worst is None else number(worst.damping_ratio, 3),
        damping_remark="all that is free fades" if worst is None else f"of the {worst.sense} whirl of {often}",
        clearance=f"{number(100.0 * share, 3)} %" if share < math.inf else "–",
        clearance_remark="a motion grows"
        if why
        else f"sag and whirl by unbalance at the worst touchdown bearing: zone {zone} of ISO 14839-2",
        whirls=tuple(
            WhirlRow(
                f"{number(each.frequency, 3)} Hz" if rotor.scales else f"{number(abs(each.exponent.imag), 3)} Ω",
                each.sense,
                number(each.damping_ratio, 3),
                each.damping_ratio,
            )
            for each in listed
        ),
        places=() if at_speed is None else _places(at_speed),
    )


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


def _places(at_speed: SynchronousResponse) -> tuple[Place, ...]:
    sizes = zip(at_speed.touchdowns.major[0], at_speed.clearances, strict=True)
    bearings = [
        Place(f"touchdown bearing {place}", micrometres(each), f"{number(100.0 * each / clearance, 3)} %")
        for place, (each, clearance) in enumerate(sizes, start=1)
    ]
    sensors = [
        Place(f"sensors of magnetic bearing {place}", micrometres(each), "")
        for place, each in enumerate(at_speed.sensors.major[0], start=1)
    ]
    return (*bearings, *sensors)


def response_of(case: Case, progress: ShowProgress = None) -> ResponseCurves:
    """Compute the response to unbalance, with sentences on it, on the loops of the bearings, and on the reduction.

    Refuse a rotor without scales, or one of which a free motion grows.
    """
    tell = Reporter.of(progress, "response to unbalance")
    rotor = rotor_of(case)
    if why := _why_unheld(case):
        raise InputError("machine", why, "one of which every free motion fades: there is no response else")
    found = unbalance_response(case)
    tell(0.5)
    loops = tuple(fact.text for fact in bearing_facts(levitating(case, rotor)))
    told = {"Response to unbalance": found.words, **({"Magnetic bearings": loops} if loops else {})}
    if rotor.finite_elements is not None:
        told["Accuracy"] = (reduction_words(rotor.finite_elements), ALONG)
    whirl = found.whirl
    return ResponseCurves(whirl.speeds, whirl.touchdowns.major, whirl.sensors.major, whirl.clearances, told)
