"""Every fact of a study, topic by topic: the motions, what disturbances did, what would change it, and what is not covered."""

from __future__ import annotations

from collections.abc import Iterator

from carom.attractors import AttractorSet
from carom.attractors.names import LEVITATION
from carom.closed_forms.exact_results import exact_results
from carom.closed_forms.sag import Levitation
from carom.closed_forms.whirl import Rolling, Runaway
from carom.motions.magnets import pull_words
from carom.orbits.orbit import Orbit
from carom.outcome import STEADY_WORDS, Outcome
from carom.parameters import GRAVITY
from carom.parameters.indentation import gives_way, indentation_of_force, indentation_of_hit
from carom.parameters.told import number
from carom.studies.actuator import actuator_words
from carom.studies.advice_facts import advice_facts
from carom.studies.coverage import not_covered
from carom.studies.endings import came_back, ending_phrase, hardest_impulse, touching
from carom.studies.facts import Fact
from carom.studies.levitation_facts import bearing_facts, critical_speed_facts, levitation_facts
from carom.studies.proven import proofs_of
from carom.studies.questions import unfinished_facts
from carom.studies.rigid_limit import wall_values, wall_words
from carom.studies.study_data import StudyData
from carom.studies.summaries import ranges_along
from carom.studies.touchdown_facts import accuracy_facts, drop_facts, drop_headline, load_facts
from carom.studies.verdict import verdict_facts
from carom.studies.wording import counted, listed, no_rigid_wall, steel_words

RUB, ROLLING = STEADY_WORDS["rub"], STEADY_WORDS["rolling"]


def facts_of(study: StudyData) -> Iterator[Fact]:
    """List all facts of a study, in the order in which they are told."""
    yield from verdict_facts(study)
    yield from drop_headline(study)
    yield from advice_facts(study)
    yield Fact("Levitation", _levitation(study))
    yield from levitation_facts(study.levitating)
    yield from critical_speed_facts(study.levitating)
    yield Fact("Rub", _rub(study))
    yield Fact("Bouncing", _bouncing(study))
    yield Fact("Backward whirl", _backward_whirl(study))
    yield Fact("Disturbances tried", _disturbances(study))
    for found in study.recoveries:
        name, *rows = ranges_along(study.wording, found)
        yield Fact("What would change it", f"{name[0]} (this machine: {name[1]}): {'; '.join(map(' '.join, rows))}.")
    yield from proofs_of(study)
    yield from bearing_facts(study.levitating)
    if study.bearing_demand is not None:
        yield Fact("Magnetic bearings", actuator_words(study.bearing_demand))
    if study.other_walls:
        words, values = wall_words(study.wording, study.other_walls), wall_values(study.other_walls, study.rotor.scales)
        yield Fact("Touchdown bearing", words, evidence="sampled", values=values)
    yield from load_facts(study)
    yield from drop_facts(study)
    yield from accuracy_facts(study)
    yield from unfinished_facts(study.unfinished)
    for text in not_covered(study):
        yield Fact("Not covered", text)


def _levitation(study: StudyData) -> str:
    say, levitation, machine = study.wording, study.equilibria[0], study.case.machine
    if levitation.status == "virtual":
        whirl = "Sag and whirl" if study.heavy else "Its whirl from unbalance"
        return f"The rotor cannot run without contact. {whirl} would need a radius of {say.radius(levitation.radius)}, more than the clearance."
    if levitation.status == "boundary":
        return "The contact-free whirl from unbalance just touches the wall: the least disturbance brings contact."
    where = f"levitates at r = {say.radius(levitation.radius)}"
    if isinstance(levitation, Levitation):
        widths = study.rotor.system.widths
        sag, whirl = (say.length(float((widths * each).max())) for each in (levitation.sags, levitation.radii))
        where = (
            f"hangs {sag} from the centre under its weight and whirls about that place with {whirl}: it comes as far as r = "
            f"{say.radius(levitation.reach)}"
        )
    limits = ", ".join(number(limit, 3) for limit in study.case.zones.limits)
    text = f"The rotor {where}, zone {study.zone} (zone limits {limits} of the clearance). A gap of {say.length(1.0 - levitation.radius)} to the wall is left."
    if not levitation.stable:
        return f"{text} But nothing damps it: a disturbance does not die out."
    decay = -float(levitation.eigenvalues.real.max())
    text += f" Small vibrations decay, with a time constant of {say.time(1.0 / decay)}."
    if machine is not None and machine.air_gap is not None:
        share = machine.clearance / machine.air_gap
        text += (
            f" Where it touches it is {number(100.0 * share, 2)} % of the air gap from the centre; {pull_words(share)}."
        )
    return " ".join([text, *_loss_of_levitation(study)])


def _loss_of_levitation(study: StudyData) -> list[str]:
    """Say how levitation ends if one gain is changed far enough."""
    say = study.wording
    places: dict[str, list[str]] = {}
    for boundary in study.boundaries:
        own = study.case.parameters.value(boundary.gain)
        if (boundary.value < own) == (
            boundary.levitates == "above"
        ):  # else beyond the range in which this machine levitates
            moves = "falls" if boundary.levitates == "above" else "rises"
            where = f"{say.name(boundary.gain)} {moves} to {say.value(boundary.gain, boundary.value)}"
            places.setdefault(_LOSS[boundary.kind], []).append(where)
    return [f"Where {' or '.join(where)}, {what}." for what, where in places.items()]


_LOSS = {
    "persistence": f"it turns into a {RUB} whose force grows from zero",
    "non-smooth fold": f"it meets an unstable {RUB} and both vanish, so that the rotor must go somewhere else",
    "degenerate": "it ends on the wall",
}


def _rub(study: StudyData) -> str:
    rubs, stable = [rub for rub in study.rubs if rub.status != "virtual"], study.stable_rub
    if study.heavy:
        return "Under weight no rub is at rest in the frame that turns with the shaft: where the disturbances below end says whether the rotor stays on the bearing."
    if not rubs:
        return f"No {RUB} exists: the unbalance cannot keep the rotor pressed against the bearing."
    say, rub = study.wording, stable or rubs[0]
    wall = study.rotor.system.contacts[rub.plane].wall
    indentation = indentation_of_force(study.rotor.in_rigid_wall, rub.normal_force)
    load = _with_weight(study, rub.normal_force)
    if gives_way(indentation):
        load = f"one for which there is no model: {steel_words(indentation)}"
    elif (friction := wall.friction * rub.normal_force) > 0.0:
        slip, heat = say.slip(wall.surface_speed), say.power(friction * wall.surface_speed)
        load += f", and friction of {say.force(friction)} at a slip of {slip} would heat the contact with {heat}"
    if stable is None:
        return f"A {RUB} exists. It is not stable in every direction, but it marks a way to stay in contact: the bearing force is {load}."
    coexists = "coexists with levitation" if study.levitates else "exists"
    return f"A {RUB} {coexists} and is stable: once it has settled there the rotor stays pressed against the touchdown bearing. The bearing force would be {load}."


def _of_hit(study: StudyData, impulse: float) -> str:
    """Return a clause on whether the rigid wall is a valid model for the normal impulse of a hit; empty if it is."""
    at = study.rotor.in_rigid_wall
    text = no_rigid_wall(indentation_of_hit(at, impulse / (1.0 + at.d))) if at else ""
    return f"; {text}" if text else ""


def _bouncing(study: StudyData) -> str:
    orbits, sentences = study.orbits, [_stable_orbit(study, orbit) for orbit in study.stable_orbits]
    unstable = sum(orbit.admissible and not orbit.stable for orbit in orbits)
    virtual = sum(not orbit.admissible for orbit in orbits)
    if unstable:
        are, they = ("is", "it takes") if unstable == 1 else ("are", "they take")
        sentences.append(
            f"{counted(unstable, 'orbit')} with one impact a period {are} unstable: the rotor does not stay there, but {they} part in deciding "
            "which disturbances come back."
        )
    if virtual:
        solve = "solves" if virtual == 1 else "solve"
        sentences.append(
            f"{counted(virtual, 'orbit')} {solve} the equations but not the contact law, and so cannot happen."
        )
    if study.rotor.system.why_not_stationary is not None:
        return orbits.argument
    if orbits.search is None and not orbits.longest_period:
        return f"Orbits with one impact a period were not searched for. {' '.join(sentences)}".rstrip()
    if not len(orbits):
        none = "No orbit with one impact a period was found."
        sentences.append(none if orbits.search else "There is no orbit with one impact a period.")
    if orbits.search is not None:
        sentences.append(orbits.argument)
    elif not orbits.complete:
        longest = study.wording.time(orbits.longest_period)
        sentences.append(f"Only periods up to {longest} were searched; there may be more such orbits.")
    elif orbits.slip_stays_forward:
        sentences.append("The list is complete: bounds exclude any other orbit with one impact a period.")
    else:
        sentences.append(
            "The list is complete for impacts that do not stop the slip; orbits whose impacts stop it, which only a rotor "
            "about as small as its clearance can have, were not searched."
        )
    return " ".join(sentences)


def _stable_orbit(study: StudyData, orbit: Orbit) -> str:
    say, impulse, words = study.wording, orbit.impulse, orbit.name.words
    whirl = "forward" if orbit.angular_speed > -1.0 else "backward"
    return (
        f"{words[0].upper()}{words[1:]} can hold the rotor for ever: one impact every {say.time(orbit.period)} "
        f"({say.per_second(orbit.period)}) at {say.velocity(orbit.radial_speed)} towards the wall, each with a normal "
        f"impulse of {say.impulse(impulse)}, a mean force of {say.force(impulse / orbit.period)}, "
        f"in {whirl} whirl{_of_hit(study, impulse)}."
    )


def _disturbances(study: StudyData) -> str:
    say, found, hardest = study.wording, study.attractors, hardest_impulse(study.attractors)
    hit = (
        f" The hardest hit had a normal impulse of {say.impulse(hardest)}{_of_hit(study, hardest)}."
        if hardest > 0
        else ""
    )
    return f"Simulated to where they settle: {found.words()}. {_endings(study)}{hit}"


def _endings(study: StudyData) -> str:
    found, touched = study.attractors, touching(study.attractors)
    counts = {member.name: member.count for member in found if member.count}
    if list(counts) == [LEVITATION]:
        return "All of them came back to levitation."
    if not counts:
        return "None of them was followed."
    text = f"They ended: {listed([f'{count} {ending_phrase(name)}' for name, count in counts.items()])}.{_irregular(found)}"
    if study.levitates and touched:
        text += f" Of the {len(touched)} that touched the wall {came_back(touched) or 'none'} came back to levitation."
    return text


def _irregular(found: AttractorSet) -> str:
    """Say how long irregular bouncing lasts, if any was found."""
    if found.transient is not None:
        return f" On the way some bounced irregularly for long: {found.transient.words}."
    lasting = next((member.survival for member in found if member.survival is not None), None)
    return f" Of such irregular motions {lasting.words}." if lasting else ""


def _backward_whirl(study: StudyData) -> str:
    say, known = study.wording, exact_results(study.rotor)
    roll, runaway = known.rolls, known.whirl
    if roll is None or runaway is None:
        return _simulated_rolling(study)
    name, bound, every_angle = (
        say.name("gamma"),
        *(say.value("gamma", at) for at in (roll.damping_bound, roll.largest_damping)),
    )
    if roll.damping_bound <= 0.0:
        return "Friction cannot sustain any backward whirl in lasting contact, whatever the damping."
    if study.rotor.value("gamma") > roll.damping_bound:
        least = bound if say.scales else f"γ = {bound}"
        return f"Damping is so strong that no backward whirl in lasting contact sustains itself (that takes {least})."
    if not roll.holds:
        return (
            "The rotor cannot roll backward round the bearing for a whole turn, but backward whirl that slides for a part of "
            f"each turn is not ruled out; {name} above {bound} would rule it out."
        )
    part = (
        ""
        if every_angle == bound
        else f" (from {every_angle} on it can roll for a part of each turn only, and slides in between)"
    )
    return (
        f"Dry friction can drive the rotor backward round the bearing. {_no_return(study, runaway)} {_where_it_ends(study, roll)} "
        f"Only {name} above {bound} rules that out{part}."
    )


def _simulated_rolling(study: StudyData) -> str:
    """Say what is known of rolling without closed forms."""
    rolled = [member for member in study.attractors if member.name.outcome is Outcome.ROLLING]
    if not rolled:
        return f"No motion that was followed ended in {ROLLING}."
    count = sum(member.count for member in rolled)
    met = f"{counted(count, 'disturbance')} ended" if count else "a start in rolling stayed"
    return f"Dry friction can drive the rotor backward round the bearing: {met} in {ROLLING}."


def _no_return(study: StudyData, runaway: Runaway) -> str:
    """Say from which speed backward whirl runs away, and with which load on the bearing."""
    say, at = study.wording, study.case.parameters
    force = runaway.certain**2 - at.omega**2 + at.rho
    power = say.power(at.mu * force * max(runaway.rolling_speed - runaway.certain, 0.0))
    certain, average = say.velocity(runaway.certain), say.velocity(runaway.average)
    # Below the speed that is certain the unbalance decides.
    perhaps = "" if certain == average else f", and it may get there from about {average} on"
    return (
        f"There is no return if, in lasting contact, its centre moves backward faster than {certain} (whirl at "
        f"{number(runaway.certain, 3)} times the speed of the shaft){perhaps}; the bearing then carries up to "
        f"{_with_weight(study, force)}, and friction takes {power} from the drive."
    )


def _where_it_ends(study: StudyData, roll: Rolling) -> str:
    """Say with which load it ends in rolling, or that a rigid wall is no model of that."""
    indentation = indentation_of_force(study.case.parameters, roll.largest_force)
    if gives_way(indentation):
        return f"The rigid model cannot predict the final load: in {ROLLING}, a rigid wall would carry a load at which {steel_words(indentation)}."
    return f"It ends in {ROLLING}, with {_with_weight(study, roll.largest_force)}, and stays in it."


def _with_weight(study: StudyData, force: float) -> str:
    """Return a force with its multiple of the weight of the rotor."""
    text, scales = study.wording.force(force), study.rotor.scales
    if scales is None:
        return text
    return f"{text} ({number(force * scales.acceleration / GRAVITY, 3)} times the weight of the rotor)"
