"""Attractors: groups of motions that have settled to the same cycle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from carom.attractors.cycles import Cycle, Whirl, cycle_of, forces_on, seen_in_contact, whirl_of
from carom.attractors.following import FIRST_PATIENCE, Ending
from carom.attractors.names import MotionName
from carom.attractors.starts import Start
from carom.attractors.survival import Survival
from carom.motions.settling import REPEATING
from carom.motions.starts import Kick, State
from carom.motions.trajectories import Trajectory, simulate
from carom.outcome import Outcome
from carom.results import Result


@dataclass(frozen=True, eq=False, repr=False)
class Attractor(Result):
    """A motion on which starts end; or, if ``settled`` is false, the reason why their end is not known.

    Attributes
    ----------
    name : MotionName
        ``"levitation"``, ``"B1,d"``, ``"2-impact bouncing"``, ``"irregular bouncing"``, ``"synchronous rub"``,
        ``"rolling"``, ``"unresolved: time-reached"`` and so on.
    words : str
        What the rotor does, in a sentence.
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

    name: MotionName
    words: str
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
        return self.name.outcome.settled and not self.transient

    @property
    def transient(self) -> bool:
        """Whether it is irregular bouncing that ends: no attractor, but a transient on which motions were given up."""
        return self.survival is not None and self.survival.transient

    @property
    def touches(self) -> bool:
        """Whether it keeps touching the bearing."""
        return self.settled and self.name.outcome is not Outcome.LEVITATED


def attractor_of(name: MotionName, endings: Sequence[Ending], state: State) -> Attractor:
    """Describe the motion on which starts end, from all endings and a state that the first of its starts has reached.

    One motion is simulated once more: from the state, or from a start if it was given up.
    """
    here = [ending for ending in endings if ending.attractor == name]
    first = here[0]
    motion = _representative(first, state)
    cycle = cycle_of(motion)
    if name.irregular or not name.outcome.settled:
        cycle = Cycle(name.outcome, False, None, cycle.positions[:0], cycle.velocities[:0])
    impulse, force = forces_on(motion, cycle)
    hit = [ending.start for ending in here if ending.start.disturbance]
    total = sum(ending.start.disturbance for ending in endings)
    survival = first.survival if name.irregular else None
    words = _words(cycle, name)
    return Attractor(
        name=name,
        words=f"{words} {_sentence(survival.words)}" if survival else words,
        period=cycle.period,
        whirl=whirl_of(motion, cycle),
        count=len(hit),
        share=len(hit) / total if total else 0.0,
        known=len(here) - len(hit),
        representative=min(hit, key=lambda start: (start.kind != "kick", start.speed), default=first.start),
        state=motion.final,
        largest_impulse=impulse,
        largest_force=force,
        survival=survival,
    )


def _representative(ending: Ending, state: State) -> Trajectory:
    """A motion on an attractor, or the one that was given up, for its first 1000 impacts if it does not repeat."""
    if ending.recovered:
        state = Kick(0.0).state(ending.rotor)
    elif not ending.attractor.outcome.settled:
        state = ending.start.state
    return seen_in_contact(simulate(ending.rotor, state, settle=True, patience=FIRST_PATIENCE))


def _sentence(words: str) -> str:
    return f"{words[0].upper()}{words[1:]}."


def _words(cycle: Cycle, name: MotionName) -> str:
    if cycle.outcome in REPEATING:
        doing = "bounces" if cycle.outcome is Outcome.BOUNCING else "alternates between bounces and lasting contact"
        if not cycle.multiplicity:
            return f"The rotor {doing} irregularly: it did not repeat itself as far as it was followed."
        impacts = "one impact" if cycle.multiplicity == 1 else f"{cycle.multiplicity} impacts"
        return f"The rotor {doing} ({name}): {impacts} in each period of {cycle.period:.4g}/Omega."
    if cycle.outcome is Outcome.FORWARD_RUB:
        how = "in step with the shaft" if cycle.synchronous else "out of step with the shaft"
        return f"The rotor rubs along the touchdown bearing {how}."
    return cycle.outcome.meaning
