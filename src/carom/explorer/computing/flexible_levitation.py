"""How a flexible machine levitates, at once: whether it does, its slowest whirls, and its whirl by unbalance; then more of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.closed_forms import SynchronousResponse, synchronous_response
from carom.outcome import InputError
from carom.parameters import Case
from carom.parameters.told import number
from carom.progress import Reporter, ShowProgress
from carom.rotors import ReducedMachine, Whirl, find_whirls
from carom.rotors.reduced_machine import UNHELD
from carom.studies.levitating import FASTEST, SLOWEST, WHIRLS, levitating_of_machine, speeds_of_response
from carom.studies.levitation_facts import (
    bearing_facts,
    critical_speed_facts,
    response_words,
    whirl_words,
    zone_words,
)
from carom.studies.response_words import micrometres
from carom.studies.touchdown_facts import reduction_words

ALONG = "Along a motion the error may be larger: carom simulate and carom drop follow it again with twice as many vectors, and tell what that changes."
ALL = 1000
"""More whirls than any machine has."""


@dataclass(frozen=True)
class WhirlRow:
    """A whirl as a row of a table; the damping ratio as a number too."""

    frequency: str
    sense: str
    damping: str
    ratio: float


@dataclass(frozen=True)
class Orbit:
    """The radius of the whirl by unbalance at one place, and its share of the clearance where there is one."""

    place: str
    radius: str
    share: str


@dataclass(frozen=True, eq=False)
class Curve:
    """The radius of the whirl by unbalance at one place, m, over the speed."""

    place: str
    radii: np.ndarray
    dashed: bool
    """Whether sensors measure it, and no wall is there."""


@dataclass(frozen=True, eq=False)
class Levitating:
    """How a machine levitates, in words and rows.

    Attributes
    ----------
    lead, more : str
        Whether it does, and the whirl by unbalance with its zone.
    stable : bool
        Whether every free motion fades.
    holds : bool
        Whether the rotor also stays clear of its touchdown bearings.
    damping, damping_remark, clearance, clearance_remark : str
        The smallest damping ratio, and the share of the clearance that sag and whirl take.
    whirls : tuple of WhirlRow
    orbits : tuple of Orbit
    speeds : ndarray
        Of the curves, rad/s.
    curves : tuple of Curve
        Empty without an unbalance or where a motion grows.
    walls : tuple of float
        Clearances, m, each once.
    """

    lead: str
    more: str
    stable: bool
    holds: bool
    damping: str
    damping_remark: str
    clearance: str
    clearance_remark: str
    whirls: tuple[WhirlRow, ...]
    orbits: tuple[Orbit, ...]
    speeds: np.ndarray
    curves: tuple[Curve, ...]
    walls: tuple[float, ...]


def levitating(case: Case, reduced: ReducedMachine, top: float) -> Levitating:
    """Compute how a machine levitates, with its response up to a speed in rad/s."""
    machine = reduced.machine
    every = find_whirls(machine, count=ALL)
    grows = [each.exponent.real > machine.slowest.rounding for each in every]
    listed = tuple(each for rank, each in enumerate(every) if rank < WHIRLS or grows[rank])
    worst = min(listed, key=lambda each: each.damping_ratio)
    try:
        share, why = reduced.model.system.rest_radius, ""
    except InputError as problem:
        unheld = problem.field == UNHELD
        share, why = np.inf, str(problem.value).removeprefix("unstable: ") if unheld else str(problem)
    stable, holds = not why, share < 1.0
    told = stable or any(grows)  # what grows without going round is no whirl
    at_speed, speeds = None, np.empty(0)
    curves: tuple[Curve, ...] = ()
    if machine.unbalances and stable:
        at_speed = synchronous_response(machine, [machine.speed])
        speeds = speeds_of_response(machine, every, (SLOWEST * machine.speed, max(top, FASTEST * machine.speed)))
        curves = _curves(synchronous_response(machine, speeds.tolist()))
    zone = case.zones.zone(min(share, 1.0))
    return Levitating(
        lead=_lead(stable, holds, why),
        more=_more(machine.speed, listed if told else (), at_speed, share, zone, stable=stable),
        stable=stable,
        holds=stable and holds,
        damping=number(worst.damping_ratio, 3) if told else "–",
        damping_remark=f"of the {worst.sense} whirl of {number(worst.frequency, 3)} Hz" if told else "a motion grows",
        clearance=f"{number(100.0 * share, 3)} %" if stable and np.isfinite(share) else "–",
        clearance_remark=f"sag and whirl by unbalance at the worst touchdown bearing: zone {zone} of ISO 14839-2"
        if stable
        else "a motion grows",
        whirls=tuple(map(_row, listed)),
        orbits=() if at_speed is None else _orbits(at_speed),
        speeds=speeds,
        curves=curves,
        walls=tuple(sorted(set(machine.clearances))),
    )


def _lead(stable: bool, holds: bool, why: str) -> str:
    if not stable:
        return f"It does not levitate: {why}."
    if not holds:
        return "Cannot run without contact: its sag and whirl from unbalance would reach a touchdown bearing."
    return "It levitates: every free motion fades, and it stays clear of its touchdown bearings."


def _more(
    speed: float,
    whirls: tuple[Whirl, ...],
    at_speed: SynchronousResponse | None,
    share: float,
    zone: str,
    *,
    stable: bool,
) -> str:
    parts = [whirl_words(speed, whirls)] if whirls else []
    if at_speed is not None:
        parts.append(response_words(at_speed))
    if stable and np.isfinite(share):
        parts.append(zone_words(share, zone))
    return " ".join(parts)


def _row(whirl: Whirl) -> WhirlRow:
    ratio = whirl.damping_ratio
    return WhirlRow(f"{number(whirl.frequency, 3)} Hz", whirl.sense, number(ratio, 3), ratio)


def _orbits(at_speed: SynchronousResponse) -> tuple[Orbit, ...]:
    planes = [
        Orbit(f"touchdown bearing {place}", micrometres(each), f"{number(100.0 * each / clearance, 3)} %")
        for place, (each, clearance) in enumerate(
            zip(at_speed.touchdowns.major[0], at_speed.clearances, strict=True), start=1
        )
    ]
    sensors = [
        Orbit(f"sensors of magnetic bearing {place}", micrometres(each), "")
        for place, each in enumerate(at_speed.sensors.major[0], start=1)
    ]
    return (*planes, *sensors)


def _curves(response: SynchronousResponse) -> tuple[Curve, ...]:
    planes = [
        Curve(f"touchdown bearing {place}", each, False)
        for place, each in enumerate(response.touchdowns.major.T, start=1)
    ]
    sensors = [
        Curve(f"sensors of bearing {place}", each, True) for place, each in enumerate(response.sensors.major.T, start=1)
    ]
    return (*planes, *sensors)


def told_more(reduced: ReducedMachine, progress: ShowProgress = None) -> dict[str, tuple[str, ...]]:
    """Sentences on critical speeds, on the loops of the bearings, and on the reduction, by their headings."""
    tell = Reporter.of(progress, "critical speeds and sensitivity")
    found = levitating_of_machine(reduced.machine)
    tell(0.9)
    facts = [*critical_speed_facts(found), *bearing_facts(found)]
    topics = dict.fromkeys(str(each.topic) for each in facts)
    told = {topic: tuple(each.text for each in facts if each.topic == topic) for topic in topics}
    return {**told, "Accuracy": (reduction_words(reduced), ALONG)}
