"""What a study of a flexible machine has found, in words: speeds in rpm, frequencies in Hz, lengths in µm, forces in N, in the fixed frame."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from carom.disturbances.echo import ITS_INSTANT
from carom.models import depends_on_instant
from carom.outcome import Outcome
from carom.parameters.told import number
from carom.rotors import ReducedMachine
from carom.studies.endings import motion_words
from carom.studies.facts import Fact, about
from carom.studies.flexible_data import FlexibleData
from carom.studies.flexible_trials import AtPlane, FlexibleTrial
from carom.studies.levitation_facts import (
    bearing_facts,
    critical_speed_facts,
    other_speeds_words,
    response_words,
    whirl_words,
    zone_words,
)
from carom.studies.load_checks import checks_of_planes
from carom.studies.load_tables import load_tables
from carom.studies.questions import FEWEST, unfinished_facts
from carom.studies.response_words import micrometres, rpm
from carom.studies.verdict import Verdict
from carom.studies.verdict_facts import KINDS
from carom.studies.wording import counted, listed

NOT_COVERED = (
    "Disturbances other than those simulated. They are samples: one between them, or a larger one, may end elsewhere.",
    "Motions in contact that no simulated start reached: the list of what can hold the rotor is not complete.",
    (
        "Periodic orbits and their stability, the values of a gain at which motions appear, the least change of a gain that leaves only recovery, and the "
        "sizes up to which contact is proven to be impossible."
    ),
    "Limits of the magnetic bearings that the file does not state, magnetic bearings whose axes differ, coefficients of supports at other speeds, and changes of speed.",
    "Damping of the shaft as it turns with it, wear and heat of the touchdown bearings, and axial motion.",
)
"""What a study of a flexible machine withholds."""
REDUCTION = (
    "Whether it levitates and all linear results are of all modes. Motions with contact are of {vectors} vectors, {modes} of them modes of the free rotor: "
    "when the free rotor comes to a touchdown bearing straight, tilting or bending, half as many vectors more change the force of the first contact by {error} %.{damped}"
)
DAMPED = " The vectors that are no modes have a damping ratio of {ratio}, without which one of them would grow, as no mode does."


def facts_of_machine(study: FlexibleData) -> Iterator[Fact]:
    """List all facts, in the order in which they are told."""
    yield from _survived(study)
    yield from _besides(study)
    yield from _levitation(study)
    yield from critical_speed_facts(study.levitation)
    yield from bearing_facts(study.levitation)
    yield from _holding(study)
    yield from _tried(study)
    yield from _fall(study)
    reduced = study.reduced
    yield Fact(
        "Accuracy",
        reduction_words(reduced),
        values={"error": reduced.error, "vectors": reduced.vectors, "modes": reduced.modes},
    )
    along = [(KINDS[trial.kind], each) for trial in study.trials for each in (trial.magnets, trial.reduction)]  # type: ignore[index]
    for kind, found in [*along, ("Drop", study.fall_reduction)]:
        if found is not None and found.words:
            yield Fact("Accuracy", f"{kind}, the worst: {found.words}", values=found.document())
    yield from unfinished_facts(study.unfinished)
    for each in NOT_COVERED:
        yield Fact("Not covered", each)


def reduction_words(reduced: ReducedMachine) -> str:
    """What the reduction of a machine leaves out."""
    ratio = reduced.damped.damping_ratio
    return REDUCTION.format(
        vectors=reduced.vectors,
        modes=reduced.modes,
        error=number(100.0 * reduced.error, 2),
        damped=DAMPED.format(ratio=number(ratio)) if ratio else "",
    )


def verdict_of_machine(study: FlexibleData, facts: Sequence[Fact]) -> Verdict:
    """The verdict; it never promises that the machine recovers."""
    survived = tuple(f"{fact.label}: {fact.text}." for fact in about(facts, "Verdict"))
    if not study.levitates:
        why = "its sag and whirl from unbalance would reach a touchdown bearing"
        return Verdict("no-contact-free-motion", "Cannot run without contact", why, survived)
    lost = [_size(study, trial) for trial in study.trials if not trial.survived]
    if lost:
        outcome = f"Does not come back from all that it must survive, vibration in zone {study.zone} of ISO 14839-2"
        return Verdict("may-not-come-back", outcome, f"some are lost of: {listed(lost)}", survived)
    if min(trial.drawn.total for trial in study.trials) < FEWEST:
        outcome = f"Not decided whether it comes back from what it must survive, vibration in zone {study.zone} of ISO 14839-2"
        return Verdict("not-decided", outcome, "too few disturbances could be followed", survived)
    outcome = f"Came back each time from what it must survive, vibration in zone {study.zone} of ISO 14839-2"
    doubts = ["no guarantee, as disturbances are samples", *_doubts(study)]
    return Verdict("all-tried-came-back", outcome, "; ".join(doubts), survived)


def _doubts(study: FlexibleData) -> list[str]:
    """What stands against the machine although all came back."""
    found = []
    loops = study.levitation.sensitivity
    if loops is not None and (zones := sorted(set(loops.zones or ()) & set("CD"))):
        found.append(f"sensitivity in zone {zones[-1]} of ISO 14839-3")
    if not study.levitation.met:
        found.append("a critical speed is nearer than API 617 allows")
    if any(check.exceeded for trial in study.trials for check in trial.checks):
        found.append("a limit of a touchdown bearing is exceeded on the way")
    loads = study.fall_loads
    if loads is not None and any(check.exceeded for check in checks_of_planes(loads, study.case.limits)):
        found.append("a limit of a touchdown bearing is exceeded in a drop")
    return found


def _size(study: FlexibleData, trial: FlexibleTrial) -> str:
    """A kind of disturbance with its size: ``kicks of up to 100 mm/s``."""
    say = study.wording
    if trial.kind == "shock" and study.required.shock is not None:
        return f"shocks of up to {say.acceleration(trial.size)}, {say.time(study.required.shock.duration)}"
    if trial.kind == "blade_loss":
        return f"losses of a blade of {say.unbalance(trial.size)}"
    return f"kicks of up to {say.velocity(trial.size)}"


def _survived(study: FlexibleData) -> Iterator[Fact]:
    """For each kind what came back."""
    for trial in study.trials:
        drawn, largest = trial.drawn, trial.largest
        text = f"{drawn.count} of {drawn.total} {_size(study, trial)} came back, and {largest.count} of {largest.total} at the full size in as many directions"
        text += f"; {trial.beyond_model} of {drawn.total} went beyond the model" if trial.beyond_model else ""
        text += f", each {ITS_INSTANT}" if depends_on_instant(study.rotor) else ""
        yield Fact("Verdict", text, KINDS[trial.kind], "sampled", trial.document(), disturbances=trial.kind)  # type: ignore[index]
    if study.beyond:
        kick = study.required.kick
        whole = [(times, back.total) for times, back in study.beyond if back.count == back.total]
        times, back = study.beyond[-1]
        parts = [
            f"at {study.wording.velocity(most * kick)} all {tried} directions tried came back"
            for most, tried in whole[-1:]
        ]
        if back.count < back.total:
            parts.append(f"at {study.wording.velocity(times * kick)} {back.count} of {back.total} did")
        values = {"times": [each for each, _ in study.beyond], "came_back": [each.count for _, each in study.beyond]}
        yield Fact("Verdict", "; ".join(parts), "Larger kicks", "sampled", values, disturbances="kick")


def _besides(study: FlexibleData) -> Iterator[Fact]:
    """What belongs to the headline besides what must be survived: the drop with its loads, and starts elsewhere."""
    loads, say = study.fall_loads, study.wording
    if loads is not None:
        told = [
            f"{(title or 'touchdown bearing').lower()} {', '.join(f'{label} {words}' for label, words in rows if label in _HEADLINE)}"
            for title, rows in load_tables(loads, "the release")
        ]
        limits = study.case.limits
        stated = "" if limits.given else "; no limit of a touchdown bearing is stated to compare them with"
        text = f"{loads.outcome.words} after {say.time(loads.time)}; {'; '.join(told)}{stated}"
        yield Fact("Verdict", text, "Drop", "sampled")
    found = study.elsewhere
    if found.total:
        held = [entry for entry in study.attractors.touching if entry.count or entry.known]
        ends = (
            f"; {listed([motion_words(entry.name) for entry in held])} can hold the rotor, once there" if held else ""
        )
        text = (
            f"{found.count} of {found.total} starts spread over the clearance came back; nothing requires them to{ends}"
        )
        yield Fact("Verdict", text, "Elsewhere", "sampled", disturbances="state")


_HEADLINE, _WHIRL = ("peak force", "depth"), "whirl at the end"


def _levitation(study: FlexibleData) -> Iterator[Fact]:
    found, worst = study.levitation, study.levitation.least_damped
    text = whirl_words(found.machine.speed, found.whirls)
    yield Fact("Levitation", text, "Whirls", values={"damping_ratio": worst.damping_ratio})
    yield Fact("Levitation", other_speeds_words(found.campbell), "Other speeds")
    if found.at_speed is not None:
        yield Fact("Levitation", response_words(found.at_speed), "Unbalance response")
    share = study.rotor.system.rest_radius
    yield Fact("Levitation", zone_words(share, study.zone), "Zone", values={"share": share, "zone": study.zone})


def _holding(study: FlexibleData) -> Iterator[Fact]:
    found, scales = study.attractors, study.rotor.scales
    for entry in found:
        if entry.name.outcome is Outcome.LEVITATED:
            continue
        by = ended_by(entry.count, len(found.disturbances), entry.known)
        force = (
            f", pressed with up to {number(entry.largest_force * scales.force, 3)} N"
            if scales and entry.largest_force
            else ""
        )
        if entry.name.outcome is Outcome.BEYOND_MODEL:
            yield Fact(
                "Disturbances tried",
                f"Beyond the model went {by}{force}: {Outcome.BEYOND_MODEL.meaning}",
                motions=(entry.name,),
            )
            continue
        if not entry.name.outcome.settled:
            text = f"Of {by} the end is not known ({entry.name.outcome.words}){force}."
            yield Fact("Disturbances tried", text, motions=(entry.name,))
            continue
        yield Fact(
            "Backward whirl" if entry.whirl == "backward" else "Disturbances tried",
            f"{entry.words} {by[0].upper()}{by[1:]} ended there{force}.",
            motions=(entry.name,),
        )
    if not found.touching:
        seen = "" if all(entry.name.outcome.settled for entry in found) else " that were followed to their end"
        text = f"None of {len(found.disturbances)} disturbances and of the starts in backward whirl{seen} ended in contact. Other motions may exist."
        yield Fact("Disturbances tried", text, evidence="sampled")


def ended_by(count: int, drawn: int, known: int) -> str:
    """Which of the disturbances drawn, and of the known motions, ended somewhere; those of which none did are left out."""
    by = [f"{count} of {counted(drawn, 'disturbance')}"] if count else []
    return listed([*by, f"{counted(known, 'start')} in backward whirl"] if known else by)


def _tried(study: FlexibleData) -> Iterator[Fact]:
    for trial in study.trials:
        lines = [f"{KINDS[trial.kind]} ({_size(study, trial)}), the worst of {trial.largest.total} at the full size:"]  # type: ignore[index]
        lines += [f"touchdown bearing {each.touchdown_bearing}: {_plane(each)}" for each in trial.planes]
        if trial.whirls:
            lines.append(f"those lost go round {listed(list(trial.whirls))}")
        yield Fact("Touchdown loads", f"{lines[0]} {'; '.join(lines[1:])}.", values=trial.document())
        for check in trial.checks:
            yield Fact("Touchdown loads", f"{KINDS[trial.kind]}, {check.words}.")  # type: ignore[index]


def _plane(each: AtPlane) -> str:
    reach = f"orbit up to {micrometres(each.radius)} from the centre"
    if not each.contacts:
        return f"{reach}, no contact"
    return f"{reach}, {counted(each.contacts, 'contact')}, {number(each.force, 3)} N, {number(1e3 * each.contact_time, 3)} ms in contact"


def _fall(study: FlexibleData) -> Iterator[Fact]:
    loads = study.fall_loads
    if loads is None:
        yield Fact("Drop", "Without weight there is no drop: a table [gravity] in the machine file adds it.")
        return
    say = study.wording
    yield Fact(
        "Drop",
        f"Levitation lost at {rpm(study.levitation.machine.speed)}, followed for {say.time(loads.time)}: {loads.outcome.words}.",
    )
    for title, rows in load_tables(loads, "the release"):
        told = dict(rows)
        chosen = [told["contacts"], *(f"{label} {told[label]}" for label in (*_HEADLINE, _WHIRL) if label in told)]
        yield Fact("Drop", f"{title}: {'; '.join(chosen)}.")
    for check in checks_of_planes(loads, study.case.limits):
        yield Fact("Drop", f"{check.words}.")
