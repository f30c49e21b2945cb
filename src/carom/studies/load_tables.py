"""What touchdown bearings bear in a motion, over all its stages: in rows for people, as JSON, and against limits."""

from __future__ import annotations

import math
from typing import Any

from carom.base.outcome import Outcome
from carom.base.results import record
from carom.motions import Braking, DropLoads, LastWhirl, TouchdownLoads
from carom.motions.loads import MEASURED
from carom.parameters import MACHINE_FIELDS, LoadLimits, Scales
from carom.parameters.formats import number
from carom.studies.load_checks import check_loads
from carom.studies.wording import Wording, counted

PLANE = "gives_way contacts bounces restitution force_at:time impulse_at:time in_contact_since:time race_at_end:speed fastest_race:speed"
LOADS = f"impacts=contacts {' '.join(f'{name}:' for name in MEASURED)} goes_on"
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
    before, end = (_speed(each, shaft.scales) for each in (1.0, shaft.speed_at_end))
    text = f"{end} at the end, {before} before"
    if shaft.left_out == 0.0:
        return text
    change = f"{'add' if shaft.left_out > 0.0 else 'take'} {_speed(abs(shaft.left_out), shaft.scales)}"
    return f"{text}; the torque of the drive is left out in flight, where it would {change}"


def load_entries(loads: DropLoads, limits: LoadLimits) -> list[dict[str, Any]]:
    """The loads of each plane as JSON, with the limits."""
    return [_entry(plane, limits) for plane in loads.planes]


def _rows(plane: TouchdownLoads, outcome: Outcome, since: str) -> list[tuple[str, str]]:
    say = Wording(plane.scales)
    rows = [*_hits(plane, say, since), ("contacts", _contacts(plane, say))]
    if plane.restitution is not None:
        rows.append(("restitution seen", f"{number(plane.restitution, 4)} in the fastest hit"))
    goes_on = f"; it goes on with {say.power(plane.lasting_power)}" if plane.lasting_power * _unit(say) > 0.1 else ""
    rows.append(("slip energy (heat)", f"{say.energy(plane.heat)}{goes_on}"))
    if plane.power > 0.0:
        rows.append(("friction power", f"up to {say.power(plane.power)}"))
    if plane.race_at_end is not None and plane.fastest_race is not None:
        end, fastest = (_speed(each, plane.scales) for each in (plane.race_at_end, plane.fastest_race))
        rows.append(("race", f"{end} at the end, at most {fastest} (shaft {_speed(1.0, plane.scales)})"))
    if plane.whirl is not None:
        rows.append(("whirl at the end", _whirl_words(plane.whirl, outcome)))
    if plane.in_contact_since is not None:
        rows.append(("in contact to the end", f"since {say.time(plane.in_contact_since)} after {since}"))
    return rows


def _entry(plane: TouchdownLoads, limits: LoadLimits) -> dict[str, Any]:
    whirl = plane.whirl
    entry = {"touchdown_bearing": plane.plane + 1, **record(plane, PLANE, plane.scales)}
    entry["loads"] = record(plane, LOADS, plane.scales)
    if plane.pressure is not None:
        entry["loads"]["pressure_si"] = plane.pressure
    if not plane.gives_way:
        # Impacts on a rigid wall have no force; this one is that of lasting contact.
        entry["loads"]["force_is_of_lasting_contact"] = True
    entry["whirl"] = whirl and record(whirl, WHIRL, whirl.scales)
    if whirl is not None and whirl.frequency_si is not None:
        entry["whirl"]["frequency_si"] = whirl.frequency_si
    entry["limits"] = [check.document() for check in check_loads(plane, limits)]
    return entry


def _unit(say: Wording) -> float:
    """Power in W, or in units of the equations."""
    return 1.0 if say.scales is None else say.scales.power


def _hits(plane: TouchdownLoads, say: Wording, since: str) -> list[tuple[str, str]]:
    """The largest force with its depth and pressure, and the largest impulse; on a rigid wall the impulse stands for the force."""
    when = f"after {since}"
    impulse = f"{say.impulse(plane.impulse)}"
    if plane.impulse_at is not None:
        impulse = f"{impulse}, {say.time(plane.impulse_at)} {when}"
    if not plane.gives_way:
        rows = [("hardest impact", f"impulse {impulse}; a rigid wall has no peak force")]
        return [*rows, ("lasting contact", f"force up to {say.force(plane.force)}")] if plane.force > 0.0 else rows
    if plane.force_at is None:
        return [("peak force", "none: it did not touch")]
    rows = [
        ("peak force", f"{say.force(plane.force)}, {say.time(plane.force_at)} {when}"),
        ("depth", say.length(plane.depth)),
    ]
    if plane.pressure is not None:
        rows.append(("pressure of balls", f"{number(1e-9 * plane.pressure, 3)} GPa on the most loaded one"))
    return [*rows, ("largest impulse", f"{impulse} (that of one contact)")] if plane.impulse > 0.0 else rows


def _contacts(plane: TouchdownLoads, say: Wording) -> str:
    kind = "contact" if plane.gives_way else "impact"
    text = f"{counted(plane.contacts, kind)}, {counted(plane.bounces, 'bounce')}"
    lasting = "" if plane.gives_way else "lasting "
    return f"{text}; {say.time(plane.contact_time)} in {lasting}contact"


def _speed(own: float, scales: Scales | None) -> str:
    """An angular speed in rpm, or in that of the shaft."""
    shown = MACHINE_FIELDS["speed"]
    if scales is None:
        return f"{number(own)} Ω"
    return f"{number(shown.in_usual_unit(own * scales.speed), 4)} {shown.usual_unit}"


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
