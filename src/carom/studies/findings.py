"""Every fact of a study, topic by topic: the recommendation, the motions, what disturbances did, loads, what would change it, and what is not covered."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial

from carom.attractors.naming import LEVITATION
from carom.base.outcome import STEADY_WORDS, Outcome
from carom.base.results import record
from carom.closed_forms import Levitation, Rolling, Runaway
from carom.models import Edge
from carom.motions.loads import pull_words
from carom.orbits import Orbit
from carom.parameters import GRAVITY, in_terms_of
from carom.parameters.formats import format_entry, number
from carom.parameters.indentation import is_compliant
from carom.rotors import ReducedMachine
from carom.studies.advice import GAIN_FACTOR, Change, evidence_of
from carom.studies.levitating import bearing_facts, levitation_facts
from carom.studies.questions import GROWTH, LABELS, UNFINISHED, Evidence, Fact
from carom.studies.standstill import spin_down_facts
from carom.studies.study_data import StudyData
from carom.studies.summaries import ranges_along
from carom.studies.verdict import proven_words, verdict_facts
from carom.studies.wording import (
    Wording,
    counted,
    edge_words,
    ending_phrase,
    entry_words,
    indentation_of_steel,
    listed,
    no_rigid_wall,
    present_values,
    steel_words,
)

RUB, ROLLING = STEADY_WORDS["rub"], STEADY_WORDS["rolling"]
ASSUMED = "; gravity of 9.81 m/s² downward is assumed, as the file states none"
BORNE = {
    True: ("{contacts:contact}, up to {force}, {contact_time} in contact",),
    False: ("{contacts:impact}, impulse up to {impulse}", "up to {force} in {contact_time} of lasting contact"),
}
"""What is stated of a compliant touchdown bearing, and of a rigid one, beside the orbit; what is zero is left out."""
HEADLINE = ("peak force", "depth", "hardest impact", "lasting contact", "whirl at the end")
NO_DROP = "No drop was simulated: it needs SI units, and a rotor whose stiffness without levitation is known."
SAMPLED = "Disturbances that were not simulated{but}: one between the samples, or a larger one, may end elsewhere."
PROVEN_KICKS = ", except the kicks that are proven to come back"
LONGER_MOTIONS = "Motions with two or more impacts a period, irregular motions, and motions that alternate between bounces and lasting contact, unless a simulated disturbance ended in one."
RIGID_WALL = "Motion, rotation and compliance of the touchdown bearing: an impact on a rigid wall has an impulse but no peak force."
COMPLIANT_WALL = "Wear, heat and axial motion of the touchdown bearing: its contact law is taken as stated."
PLANAR = "Changes of speed, gravity, bending and tilting of the rotor, and controllers other than a spring and damper."
LINEAR = "Changes of speed, and what the file does not state: internal damping, support coefficients that vary with speed, limits of the magnetic bearings."
SYMMETRY = f"{RUB.capitalize()}s and orbits in closed form, which need rotational symmetry; and kicks at other angles of the unbalance than that in the machine file."
CLOSED_FORMS = "What closed forms give for the planar rotor only: whether rolling persists, the speed from which whirl runs away to rolling, the range in which each motion exists, and that no orbit is missing."
AT_LIMITS = "Disturbances at other angles of the unbalance than that in the machine file, saturation of the iron, and voltage limits of the magnetic bearings."
CHANGES = ("Change", "Or")
"""Labels of the changes that help."""
_NO_CHANGE = {
    "no-change-needed": "none indicated: all disturbances tried up to the requirement came back",
    "not-decided": "undecided: too few of the required disturbances could be followed to their end",
    "no-change-found": f"none found that brings back every required disturbance and changes no gain by more than a factor of {number(GAIN_FACTOR)}",
}
_HOW_SURE = "closed form: exact; searched: complete lists of orbits at closely spaced values; sampled: random disturbances, so rare ones may end elsewhere; results not marked 'proven' are not proven"
_LAST_ZONE = "D"
_advised = partial(Fact, "Recommendation")


def facts_of(study: StudyData) -> Iterator[Fact]:
    """List all facts of a study, in the order in which they are stated."""
    yield from verdict_facts(study)
    yield from drop_headline(study)
    yield from advice_facts(study)
    yield Fact("Levitation", _levitation(study))
    yield from levitation_facts(study.levitating)
    yield Fact("Rub", _rub(study))
    yield Fact("Bouncing", _bouncing(study))
    yield Fact("Backward whirl", _backward_whirl(study))
    yield Fact("Disturbances tried", _disturbances(study))
    for found in study.recoveries:
        name, *rows = ranges_along(study.wording, found)
        yield Fact("What would change it", f"{name[0]} (this machine: {name[1]}): {'; '.join(map(' '.join, rows))}.")
    if study.proof is not None:
        yield Fact("Proven", proven_words(study.proof, study.rotor.scales), evidence="proven")
    yield from bearing_facts(study.levitating)
    if study.bearing_demand is not None:
        yield Fact("Magnetic bearings", study.bearing_demand.words, values=study.bearing_demand.document())
    yield from load_facts(study)
    yield from drop_facts(study)
    yield from spin_down_facts(study.spin_down)
    yield from accuracy_facts(study)
    yield from unfinished_facts(study)
    yield from (Fact("Not covered", text) for text in not_covered(study))


def unfinished_facts(study: StudyData) -> Iterator[Fact]:
    """What was not followed to its end, and how much of it was."""
    if study.unfinished:
        shown = [f"{each.words} ({each.followed:,} of {each.asked:,} motions)" for each in study.unfinished]
        text = f"Not completed: {listed(shown)}. Each search stops after a fixed number of simulated events, or at the time limit."
        yield Fact("Not reached", text, values={"questions": [record(each, UNFINISHED) for each in study.unfinished]})


def _levitation(study: StudyData) -> str:
    say, levitation, si = study.wording, study.equilibria[0], study.case.si
    if levitation.status == "virtual":
        whirl = "Sag and whirl" if study.under_gravity else "Its whirl from unbalance"
        return f"The rotor cannot run without contact. {whirl} would need a radius of {say.radius(levitation.radius)}, more than the clearance."
    if levitation.status == "boundary":
        return "The contact-free whirl from unbalance just touches the wall: any disturbance leads to contact."
    where = f"levitates at r = {say.radius(levitation.radius)}"
    if isinstance(levitation, Levitation):
        widths = study.rotor.system.widths
        sag, whirl = (say.length(float((widths * each).max())) for each in (levitation.sags, levitation.radii))
        where = f"sags {sag} from the bearing centre and whirls about that point with a radius of {whirl}, reaching r = {say.radius(levitation.reach)}"
    limits = ", ".join(number(limit, 3) for limit in study.case.zones.limits)
    text = f"The rotor {where}, zone {study.zone} (zone limits {limits} of the clearance)."
    if not levitation.stable:
        grows = levitation.eigenvalues.real.max() > GROWTH
        return f"{text} {'Small vibrations grow.' if grows else 'It has no damping: vibrations do not decay.'}"
    decay = -float(levitation.eigenvalues.real.max())
    text += f" Small vibrations decay, with a time constant of {say.time(1.0 / decay)}."
    if "air_gap" in si:
        share = si["clearance"] / si["air_gap"]
        text += f" The clearance is {number(100.0 * share, 2)} % of the air gap; {pull_words(share)}."
    return text


def _rub(study: StudyData) -> str:
    rubs, stable = [rub for rub in study.rubs if rub.status != "virtual"], study.stable_rub
    if study.under_gravity:
        return "Under weight no rub is an equilibrium of the co-rotating frame. The disturbances below show whether the rotor stays on the bearing."
    if not rubs:
        return f"No {RUB} exists: the unbalance cannot keep the rotor pressed against the bearing."
    say, rub = study.wording, stable or rubs[0]
    wall = study.rotor.system.contacts[rub.plane].wall
    load = _load(study, rub.normal_force)
    if wall.friction and not is_compliant(indentation_of_steel(study.rotor, force=rub.normal_force)):
        load += f", and friction would heat the contact at {say.power(wall.friction * rub.normal_force * wall.surface_speed)}"
    coexists = "coexists with levitation" if study.levitates else "exists"
    holds = "is stable: it can hold the rotor" if stable else "is not stable in every direction"
    return f"A {RUB} {coexists} and {holds}. The bearing force would be {load}."


def _load(study: StudyData, force: float) -> str:
    """A force of lasting contact as a multiple of the weight of the rotor, or that the rigid model cannot predict it."""
    indentation, scales = indentation_of_steel(study.rotor, force=force), study.rotor.scales
    if is_compliant(indentation):
        return f"a force that the rigid model cannot predict: {steel_words(indentation)}"
    weight = f" ({number(force * scales.acceleration / GRAVITY, 3)} times the weight of the rotor)" if scales else ""
    return f"{study.wording.force(force)}{weight}"


def _of_impact(study: StudyData, impulse: float) -> str:
    """Return a clause on whether the rigid wall is a valid model for the normal impulse of an impact; empty if it is."""
    text = no_rigid_wall(indentation_of_steel(study.rotor, impulse))
    return f"; {text}" if text else ""


def _bouncing(study: StudyData) -> str:
    orbits = study.orbits
    if orbits.search is not None or study.rotor.system.why_not_stationary is not None:
        sure = orbits.argument
    elif not orbits.longest_period:
        sure = "Orbits with one impact a period were not searched."
    elif not orbits.complete:
        longest = study.wording.time(orbits.longest_period)
        sure = f"Orbits with one impact a period were searched up to a period of {longest}; there may be others with longer periods."
    else:
        none = "" if study.stable_orbits else "No orbit with one impact a period is stable. "
        but = "" if orbits.slip_stays_forward else ", except orbits with impacts that stop the slip"
        sure = f"{none}All orbits with one impact a period were found{but}."
    return " ".join([*(_stable_orbit(study, orbit) for orbit in study.stable_orbits), sure])


def _stable_orbit(study: StudyData, orbit: Orbit) -> str:
    say, impulse, words = study.wording, orbit.impulse, orbit.name.words
    whirl = "forward" if orbit.angular_speed > -1.0 else "backward"
    return (
        f"{words[0].upper()}{words[1:]} can persist indefinitely: one impact every {say.time(orbit.period)} "
        f"({say.per_second(orbit.period)}) at {say.velocity(orbit.radial_speed)} towards the wall, each with a normal "
        f"impulse of {say.impulse(impulse)}, a mean force of {say.force(impulse / orbit.period)}, "
        f"in {whirl} whirl{_of_impact(study, impulse)}."
    )


def _disturbances(study: StudyData) -> str:
    say, found, hardest = study.wording, study.attractors, study.attractors.hardest_impulse
    counts, touched = {member.name: member.count for member in found if member.count}, found.touched
    text = f"Simulated until they settled: {found.words()}."
    if not counts:
        return f"{text} None of them was followed."
    if list(counts) == [LEVITATION]:
        text += " All of them came back to levitation."
    else:
        text += f" Outcomes: {listed([f'{count} {ending_phrase(name)}' for name, count in counts.items()])}."
        if study.levitates and touched:
            back = sum(each.recovered for each in touched)
            text += f" Of {len(touched)} that touched the wall, {back or 'none'} came back to levitation."
    if hardest > 0.0:
        text += f" The hardest impact had a normal impulse of {say.impulse(hardest)}{_of_impact(study, hardest)}."
    return text


def _backward_whirl(study: StudyData) -> str:
    say, known = study.wording, study.known
    roll, runaway = known.rolls, known.whirl
    if roll is None or runaway is None:
        return _simulated_rolling(study)
    bound = f"{say.name('gamma')} above {say.value('gamma', roll.damping_bound)}"
    if roll.damping_bound <= 0.0:
        return "Friction cannot sustain backward whirl in lasting contact at any damping."
    if study.rotor.value("gamma") > roll.damping_bound:
        return f"Backward whirl in lasting contact cannot sustain itself: {bound} rules it out."
    if not roll.holds:
        return f"The rotor cannot roll backward for a whole turn, but may slide backward for part of each turn; {bound} would rule this out."
    return f"Dry friction can drive the rotor backward round the bearing. {_no_return(study, runaway, roll)} Only {bound} rules that out."


def _simulated_rolling(study: StudyData) -> str:
    """Say what is known of rolling without closed forms."""
    rolled = [member for member in study.attractors if member.name.outcome is Outcome.ROLLING]
    if not rolled:
        return f"No simulated motion ended in {ROLLING}."
    count = sum(member.count for member in rolled)
    met = f"{counted(count, 'disturbance')} ended" if count else "a motion started in rolling stayed"
    return f"Dry friction can drive the rotor backward round the bearing: {met} in {ROLLING}."


def _no_return(study: StudyData, runaway: Runaway, roll: Rolling) -> str:
    """Say from which speed backward whirl runs away, with which load on the bearing, and with which it ends."""
    at, whirl = study.case.parameters, number(runaway.certain, 3)
    force = runaway.certain**2 - at.omega**2 + at.rho
    return (
        f"There is no return once, in lasting contact, its centre moves backward faster than {study.wording.velocity(runaway.certain)} (whirl at "
        f"{whirl} times the shaft speed). The bearing then carries up to {_load(study, force)}, and in the final {ROLLING} "
        f"{_load(study, roll.largest_force)}."
    )


def load_facts(study: StudyData) -> Iterator[Fact]:
    """What each kind that must be survived asks of the bearings at its full size, and the worst of all against limits."""
    for each in study.full_size:
        label = LABELS[each.kind]
        size = study.wording.size_of(each.kind)(each.size)
        of = "phases" if each.kind == "blade_loss" else "directions"
        lines = [f"{label} of {size}, worst of {each.back.total} {of} ({each.back.count} came back):"]
        for bearing in each.bearings:
            say = Wording(bearing.scales)
            borne = filter(None, (say.fill(text, bearing) for text in BORNE[bearing.is_compliant]))
            at = f"touchdown bearing {bearing.touchdown_bearing}: " if len(each.bearings) > 1 else ""
            orbit = f"orbit radius up to {say.length(bearing.radius)}"
            lines.append(f"{at}{', '.join([orbit, *(borne if bearing.contacts else ['no contact'])])}")
        if each.whirls:
            lines.append(f"those that do not come back whirl {listed(list(each.whirls))}")
        yield Fact("Touchdown loads", f"{lines[0]} {'; '.join(lines[1:])}.", label, values=each.document())
        yield from (Fact("Touchdown loads", f"{label}, {check.words}.", label) for check in each.checks)


def drop_headline(study: StudyData) -> Iterator[Fact]:
    """The drop with its loads, as it belongs to the verdict."""
    drop = study.drop
    if drop is None:
        return
    shown = [
        f"{title and f'{title.lower()}: '}{'; '.join(f'{label}: {words}' for label, words in rows if label in HEADLINE) or 'no contact'}"
        for title, rows in drop.tables
    ]
    limits = "" if drop.checks else "; the file states no limits of the touchdown bearing"
    loads = drop.loads
    text = f"{loads.outcome.words} after {study.wording.time(loads.time)}; {'; '.join(shown)}{limits}"
    yield Fact("Verdict", f"{text}{ASSUMED if drop.assumed else ''}", "Drop", "sampled")


def drop_facts(study: StudyData) -> Iterator[Fact]:
    """How the drop ends, and its loads against limits; the verdict has what each bearing bears."""
    drop = study.drop
    if drop is None:
        yield Fact("Drop", NO_DROP if study.levitates else "It does not levitate, so there is no drop.")
        return
    yield Fact("Drop", f"{drop.echo.words}. {drop.headline}")
    yield from (Fact("Drop", f"{check.words}.") for check in drop.checks)


def accuracy_facts(study: StudyData) -> Iterator[Fact]:
    """What the reduction of a flexible machine leaves out, and how far the linear law of magnets holds."""
    reduced = study.rotor.finite_elements
    if reduced is not None:
        yield Fact("Accuracy", reduction_words(reduced), values=record(reduced, "error vectors modes"))
    along = [(LABELS[each.kind], found) for each in study.full_size for found in (each.magnets, each.reduction)]
    if study.drop is not None:
        along.append(("Drop", study.drop.reduction))
    for kind, found in along:
        if found is not None and found.words:
            yield Fact("Accuracy", f"{kind}, worst case: {found.words}", values=found.document())


def reduction_words(reduced: ReducedMachine) -> str:
    """What the reduction of a machine leaves out."""
    ratio, error = reduced.damped.damping_ratio, number(100.0 * reduced.error, 2)
    text = f"Linear results use all modes; motions with contact use {reduced.vectors} vectors ({reduced.modes} modes of the free rotor). "
    text += f"Half as many vectors more change the force of a first contact by {error} %."
    if ratio:
        text += f" Vectors that are not modes are given a damping ratio of {number(ratio)}, without which one of them would grow."
    return text


def not_covered(study: StudyData) -> tuple[str, ...]:
    """What the study does not cover, by what the rotor has."""
    rotor, exact = study.rotor, study.known.orbits
    shown = {
        SAMPLED.format(but=PROVEN_KICKS if study.kicks is not None and study.kicks.share else ""): True,
        LONGER_MOTIONS: True,
        COMPLIANT_WALL if (rotor.system.arrays["stiffness"] > 0.0).any() else RIGID_WALL: True,
        PLANAR if exact else LINEAR: True,
        SYMMETRY: study.under_gravity,
        CLOSED_FORMS: not exact,
        AT_LIMITS: bool(rotor.system.limits),
    }
    return tuple(text for text, holds in shown.items() if holds)


def advice_facts(study: StudyData) -> Iterator[Fact]:
    """The machine, what it does now, the changes that help, and how sure all this is."""
    say, si, recommended = study.wording, study.case.si, study.recommendation
    shown = [present_values(study.case)]
    shown += [f"{name} {format_entry(name, si[name])}" for name in ("mass", "clearance", "eccentricity") if name in si]
    yield _advised(", ".join(shown), "Machine")
    kind = recommended.kind
    if kind in _NO_CHANGE:
        finished = all(entry.complete and entry.searched for entry in study.recoveries)
        but = ", but the search was not finished" if kind == "no-change-found" and not finished else ""
        yield _advised(f"{_NO_CHANGE[kind]}{but}", "Change", "sampled")
    for place, change in enumerate(recommended.changes):
        yield _advised(_change(study, change), CHANGES[min(place, 1)], values=change.document(say))
        for label, text, sure in _details(study, change):
            yield _advised(text, label, sure, detail=True)
    for margin in recommended.margins:
        name, end, own = margin.parameter, margin.edge.value, study.case.parameters.value(margin.parameter)
        side = "above" if own > end else "below"
        text = f"{say.name(name)} {say.value(name, own)} is {number(100.0 * margin.share, 2)} % {side} {say.value(name, end)}, {edge_words(margin.edge)}"
        values = say.in_both(name, present=own) | margin.document(say)
        yield _advised(text, "Margin", evidence_of(margin.edge), values, detail=True)
    of_now = "" if study.proof is None else "; proofs hold for the present values, not for the change"
    yield _advised(f"{_HOW_SURE}{of_now}.", "How sure")


def _change(study: StudyData, change: Change) -> str:
    """The change in the terms of the machine file, what it is in others, and how far beyond it was searched."""
    name, terms = change.parameter, change.terms
    # ω varies with the square root of the stiffness.
    what = "stiffness" if name == "omega" and not study.wording.of_machine else study.wording.name(name)
    times = "none at present" if math.isinf(change.ratio) else f"{what} × {number(change.ratio, 3)}"
    now, far = (in_terms_of(study.case, name, value).text for value in (change.present, change.far.value))
    bound, searched = ("", "") if change.bound == "about" else (f"{change.bound} ", f", searched to {far}")
    return f"{entry_words(terms.entry)} {now} → {bound}{terms.text} ({', '.join([*terms.beside, times])}){searched}"


def _details(study: StudyData, change: Change) -> Iterator[tuple[str, str, Evidence | None]]:
    """Label, text and evidence of the lines under a change: how to try it, margin, levitation there, what was tried, what remains."""
    say, margin, zone = study.wording, change.margin, f"zone {change.zone}"
    yield "Set", f'--set "{change.terms.setting}"', None
    text = f"{number(100.0 * margin.share, 2)} % beyond {_end(say, margin.parameter, margin.edge)}"
    text += f"; stay on this side of {_end(say, change.parameter, change.far)}" if change.bound == "about" else ""
    yield "Margin", text, None
    if change.zone == _LAST_ZONE:
        zone = f"{'still ' if study.zone == _LAST_ZONE else ''}{zone}: the unbalance must be reduced too"
    yield "Then", f"levitates at a radius of {say.length(change.radius)}, {zone}", "closed form"
    yield "Tried", _tried(study, change), "sampled"
    if change.whirl is not None:
        fast = say.velocity(change.whirl.certain)
        text = f"{Outcome.ROLLING.words}: certain to begin if, in lasting contact, the rotor centre moves backward faster than {fast}"
        yield "Remains", text, "closed form"


def _tried(study: StudyData, change: Change) -> str:
    """Say how many fresh disturbances were followed at the value, and that all came back."""
    drawn, largest = change.check.drawn, sum(share.total for share in change.check.largest)
    return (
        f"all of {drawn.total:,} new disturbances up to {study.wording.velocity(study.required.kick)}, and {largest:,} at full size, "
        f"came back (95 % confidence: at least {number(100.0 * drawn.low, 4)} % do)"
    )


def _end(say: Wording, name: str, edge: Edge) -> str:
    return f"{say.value(name, edge.value)}, {edge_words(edge)} ({evidence_of(edge)})"
