"""Attractors: groups of motions that have settled to the same cycle, with a name."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

from carom.attractors.cycles import Cycle, Whirl, cycle_of, forces_on, orbit_of, same_cycle, whirl_of
from carom.attractors.following import Ending
from carom.attractors.starts import Start
from carom.attractors.survival import Survival
from carom.motions.starts import State
from carom.motions.trajectories import Trajectory
from carom.orbits.single_impact import Orbit
from carom.outcome import Outcome
from carom.results import Result

__all__ = ["Attractor", "Groups", "motion_name"]


@dataclass(frozen=True, eq=False, repr=False)
class Attractor(Result):
    """A motion on which starts end; or, if ``settled`` is false, the reason why their end is not known.

    Attributes
    ----------
    name : str
        ``"levitation"``, ``"B1,d"``, ``"2-impact bouncing"``, ``"irregular bouncing"``, ``"synchronous rub"``,
        ``"rolling"``, ``"unresolved: time-reached"`` and so on.
    words : str
        What the rotor does, in a sentence.
    outcome : Outcome
    multiplicity : int
        Impacts per period; 0 without impacts or period.
    period : float or None
        In ``1/Ω``, in the co-rotating frame; ``None`` for rest in that frame and for irregular motion.
    whirl : {"forward", "backward", "none"}
        Mean direction of the whirl of the rotor centre in the fixed frame.
    count : int
        Disturbances that end here.
    share : float
        The same as a share of all disturbances.
    known : int
        Starts next to motions known in closed form that end here.
    representative : Start
        The mildest disturbance that ends here; if there is none, the first other start.
    state : State
        A state on it (for periodic bouncing just before an impact).
    largest_impulse : float
        Largest normal impulse of the impacts on it, in ``m c_r Ω``.
    largest_force : float
        Largest normal force of lasting contact on it, in ``m c_r Ω²``.
    survival : Survival or None
        How long it lasts, if it is irregular bouncing.
    """

    name: str
    words: str
    outcome: Outcome
    multiplicity: int
    period: float | None
    whirl: Whirl
    count: int
    share: float
    known: int
    representative: Start
    state: State
    largest_impulse: float
    largest_force: float
    survival: Survival | None = None

    @property
    def settled(self) -> bool:
        """Whether motions stay on it: it is neither a motion that was given up nor a transient."""
        return self.outcome.settled and not self.transient

    @property
    def transient(self) -> bool:
        """Whether it is irregular bouncing that ends: no attractor, but a transient on which motions were given up."""
        return self.survival is not None and self.survival.transient

    @property
    def touches(self) -> bool:
        """Whether it keeps touching the bearing."""
        return self.settled and self.outcome is not Outcome.LEVITATED


class Groups:
    """Groups of motions that have settled to the same cycle, by name, in the order in which they were found."""

    def __init__(self, orbits: Sequence[Orbit]) -> None:
        self.orbits = orbits
        self.names: dict[str, tuple[Cycle, Attractor]] = {}

    def name_of(self, motion: Trajectory) -> str:
        """Name of the group of a motion; a new group is created if the motion fits none."""
        cycle = cycle_of(motion)
        for name, (known, _) in self.names.items():
            if same_cycle(known, cycle):
                return name
        name = self._new_name(cycle)
        impulse, force = forces_on(motion, cycle)
        found = Attractor(
            name=name,
            words=_words(cycle, name),
            outcome=cycle.outcome,
            multiplicity=cycle.multiplicity,
            period=cycle.period,
            whirl=whirl_of(motion, cycle),
            count=0,
            share=0.0,
            known=0,
            representative=Start("start", motion.start, "a start within the clearance"),
            state=motion.final,
            largest_impulse=impulse,
            largest_force=force,
        )
        self.names[name] = cycle, found
        return name

    def _new_name(self, cycle: Cycle) -> str:
        orbit = orbit_of(cycle, self.orbits)
        name = orbit.name if orbit else _name(cycle)
        alike = sum(known.split(" (")[0] == name for known in self.names)
        return f"{name} ({alike + 1})" if alike else name

    def attractor(self, name: str, endings: Sequence[Ending]) -> Attractor:
        """Return the attractor of a group, with the starts that end on it counted."""
        _, member = self.names[name]
        group = [ending for ending in endings if ending.attractor == name]
        here = [ending.start for ending in group]
        hit = [start for start in here if start.disturbance]
        total = sum(ending.start.disturbance for ending in endings)
        survival = next((ending.survival for ending in group if ending.irregular), None)
        gentlest = min(hit, key=lambda start: (start.kind != "kick", start.speed), default=None)
        return dataclasses.replace(
            member,
            words=f"{member.words} {_sentence(survival.words)}" if survival else member.words,
            survival=survival,
            count=len(hit),
            share=len(hit) / total if total else 0.0,
            known=len(here) - len(hit),
            representative=gentlest or next(iter(here), member.representative),
        )


def _sentence(words: str) -> str:
    return f"{words[0].upper()}{words[1:]}."


def motion_name(outcome: Outcome, multiplicity: int) -> str:
    """Name of a settled motion that is not a known orbit: ``"2-impact bouncing"``, ``"rolling"`` and so on."""
    if outcome in _REPEATING:
        noun = _REPEATING[outcome]
        return f"{multiplicity}-impact {noun}" if multiplicity else f"irregular {noun}"
    return _NAMES.get(outcome, f"unresolved: {outcome.label}")


def _name(cycle: Cycle) -> str:
    if cycle.outcome is Outcome.FORWARD_RUB and not cycle.synchronous:
        return "drifting rub"
    return motion_name(cycle.outcome, cycle.multiplicity)


def _words(cycle: Cycle, name: str) -> str:
    if cycle.outcome in _REPEATING:
        doing = "bounces" if cycle.outcome is Outcome.BOUNCING else "alternates between bounces and lasting contact"
        if not cycle.multiplicity:
            return f"The rotor {doing} irregularly: it did not repeat itself as far as it was followed."
        impacts = "one impact" if cycle.multiplicity == 1 else f"{cycle.multiplicity} impacts"
        return f"The rotor {doing} ({name}): {impacts} in each period of {cycle.period:.4g}/Omega."
    if cycle.outcome is Outcome.FORWARD_RUB:
        how = "in step with the shaft" if cycle.synchronous else "out of step with the shaft"
        return f"The rotor rubs along the touchdown bearing {how}."
    return cycle.outcome.meaning


_REPEATING = {Outcome.BOUNCING: "bouncing", Outcome.MIXED: "bouncing with rub"}
_NAMES = {
    Outcome.LEVITATED: "levitation",
    Outcome.FORWARD_RUB: "synchronous rub",
    Outcome.BACKWARD_WHIRL: "backward whirl",
    Outcome.ROLLING: "rolling",
}
