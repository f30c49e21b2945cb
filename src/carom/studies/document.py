"""Results as JSON: the documents that ``--json`` prints and that ``study.json`` holds.

Complex numbers are ``[re, im]``.  Times are in ``1/Ω`` and lengths in ``c_r``, in the co-rotating frame, unless the key
ends in ``_si``; those keys exist if the machine is known.  Values that are not finite are ``null``.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from importlib.metadata import version
from operator import itemgetter
from types import SimpleNamespace
from typing import Any

from carom.attractors import Attractor, AttractorSet, document_of, exact_interval
from carom.base.arguments import checked
from carom.base.outcome import Phase
from carom.base.results import Column, keys_of, record
from carom.basins import share_of_kicks
from carom.bifurcations.documents import search_document
from carom.closed_forms import Levitation
from carom.closed_forms.equilibria import SteadyMotion
from carom.models import Rotor, rotor_of
from carom.motions import LastingContact, Trajectory, drop_loads
from carom.orbits import LyapunovExponents, Orbit, OrbitSet
from carom.orbits.happenings import RECOVERS, SATURATES
from carom.orbits.simulated import SimulatedOrbit
from carom.parameters import MACHINE_FIELDS, Case, LoadLimits, Parameters
from carom.parameters.formats import complex_words, format_quantity
from carom.parameters.indentation import is_compliant
from carom.studies.drops import load_entries
from carom.studies.questions import UNFINISHED, Fact
from carom.studies.recovery import Recovery
from carom.studies.study_data import StudyData
from carom.studies.trials import Check
from carom.studies.verdict import Verdict
from carom.studies.wording import Wording, counted, indentation_of_steel

_TIMES = ("time", "start", "end", "peak_time")
STATE = "U=position V=velocity"
SCALES = "length time velocity acceleration force impulse energy damping stiffness"
IMPACT = ("time", "touchdown_bearing", "angle", "radial_speed", "angular_speed", "normal_impulse")
CONTACT = "angle radial_speed radial_speed_after peak_force:force peak_time deepest:length heat: lasts impulse=normal_impulse:"


def _number(name: str) -> Callable[[Orbit, object], str]:
    return lambda orbit, _: f"{getattr(orbit, name):.10g}"


def _period_of_found(orbit: Orbit | SimulatedOrbit, found: OrbitSet) -> str:
    turns = "" if orbit.turns is None else f", {counted(orbit.turns, 'turn')}"
    return f"{Wording(found.rotor.scales).time(orbit.period)}{turns}"


def _multipliers(orbit: Orbit | SimulatedOrbit, _: object) -> str:
    return "   ".join(map(complex_words, orbit.multipliers.values))


FOUND_ORBIT = (
    Column("", "orbit", lambda orbit, _: orbit.name),
    Column("", "period", _period_of_found),
    Column("", "state", lambda orbit, _: orbit.multipliers.stability),
    Column("word=segments", "word"),
    Column("all_multipliers=complete"),
)
ORBIT = (
    Column("name", "orbit"),
    Column("impacts"),
    Column("period:", "period T", _number("period")),
    Column("radial_speed:", "ṙ", _number("radial_speed")),
    Column("angle", "θ", _number("angle")),
    Column("angular_speed", "θ̇", _number("angular_speed")),
    Column("stable"),
    Column("stability=multipliers.stability"),
    Column("admissible"),
    Column("reason"),
)
MULTIPLIERS = (
    Column("", "orbit", lambda orbit, _: orbit.name),
    Column("", "largest modulus", lambda orbit, _: f"{orbit.multipliers.spectral_radius:.6g}"),
    Column("multipliers=multipliers.values", "multipliers", _multipliers),
)
ATTRACTOR = (
    "name outcome=name.outcome.label settled multiplicity=name.multiplicity period whirl count share_of_disturbances "
    "known_starts=known largest_impulse: largest_force:"
)
DISTURBANCES = "fastest patience smallest_unrecovered_kick:velocity"
STUDY = "zone survives levitating bearing_demand full_size drop proof kick_proof=kicks.proof"
SHARE = "tried=total came_back=count"


@checked
def orbits_document(
    numbers: Parameters | Rotor, equilibria: tuple[SteadyMotion, ...], orbits: OrbitSet, case: Case | None = None
) -> dict[str, Any]:
    """Return the document of equilibria and periodic orbits of a rotor, with the numbers of the machine that its case states."""
    rotor = rotor_of(numbers)
    return {
        **rotor.document(),
        "machine_si": {name: case.si[name] for name in MACHINE_FIELDS} if case and case.si else None,
        "machine_given": case.given_texts if case and case.si else None,
        "equilibria": [_equilibrium(entry, rotor) for entry in equilibria],
        "orbits": [_orbit(entry) for entry in orbits],
        **record(orbits, "complete longest_period argument"),
    }


@checked
def found_orbits_document(found: OrbitSet) -> dict[str, object]:
    """Return the document of orbits with at most a number of impacts."""
    return {
        **found.rotor.document(),
        "impacts": found.impacts,
        "orbits": [_found_orbit(entry) for entry in found],
        "search": search_document(found.search) if found.search else None,
        "argument": found.argument,
    }


def _found_orbit(orbit: Orbit | SimulatedOrbit) -> dict[str, object]:
    """With what happens in a period, and the largest radius, depth and force at any touchdown bearing."""
    return {
        **_orbit(orbit),
        **record(orbit, keys_of(FOUND_ORBIT)),
        **record(orbit.extremes, "largest_radius=radius deepest=depth peak_force=force:force", orbit.rotor.scales),
        **_turns(orbit),
        "contacts": [
            {
                "kind": "impact" if kind.startswith("impact") else kind.rstrip("+-"),
                "limit" if kind in (SATURATES, RECOVERS) else "touchdown_bearing": place + 1,
                "time": time,
                **record(section, "angle radial_speed angular_speed"),
            }
            for kind, place, time, section in orbit.contacts
        ],
    }


def _turns(orbit: Orbit | SimulatedOrbit | None) -> dict[str, object]:
    return {} if orbit is None or orbit.turns is None else {"turns": orbit.turns}


def attractors_document(
    found: AttractorSet, exponents: Sequence[LyapunovExponents | None] | None = None
) -> dict[str, object]:
    """Return the document of attractors, with the Lyapunov exponents of each member of ``found`` where they are given."""
    total, share = len(found.disturbances), share_of_kicks(found)
    entries = [_seen(entry, total) for entry in found]
    for entry, known in zip(entries, exponents or (), strict=False):
        entry["exponents"] = known and record(known, EXPONENTS)
    return {
        **found.rotor.document(),
        "attractors": entries,
        "share": share.document() if share else None,
        "disturbances": found.words(),
        "starts": total,
        "known_starts": len(found.endings) - total,
        "seed": getattr(found.sample, "seed", None),
        "irregular_transient": found.transient and document_of(found.transient),
        "argument": found.argument,
    }


EXPONENTS = "per_time=values per_impact error_per_time=errors error_per_impact lost"


def _lasting(entry: Attractor, _: AttractorSet) -> str:
    """Whether motions stay on it; irregular bouncing is never called an attractor."""
    if entry.survival is not None:
        return entry.survival.verdict
    return "undecided" if entry.name.irregular or not entry.name.outcome.settled else "attractor"


def _interval(entry: Attractor, total: int) -> tuple[float, float]:
    return exact_interval(entry.count, total) if total else (0.0, 1.0)


def _share(entry: Attractor, found: AttractorSet) -> str:
    """In per cent; the ends of the interval to two digits, or three where two would be a power of ten."""
    ends = _interval(entry, len(found.disturbances))
    low, high = (f"{100.0 * end:.{2 if end < 0.995 else 3}g}" for end in ends)
    return f"{100.0 * entry.share_of_disturbances:.3g} % ({low} to {high})"


def _period(entry: Attractor, _: AttractorSet) -> str:
    return format_quantity(entry.period, "time", entry.scales, 6) if entry.period else "-"


def _impacts(entry: Attractor) -> int | None:
    return (entry.orbit.impacts if entry.orbit else entry.name.multiplicity) or None


SEEN = (
    Column("name", "motion", lambda entry, _: entry.name.words),
    Column("outcome=name.outcome.label"),
    Column("", "lasting", _lasting),
    Column("", "disturbances", _share),
    Column("count"),
    Column("known_starts=known"),
    Column("", "impacts", lambda entry, _: str(_impacts(entry) or "-")),
    Column("period", "period", _period),
    Column("words"),
)


def _seen(entry: Attractor, total: int) -> dict[str, object]:
    orbit, lasts = entry.orbit, entry.survival
    return {
        **record(entry, keys_of(SEEN)),
        "word": str(orbit.word) if orbit else None,
        **_turns(orbit),
        "impacts": _impacts(entry),
        "period": orbit.period if orbit else entry.period,
        "share": [entry.share_of_disturbances, *_interval(entry, total)],
        **(document_of(lasts) | {"transient": lasts is not None and lasts.verdict == "transient"}),
    }


def study_document(study: StudyData, verdict: Verdict, facts: Sequence[Fact]) -> dict[str, object]:
    """Return the document of a study, with all its results."""
    case, rotor, say = study.case, study.rotor, study.wording
    scales, reduced = rotor.scales, rotor.finite_elements
    return {
        "name": case.name,
        "carom": version("carom"),
        **orbits_document(rotor, study.equilibria, study.orbits, case),
        "scales_si": scales and record(scales, SCALES),
        "reduction": reduced and {**record(reduced, "vectors modes error"), "error_is": "an estimate, no bound"},
        "zone_limits": list(case.zones.limits),
        "verdict": record(verdict, "level outcome reason headline"),
        "requirement": study.requirement_document(),
        "share": study.share.document() if study.share and study.share.total else None,
        "facts": [fact.document() for fact in facts],
        "not_reached": [record(each, UNFINISHED) for each in study.unfinished],
        "thresholds": [
            record(entry, "motion parameter")
            | {"exists": side, **record(edge, "kind value period")}
            | say.in_si(entry.parameter, value=edge.value)
            for entry in study.ranges
            for edge, side in entry.thresholds
        ],
        "ranges": [record(entry, "motion parameter step spans searched") for entry in study.ranges],
        "present": study.present and _check(study.present),
        "recovery": [_recovery(entry, say) for entry in study.recoveries],
        "recommendation": study.recommendation.document(say),
        "attractors": [_attractor(entry, rotor) for entry in study.attractors],
        **record(study, STUDY),
        "rolling": _rolling(study),
        "disturbances": _disturbances(study.attractors, rotor),
    }


def _equilibrium(entry: SteadyMotion, rotor: Rotor) -> dict[str, object]:
    columns = "kind U=position radius: normal_force: status stable eigenvalues"
    document = record(entry, f"{columns} sag whirl" if isinstance(entry, Levitation) else columns, rotor.scales)
    return document | _wall(rotor, force=entry.normal_force) if entry.kind == "rub" else document


def _orbit(entry: Orbit | SimulatedOrbit) -> dict[str, object]:
    document, own = record(entry, keys_of((*ORBIT, *MULTIPLIERS)), entry.scales), entry.scales
    if own is not None:
        document |= {"normal_impulse_si": entry.impulse * own.impulse}
    return document | _wall(entry.rotor, impulse=entry.impulse)


def _recovery(entry: Recovery, say: Wording) -> dict[str, object]:
    return {
        **record(entry, "parameter=along.name searched spans complete"),
        "ends": [[edge.motion or edge.kind for edge in span] for span in entry.spans],
        "values": [_check(check) | say.in_si(entry.along.name, value=check.value) for check in entry.checks],
    }


def _check(check: Check) -> dict[str, object]:
    lost = check.example
    return {
        **record(check, "value tried asked"),
        "kinds": [record(share, SHARE) for share in check.returned],
        "at_their_largest": [record(share, SHARE) for share in check.largest],
        "lost": lost and {"disturbance": lost.model.describe(), **record(lost, "coordinates=values motion")},
    }


def _attractor(entry: Attractor, rotor: Rotor) -> dict[str, object]:
    document = record(entry, ATTRACTOR, rotor.scales) | document_of(entry.survival)
    return document | _wall(rotor, entry.largest_impulse, entry.largest_force)


def _disturbances(found: AttractorSet, rotor: Rotor) -> dict[str, object]:
    hardest, touched = found.hardest_impulse, found.touched
    return {
        "seed": getattr(found.sample, "seed", None),
        **record(found, DISTURBANCES, rotor.scales),
        "words": found.words(),
        "count": len(found.disturbances),
        "recovered": sum(each.recovered for each in found.disturbances),
        "touching": len(touched),
        "touching_recovered": sum(each.recovered for each in touched),
        "irregular_transient": found.transient and document_of(found.transient),
        "starts": [
            record(ending, "kind=start.kind attractor time impacts hardest_impulse")
            | {"start": record(ending.start.state, STATE)}
            for ending in found.endings
        ],
        **({"hardest_impulse_si": hardest * rotor.scales.impulse} if rotor.scales else {}),
        **_wall(rotor, hardest),
    }


def _wall(rotor: Rotor, impulse: float = 0.0, force: float = 0.0) -> dict[str, object]:
    """Return the least indentation of a wall of solid steel, in clearances, and whether the rigid wall is valid; nothing if unknown."""
    indentation = indentation_of_steel(rotor, impulse, force)
    return {} if math.isnan(indentation) else {"indentation": indentation, "rigid_wall": not is_compliant(indentation)}


def _rolling(study: StudyData) -> dict[str, object] | None:
    """Return whether rolling backward whirl sustains itself, with its speed and force; ``None`` without a closed form."""
    roll, rotor = study.known.rolls, study.rotor
    if roll is None:
        return None
    return record(roll, "holds speed largest_force:", rotor.scales) | _wall(rotor, force=roll.largest_force)


@checked
def trajectory_document(trajectory: Trajectory, limits: LoadLimits | None = None) -> dict[str, object]:
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
        "impacts": sorted((each for seen in motion.at_each for each in _impacts_at(seen)), key=itemgetter("time")),
        "contacts": sorted((each for seen in motion.at_each for each in _contacts(seen)), key=itemgetter("start")),
        "final": record(motion.final, STATE),
        "touchdown_bearings": [entry | {"final": _end(seen)} for entry, seen in loads],
        **({} if motion.scales is None else {"scales_si": record(motion.scales, SCALES)}),
    }


def _impacts_at(motion: Trajectory) -> list[dict[str, object]]:
    """Impacts at one bearing."""
    if motion.is_compliant:
        return []
    columns = record(motion.contacts, " ".join(IMPACT)).values()
    return [dict(zip(IMPACT, each, strict=True)) for each in zip(*columns, strict=True)]


def _contacts(motion: Trajectory) -> list[dict[str, object]]:
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


def _stretch(contact: LastingContact) -> dict[str, object]:
    return record(contact, "kind phase=phase.label start end")


def _end(seen: Trajectory) -> dict[str, object]:
    """Place and velocity of the rotor in one bearing at the end, in the fixed frame."""
    place, velocity = seen.end()
    return record(SimpleNamespace(place=place, velocity=velocity), "place:length velocity:", seen.scales)
