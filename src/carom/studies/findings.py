"""The paragraphs of a verdict, one function for each topic."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from carom.attractors import AttractorSet
from carom.attractors.names import LEVITATION
from carom.closed_forms.equilibria import Equilibrium
from carom.closed_forms.exact_results import exact_results
from carom.closed_forms.sag import Levitation
from carom.closed_forms.whirl import Rolling, Runaway
from carom.motions.magnets import pull_words
from carom.orbits.orbit import Orbit
from carom.outcome import STEADY_WORDS, Outcome
from carom.parameters import GRAVITY
from carom.parameters.indentation import gives_way, indentation_of_force, indentation_of_hit
from carom.parameters.told import number
from carom.studies.endings import came_back, ending_phrase, hardest_impulse, motion_words, touching
from carom.studies.facts import Topic
from carom.studies.ranges import Motion
from carom.studies.recovery import Recovery
from carom.studies.study_data import StudyData
from carom.studies.wording import Wording, counted, listed, no_rigid_wall, steel_words

RUB, ROLLING = STEADY_WORDS["rub"], STEADY_WORDS["rolling"]


def stable_rub(study: StudyData) -> Equilibrium | None:
    """Return the stable, admissible synchronous rub, which can hold the rotor, if there is one."""
    return next((rub for rub in study.rubs if rub.stable and rub.status == "admissible"), None)


def _levitation(study: StudyData) -> str:
    say, levitation = study.wording, study.equilibria[0]
    limits = ", ".join(number(limit, 3) for limit in study.case.zones.limits)
    if levitation.status == "virtual":
        return (
            f"The rotor cannot run without contact. {'Sag and whirl' if study.heavy else 'Its whirl from unbalance'} would need a radius of "
            f"{say.radius(levitation.radius)}, more than the clearance."
        )
    if levitation.status == "boundary":
        return "The contact-free whirl from unbalance just touches the wall: the least disturbance brings contact."
    if isinstance(levitation, Levitation):
        widths = study.rotor.system.widths
        sag, whirl = (say.length(float((widths * each).max())) for each in (levitation.sags, levitation.radii))
        text = (
            f"The rotor hangs {sag} from the centre under its weight and whirls about that place with {whirl}: it comes as far as r = "
            f"{say.radius(levitation.reach)}, zone {study.zone} (zone limits {limits} of the clearance). "
        )
    else:
        text = (
            f"The rotor levitates at r = {say.radius(levitation.radius)}, zone {study.zone} "
            f"(zone limits {limits} of the clearance). "
        )
    text += f"A gap of {say.length(1.0 - levitation.radius)} to the wall is left. "
    decay = -float(levitation.eigenvalues.real.max())
    if not levitation.stable:
        return text + "But nothing damps it: a disturbance does not die out."
    text += f"Disturbances that do not reach the wall die out, with a time constant of {say.time(1.0 / decay)}."
    if study.case.machine is not None and study.case.machine.air_gap is not None:
        share = study.case.machine.clearance / study.case.machine.air_gap
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
        if (boundary.value < own) != (boundary.levitates == "above"):
            continue  # beyond the range in which this machine levitates
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
    if study.heavy:
        return (
            "Under weight no rub is at rest in the frame that turns with the shaft. Where the rotor stays on the bearing is told by where "
            "the disturbances below end."
        )
    rubs = [rub for rub in study.rubs if rub.status != "virtual"]
    if not rubs:
        return f"No {RUB} exists: the unbalance cannot keep the rotor pressed against the bearing."
    stable = stable_rub(study)
    if stable is None:
        return (
            f"A {RUB} exists. It is not stable in every direction, but it marks a way to stay in contact: the bearing force "
            f"is {_rub_load(study, rubs[0])}."
        )
    start = f"A {RUB} exists and is stable"
    if study.levitates:
        start = f"A {RUB} coexists with levitation and is stable"
    return (
        f"{start}: once it has settled there the rotor stays pressed against the touchdown bearing. "
        f"The bearing force would be {_rub_load(study, stable)}."
    )


def _rub_load(study: StudyData, rub: Equilibrium) -> str:
    say, wall = study.wording, study.rotor.system.contacts[rub.plane].wall
    indentation = indentation_of_force(study.rotor.in_rigid_wall, rub.normal_force)
    if gives_way(indentation):
        return f"one for which there is no model: {steel_words(indentation)}"
    friction, slip = wall.friction * rub.normal_force, wall.surface_speed
    text = _with_weight(study, rub.normal_force)
    if friction > 0:
        text += (
            f", and friction of {say.force(friction)} at a slip of {say.slip(slip)} would heat the contact with "
            f"{say.power(friction * slip)}"
        )
    return text


def _of_hit(study: StudyData, impulse: float) -> str:
    """Return a clause on whether the rigid wall is a valid model for the normal impulse of a hit; empty if it is."""
    at = study.rotor.in_rigid_wall
    text = no_rigid_wall(indentation_of_hit(at, impulse / (1.0 + at.d))) if at else ""
    return f"; {text}" if text else ""


def _bouncing(study: StudyData) -> str:
    orbits = study.orbits
    stable = study.stable_orbits
    unstable = [orbit for orbit in orbits if orbit.admissible and not orbit.stable]
    virtual = [orbit for orbit in orbits if not orbit.admissible]
    sentences = [_stable_orbit(study, orbit) for orbit in stable]
    if unstable:
        one = len(unstable) == 1
        sentences.append(
            f"{counted(len(unstable), 'orbit')} with one impact a period {'is' if one else 'are'} unstable: the rotor does not "
            f"stay there, but {'it takes' if one else 'they take'} part in deciding which disturbances come back."
        )
    if virtual:
        sentences.append(
            f"{counted(len(virtual), 'orbit')} solve{'s' if len(virtual) == 1 else ''} the equations but not the contact law, "
            "and so cannot happen."
        )
    if study.rotor.system.limits:
        return orbits.argument
    if orbits.search is None and not orbits.longest_period:
        return f"Orbits with one impact a period were not searched for. {' '.join(sentences)}".rstrip()
    if not len(orbits):
        none = "No orbit with one impact a period was found."
        sentences.append(none if orbits.search else "There is no orbit with one impact a period.")
    if orbits.search is not None:
        sentences.append(orbits.argument)
    elif orbits.complete and orbits.slip_stays_forward:
        sentences.append("The list is complete: bounds exclude any other orbit with one impact a period.")
    elif orbits.complete:
        sentences.append(
            "The list is complete for impacts that do not stop the slip; orbits whose impacts stop it, which only a rotor "
            "about as small as its clearance can have, were not searched."
        )
    else:
        longest = study.wording.time(orbits.longest_period)
        sentences.append(f"Only periods up to {longest} were searched; there may be more such orbits.")
    return " ".join(sentences)


def _stable_orbit(study: StudyData, orbit: Orbit) -> str:
    say, impulse = study.wording, orbit.impulse
    words = orbit.name.words
    whirl = "forward" if orbit.angular_speed > -1.0 else "backward"
    return (
        f"{words[0].upper()}{words[1:]} can hold the rotor for ever: one impact every {say.time(orbit.period)} "
        f"({say.per_second(orbit.period)}) at {say.velocity(orbit.radial_speed)} towards the wall, each with a normal "
        f"impulse of {say.impulse(impulse)}, a mean force of {say.force(impulse / orbit.period)}, "
        f"in {whirl} whirl{_of_hit(study, impulse)}."
    )


def _disturbances(study: StudyData) -> str:
    say, found = study.wording, study.attractors
    text = f"Simulated to where they settle: {found.words()}. {_endings(study)}"
    hardest = hardest_impulse(found)
    if hardest > 0:
        text += f" The hardest hit had a normal impulse of {say.impulse(hardest)}{_of_hit(study, hardest)}."
    return text


def _endings(study: StudyData) -> str:
    found = study.attractors
    counts = {member.name: member.count for member in found if member.count}
    if list(counts) == [LEVITATION]:
        return "All of them came back to levitation."
    if not counts:
        return "None of them was followed."
    parts = [f"{count} {ending_phrase(name)}" for name, count in counts.items()]
    text = f"They ended: {listed(parts)}.{_irregular(found)}"
    touched = touching(found)
    if study.levitates and touched:
        text += f" Of the {len(touched)} that touched the wall {came_back(touched) or 'none'} came back to levitation."
    return text


def _irregular(found: AttractorSet) -> str:
    """Say how long irregular bouncing lasts, if any was found."""
    if found.transient is not None:
        return f" On the way some bounced irregularly for long: {found.transient.words}."
    lasting = next((member for member in found if member.survival is not None), None)
    return f" Of such irregular motions {lasting.survival.words}." if lasting and lasting.survival else ""


def _backward_whirl(study: StudyData) -> str:
    say, known = study.wording, exact_results(study.rotor)
    roll, runaway = known.rolls, known.whirl
    if roll is None or runaway is None:
        return _simulated_rolling(study)
    gamma = study.rotor.value("gamma")
    bound = say.value("gamma", roll.damping_bound)
    if roll.damping_bound <= 0.0:
        return "Friction cannot sustain any backward whirl in lasting contact, whatever the damping."
    if gamma > roll.damping_bound:
        least = bound if say.scales else f"γ = {bound}"
        return f"Damping is so strong that no backward whirl in lasting contact sustains itself (that takes {least})."
    if not roll.holds:
        return (
            "The rotor cannot roll backward round the bearing for a whole turn, but backward whirl that slides for a part of "
            f"each turn is not ruled out; {say.name('gamma')} above {bound} would rule it out."
        )
    return (
        f"Dry friction can drive the rotor backward round the bearing. {_no_return(study, runaway)} {_where_it_ends(study, roll)} "
        f"Only {say.name('gamma')} above {bound} rules that out{_interrupted(study, roll)}."
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
    power = at.mu * force * max(runaway.rolling_speed - runaway.certain, 0.0)
    certain, average = say.velocity(runaway.certain), say.velocity(runaway.average)
    # Below the speed that is certain the unbalance decides.
    perhaps = "" if certain == average else f", and it may get there from about {average} on"
    return (
        f"There is no return if, in lasting contact, its centre moves backward faster than {certain} (whirl at "
        f"{number(runaway.certain, 3)} times the speed of the shaft){perhaps}; the bearing then carries up to "
        f"{_with_weight(study, force)}, and friction takes {say.power(power)} from the drive."
    )


def _where_it_ends(study: StudyData, roll: Rolling) -> str:
    """Say with which load it ends in rolling, or that a rigid wall is no model of that."""
    indentation = indentation_of_force(study.case.parameters, roll.largest_force)
    if gives_way(indentation):
        return f"Where that ends there is no model: in {ROLLING}, a rigid wall would carry a load at which {steel_words(indentation)}."
    force = _with_weight(study, roll.largest_force)
    return f"It ends in {ROLLING}, with {force}, and stays in it."


def _interrupted(study: StudyData, roll: Rolling) -> str:
    """Explain the two limits of rolling, if they differ in the digits shown."""
    every_angle, bound = (study.wording.value("gamma", limit) for limit in (roll.largest_damping, roll.damping_bound))
    if every_angle == bound:
        return ""
    return f" (from {every_angle} on it can roll for a part of each turn only, and slides in between)"


def _with_weight(study: StudyData, force: float) -> str:
    """Return a force with its multiple of the weight of the rotor."""
    text, scales = study.wording.force(force), study.rotor.scales
    if scales is None:
        return text
    return f"{text} ({number(force * scales.acceleration / GRAVITY, 3)} times the weight of the rotor)"


def _remedies(study: StudyData) -> str:
    return "\n".join(_remedies_along(study.wording, found) for found in study.recoveries)


def _remedies_along(say: Wording, found: Recovery) -> str:
    along = found.along
    name, own = say.name(along.name), say.value(along.name, along.value(found.rotor))
    parts = []
    for motion, words in _POSSIBLE.items():
        entry = found.range_of(motion)
        if entry is not None and (entry.spans or motion != "stable-single-impact"):
            parts.append(f"{words} {say.where(along.name, entry.spans, entry.searched)}")
    if found.range_of("single-impact") and not found.range_of("stable-single-impact"):
        parts.append(
            f"{_POSSIBLE['stable-single-impact'].rstrip(',')} were not searched: there are too many orbits to follow"
        )
    what = name if not say.of_machine else f"{name[0].upper()}{name[1:]}"  # A symbol keeps its case: Ω is not ω.
    possible = f"{'; '.join(parts)}. " if parts else ""
    return f"{what} (this machine: {own}): {possible}{_recovery_words(say, found, name)}"


def _recovery_words(say: Wording, found: Recovery, name: str) -> str:
    """Say where along a parameter everything tried came back, how much was tried, and what was met beyond."""
    along = found.along.name
    if found.motions and not found.range_of("single-impact"):
        return f"At which {name} all that must be survived comes back was not searched."
    if not found.searched:
        return f"There is no {name} in the range searched at which the rotor levitates."
    if not found.complete:
        return f"The search for the {name} at which all that must be survived comes back was not finished."
    low, high = say.value(along, found.searched[0].low.value), say.value(along, found.searched[-1].high.value)
    if not found.spans:
        return f"At no {name} tried from {low} to {high} all that must be survived came back."
    each = min(check.tried for check in found.clear)
    ends = {(edge.motion, edge.value) for span in found.spans for edge in span if edge.motion}
    met = [f"some end in {motion_words(motion)} beyond {say.value(along, value)}" for motion, value in sorted(ends)]
    beyond = f"; {listed(met)}" if met else ""
    return (
        f"Of {each:,} disturbances at each of {counted(len(found.clear), 'value')} of {name} none was lost "
        f"{say.where(along, found.spans)}, searched from {low} to {high}{beyond}."
    )


_POSSIBLE: dict[Motion, str] = {
    "contact-free": "levitation exists",
    "rub": f"a {RUB} can hold the rotor",
    "single-impact": "orbits with one impact a period are possible",
    "stable-single-impact": "stable ones, which can hold the rotor,",
}


FINDINGS: Mapping[Topic, Callable[[StudyData], str]] = {
    "Levitation": _levitation,
    "Rub": _rub,
    "Bouncing": _bouncing,
    "Backward whirl": _backward_whirl,
    "Disturbances tried": _disturbances,
    "What would change it": _remedies,
}
"""Topics in the order of the verdict, with the functions that write them."""
