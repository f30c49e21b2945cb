"""Results as JSON: the documents that ``--json`` prints and that ``study.json`` holds.

Complex numbers are ``[re, im]``.  Times are in ``1/Ω`` and lengths in ``c_r``, in the co-rotating frame, unless the key
ends in ``_si``; those keys exist if the machine is known.  Values that are not finite are ``null``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from importlib.metadata import version
from typing import Any

from carom.arguments import checked
from carom.attractors import Attractor, AttractorSet, Ending, document_of
from carom.bifurcations.boundary import BoundaryEquilibrium
from carom.bifurcations.documents import search_document
from carom.closed_forms.equilibria import SteadyMotion
from carom.closed_forms.sag import Levitation
from carom.models import Rotor, Span, jeffcott
from carom.orbits.happenings import RECOVERS, SATURATES
from carom.orbits.orbit import Orbit
from carom.orbits.simulated import SimulatedOrbit
from carom.orbits.single_impact import OrbitSet
from carom.parameters import MACHINE_FIELDS, Machine, Parameters
from carom.parameters.indentation import gives_way, indentation_of_force, indentation_of_hit
from carom.results import fields_of, in_si
from carom.studies.advice_facts import change_document
from carom.studies.endings import came_back, hardest_impulse, touching
from carom.studies.facts import Fact
from carom.studies.motion_documents import scales_document, state_document
from carom.studies.questions import unfinished_document
from carom.studies.ranges import MotionRange, Threshold
from carom.studies.recovery import Recovery
from carom.studies.study_data import StudyData
from carom.studies.trials import Check
from carom.studies.verdict import Verdict
from carom.studies.verdict_facts import requirement_document, survived_document
from carom.studies.wording import Wording


@checked
def orbits_document(
    parameters: Parameters, equilibria: tuple[SteadyMotion, ...], orbits: OrbitSet, machine: Machine | None = None
) -> dict[str, Any]:
    """Return the document of equilibria and periodic orbits."""
    return _orbits_of(jeffcott(parameters), equilibria, orbits, machine)


def _orbits_of(
    rotor: Rotor, equilibria: tuple[SteadyMotion, ...], orbits: OrbitSet, machine: Machine | None
) -> dict[str, Any]:
    return {
        **rotor.document(),
        "machine_si": {name: getattr(machine, name) for name in MACHINE_FIELDS} if machine is not None else None,
        "machine_given": machine.given_texts if machine is not None else None,
        "equilibria": [_equilibrium(entry, rotor) for entry in equilibria],
        "orbits": [_orbit(entry) for entry in orbits],
        **fields_of(orbits, "complete", "longest_period", "argument"),
    }


@checked
def found_orbits_document(parameters: Parameters | Rotor, found: OrbitSet) -> dict[str, Any]:
    """Return the document of orbits with at most a number of impacts."""
    return {
        **({"parameters": parameters.as_dict()} if isinstance(parameters, Parameters) else found.rotor.document()),
        "impacts": found.impacts,
        "orbits": [
            {
                **_orbit(entry),
                "word": entry.segments,
                **_extremes(entry),
                **({} if entry.turns is None else {"turns": entry.turns}),
                "contacts": _contacts(entry),
            }
            for entry in found
        ],
        "search": search_document(found.search) if found.search else None,
        "argument": found.argument,
    }


def _extremes(orbit: Orbit | SimulatedOrbit) -> dict[str, Any]:
    """Largest radius, depth and force of an orbit, at any touchdown bearing; and whether all multipliers are told."""
    found = fields_of(orbit, largest_radius="extremes.radius", deepest="extremes.depth", peak_force="extremes.force")
    if orbit.rotor.scales is not None:
        found |= {"peak_force_si": found["peak_force"] * orbit.rotor.scales.force}
    return found | {"all_multipliers": orbit.complete}


def _contacts(orbit: Orbit | SimulatedOrbit) -> list[dict[str, Any]]:
    """What happens in a period, with the state there, before an impact."""
    return [
        {
            "kind": "impact" if kind.startswith("impact") else kind.rstrip("+-"),
            "limit" if kind in (SATURATES, RECOVERS) else "touchdown_bearing": place + 1,
            "time": time,
            **fields_of(section, "angle", "radial_speed", "angular_speed"),
        }
        for kind, place, time, section in orbit.contacts
    ]


def study_document(study: StudyData, verdict: Verdict, facts: Sequence[Fact]) -> dict[str, Any]:
    """Return the document of a study, with all its results."""
    case, rotor, say = study.case, study.rotor, study.wording
    return {
        "name": case.name,
        "carom": version("carom"),
        **_orbits_of(rotor, study.equilibria, study.orbits, case.machine),
        "scales_si": scales_document(rotor.scales) if rotor.scales else None,
        "levitating": study.levitating.document(),
        "reduction": None
        if study.reduced is None
        else {**fields_of(study.reduced, "vectors", "modes", "error"), "error_is": "an estimate, no bound"},
        "zone": study.zone,
        "zone_limits": list(case.zones.limits),
        "verdict": fields_of(verdict, "level", "outcome", "reason", "headline"),
        "requirement": requirement_document(study),
        "survives": {name: survived_document(study, name, found) for name, found in study.survives.items()}
        if study.survives
        else None,
        "share": study.share.document if study.share and study.share.total else None,
        "not_reached": unfinished_document(study.unfinished),
        "facts": [fact.document() for fact in facts],
        "thresholds": [_threshold(entry, say) for entry in study.thresholds],
        "ranges": [_range(entry) for entry in study.ranges],
        "boundaries": [_boundary(entry, say) for entry in study.boundaries],
        "present": _check(study.present) if study.present else None,
        "elsewhere": fields_of(study.elsewhere, tried="total", came_back="count") if study.elsewhere else None,
        "recovery": [_recovery(entry, say) for entry in study.recoveries],
        "recommendation": {
            "kind": study.recommendation.kind,
            "changes": [change_document(study, change) for change in study.recommendation.changes],
        },
        "attractors": [_attractor(entry, rotor) for entry in study.attractors],
        "rolling": _rolling(study),
        "disturbances": _disturbances(study.attractors, rotor),
        "bearing_demand": study.bearing_demand.document() if study.bearing_demand else None,
        "loads": study.loads.document() if study.loads else None,
        "full_size": [each.document() for each in study.full_size],
        "drop": study.drop.document() if study.drop else None,
        "proof": study.proof.document() if study.proof else None,
        "kick_proof": study.kicks.proof.document() if study.kicks else None,
        "state_proof": study.states.document() if study.states else None,
    }


def _equilibrium(entry: SteadyMotion, rotor: Rotor) -> dict[str, Any]:
    scales = rotor.scales
    document = {
        **fields_of(entry, kind="kind", U="position", radius="radius", normal_force="normal_force"),
        **fields_of(entry, "status", "stable"),
        "eigenvalues": list(entry.eigenvalues),
    }
    if isinstance(entry, Levitation):
        document |= fields_of(entry, "sag", "whirl")
    document |= in_si(document, scales, "radius", "normal_force")
    if scales is not None and entry.kind == "rub":
        document |= _wall(indentation_of_force(rotor.in_rigid_wall, entry.normal_force))
    return document


def _orbit(entry: Orbit | SimulatedOrbit) -> dict[str, Any]:
    document = fields_of(entry, "name", "impacts", "period", "radial_speed", "angle", "angular_speed")
    document |= fields_of(entry, multipliers="multipliers.values") | fields_of(entry, "stable", "admissible", "reason")
    own = entry.scales
    if own is not None:
        document |= in_si(document, own, "period", "radial_speed")
        document |= {"normal_impulse_si": entry.impulse * own.impulse}
        document |= _wall(indentation_of_hit(entry.rotor.in_rigid_wall, entry.radial_speed))
    return document


def _threshold(entry: Threshold, say: Wording) -> dict[str, Any]:
    told = fields_of(entry, motion="motion", kind="edge.kind", exists="exists", parameter="parameter")
    told |= fields_of(entry.edge, "value", "period", "certified")
    return told | say.in_si(entry.parameter, value=entry.edge.value)


def _boundary(entry: BoundaryEquilibrium, say: Wording) -> dict[str, Any]:
    return {
        **fields_of(entry, parameter="gain", value="value", levitates="levitates", kind="kind"),
        "orbits": [
            fields_of(orbit, "name", "levitating_side", "stable", "period")
            for orbit in entry.orbits
            if orbit.admissible
        ],
        "complete": entry.complete,
        **say.in_si(entry.gain, value=entry.value),
    }


def _range(entry: MotionRange) -> dict[str, Any]:
    return {
        **fields_of(entry, "motion", "parameter", "step"),
        "spans": _spans(entry.spans),
        "searched": _span(entry.searched) if entry.searched else None,
    }


def _span(span: Span) -> list[float]:
    return [edge.value for edge in span]


def _spans(spans: tuple[Span, ...]) -> list[list[float]]:
    return [_span(span) for span in spans]


def _recovery(entry: Recovery, say: Wording) -> dict[str, Any]:
    name = entry.along.name
    return {
        "parameter": name,
        "searched": _spans(entry.searched),
        "spans": _spans(entry.spans),
        "ends": [[edge.motion or edge.kind for edge in span] for span in entry.spans],
        "complete": entry.complete,
        "values": [_check(check) | say.in_si(name, value=check.value) for check in entry.checks],
    }


def _check(check: Check) -> dict[str, Any]:
    example = check.example
    return {
        **fields_of(check, "value", "tried", "asked"),
        "kinds": [fields_of(share, tried="total", came_back="count") for share in check.returned],
        "at_their_largest": [fields_of(share, tried="total", came_back="count") for share in check.largest],
        "lost": None
        if example is None
        else {"disturbance": example.model.describe(), "coordinates": list(example.values), "motion": example.motion},
    }


def _attractor(entry: Attractor, rotor: Rotor) -> dict[str, Any]:
    scales, at = rotor.scales, rotor.in_rigid_wall
    told = fields_of(entry, name="name", outcome="name.outcome.label", settled="settled")
    told |= fields_of(entry, multiplicity="name.multiplicity", period="period", whirl="whirl", count="count")
    told |= fields_of(entry, "share_of_disturbances", known_starts="known")
    told |= fields_of(entry, "largest_impulse", "largest_force")
    document = told | document_of(entry.survival) | in_si(told, scales, "largest_impulse", "largest_force")
    if at is not None:
        hit = indentation_of_hit(at, entry.largest_impulse / (1.0 + at.d))
        document |= _wall(max(hit, indentation_of_force(at, entry.largest_force)))
    return document


def _disturbances(found: AttractorSet, rotor: Rotor) -> dict[str, Any]:
    scales, at = rotor.scales, rotor.in_rigid_wall
    touched = touching(found)
    document = {
        "seed": getattr(found.sample, "seed", None),
        "fastest": found.fastest,
        "patience": found.patience,
        "words": found.words(),
        "count": len(found.disturbances),
        "recovered": came_back(found.disturbances),
        "touching": len(touched),
        "touching_recovered": came_back(touched),
        "smallest_unrecovered_kick": found.smallest_unrecovered_kick,
        "irregular_transient": document_of(found.transient) if found.transient else None,
        "starts": [_ending(ending) for ending in found.endings],
    }
    document |= in_si(document, scales, smallest_unrecovered_kick="velocity")
    if scales is not None:
        document["hardest_impulse_si"] = hardest_impulse(found) * scales.impulse
    if at is not None:
        document |= _wall(indentation_of_hit(at, hardest_impulse(found) / (1.0 + at.d)))
    return document


def _ending(entry: Ending) -> dict[str, Any]:
    start = {"kind": entry.start.kind, "start": state_document(entry.start.state)}
    return start | fields_of(entry, "attractor", "time", "impacts", "hardest_impulse")


def _wall(indentation: float) -> dict[str, Any]:
    """Return the least indentation of a wall of solid steel, in clearances, and whether the rigid wall is valid; nothing if unknown."""
    if math.isnan(indentation):
        return {}
    return {"indentation": indentation, "rigid_wall": not gives_way(indentation)}


def _rolling(study: StudyData) -> dict[str, Any] | None:
    """Return whether rolling backward whirl sustains itself, with its speed and force; ``None`` without a closed form."""
    roll, scales = study.known.rolls, study.rotor.scales
    if roll is None:
        return None
    document = fields_of(roll, "holds", "speed", "largest_force")
    document |= in_si(document, scales, "largest_force")
    if scales is not None:
        document |= _wall(indentation_of_force(study.rotor.in_rigid_wall, roll.largest_force))
    return document
