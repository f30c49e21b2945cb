"""Attractors: groups of motions that have settled to the same one, and how fast disturbed motions return to them, or separate on them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from carom.attractors.following import FIRST_PATIENCE, Ending, Survival
from carom.attractors.naming import MotionName
from carom.attractors.settled import SettledMotion, Whirl, forces_on, seen_in_contact, settled_motion, whirl_of
from carom.base.arguments import Count, checked
from carom.base.outcome import CaromError, Outcome, Phase
from carom.base.results import Result
from carom.closed_forms import find_equilibria
from carom.models import Rotor, Subject, rotor_of
from carom.motions import State, Trajectory, simulate
from carom.motions.settling import REPEATING
from carom.motions.starts import levitating
from carom.orbits import LyapunovExponents, Orbit, lyapunov_exponents, orbit_exponents
from carom.orbits.simulated import SimulatedOrbit
from carom.parameters import Scales
from carom.parameters.formats import format_quantity

MEASURED = 20_000
"""Impacts from which exponents of irregular bouncing are measured."""
APPROACHED = 1e-6
"""Distance from a synchronous rub below which a motion is at it."""
FADING = "It was still bouncing when the simulation ended: friction stops its slip in every impact, and the bounces provably fade."
"""What is said of rolling that is reached only after more impacts than are followed, or in the limit of infinitely many."""


@checked
def exponents_of(machine: Subject, attractor: Attractor, impacts: Count = MEASURED) -> LyapunovExponents | None:
    """Lyapunov exponents of an attractor: from the modes of levitation, the eigenvalues of a rub, or the multipliers of its orbit.

    Those of irregular bouncing are measured on one motion, with standard errors.  ``None`` where they are not known.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        That of :func:`~carom.attractors.find_attractors`.
    attractor : Attractor
    impacts : int
        Impacts from which exponents of irregular bouncing are measured.
    """
    rotor, name = rotor_of(machine), attractor.name
    if name.outcome is Outcome.LEVITATED:
        return _exact(np.repeat(rotor.system.exponents.real, 2))
    if name.irregular:
        try:
            return lyapunov_exponents(rotor, attractor.state, impacts)
        except CaromError:
            return None
    if attractor.orbit is not None:
        return orbit_exponents(attractor.orbit) if attractor.orbit.admissible else None
    if name.outcome is Outcome.ROLLING:
        return _rolling(rotor, attractor)
    return _rubbing(rotor, attractor) if name.outcome is Outcome.FORWARD_RUB and not name.drifting else None


def _exact(rates: np.ndarray, along: float = math.nan, time: float = math.inf) -> LyapunovExponents:
    return LyapunovExponents(np.sort(rates)[::-1], np.zeros(len(rates)), along, float(rates.sum()), 0, 0, time)


def _rolling(rotor: Rotor, attractor: Attractor) -> LyapunovExponents | None:
    """Exponents of rolling that leaves nothing of a disturbance but a delay, as that of the planar rotor on a rigid wall does."""
    # On an elastic wall bounces fade at a finite rate.
    if not rotor.has_closed_forms or attractor.period is None or rotor.system.arrays.restitution[0] == 1.0:
        return None
    return _exact(np.array([0.0, -np.inf, -np.inf, -np.inf]), 0.0, attractor.period)


def _rubbing(rotor: Rotor, attractor: Attractor) -> LyapunovExponents | None:
    """Exponents of sliding next to a synchronous rub; the directions off the wall have none."""
    for rub in find_equilibria(rotor)[1:] if rotor.system.forced is None else ():
        if np.abs(np.atleast_1d(rub.position) - np.atleast_1d(attractor.state.position)).max() < APPROACHED:
            rates = np.array([complex(value).real for value in rub.eigenvalues])
            return _exact(np.append(rates, np.full(2 * len(rotor.system.exponents) - len(rates), -np.inf)))
    return None


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
    share_of_disturbances : float
        The same as a share of all disturbances: of kicks and starts elsewhere alike, so not the share of kicks that
        :func:`carom.basins.share_of_kicks` gives.
    known : int
        Starts next to motions known in closed form that end here.
    state : State
        A state on it (for periodic bouncing just before an impact).
    largest_impulse : float
        Largest normal impulse of the impacts on it, in ``m c_r Ω``.
    largest_force : float
        Largest normal force of lasting contact on it, in ``m c_r Ω²``.
    survival : Survival or None
        How long it lasts, if it is irregular bouncing.
    orbit : Orbit or None
        The orbit of periodic bouncing or of a whirl that slides; ``None`` for other motions, and where Newton's method closes none.
    scales : Scales or None
        Those of the rotor.
    """

    name: MotionName
    words: str
    period: float | None
    whirl: Whirl
    count: int
    share_of_disturbances: float
    known: int
    state: State
    largest_impulse: float
    largest_force: float
    survival: Survival | None = None
    orbit: Orbit | SimulatedOrbit | None = None
    scales: Scales | None = None

    @property
    def settled(self) -> bool:
        """Whether motions stay on it: it is neither a motion that was given up nor a transient."""
        return self.name.outcome.settled and not self.transient

    @property
    def transient(self) -> bool:
        """Whether it is irregular bouncing that ends: no attractor, but a transient on which motions were given up."""
        return self.survival is not None and self.survival.transient


def attractor_of(name: MotionName, endings: Sequence[Ending], state: State) -> Attractor:
    """Describe the motion on which starts end, from all endings and a state that the first of its starts has reached.

    One motion is simulated once more: from the state, or from a start if it was given up.
    """
    here = [ending for ending in endings if ending.attractor == name]
    first = here[0]
    motion = _representative(first, state)
    given_up = name.irregular or not name.outcome.settled
    settled = SettledMotion(motion, name.outcome) if given_up else settled_motion(motion)
    impulse, force = forces_on(settled)
    disturbed = sum(ending.start.disturbance for ending in here)
    total = sum(ending.start.disturbance for ending in endings)
    survival = first.survival if name.irregular else None
    words = _words(settled, name)
    return Attractor(
        name=name,
        words=f"{words} {survival.words[0].upper()}{survival.words[1:]}." if survival else words,
        period=settled.period,
        whirl=whirl_of(settled),
        count=disturbed,
        share_of_disturbances=disturbed / total if total else 0.0,
        known=len(here) - disturbed,
        state=settled.motion.final,
        largest_impulse=impulse,
        largest_force=force,
        survival=survival,
        orbit=settled.orbit and replace(settled.orbit, name=name.orbit or settled.orbit.name),
        scales=first.rotor.scales,
    )


def _representative(ending: Ending, state: State) -> Trajectory:
    """A motion on an attractor, or the one that was given up, for its first 1000 impacts if it does not repeat."""
    until = None
    if ending.recovered:
        state = levitating(ending.rotor)
    elif not ending.attractor.outcome.settled:
        state, until = ending.start.state, ending.time
    return seen_in_contact(simulate(ending.rotor, state, until, settle=True, patience=FIRST_PATIENCE))


def _words(settled: SettledMotion, name: MotionName) -> str:
    if settled.outcome in REPEATING:
        doing = "bounces" if settled.outcome is Outcome.BOUNCING else "alternates between bounces and lasting contact"
        if not settled.multiplicity:
            return f"The rotor {doing} irregularly: it did not repeat itself within the simulated time."
        impacts = "one impact" if settled.multiplicity == 1 else f"{settled.multiplicity} impacts"
        period = format_quantity(settled.period or 0.0, "time", settled.motion.rotor.scales, 4)
        return f"The rotor {doing} ({name}): {impacts} in each period of {period}."
    if settled.outcome is Outcome.FORWARD_RUB:
        how = "synchronously with the shaft" if settled.synchronous else "asynchronously"
        if settled.orbit is not None and (turns := settled.orbit.turns):
            how = f"and repeats itself after {'each turn' if turns == 1 else f'{turns} turns'} of the shaft"
        return f"The rotor slides along the touchdown bearing {how}."
    if settled.outcome is Outcome.ROLLING and settled.motion.segment_phases[-1, settled.motion.plane] == Phase.FLIGHT:
        return f"{settled.outcome.meaning} {FADING}"
    return settled.outcome.meaning
