"""The verdict of a study in words: what the machine does, what may hold it, what would change that, what is unknown.

It never promises that a machine recovers.  Disturbances are samples, and motions that none of them meets may exist, so
the best verdict is that everything tried came back.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from carom.outcome import Outcome
from carom.study.disturbances import Trials
from carom.study.ranges import Gain, Motion, MotionRange, Span, common, outside
from carom.study.wording import counted, listed, number
from carom.whirl import rolling, runaway_speed

if TYPE_CHECKING:
    from carom.equilibria import Equilibrium
    from carom.orbits import Orbit
    from carom.study.assembly import Study

__all__ = ["NOT_COVERED", "Finding", "Level", "Verdict", "free_spans", "verdict"]

Level = Literal["no-contact-free-motion", "may-not-come-back", "all-tried-came-back"]

GRAVITY = 9.80665
"""Standard acceleration of free fall, m/s²."""
NOT_COVERED = (
    "Disturbances other than those simulated. They are samples: one between them, or a larger one, may end elsewhere.",
    (
        "Periodic motions with two or more impacts a period, bouncing that never repeats, and motions that alternate "
        "between bounces and lasting contact. They are named only if a simulated disturbance ended in one."
    ),
    "A touchdown bearing that moves, turns or gives way: the wall is rigid, so the load of an impact is an impulse.",
    "Changes of speed, gravity, a rotor that bends or tilts, and controllers that do more than a spring and a damper.",
)
"""What a study does not cover."""


@dataclass(frozen=True)
class Finding:
    """A part of the verdict; each line of its text is a paragraph."""

    topic: str
    text: str


@dataclass(frozen=True)
class Verdict:
    """What a study says.

    Attributes
    ----------
    level : {"no-contact-free-motion", "may-not-come-back", "all-tried-came-back"}
        The verdict for programs.
    headline : str
    findings : tuple of Finding
    """

    level: Level
    headline: str
    findings: tuple[Finding, ...]

    @property
    def text(self) -> str:
        """All of it as plain text."""
        return "\n\n".join([self.headline, *(f"{finding.topic}: {finding.text}" for finding in self.findings)])


def verdict(study: Study) -> Verdict:
    """Put a study in words."""
    findings = [
        Finding("Levitation", _levitation(study)),
        Finding("Rub", _rub(study)),
        Finding("Bouncing", _bouncing(study)),
        Finding("Backward whirl", _backward_whirl(study)),
        Finding("Disturbances tried", _disturbances(study)),
        Finding("What would change it", _remedies(study)),
        Finding("Not covered", "\n".join(NOT_COVERED)),
    ]
    level, headline = _headline(study)
    return Verdict(level, headline, tuple(findings))


def free_spans(ranges: tuple[MotionRange, ...], gain: Gain) -> tuple[Span, ...] | None:
    """Where, along one gain, the contact-free motion exists and neither a rub nor a single-impact orbit does.

    Parameters
    ----------
    ranges : tuple of MotionRange
    gain : {"gamma", "omega"}

    Returns
    -------
    tuple of Span, or None
        Within what was searched for orbits; ``None`` if nothing was.
    """
    here = {entry.motion: entry for entry in ranges if entry.gain == gain}
    orbits = here.get("single-impact")
    if orbits is None or orbits.searched is None or "rub" not in here:
        return None
    searched = orbits.searched
    quiet = common(outside(orbits.spans, searched), outside(here["rub"].spans, searched))
    return common(quiet, here["contact-free"].spans)


def _headline(study: Study) -> tuple[Level, str]:
    levitation = study.equilibria[0]
    if levitation.status != "admissible":
        what = "just reaches" if levitation.status == "boundary" else "would lie beyond"
        return (
            "no-contact-free-motion",
            f"It cannot run without contact: its whirl from unbalance {what} the wall of the touchdown bearing.",
        )
    if not levitation.stable:
        return "no-contact-free-motion", "Its levitation is not damped: a disturbance does not die out."
    holds = _what_may_hold(study)
    if holds:
        return (
            "may-not-come-back",
            f"It levitates without contact, but after a touch it may not come back: {listed(holds)}.",
        )
    text = "It levitates without contact and came back from every disturbance tried."
    if rolling(study.rotor).holds:
        text = f"{text[:-1]}; only backward whirl is known to be able to hold it."
    return "all-tried-came-back", f"{text} That is no guarantee: see what is not covered."


def _what_may_hold(study: Study) -> list[str]:
    holds = []
    if any(rub.status != "virtual" for rub in study.rubs):
        holds.append("a stable synchronous rub exists" if _stable_rub(study) else "a synchronous rub exists")
    if study.stable_orbits:
        holds.append(f"it can bounce for ever ({_names(list(study.stable_orbits))})")
    lost = len(study.disturbances) - study.disturbances.recovered
    if lost:
        holds.append(f"it did not come back from {lost} of {len(study.disturbances)} disturbances tried")
    if not study.orbits.complete and not study.stable_orbits:
        holds.append("not all of its periodic motions could be searched")
    return holds


def _stable_rub(study: Study) -> Equilibrium | None:
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
        f"The rotor levitates without contact at r = {say.radius(levitation.radius)}, zone {study.zone} "
        f"(zone limits {limits} of the clearance). A gap of {say.length(1.0 - levitation.radius)} to the wall is left. "
    )
    decay = -float(levitation.eigenvalues.real.max())
    if not levitation.stable:
        return text + "But nothing damps it: a disturbance does not die out."
    text += f"Disturbances that do not reach the wall die out, with a time constant of {say.time(1.0 / decay)}."
    return " ".join([text, *_loss_of_levitation(study)])


def _loss_of_levitation(study: Study) -> list[str]:
    """How levitation ends if one gain is turned far enough from where it is."""
    say = study.wording
    places: dict[str, list[str]] = {}
    for boundary in study.boundaries:
        own = getattr(study.case.parameters, boundary.gain)
        if (boundary.value < own) != (boundary.levitates == "above"):
            continue  # beyond the range in which this machine levitates
        moves = "falls" if boundary.levitates == "above" else "rises"
        where = f"{say.gain_name(boundary.gain)} {moves} to {say.gain(boundary.gain, boundary.value)}"
        places.setdefault(_LOSS[boundary.kind], []).append(where)
    return [f"Where {' or '.join(where)}, {what}." for what, where in places.items()]


_LOSS = {
    "persistence": "it goes over into a synchronous rub that begins without force",
    "non-smooth fold": "it meets an unstable synchronous rub and both vanish, so that the rotor must go somewhere else",
    "degenerate": "it ends on the wall",
}


def _rub(study: Study) -> str:
    rubs = [rub for rub in study.rubs if rub.status != "virtual"]
    if not rubs:
        return "No synchronous rub exists: the unbalance cannot keep the rotor pressed against the bearing."
    stable = _stable_rub(study)
    if stable is None:
        return (
            "A synchronous rub exists. It is not stable in every direction, but it marks a way to stay in contact "
            f"(bearing force {study.wording.force(rubs[0].normal_force)})."
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
            f", and friction of {say.force(friction)} at a slip of {say.velocity(slip)} would heat the contact with "
            f"{say.power(friction * slip)}"
        )
    return text


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
            f"({_names(unstable)}): the rotor does not stay there, but {'it takes' if one else 'they take'} part in "
            "deciding which disturbances come back."
        )
    if virtual:
        sentences.append(
            f"{counted(len(virtual), 'orbit')} ({_names(virtual)}) solve{'s' if len(virtual) == 1 else ''} the equations "
            "but not the contact law, and so cannot happen."
        )
    if not len(orbits):
        sentences.append("There is no orbit with one impact a period.")
    if orbits.complete:
        sentences.append("The list is complete: it is proven that no other orbit with one impact a period exists.")
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
        f"in {whirl} whirl."
    )


def _names(orbits: list[Orbit]) -> str:
    names = [orbit.name for orbit in orbits]
    return listed(names if len(names) <= 8 else [*names[:7], f"{len(names) - 7} more"])


def _disturbances(study: Study) -> str:
    say, trials = study.wording, study.disturbances
    kicks, starts = trials.of_kind("kick"), trials.of_kind("start")
    tried = []
    if len(kicks):
        speeds = sorted(member.speed for member in kicks)
        tried.append(
            f"{len(kicks)} velocity kicks of the levitating rotor, {say.velocity(speeds[0])} to {say.velocity(speeds[-1])}"
        )
    tried.append(f"{len(starts)} starts spread over the clearance")
    text = f"{len(trials)} were simulated to where they settle: {' and '.join(tried)}. {_endings(trials)}"
    touching = trials.touching
    if trials.recovered and len(touching) < len(trials):
        back = touching.recovered or "none"
        text += f" Of the {len(touching)} that touched the wall {back} came back to levitation."
    smallest = trials.smallest_unrecovered_kick
    if smallest is not None:
        alike = kicks.of_speed(smallest)
        text += (
            f" The smallest kick tried that did not come back was {say.velocity(smallest)} "
            f"({len(alike) - alike.recovered} of {len(alike)} directions)."
        )
    if trials.hardest_impulse > 0:
        text += f" The hardest hit had a normal impulse of {say.impulse(trials.hardest_impulse)}."
    if trials.final_force > 0:
        text += f" The largest force of lasting contact they ended with was {say.force(trials.final_force)}."
    return text


def _endings(trials: Trials) -> str:
    if trials.recovered == len(trials):
        return "All of them came back to contact-free levitation."
    parts = [f"{len(group)} in {ending.words}" for ending, group in trials.endings.items() if ending.outcome in _STEADY]
    parts += [
        f"{len(group)} {ending.words}" for ending, group in trials.endings.items() if ending.outcome not in _STEADY
    ]
    return f"They ended: {listed(parts)}."


_STEADY = (Outcome.LEVITATED, Outcome.FORWARD_RUB, Outcome.BACKWARD_WHIRL, Outcome.ROLLING)


def _backward_whirl(study: Study) -> str:
    say, gamma = study.wording, study.case.parameters.gamma
    roll, runaway = rolling(study.rotor), runaway_speed(study.rotor)
    bound = say.gain("gamma", roll.damping_bound)
    if roll.damping_bound <= 0.0:
        return "Friction cannot sustain any backward whirl in lasting contact, whatever the damping."
    if gamma > roll.damping_bound:
        return f"Damping is so strong that no backward whirl in lasting contact sustains itself (that takes {bound})."
    if not roll.holds:
        return (
            "The rotor cannot roll backward round the bearing for a whole turn, but backward whirl that slides for a part of "
            f"each turn is not ruled out; {say.gain_name('gamma')} above {bound} would rule it out."
        )
    return (
        f"Dry friction can drive the rotor backward round the bearing until it rolls there with "
        f"{_with_weight(study, roll.largest_force)}. Once it rolls, it goes on rolling; only {say.gain_name('gamma')} above "
        f"{bound} rules that out. It surely gets there if, in lasting contact, its centre moves backward faster than "
        f"{say.velocity(runaway.certain)} ({number(runaway.certain, 3)} times the speed of the shaft), and may from about "
        f"{say.velocity(runaway.average)} on."
    )


def _with_weight(study: Study, force: float) -> str:
    """A force, and how many times the weight of the rotor that is."""
    text, scales = study.wording.force(force), study.rotor.scales
    if scales is None:
        return text
    return f"{text} ({number(force * scales.acceleration / GRAVITY, 3)} times the weight of the rotor)"


def _remedies(study: Study) -> str:
    return "\n".join(" ".join(_remedies_along(study, gain)) for gain in study.gains)


def _remedies_along(study: Study, gain: Gain) -> list[str]:
    say = study.wording
    name, own = say.gain_name(gain), say.gain(gain, getattr(study.case.parameters, gain))
    parts = []
    for motion, words in _POSSIBLE.items():
        entry = study.range_of(motion, gain)
        if entry is not None:
            parts.append(f"{words} {say.where(gain, entry.spans, entry.searched)}")
    sentences = [f"{name[0].upper()}{name[1:]} (this machine: {own}): {'; '.join(parts)}."]
    orbits, free = study.range_of("single-impact", gain), free_spans(study.ranges, gain)
    aside = ", backward whirl aside," if _rolling_concerns(study, gain) else ""
    if free is None or orbits is None:
        sentences.append(f"Which {name} would leave levitation alone was not found out.")
    elif free:
        where = say.where(gain, free, orbits.searched)
        sentences.append(f"Of these motions levitation alone{aside} is left {where}.")
    else:
        sentences.append(f"No {name} in the range searched leaves levitation alone.")
    return sentences


_POSSIBLE: dict[Motion, str] = {
    "contact-free": "contact-free motion exists",
    "rub": "a synchronous rub can hold the rotor",
    "single-impact": "orbits with one impact a period are possible",
}


def _rolling_concerns(study: Study, gain: Gain) -> bool:
    rolling = study.range_of("rolling", gain)
    return rolling is not None and bool(rolling.spans)
