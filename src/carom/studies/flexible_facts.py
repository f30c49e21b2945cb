"""What a study of a flexible machine has found, in words: speeds in rpm, frequencies in Hz, lengths in µm, forces in N, in the fixed frame."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from carom.outcome import Outcome
from carom.parameters.told import number
from carom.studies.endings import motion_words
from carom.studies.facts import Fact, about
from carom.studies.flexible_data import FlexibleData
from carom.studies.flexible_levitation import Critical
from carom.studies.flexible_trials import DIRECTIONS, AtPlane, FlexibleTrial
from carom.studies.load_tables import checks_of_planes, load_tables
from carom.studies.response_words import micrometres, rpm
from carom.studies.standards import CRITICALLY_DAMPED
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
    "Linear results are of all modes. Motions with contact are of {vectors} vectors, {modes} of them modes of the free rotor: their estimated error of contact forces "
    "is {error} %. That is the change of the force of one straight first contact with half as many vectors more, an estimate and no bound: motions in "
    "which the rotor bends on its way may differ by more."
)
SENSITIVITY_LIMITS = "ISO 14839-3: zone A up to 3 (9.5 dB), B up to 4 (12 dB), C up to 5 (14 dB), D above"
_HERTZ = 2.0 * math.pi


def facts_of_machine(study: FlexibleData) -> Iterator[Fact]:
    """List all facts, in the order in which they are told."""
    yield from _survived(study)
    yield from _levitation(study)
    yield from _critical_speeds(study)
    yield from _bearings(study)
    yield from _holding(study)
    yield from _tried(study)
    yield from _fall(study)
    reduced = study.reduced
    error = number(100.0 * reduced.error, 2)
    text = REDUCTION.format(vectors=reduced.vectors, modes=reduced.modes, error=error)
    yield Fact("Accuracy", text, values={"error": reduced.error, "vectors": reduced.vectors, "modes": reduced.modes})
    for each in NOT_COVERED:
        yield Fact("Not covered", each)


def verdict_of_machine(study: FlexibleData, facts: Sequence[Fact]) -> Verdict:
    """The verdict; it never promises that the machine recovers."""
    survived = tuple(f"{fact.label}: {fact.text}." for fact in about(facts, "Verdict"))
    if not study.levitates:
        why = "its sag and whirl from unbalance would reach a touchdown bearing"
        return Verdict("no-contact-free-motion", "Cannot run without contact", why, survived)
    lost = [_size(study, trial) for trial in study.trials if not trial.survived]
    if lost:
        outcome = f"Does not come back from all that it must survive, zone {study.zone}"
        return Verdict("may-not-come-back", outcome, f"some are lost of: {listed(lost)}", survived)
    outcome = f"Came back each time from what it must survive, zone {study.zone}"
    doubts = ["no guarantee, as disturbances are samples", *_doubts(study)]
    return Verdict("all-tried-came-back", outcome, "; ".join(doubts), survived)


def _doubts(study: FlexibleData) -> list[str]:
    """What stands against the machine although all came back."""
    found = []
    loops = study.levitation.sensitivity
    if loops is not None and (zones := sorted(set(loops.zones) & set("CD"))):
        found.append(f"sensitivity in zone {zones[-1]} of ISO 14839-3")
    if not study.levitation.met:
        found.append("a critical speed is nearer than API 617 allows")
    if any(check.exceeded for trial in study.trials for check in trial.checks):
        found.append("a limit of a touchdown bearing is exceeded on the way")
    loads = study.fall_loads
    if loads is not None and any(check.exceeded for check in checks_of_planes(loads, study.case.limits)):
        found.append("a limit of a touchdown bearing is exceeded in a drop")
    held = [entry for entry in study.attractors.touching if entry.count or entry.known]
    if held:
        found.append(f"{listed([motion_words(entry.name) for entry in held])} can hold the rotor, once there")
    return found


def _size(study: FlexibleData, trial: FlexibleTrial) -> str:
    """A kind of disturbance with its size: ``kicks of up to 100 mm/s``."""
    say = study.wording
    if trial.kind == "shock" and study.required.shock is not None:
        return f"shocks of up to {say.acceleration(trial.size)}, {say.time(study.required.shock.duration)}"
    if trial.kind == "blade_loss":
        return f"losses of a blade that leave {say.unbalance(trial.size)}"
    return f"kicks of up to {say.velocity(trial.size)}"


def _survived(study: FlexibleData) -> Iterator[Fact]:
    """For each kind what came back."""
    for trial in study.trials:
        drawn, largest = trial.drawn, trial.largest
        text = f"{drawn.count} of {drawn.total} {_size(study, trial)} came back, and {largest.count} of {largest.total} at the full size in all directions"
        yield Fact("Verdict", text, KINDS[trial.kind], "sampled", trial.document(), disturbances=trial.kind)  # type: ignore[index]
    if study.beyond:
        kick = study.required.kick
        whole = [times for times, back in study.beyond if back == DIRECTIONS]
        times, back = study.beyond[-1]
        parts = (
            [f"at {study.wording.velocity(max(whole) * kick)} all {DIRECTIONS} directions tried came back"]
            if whole
            else []
        )
        if back < DIRECTIONS:
            parts.append(f"at {study.wording.velocity(times * kick)} {back} of {DIRECTIONS} did")
        values = {"times": [each for each, _ in study.beyond], "came_back": [each for _, each in study.beyond]}
        yield Fact("Verdict", "; ".join(parts), "Larger kicks", "sampled", values, disturbances="kick")


def _levitation(study: FlexibleData) -> Iterator[Fact]:
    found, worst = study.levitation, study.levitation.least_damped
    text = (
        f"At {rpm(found.machine.speed)} the least damped of the {len(found.whirls)} slowest whirls is one of {number(worst.frequency, 3)} Hz, {worst.sense}, with a "
        f"damping ratio of {number(worst.damping_ratio, 2)}."
    )
    yield Fact("Levitation", text, "Whirls", values={"damping_ratio": worst.damping_ratio})
    response = found.at_speed
    if response is not None:
        planes = listed(
            [
                f"{micrometres(each)} at plane {place}"
                for place, each in enumerate(response.touchdown_ellipses.major[0], start=1)
            ]
        )
        measured = [
            f"{micrometres(each)} at the sensors of bearing {place}"
            for place, each in enumerate(response.sensor_ellipses.major[0], start=1)
        ]
        # Supports that act differently in two directions make ellipses of circles.
        sizes = "longer half axes" if found.machine.whole.equations.mirrored else "radii"
        reached = f"{planes}, and {listed(measured)}" if measured else planes
        yield Fact("Levitation", f"Its unbalance makes it whirl with {sizes} of {reached}.", "Unbalance response")
    share = study.rotor.system.rest_radius
    say = f"{number(100.0 * share, 3)} % of the clearance at the worst plane"
    yield Fact(
        "Levitation",
        f"With the static sag that is {say}: zone {study.zone} of ISO 14839-2.",
        "Zone",
        values={"share": share, "zone": study.zone},
    )


def _critical_speeds(study: FlexibleData) -> Iterator[Fact]:
    found = study.levitation
    if found.response is None:
        yield Fact("Critical speeds", "Without an unbalance there is no response whose peaks could be told.")
        return
    speeds = found.response.speeds
    if not found.criticals:
        yield Fact("Critical speeds", f"The response has no peak between {rpm(speeds[0])} and {rpm(speeds[-1])}.")
    for each in found.criticals:
        text = f"Bearing {each.bearing}: {rpm(each.speed)}, {micrometres(each.amplitude)} at its sensors; {_separation(study, each)}"
        yield Fact("Critical speeds", text, values={"speed_si": each.speed, "met": each.separation.met})
    rule = "Amplification factors and separations are those of API 617 (API RP 684, SP6.8.2.1 and SP6.8.2.10), by the half-power width at the sensors; its annex on magnetic bearings may state others."
    yield Fact("Critical speeds", f"{rule} Searched from {rpm(speeds[0])} to {rpm(speeds[-1])}.")


def _separation(study: FlexibleData, critical: Critical) -> str:
    margin, factor = critical.separation, critical.factor
    if factor is None:
        return "the peak is too flat for an amplification factor, so none is required."
    told = f"amplification factor {number(factor, 3)}"
    if factor < CRITICALLY_DAMPED:
        return f"{told}: critically damped, so no separation is required."
    run = rpm(study.levitation.machine.speed)
    where = f"{number(100.0 * margin.actual, 3)} % {margin.side} {run}" if margin.side != "inside" else f"at {run}"
    return f"{told}, {where}, required {number(100.0 * margin.required, 3)} %: {'met' if margin.met else 'not met'}."


def _bearings(study: FlexibleData) -> Iterator[Fact]:
    found = study.levitation
    loops = found.sensitivity
    if loops is not None:
        rows = zip(loops.peaks.tolist(), loops.peak_frequencies.tolist(), loops.zones, strict=True)
        told = [
            f"{number(peak, 3)} ({number(20.0 * math.log10(peak), 3)} dB) at {number(at / _HERTZ, 3)} Hz, zone {zone}, of bearing {place}"
            for place, (peak, at, zone) in enumerate(rows, start=1)
        ]
        yield Fact("Magnetic bearings", f"Largest sensitivity: {listed(told)} ({SENSITIVITY_LIMITS}).", "Sensitivity")
    for each in found.collocations:
        name = f"the {each.whirl.sense} whirl of {number(each.whirl.frequency, 3)} Hz (damping ratio {number(each.whirl.damping_ratio, 2)})"
        if each.opposed:
            text = f"A node of {name} lies between the sensors and the magnet of bearing {each.bearing}: they move against each other, so damping by the controller feeds it."
        elif each.hardly:
            what = "sensors hardly see" if abs(each.sensor) <= abs(each.magnet) else "magnet hardly moves"
            text = f"Bearing {each.bearing}: its {what} {name}, for a node lies there."
        else:
            continue
        yield Fact("Magnetic bearings", text, "Non-collocation")
    if found.collocations and not any(each.opposed or each.hardly for each in found.collocations):
        yield Fact(
            "Magnetic bearings",
            f"In none of the {len(found.whirls)} slowest whirls a node lies between sensors and magnet.",
            "Non-collocation",
        )


def _holding(study: FlexibleData) -> Iterator[Fact]:
    found, scales = study.attractors, study.rotor.scales
    for entry in found:
        if entry.name.outcome is Outcome.LEVITATED:
            continue
        by = f"{counted(entry.count, 'disturbance')} of {len(found.disturbances)} and {counted(entry.known, 'start')} in backward whirl ended there"
        force = (
            f", pressed with up to {number(entry.largest_force * scales.force, 3)} N"
            if scales and entry.largest_force
            else ""
        )
        yield Fact(
            "Backward whirl" if entry.whirl == "backward" else "Disturbances tried",
            f"{entry.words} {by[0].upper()}{by[1:]}{force}.",
            motions=(entry.name,),
        )
    if not found.touching:
        text = f"None of {len(found.disturbances)} disturbances, nor of the starts in backward whirl, ended in contact. Other motions may exist."
        yield Fact("Disturbances tried", text, evidence="sampled")


def _tried(study: FlexibleData) -> Iterator[Fact]:
    for trial in study.trials:
        lines = [f"{KINDS[trial.kind]} ({_size(study, trial)}), the worst of {trial.largest.total} at the full size:"]  # type: ignore[index]
        lines += [f"plane {each.plane}: {_plane(each)}" for each in trial.planes]
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
        named = ("peak force", "depth", "whirl at the end")
        chosen = [told["contacts"], *(f"{label} {told[label]}" for label in named if label in told)]
        yield Fact("Drop", f"{title}: {'; '.join(chosen)}.")
    for check in checks_of_planes(loads, study.case.limits):
        yield Fact("Drop", f"{check.words}.")
