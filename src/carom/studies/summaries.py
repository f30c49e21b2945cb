"""The tables of a study, as text: the same in the terminal and in the report."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass, replace
from typing import Literal

from carom.attractors import Attractor, AttractorSet
from carom.attractors.naming import LEVITATION, SYNCHRONOUS_RUB
from carom.base.outcome import STEADY_WORDS
from carom.base.results import Column
from carom.closed_forms import Levitation
from carom.closed_forms.equilibria import SteadyMotion
from carom.orbits import LyapunovExponents, Orbit, OrbitSet
from carom.parameters import Case, Parameters
from carom.parameters.indentation import indentation_of_force, indentation_of_impact
from carom.parameters.numbers import own_numbers
from carom.studies.questions import LABELS
from carom.studies.recovery import Motion, Recovery
from carom.studies.study_data import StudyData
from carom.studies.verdict import SURVIVED, condition_of, is_proven, survived_cells
from carom.studies.wording import Wording, counted, indentation_of_steel, motion_words, no_rigid_wall

State = Literal["stable", "neutral", "unstable", "not possible", "seen", "transient", "undecided"]


@dataclass(frozen=True)
class MotionRow:
    """A motion of the machine."""

    name: str
    state: State
    """Seen: disturbances ended there, its stability was not computed; transient: it ends; undecided: its end was not
    found.  One of "stable", "neutral", "unstable", "not possible", "seen", "transient", "undecided"."""
    _: KW_ONLY
    period: str = ""
    size: str = ""
    """Radius of a steady motion, or radial speed of impacts."""
    impulse: str = ""
    """Normal impulse of an impact."""
    force: str = ""
    """Force of lasting contact, or mean force of impacts."""
    trials: str = ""
    """Number of disturbances that ended there."""
    remark: str = ""
    multipliers: str = ""
    """Non-trivial ones of an orbit, where they are stated."""


MOTIONS: dict[Motion, str] = {
    "contact-free": STEADY_WORDS["contact-free"],
    "rub": STEADY_WORDS["rub"],
    "single-impact": "orbits with one impact a period",
    "stable-single-impact": "stable orbits with one impact a period",
    "rolling": STEADY_WORDS["rolling"],
}
"""Names of the motions whose ranges are known."""
BACK = "full recovery from the required disturbances"
MOTION_COLUMNS = {
    "name": "motion",
    "state": "state",
    "period": "period",
    "size": "radius or impact speed",
    "impulse": "impulse per impact",
    "force": "force",
    "trials": "disturbances",
    "remark": "remark",
}
"""Headings of the table of motions, by the fields of :class:`MotionRow`."""


def survived_rows(study: StudyData) -> list[tuple[str, ...]]:
    """Return the headings, and a row for each kind of disturbance that was searched; nothing where there is no stable levitation."""
    if study.survives is None:
        return []
    found = [(name, survived_cells(study, name, each)) for name, each in study.survives.items()]
    used = [column for column in SURVIVED if any(column in cells for _, cells in found)]
    rows = [
        (" ".join([LABELS[name], condition_of(study, name)]).strip(), *(cells.get(column, "none") for column in used))
        for name, cells in found
    ]
    return [("disturbance", *(SURVIVED[column] for column in used)), *rows]


def dimensionless_rows(case: Case) -> list[tuple[str, str]]:
    """Return the dimensionless parameters: symbols and values."""
    fields = case.parameters.varied
    return [(fields[name].symbol, f"{value:.6g}") for name, value in own_numbers(case.parameters).items()]


def motion_rows(study: StudyData) -> list[MotionRow]:
    """Return the rows of all motions: steady ones, orbits, and other motions in which disturbances ended."""
    rows = simple_motion_rows(study.equilibria, study.orbits, study.wording, study.attractors)
    proven = {f"orbit {orbit.name}" for orbit in study.orbits if is_proven(study.proof, orbit)}
    rows = [replace(row, remark=_joined("proven" * (row.name in proven), row.remark)) for row in rows]
    simple = {LEVITATION, SYNCHRONOUS_RUB, *(orbit.name for orbit in study.orbits)}
    return rows + [_seen(study, member) for member in study.attractors if member.name not in simple]


def _joined(*remarks: str) -> str:
    return "; ".join(filter(None, remarks))


def simple_motion_rows(
    equilibria: tuple[SteadyMotion, ...],
    orbits: OrbitSet,
    say: Wording,
    found: AttractorSet | None = None,
    most_virtual: int = 8,
) -> list[MotionRow]:
    """Return the rows of equilibria and orbits, with the number of disturbances that ended there, if simulated.

    Orbits that are not possible are left out if there are more than ``most_virtual``.
    """
    rows = steady_rows(equilibria, say, found, orbits.rotor.in_rigid_wall)
    virtual = [orbit for orbit in orbits if not orbit.admissible]
    shown = [orbit for orbit in orbits if orbit.admissible or len(virtual) <= most_virtual]
    return rows + [_bounce(orbit, say, _share(found, orbit.name)) for orbit in shown]


def steady_rows(
    equilibria: tuple[SteadyMotion, ...],
    say: Wording,
    found: AttractorSet | None = None,
    rigid: Parameters | None = None,
) -> list[MotionRow]:
    """Return the rows of equilibria; with the parameters of a rotor in a rigid wall they say where no wall is rigid enough."""
    rows = []
    for entry in equilibria:
        name = LEVITATION if entry.kind == "contact-free" else SYNCHRONOUS_RUB if entry.stable else ""
        rows.append(_steady(entry, say, _share(found, name), rigid))
    return rows


def _share(found: AttractorSet | None, name: str) -> str:
    if found is None or name not in {member.name for member in found} or not found[name].count:
        return ""
    return f"{found[name].count} of {len(found.disturbances)}"


def _steady(entry: SteadyMotion, say: Wording, share: str, parameters: Parameters | None) -> MotionRow:
    contact_free, name = entry.kind == "contact-free", MOTIONS[entry.kind]
    size = f"{'up to ' if isinstance(entry, Levitation) else ''}r = {say.radius(entry.radius)}" if contact_free else ""
    if entry.status == "virtual":
        remark = "would lie outside the wall" if contact_free else "the wall would have to pull"
        return MotionRow(name, "not possible", size=size, trials=share, remark=remark)
    soft = "" if contact_free else no_rigid_wall(indentation_of_force(parameters, entry.normal_force))
    force = "" if contact_free else "no model" if soft else say.force(entry.normal_force)
    touches = "touches the wall without force" if entry.status == "boundary" else soft
    state: State = "stable" if entry.stable else "unstable"
    return MotionRow(name, state, size=size, force=force, trials=share, remark=touches)


def _bounce(orbit: Orbit, say: Wording, share: str) -> MotionRow:
    name, period, size = f"orbit {orbit.name}", say.time(orbit.period), say.velocity(orbit.radial_speed)
    if not orbit.admissible:
        return MotionRow(name, "not possible", period=period, size=size, remark=orbit.reason)
    impulse, force = say.impulse(orbit.impulse), f"{say.force(orbit.impulse / orbit.period)} mean"
    if math.isnan(orbit.impulse):  # contact that never ends
        size, impulse, force = "", "", ""
    how = orbit.multipliers.instability
    grows = f"disturbances grow {how}" if how else ""
    remark = _joined(grows, no_rigid_wall(indentation_of_impact(orbit.rotor.in_rigid_wall, orbit.radial_speed)))
    state: State = orbit.multipliers.stability
    return MotionRow(name, state, period=period, size=size, impulse=impulse, force=force, trials=share, remark=remark)


def _seen(study: StudyData, member: Attractor) -> MotionRow:
    say, impulse, force = study.wording, member.largest_impulse, member.largest_force
    soft = no_rigid_wall(indentation_of_steel(study.rotor, impulse, force))
    lasts, known = member.survival.words if member.survival else "", "" if member.count else "from a start next to it"
    return MotionRow(
        member.name.words,
        "transient" if member.transient else "seen" if member.settled else "undecided",
        period=say.time(member.period) if member.period else "",
        impulse=f"up to {say.impulse(impulse)}" if impulse > 0 else "",
        force=("no model" if soft else say.force(force)) if force > 0 else "",
        trials=_share(study.attractors, member.name),
        remark=_joined(lasts, known, soft),
    )


def ranges_along(say: Wording, found: Recovery) -> list[tuple[str, str]]:
    """A parameter with its present value, then each motion with the values for which it exists, and where all that must be survived comes back."""
    name = say.name(found.along.name)
    # A symbol keeps its case: Ω is not ω.
    head = (
        f"{name[0].upper()}{name[1:]}" if say.of_machine else name,
        say.value(found.along.name, found.along.value(found.rotor)),
    )
    ranges = [(words, found.range_of(motion)) for motion, words in MOTIONS.items()]
    rows = [(words, say.where(each.parameter, each.spans, each.searched)) for words, each in ranges if each]
    return [head, *rows, (BACK, _back_words(say, found))]


def _back_words(say: Wording, found: Recovery) -> str:
    """Where along a parameter everything tried came back, how much was tried, and what was met beyond."""
    along = found.along.name
    if found.motions and not found.range_of("single-impact"):
        return "not searched"
    if not found.searched:
        return "nowhere: the rotor does not levitate in the searched range"
    if not found.complete:
        return "unknown: the search was not finished"
    low, high = say.value(along, found.searched[0].low.value), say.value(along, found.searched[-1].high.value)
    if not found.spans:
        return f"at no value tried from {low} to {high}"
    each = min(check.tried for check in found.clear)
    ends = {(edge.motion, edge.value) for span in found.spans for edge in span if edge.motion}
    met = [f"; beyond {say.value(along, value)} some end in {motion_words(motion)}" for motion, value in sorted(ends)]
    tried = f"all of {each:,} disturbances at each of {counted(len(found.clear), 'value')}"
    return f"{say.where(along, found.spans)} ({tried}, searched from {low} to {high}{''.join(met)})"


Measured = tuple[Attractor, LyapunovExponents | None]


def _exponent(value: float, error: float, digits: int) -> str:
    return f"{value:.{digits}g}" + (f" ± {error:.1g}" if error else "")


def _all_exponents(measured: Measured, _: object) -> str:
    if (found := measured[1]) is None:
        return "not known"
    pairs = zip(found.values, found.errors, strict=True)
    return ", ".join(_exponent(value, error, 4 if error else 6) for value, error in pairs)


def _measured(measured: Measured, _: object) -> str:
    found = measured[1]
    return "-" if found is None else f"{found.impacts:,}" if found.errors.any() else "exact"


def _across(measured: Measured, _: object) -> str:
    if (found := measured[1]) is None:
        return "-"
    value, error = found.across
    return _exponent(value, error, 3)


ACROSS = (Column("", "largest exponent across the motion", _across),)
MEASURED = (
    Column("", "motion", lambda measured, _: measured[0].name.words),
    Column("", "exponents", _all_exponents),
    Column("", "impacts measured", _measured),
)
"""Of each attractor with its exponents, what people see of these."""
