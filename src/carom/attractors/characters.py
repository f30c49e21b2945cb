"""What kind of motion an attractor is: rest, rub, a periodic orbit, a torus or chaos, each with its evidence."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np

from carom.arguments import Count, checked
from carom.attractors.groups import Attractor
from carom.attractors.regularity import Rotation, rotation_of
from carom.attractors.survival import Survival
from carom.closed_forms.equilibria import find_equilibria
from carom.models import Rotor, Subject, rotor_of
from carom.motions.settling import REPEATING
from carom.motions.simulation import simulate
from carom.motions.trajectories import Trajectory
from carom.orbits.closing import close
from carom.orbits.exponents import LOST, LyapunovExponents, lyapunov_exponents, orbit_exponents
from carom.orbits.happenings import arrives
from carom.orbits.orbit import Orbit, orbit_near
from carom.orbits.recognising import with_impacts
from carom.orbits.simulated import SimulatedOrbit
from carom.orbits.word import Kind
from carom.outcome import CaromError, Outcome
from carom.results import Result

CharacterKind = Literal["equilibrium", "rub", "periodic", "torus", "chaotic", "undecided"]
Lasting = Literal["attractor", "not seen to end", "transient", "undecided"]

MEASURED = 20_000
"""Impacts from which exponents and averages of irregular bouncing are computed."""
MOST_IMPACTS = 256
"""Impacts of the longest orbit that is looked for next to a motion that has not repeated."""
TRIED = 4
"""Number of impacts a period that are tried for it."""
APPROACHED = 1e-6
"""Distance from an orbit, relative to one plus the size of the state, below which a motion is on it."""


@dataclass(frozen=True, eq=False, repr=False)
class Character(Result):
    """Kind of an attractor.

    Attributes
    ----------
    kind : {"equilibrium", "rub", "periodic", "torus", "chaotic", "undecided"}
        ``"rub"`` is all motion in contact that lasts: synchronous rub, rolling and backward whirl.
    words : str
        The evidence, or why it is undecided.
    lasting : {"attractor", "not seen to end", "transient", "undecided"}
        Whether motions stay on it.  Irregular bouncing is never called an attractor: if it was not seen to end,
        ``survival`` says how long it lasts at least.
    orbit : Orbit or None
        Where it is periodic, also a whirl that slides: closed by Newton's method, so that its number of impacts is exact.
    exponents : LyapunovExponents or None
        For a periodic orbit from its multipliers, for rolling, and for irregular bouncing as measured on one motion.
    rates : ndarray or None
        Lyapunov exponents in ``Ω``, the largest first, where they are known: those of ``exponents``, or those of the
        linearised motion next to levitation and a synchronous rub.
    rotation : Rotation or None
        Regularity of bouncing that does not repeat; its rotation number if it is a torus.
    """

    rests_on: ClassVar[tuple[str, ...]] = ("mora2014", "das2017")

    shown: ClassVar[tuple[str, ...]] = ("kind", "lasting", "words", "rates")

    kind: CharacterKind
    words: str
    lasting: Lasting
    orbit: Orbit | SimulatedOrbit | None = None
    exponents: LyapunovExponents | None = None
    rates: np.ndarray | None = None
    rotation: Rotation | None = None


@checked
def character_of(machine: Subject, attractor: Attractor, impacts: Count = MEASURED) -> Character:
    """Find out what kind of motion an attractor is.

    An undecided character says why.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        That of :func:`~carom.attractors.find_attractors`.
    attractor : Attractor
    impacts : int
        Impacts from which exponents of irregular bouncing are measured.
    """
    rotor, outcome = rotor_of(machine), attractor.name.outcome
    if outcome is Outcome.LEVITATED:
        rates = np.sort(np.repeat(rotor.system.exponents.real, 2))[::-1]
        return Character("equilibrium", "Levitation is proven to last.", "attractor", rates=rates)
    if outcome in REPEATING:
        return _bouncing(rotor, attractor, impacts)
    if outcome.settled:
        return _rubbing(rotor, attractor)
    return Character("undecided", f"The motions were given up: {outcome.meaning}", "undecided")


def _rubbing(rotor: Rotor, attractor: Attractor) -> Character:
    """Character of a motion that stays in contact."""
    exponents = orbit_exponents(attractor.orbit) if attractor.orbit is not None else None
    if attractor.name.outcome is Outcome.ROLLING:
        exponents = _rolling_exponents(rotor, attractor)
    rates = _rub_rates(rotor, attractor) if exponents is None else exponents.values
    return Character("rub", attractor.words, "attractor", attractor.orbit, exponents, rates)


def _rolling_exponents(rotor: Rotor, attractor: Attractor) -> LyapunovExponents | None:
    """Exponents of rolling that leaves nothing of a disturbance but a delay, as that of the planar rotor on a rigid wall does."""
    directions = 2 * len(rotor.system.exponents) - 1
    # The phase of a weight is not left alone by a delay.
    if rotor.system.arrays.stiffness.any() or rotor.system.forced is not None:
        return None
    # On an elastic wall bounces fade at a finite rate.
    if directions > LOST[Kind.ROLL] or attractor.period is None or (rotor.system.arrays.restitution == 1.0).any():
        return None
    values = np.array([0.0, *[-np.inf] * directions])
    return LyapunovExponents(values, np.zeros(len(values)), 0.0, -np.inf, 0, 0, attractor.period)


def _rub_rates(rotor: Rotor, attractor: Attractor) -> np.ndarray | None:
    """Exponents of sliding next to a synchronous rub; the directions off the wall have no exponents."""
    steady = attractor.name.outcome is Outcome.FORWARD_RUB and not attractor.name.drifting
    if not steady or rotor.system.forced is not None:
        return None
    for rub in find_equilibria(rotor)[1:]:
        if np.abs(np.atleast_1d(rub.position) - np.atleast_1d(attractor.state.position)).max() < APPROACHED:
            rates = np.sort([complex(value).real for value in rub.eigenvalues])[::-1]
            return np.concatenate([rates, np.full(2 * len(rotor.system.exponents) - len(rates), -np.inf)])
    return None


def _bouncing(rotor: Rotor, attractor: Attractor, impacts: int) -> Character:
    """Character of bouncing, with or without lasting contact in between."""
    if attractor.name.multiplicity:
        if attractor.orbit is None:
            return _undecided(attractor, "The motion recurs, but Newton's method closes no orbit there.")
        return _periodic(attractor, attractor.orbit)
    try:
        exponents = lyapunov_exponents(rotor, attractor.state, impacts)
    except CaromError as reason:
        return _undecided(attractor, f"No exponents: {reason}")
    motion = simulate(rotor, attractor.state, max(exponents.time, 1.0), max_events=10 * impacts)
    rotation = rotation_of(rotor.system.nodes.of(motion.arrivals[arrives(motion)]))
    return _irregular(rotor, attractor, exponents, rotation, motion)


def _irregular(
    rotor: Rotor, attractor: Attractor, exponents: LyapunovExponents, rotation: Rotation, motion: Trajectory
) -> Character:
    """Character of bouncing that has not repeated, from what was measured."""
    value, error = exponents.across
    told = f"largest exponent {value:.3g} Omega, standard error {error:.2g}, from {exponents.impacts:,} impacts"
    kind: CharacterKind = "undecided"
    words = f"It has not repeated, and its averages do not tell what it is: {told}."
    if exponents.positive and not rotation.regular:
        kind, words = "chaotic", f"Nearby motions separate: {told}."
    elif exponents.negative:
        orbit = _approached_orbit(motion)
        if orbit is not None:
            return _periodic(attractor, orbit)
        words = f"Nearby motions approach each other ({told}), but no orbit of up to {MOST_IMPACTS} impacts was found there."
    elif rotation.regular and not exponents.positive and exponents.lost < len(exponents.values) - 1:
        if rotation.locked:
            words = f"Its rotation number is {rotation.nearest}, but no orbit closes there: {told}."
        else:
            kind = "torus"
            words = (
                f"Averages over both halves agree to {rotation.digits:.0f} digits and nearby motions do not separate ({told}); "
                f"{_curves(rotation)}."
            )
    return Character(
        kind, words, lasting_of(attractor.survival), exponents=exponents, rates=exponents.values, rotation=rotation
    )


def _curves(rotation: Rotation) -> str:
    curves = "one closed curve" if rotation.loops == 1 else f"{rotation.loops} closed curves in turn"
    return f"the impacts lie on {curves}, rotation number {rotation.number:.9g} up to a whole multiple"


def lasting_of(survival: Survival | None) -> Lasting:
    """Whether irregular bouncing lasts, from its survival: a transient only if its motions were followed long enough."""
    return "undecided" if survival is None else survival.verdict


def _undecided(attractor: Attractor, words: str) -> Character:
    lasting = lasting_of(attractor.survival) if attractor.name.irregular else "undecided"
    return Character("undecided", words, lasting)


def _periodic(attractor: Attractor, orbit: Orbit | SimulatedOrbit) -> Character:
    """Character of bouncing next to an orbit: periodic if the orbit attracts and is a motion of the machine."""
    if not orbit.admissible:
        return _undecided(attractor, f"The orbit found next to it is no motion of the machine: {orbit.reason}.")
    if not orbit.stable:
        return _undecided(attractor, f"The orbit found next to it repels: {orbit.multipliers.instability}.")
    exponents, largest = orbit_exponents(orbit), orbit.multipliers.spectral_radius
    words = f"It closes by Newton's method, and its largest multiplier is {largest:.4g}."
    return Character("periodic", words, "attractor", orbit, exponents, exponents.values)


def _approached_orbit(motion: Trajectory) -> Orbit | SimulatedOrbit | None:
    """Attracting orbit to which a motion comes closer and closer."""
    struck = arrives(motion)
    states, times = motion.rotor.system.states_of(motion.arrivals[struck]), motion.segment_starts[1:][struck]
    count = len(states)
    if count < 4 * MOST_IMPACTS:
        return None
    apart = np.abs(states[-1] - states[-1 - MOST_IMPACTS : -1][::-1]).max(axis=1)
    for impacts in np.sort(np.argsort(apart, kind="stable")[:TRIED] + 1).tolist():
        orbit: Orbit | SimulatedOrbit | None
        if motion.rotor.has_closed_forms:
            guess = with_impacts(motion, count - 1 - impacts, impacts)
            orbit = orbit_near(motion.rotor, *guess) if guess else None
        else:
            begun = count - 1 - impacts
            orbit = close(motion, 0.5 * float(times[begun - 1] + times[begun]), float(times[-1] - times[begun]))
        if orbit is not None and orbit.stable and orbit.admissible:
            early, late = (_distance(orbit, states[place]) for place in (count // 2, count - 1))
            if late < max(0.5 * early, APPROACHED):
                return orbit
    return None


def _distance(orbit: Orbit | SimulatedOrbit, state: np.ndarray) -> float:
    """Distance of a state at an arrival from the nearest one of an orbit, relative to one plus its size."""
    states = orbit.arrivals if isinstance(orbit, SimulatedOrbit) else orbit.nodes
    return float(np.abs(states - state).max(axis=1).min() / (1.0 + np.abs(state).max()))
