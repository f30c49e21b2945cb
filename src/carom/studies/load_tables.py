"""What touchdown bearings bear in a motion, over all its stages: in rows for people, as JSON, and against limits."""

from __future__ import annotations

import math
from typing import Any

from carom.base.outcome import Outcome
from carom.base.results import record
from carom.motions import Braking, DropLoads, LastWhirl, TouchdownLoads
from carom.motions.loads import MEASURED
from carom.parameters import LoadLimits
from carom.parameters.formats import number
from carom.studies.load_checks import check_loads
from carom.studies.wording import Wording

PLANE = "is_compliant contacts bounces restitution force_at:time impulse_at:time in_contact_since:time race_at_end:speed fastest_race:speed"
LOADS = f"impacts=contacts {' '.join(f'{name}:' for name in MEASURED)} goes_on"
_IN_BOTH = (
    ("restitution seen", "{restitution} in the fastest impact"),
    ("slip energy (heat)", "{heat}"),
    ("heating goes on", "with {lasting_power}"),
    ("friction power", "up to {power}"),
    ("race", "{race_at_end:speed} at the end, at most {fastest_race:speed}"),
    ("in contact to the end", "since {in_contact_since:time} after {since}"),
)
COMPLIANT = (
    ("peak force", "{force}, {force_at:time} after {since}"),
    ("depth", "{depth}"),
    ("pressure of balls", "{pressure:pressure} on the most loaded one"),
    ("largest impulse", "{impulse}, {impulse_at:time} after {since} (that of one contact)"),
    ("contacts", "{contacts:contact}, {contact_time} in contact"),
    ("of which it left", "{bounces:bounce}"),
    *_IN_BOTH,
)
RIGID = (
    ("hardest impact", "impulse {impulse}, {impulse_at:time} after {since}; a rigid wall has no peak force"),
    ("contacts", "{contacts:impact}"),
    ("lasting contact", "force up to {force}, {contact_time} together"),
    *_IN_BOTH,
)
"""What people see of a touchdown bearing: labels, and attributes of its loads by name and kind; what is zero or not known is left out."""
WHIRL = "direction angular_speed: turned lasted:time since:time goes_on"


def load_tables(loads: DropLoads, since: str) -> list[tuple[str, list[tuple[str, str]]]]:
    """For each plane a title, empty if there is one plane alone, and labels with what they say; times count from ``since``."""
    planes = loads.planes
    tables = [
        (f"Touchdown bearing {each.plane + 1}" if len(planes) > 1 else "", _rows(each, loads.outcome, since))
        for each in planes
    ]
    if loads.shaft is not None:
        tables[-1][1].append(("shaft", _shaft_words(loads.shaft)))
    return tables


def _shaft_words(shaft: Braking) -> str:
    """Its speed at the end, and what the drive would do where its torque is left out."""
    before, end = (Wording(shaft.scales).write(each, "speed") for each in (1.0, shaft.speed_at_end))
    text = f"{end} at the end, {before} before"
    if shaft.left_out == 0.0:
        return text
    change = f"{'add' if shaft.left_out > 0.0 else 'take'} {Wording(shaft.scales).write(abs(shaft.left_out), 'speed')}"
    return f"{text}; the torque of the drive is left out in flight, where it would {change}"


def load_entries(loads: DropLoads, limits: LoadLimits) -> list[dict[str, Any]]:
    """The loads of each plane as JSON, with the limits."""
    return [_entry(plane, limits) for plane in loads.planes]


def _rows(plane: TouchdownLoads, outcome: Outcome, since: str) -> list[tuple[str, str]]:
    if plane.is_compliant and plane.force_at is None:
        rows = [("peak force", "none: it did not touch")]
    else:
        rows = Wording(plane.scales).rows(COMPLIANT if plane.is_compliant else RIGID, plane, since=since)
    return rows if plane.whirl is None else [*rows, ("whirl at the end", _whirl_words(plane.whirl, outcome))]


def _entry(plane: TouchdownLoads, limits: LoadLimits) -> dict[str, Any]:
    whirl = plane.whirl
    entry = {"touchdown_bearing": plane.plane + 1, **record(plane, PLANE, plane.scales)}
    entry["loads"] = record(plane, LOADS, plane.scales)
    if plane.pressure is not None:
        entry["loads"]["pressure_si"] = plane.pressure
    if not plane.is_compliant:
        # Impacts on a rigid wall have no force; this one is that of lasting contact.
        entry["loads"]["force_is_of_lasting_contact"] = True
    entry["whirl"] = whirl and record(whirl, WHIRL, whirl.scales)
    if whirl is not None and whirl.frequency_si is not None:
        entry["whirl"]["frequency_si"] = whirl.frequency_si
    entry["limits"] = [check.document() for check in check_loads(plane, limits)]
    return entry


def _whirl_words(whirl: LastWhirl, outcome: Outcome) -> str:
    """Sense and frequency, and whether it goes on."""
    turns = number(whirl.lasted / (2.0 * math.pi), 3)
    if whirl.direction is None:
        return "none"
    rate = f"{number(abs(whirl.angular_speed), 4)} Ω"
    if whirl.frequency_si is not None:
        rate = f"{number(whirl.frequency_si, 4)} Hz ({number(abs(whirl.angular_speed), 3)} times the shaft)"
    if whirl.goes_on:
        return f"{whirl.direction}, {rate}; it goes on"
    seen = "and is not known to go on" if not outcome.settled else "in the mean"
    return f"{whirl.direction}, {rate}, over the last {turns} turns of the shaft, {seen}"
