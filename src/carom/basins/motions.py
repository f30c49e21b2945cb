"""Names of the motions that starts end on: those of :mod:`carom.attractors`."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from carom.attractors.groups import Groups
from carom.closed_forms.absorbing import rub_neighbourhood
from carom.models import Jeffcott
from carom.motions.ensembles import Endings
from carom.motions.starts import State
from carom.motions.trajectories import simulate
from carom.orbits.single_impact import Orbit, orbits_within_reach
from carom.outcome import CaromError, Outcome

__all__ = ["name_motions"]

ALIKE = 4
"""Decimals to which the speeds at an impact must agree for motions to count as one kind."""
LOOKED_AT = 400
"""Most kinds of periodic bouncing that are compared; further ones are named by their number of impacts alone."""
AT_REST = 1e-6
_PLAIN = {
    Outcome.LEVITATED: "levitation",
    Outcome.BACKWARD_WHIRL: "backward whirl",
    Outcome.ROLLING: "rolling",
}
_NOUNS = {Outcome.BOUNCING: "bouncing", Outcome.MIXED: "bouncing with rub"}


def name_motions(rotor: Jeffcott, outcomes: np.ndarray, endings: Endings) -> tuple[np.ndarray, tuple[str, ...]]:
    """Name the motion each start ends on.

    The names of levitation and of motions in lasting contact follow from the outcome.  For periodic bouncing, one
    motion of each kind (impacts per period, speeds at the last impact) is followed for its period and compared with the
    orbits known in closed form and with the other kinds.

    Parameters
    ----------
    rotor : Jeffcott
    outcomes : ndarray of int8
        Negative where there is no start.
    endings : Endings

    Returns
    -------
    indices : ndarray of int16
        Index of the name of each; −1 where there is no start.
    names : tuple of str
        The names, in the order of their outcome.
    """
    named = np.full(outcomes.shape, -1, np.int16)
    names: list[str] = []

    def note(chosen: np.ndarray, name: str) -> None:
        if not chosen.any():
            return
        if name not in names:
            names.append(name)
        named[chosen] = names.index(name)

    for code in np.unique(outcomes[outcomes >= 0]):
        outcome = Outcome(code)
        chosen = outcomes == code
        if outcome in _NOUNS:
            note(chosen & (endings.multiplicities == 0), f"irregular {_NOUNS[outcome]}")
        elif outcome is Outcome.FORWARD_RUB:
            synchronous = _goes_over_to_rub(rotor, endings)
            note(chosen & synchronous, "synchronous rub")
            note(chosen & ~synchronous, "drifting rub")
        else:
            note(chosen, _PLAIN.get(outcome, f"unresolved: {outcome.label}"))
    periodic = np.isin(outcomes, list(_NOUNS)) & (endings.multiplicities > 0)
    for chosen, name in _periodic(rotor, outcomes, endings, np.flatnonzero(periodic)):
        note(chosen, name)
    return named, tuple(names)


def _goes_over_to_rub(rotor: Jeffcott, endings: Endings) -> np.ndarray:
    """Which motions in forward rub are at the synchronous rub, or are proven to go over to it."""
    still: np.ndarray = np.abs(endings.velocities) < AT_REST
    around = rub_neighbourhood(rotor)
    if around is None:
        return still
    along = endings.positions.real * endings.velocities.imag - endings.positions.imag * endings.velocities.real
    return still | around.contains(np.angle(endings.positions), along)


def _periodic(
    rotor: Jeffcott, outcomes: np.ndarray, endings: Endings, places: np.ndarray
) -> list[tuple[np.ndarray, str]]:
    """Kinds of periodic bouncing: the starts that belong to each, and its name."""
    if not len(places):
        return []
    positions, velocities = endings.positions.ravel()[places], endings.velocities.ravel()[places]
    codes, counts = outcomes.ravel()[places], endings.multiplicities.ravel()[places]
    radial = positions.real * velocities.real + positions.imag * velocities.imag
    along = positions.real * velocities.imag - positions.imag * velocities.real
    first, kinds = _alike(codes, counts, radial.round(ALIKE), along.round(ALIKE))
    groups = Groups(_orbits(rotor))
    found = []
    for kind, place in enumerate(first):
        chosen = np.zeros(outcomes.size, bool)
        chosen[places[kinds == kind]] = True
        if kind < LOOKED_AT:
            state = State(complex(positions[place]), complex(velocities[place]))
            name = groups.name_of(simulate(rotor, state, settle=True))
        else:
            name = f"{counts[place]}-impact {_NOUNS[Outcome(codes[place])]}"
        found.append((chosen.reshape(outcomes.shape), name))
    return found


def _alike(*features: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """First member of each group of equal features, and the group of each member."""
    groups = np.zeros(len(features[0]), np.int64)
    first = np.zeros(1, np.int64)
    for feature in features:  # one at a time: sorting rows is a hundred times slower than sorting numbers
        _, ranks = np.unique(feature, return_inverse=True)
        _, first, groups = np.unique(groups * (ranks.max() + 1) + ranks, return_index=True, return_inverse=True)
    return first, groups


def _orbits(rotor: Jeffcott) -> Sequence[Orbit]:
    """Orbits known in closed form; empty where their search fails."""
    try:
        return orbits_within_reach(rotor)
    except CaromError:
        return ()
