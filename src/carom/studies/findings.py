"""The paragraphs of a verdict, one function for each topic."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.attractors.names import LEVITATION
from carom.basins.shares import CONFIDENCE
from carom.closed_forms.thresholds import Gain
from carom.closed_forms.whirl import Rolling, Runaway, rolling, runaway_speed
from carom.parameters.indentation import indentation_of_force, indentation_of_hit
from carom.studies.endings import KickSize, came_back, ending_phrase, hardest_impulse, kick_sizes, touching
from carom.studies.ranges import Motion
from carom.studies.remedies import alone_sentences
from carom.studies.safety.limits import share_words
from carom.studies.wording import counted, listed, no_rigid_wall, number

if TYPE_CHECKING:
    from carom.attractors import AttractorSet
    from carom.closed_forms.equilibria import Equilibrium
    from carom.orbits.orbit import Orbit
    from carom.studies.assembly import Study

GRAVITY = 9.80665
"""Standard acceleration of free fall, m/s²."""
MOST_NAMES = 8


def stable_rub(study: Study) -> Equilibrium | None:
    """Return the stable, admissible synchronous rub, which can hold the rotor, if there is one."""
    return next((rub for rub in study.rubs if rub.stable and rub.status == "admissible"), None)


def _levitation(study: Study) -> str:
    say, levitation = study.wording, study.equilibria[0]
    limits = ", ".join(number(limit, 3) for limit in study.case.zones.limits)
    if levitation.status == "virtual":
        return (
            f"The rotor cannot run without contact. Its whirl from unbalance would need a radius of "
            f"{say.radius(levitation.radius)}, more than the clearance."
        )
    if levitation.status == "boundary":
        return "The contact-free whirl from unbalance just touches the wall: the least disturbance brings contact."
    text = (
        f"The rotor levitates at r = {say.radius(levitation.radius)}, zone {study.zone} "
        f"(zone limits {limits} of the clearance). A gap of {say.length(1.0 - levitation.radius)} to the wall is left. "
    )
    decay = -float(levitation.eigenvalues.real.max())
    if not levitation.stable:
        return text + "But nothing damps it: a disturbance does not die out."
    text += f"Disturbances that do not reach the wall die out, with a time constant of {say.time(1.0 / decay)}."
    return " ".join([text, *_loss_of_levitation(study)])


def _loss_of_levitation(study: Study) -> list[str]:
    """Say how levitation ends if one gain is changed far enough."""
    say = study.wording
    places: dict[str, list[str]] = {}
    for boundary in study.boundaries:
        own = study.case.parameters.value(boundary.gain)
        if (boundary.value < own) != (boundary.levitates == "above"):
            continue  # beyond the range in which this machine levitates
        moves = "falls" if boundary.levitates == "above" else "rises"
        where = f"{say.gain_name(boundary.gain)} {moves} to {say.gain(boundary.gain, boundary.value)}"
        places.setdefault(_LOSS[boundary.kind], []).append(where)
    return [f"Where {' or '.join(where)}, {what}." for what, where in places.items()]


_LOSS = {
    "persistence": "it turns into a synchronous rub whose force grows from zero",
    "non-smooth fold": "it meets an unstable synchronous rub and both vanish, so that the rotor must go somewhere else",
    "degenerate": "it ends on the wall",
}


def _rub(study: Study) -> str:
    rubs = [rub for rub in study.rubs if rub.status != "virtual"]
    if not rubs:
        return "No synchronous rub exists: the unbalance cannot keep the rotor pressed against the bearing."
    stable = stable_rub(study)
    if stable is None:
        return (
            "A synchronous rub exists. It is not stable in every direction, but it marks a way to stay in contact "
            f"(bearing force {study.wording.force(rubs[0].normal_force)}{_of_force(study, rubs[0].normal_force)})."
        )
    start = "A synchronous rub exists and is stable"
    if study.levitates:
        start = "A synchronous rub coexists with levitation and is stable"
    return (
        f"{start}: once it has settled there the rotor stays pressed against the touchdown bearing. "
        f"The bearing force would be {_rub_load(study, stable)}."
    )


def _rub_load(study: Study, rub: Equilibrium) -> str:
    say, parameters = study.wording, study.case.parameters
    friction = parameters.mu * rub.normal_force
    slip = parameters.radius_ratio + 1.0
    text = _with_weight(study, rub.normal_force)
    if friction > 0:
        text += (
            f", and friction of {say.force(friction)} at a slip of {say.slip(slip)} would heat the contact with "
            f"{say.power(friction * slip)}"
        )
    return text + _of_force(study, rub.normal_force)


def _of_force(study: Study, force: float) -> str:
    """Return a clause on whether the rigid wall is a valid model under a force; empty if it is."""
    text = no_rigid_wall(indentation_of_force(study.case.parameters, force))
    return f"; {text}" if text else ""


def _of_hit(study: Study, impulse: float) -> str:
    """Return a clause on whether the rigid wall is a valid model for the normal impulse of a hit; empty if it is."""
    parameters = study.case.parameters
    text = no_rigid_wall(indentation_of_hit(parameters, impulse / (1.0 + parameters.d)))
    return f"; {text}" if text else ""


def _bouncing(study: Study) -> str:
    orbits = study.orbits
    stable = study.stable_orbits
    unstable = [orbit for orbit in orbits if orbit.admissible and not orbit.stable]
    virtual = [orbit for orbit in orbits if not orbit.admissible]
    sentences = [_stable_orbit(study, orbit) for orbit in stable]
    if unstable:
        one = len(unstable) == 1
        sentences.append(
            f"{counted(len(unstable), 'orbit')} with one impact a period {'is' if one else 'are'} unstable "
            f"({names_of(unstable)}): the rotor does not stay there, but {'it takes' if one else 'they take'} part in "
            "deciding which disturbances come back."
        )
    if virtual:
        sentences.append(
            f"{counted(len(virtual), 'orbit')} ({names_of(virtual)}) solve{'s' if len(virtual) == 1 else ''} the equations "
            "but not the contact law, and so cannot happen."
        )
    if not len(orbits):
        sentences.append("There is no orbit with one impact a period.")
    if orbits.complete and orbits.slip_stays_forward:
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


def _stable_orbit(study: Study, orbit: Orbit) -> str:
    say, parameters = study.wording, study.case.parameters
    impulse = (1.0 + parameters.d) * orbit.radial_speed
    whirl = "forward" if orbit.angular_speed > -1.0 else "backward"
    return (
        f"The rotor can bounce for ever on the stable orbit {orbit.name}: one impact every {say.time(orbit.period)} "
        f"({say.per_second(orbit.period)}) at {say.velocity(orbit.radial_speed)} towards the wall, each with a normal "
        f"impulse of {say.impulse(impulse)}, a mean force of {say.force(impulse / orbit.period)}, "
        f"in {whirl} whirl{_of_hit(study, impulse)}."
    )


def names_of(orbits: list[Orbit]) -> str:
    """List the names of orbits, at most ``MOST_NAMES`` of them."""
    names: list[str] = [orbit.name for orbit in orbits]
    few = MOST_NAMES - 1
    return listed(names if len(names) <= MOST_NAMES else [*names[:few], f"{len(names) - few} more"])


def _disturbances(study: Study) -> str:
    say, found = study.wording, study.attractors
    sizes = kick_sizes(found)
    text = f"Simulated to where they settle: {found.words(say.velocity)}. {_endings(study)}"
    text += _smallest_kick(study, sizes)
    hardest = hardest_impulse(found)
    if hardest > 0:
        text += f" The hardest hit had a normal impulse of {say.impulse(hardest)}{_of_hit(study, hardest)}."
    return text


def _smallest_kick(study: Study, sizes: tuple[KickSize, ...]) -> str:
    """Say between which of the sizes tried the first kicks are lost."""
    say = study.wording
    place = next((place for place, size in enumerate(sizes) if size.lost), None)
    if place is None:
        return ""
    lost = sizes[place]
    gone = f"{lost.directions - lost.recovered} of {lost.directions} directions"
    if place == 0:
        return f" Kicks of {say.velocity(lost.speed)}, the smallest tried, did not come back in {gone}."
    return (
        f" Kicks up to {say.velocity(sizes[place - 1].speed)} came back in all directions tried; of {say.velocity(lost.speed)} they did "
        f"not in {gone}. `carom basins` looks for the smallest that is lost."
    )


def _endings(study: Study) -> str:
    found = study.attractors
    counts = {member.name: member.count for member in found if member.count}
    if list(counts) == [LEVITATION]:
        return f"All of them came back to levitation{_fresh_words(study)}."
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


def _fresh_words(study: Study) -> str:
    """Say how a larger sample of disturbances ended, if all of the first sample came back."""
    fresh = study.fresh
    if fresh is None:
        return ""
    if fresh.lost:
        return f", but of {fresh.sample.count:,} others of the same kinds {fresh.lost} did not"
    return (
        f", and so did {fresh.sample.count:,} others of the same kinds: with {100 * CONFIDENCE:.0f} % confidence "
        f"{share_words(fresh.share_below)}"
    )


def _backward_whirl(study: Study) -> str:
    say, gamma = study.wording, study.case.parameters.gamma
    roll, runaway = rolling(study.rotor), runaway_speed(study.rotor)
    bound = say.gain("gamma", roll.damping_bound)
    if roll.damping_bound <= 0.0:
        return "Friction cannot sustain any backward whirl in lasting contact, whatever the damping."
    if gamma > roll.damping_bound:
        least = bound if say.scales else f"γ = {bound}"
        return f"Damping is so strong that no backward whirl in lasting contact sustains itself (that takes {least})."
    if not roll.holds:
        return (
            "The rotor cannot roll backward round the bearing for a whole turn, but backward whirl that slides for a part of "
            f"each turn is not ruled out; {say.gain_name('gamma')} above {bound} would rule it out."
        )
    return (
        f"Dry friction can drive the rotor backward round the bearing until it rolls there with "
        f"{_with_weight(study, roll.largest_force)}{_of_force(study, roll.largest_force)}. Once it rolls, it goes on rolling; only {say.gain_name('gamma')} above "
        f"{bound} rules that out{_interrupted(study, roll)}. It surely gets there if, in lasting contact, its centre moves backward faster than "
        f"{say.velocity(runaway.certain)} (whirl at {number(runaway.certain, 3)} times the speed of the shaft)"
        f"{_perhaps(study, runaway)}."
    )


def _interrupted(study: Study, roll: Rolling) -> str:
    """Explain the two limits of rolling, if they differ in the digits shown."""
    every_angle, bound = (study.wording.gain("gamma", limit) for limit in (roll.largest_damping, roll.damping_bound))
    if every_angle == bound:
        return ""
    return f" (from {every_angle} on it can roll for a part of each turn only, and slides in between)"


def _perhaps(study: Study, runaway: Runaway) -> str:
    """Name the lower speed from which the unbalance decides whether backward whirl runs away."""
    certain, average = study.wording.velocity(runaway.certain), study.wording.velocity(runaway.average)
    return "" if certain == average else f", and it may get there from about {average} on"


def _with_weight(study: Study, force: float) -> str:
    """Return a force with its multiple of the weight of the rotor."""
    text, scales = study.wording.force(force), study.rotor.scales
    if scales is None:
        return text
    return f"{text} ({number(force * scales.acceleration / GRAVITY, 3)} times the weight of the rotor)"


def _remedies(study: Study) -> str:
    lines = [" ".join(_remedies_along(study, gain)) for gain in study.gains]
    lines[0] = f"{lines[0]} {study.safe_damping.words}"
    return "\n".join(lines)


def _remedies_along(study: Study, gain: Gain) -> list[str]:
    say = study.wording
    name, own = say.gain_name(gain), say.gain(gain, study.case.parameters.value(gain))
    parts = []
    for motion, words in _POSSIBLE.items():
        entry = study.range_of(motion, gain)
        if entry is not None and (entry.spans or motion != "stable-single-impact"):
            parts.append(f"{words} {say.where(gain, entry.spans, entry.searched)}")
    along = name if say.scales is None else f"{name[0].upper()}{name[1:]}"  # A symbol keeps its case: Ω is not ω.
    sentences = [f"{along} (this machine: {own}): {'; '.join(parts)}."]
    return [*sentences, *alone_sentences(study, gain)]


_POSSIBLE: dict[Motion, str] = {
    "contact-free": "levitation exists",
    "rub": "a synchronous rub can hold the rotor",
    "single-impact": "orbits with one impact a period are possible",
    "stable-single-impact": "stable ones, which can hold the rotor,",
}


FINDINGS = {
    "Levitation": _levitation,
    "Rub": _rub,
    "Bouncing": _bouncing,
    "Backward whirl": _backward_whirl,
    "Disturbances tried": _disturbances,
    "What would change it": _remedies,
}
"""Topics in the order of the verdict, with the functions that write them."""
