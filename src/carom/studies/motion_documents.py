"""One motion as JSON: all its stages, its contacts at all touchdown bearings, and what each of these bears."""

from __future__ import annotations

from dataclasses import replace
from operator import itemgetter
from types import SimpleNamespace
from typing import Any

from carom.base.arguments import checked
from carom.base.outcome import Phase
from carom.base.results import record
from carom.motions import drop_loads
from carom.motions.history import LastingContact
from carom.motions.trajectories import Trajectory
from carom.parameters import LoadLimits
from carom.studies.drops import load_entries

_TIMES = ("time", "start", "end", "peak_time")
STATE = "U=position V=velocity"
SCALES = "length time velocity acceleration force impulse energy damping stiffness"
IMPACT = ("time", "touchdown_bearing", "angle", "radial_speed", "angular_speed", "normal_impulse")
CONTACT = "angle radial_speed radial_speed_after peak_force:force peak_time deepest:length heat: lasts impulse=normal_impulse:"


@checked
def trajectory_document(trajectory: Trajectory, limits: LoadLimits | None = None) -> dict[str, Any]:
    """Return the document of one motion with its impacts and lasting contacts; velocities are those before impacts.

    Of a motion in several stages it is that of all, with times from its beginning, and ``stages`` has the document of each.  Loads are
    compared with limits, if some are stated.
    """
    limits, parts = limits or LoadLimits(), trajectory.parts
    if len(parts) == 1:
        return _stage(trajectory, limits)
    stages = [{"begins": part.begins} | _stage(replace(part, earlier=()), limits) for part in parts]
    document = _stage(trajectory, limits) | {"start": stages[0]["start"], "time": trajectory.begins + trajectory.time}
    for key in ("impacts", "contacts"):
        document[key] = [
            entry | {name: stage["begins"] + entry[name] for name in _TIMES if name in entry}
            for stage in stages
            for entry in stage[key]
        ]
    return document | {"stages": stages}


def _stage(motion: Trajectory, limits: LoadLimits) -> dict[str, Any]:
    """A stage, with what the bearings bear in it and in those before that it knows."""
    loads = zip(load_entries(drop_loads(motion), limits), motion.at_each, strict=True)
    return {
        **motion.rotor.document(),
        "start": record(motion.start, STATE),
        **record(motion, "outcome=outcome.label meaning=outcome.meaning multiplicity time"),
        "impacts": sorted((each for seen in motion.at_each for each in _impacts(seen)), key=itemgetter("time")),
        "contacts": sorted((each for seen in motion.at_each for each in _contacts(seen)), key=itemgetter("start")),
        "final": record(motion.final, STATE),
        "touchdown_bearings": [entry | {"final": _end(seen)} for entry, seen in loads],
        **({} if motion.scales is None else {"scales_si": record(motion.scales, SCALES)}),
    }


def _impacts(motion: Trajectory) -> list[dict[str, object]]:
    """Impacts at one bearing."""
    if motion.is_compliant:
        return []
    columns = record(motion.contacts, " ".join(IMPACT)).values()
    return [dict(zip(IMPACT, each, strict=True)) for each in zip(*columns, strict=True)]


def _contacts(motion: Trajectory) -> list[dict[str, Any]]:
    """Stretches of lasting contact at one bearing; of a compliant one whole contacts, by the kind that takes most of each."""
    log, number = motion.contacts, {"touchdown_bearing": motion.plane + 1}
    if not motion.is_compliant:
        return [_stretch(contact) | number for contact in motion.lasting_contacts]
    columns = record(log, CONTACT, log.scales)
    kinds = zip(log.phase.tolist(), log.time.tolist(), log.end.tolist(), strict=True)
    return [
        _stretch(LastingContact(Phase(phase), start, end)) | number | dict(zip(columns, values, strict=True))
        for (phase, start, end), *values in zip(kinds, *columns.values(), strict=True)
    ]


def _stretch(contact: LastingContact) -> dict[str, Any]:
    return record(contact, "kind phase=phase.label start end")


def _end(seen: Trajectory) -> dict[str, object]:
    """Place and velocity of the rotor in one bearing at the end, in the fixed frame."""
    place, velocity = seen.end()
    return record(SimpleNamespace(place=place, velocity=velocity), "place:length velocity:", seen.scales)
