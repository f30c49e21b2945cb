"""What motions are called, and the motions on which starts end, by name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np

from carom.attractors.settled import SETTLED_RTOL, SettledMotion, known_orbit, same_motion, settled_motion
from carom.base.arguments import checked, having
from carom.base.outcome import DRIFTING_RUB, STEADY_WORDS, CaromError, Outcome
from carom.closed_forms.exact_results import exact_results
from carom.disturbances import Disturbance
from carom.models import Rotor
from carom.motions import Endings, simulate
from carom.motions.settling import AT_REST, REPEATING
from carom.orbits import Orbit, orbits_within_reach
from carom.orbits.names import Name, OrbitName

LASTING = (Outcome.FORWARD_RUB, Outcome.BACKWARD_WHIRL, Outcome.ROLLING)
ON_WALL = 1e-9
"""Distance from a wall, in its clearance, within which a plane at the end of lasting contact counts as in contact."""
DECIMALS = 4
"""Decimals to which the speeds at an impact must agree for motions to count as one kind."""
LOOKED_AT = 400
"""Most kinds of periodic bouncing that are compared; further ones are named by their number of impacts alone."""


@dataclass(frozen=True, eq=False, repr=False)
class MotionName(Name):
    """Name of a motion, such as ``"levitation"`` or ``"2-impact bouncing"``: a text that also carries what it says.

    Parameters
    ----------
    multiplicity : int
        Impacts per period of bouncing; 0 if it is irregular, and for all other motions.
    drifting : bool
        Whether a forward rub moves along the wall in the co-rotating frame; otherwise it is synchronous.
    orbit : OrbitName or None
        The single-impact orbit that it is.
    number : int
        Number among the motions with the same name otherwise, from 1.
    """

    outcome: Outcome
    multiplicity: int = 0
    drifting: bool = False
    orbit: OrbitName | None = None
    number: int = 1

    def __new__(
        cls,
        outcome: Outcome,
        multiplicity: int = 0,
        drifting: bool = False,
        orbit: OrbitName | None = None,
        number: int = 1,
    ) -> MotionName:
        """Make the text from the parts."""
        text: str = outcome.words if outcome.settled else f"unresolved: {outcome.label}"
        if orbit is not None:
            text = orbit
        elif outcome in REPEATING:
            text = f"{f'{multiplicity}-impact' if multiplicity else 'irregular'} {outcome.words}"
        elif outcome is Outcome.FORWARD_RUB:
            text = DRIFTING_RUB if drifting else STEADY_WORDS["rub"]
        return super().__new__(cls, f"{text} ({number})" if number > 1 else text)

    @classmethod
    @checked
    def of(cls, parts: Annotated[Mapping[str, Any], having("outcome", "orbit")]) -> MotionName:
        """Name from its parts as plain data, from :func:`dataclasses.asdict` or JSON."""
        orbit = OrbitName(**parts["orbit"]) if parts["orbit"] else None
        return cls(**{**parts, "outcome": Outcome(parts["outcome"]), "orbit": orbit})

    @property
    def words(self) -> str:
        """The name for people: that of :attr:`OrbitName.words <carom.orbits.names.OrbitName.words>` for an orbit; else the name itself, or why there is none."""
        if self.orbit is None:
            return str(self) if self.outcome.settled else self.outcome.words
        return f"{self.orbit.words} ({self.number})" if self.number > 1 else self.orbit.words

    @property
    def irregular(self) -> bool:
        """Whether it is bouncing, with or without rub, that did not repeat itself as far as it was followed."""
        return self.outcome in REPEATING and not self.multiplicity


LEVITATION = MotionName(Outcome.LEVITATED)
SYNCHRONOUS_RUB = MotionName(Outcome.FORWARD_RUB)


def name_motions(
    rotor: Rotor, endings: Endings, orbits: Sequence[Orbit] | None = None
) -> tuple[np.ndarray, tuple[MotionName, ...]]:
    """Name the motion each start ends on: indices (int16, −1 without a start), and names in the order of outcomes.

    The names of levitation and of motions in lasting contact follow from the outcome.  For periodic bouncing, one
    motion of each kind (impacts per period, speeds at the last impact) is followed for its period and compared with the
    orbits known in closed form, which are searched for if they are not given, and with the other kinds.
    """
    outcomes = endings.outcomes
    named = np.full(outcomes.shape, -1, np.int16)
    names: list[MotionName] = []

    def note(chosen: np.ndarray, name: MotionName) -> None:
        if not chosen.any():
            return
        if name not in names:
            names.append(name)
        named[chosen] = names.index(name)

    def note_rubs(chosen: np.ndarray, name: MotionName) -> None:
        for number, apart in enumerate(_apart(rotor, endings, chosen, name)):
            note(apart, replace(name, number=number + 1))

    for code in np.unique(outcomes[outcomes >= 0]):
        name = MotionName(Outcome(code))
        chosen = outcomes == code
        if name.irregular:
            chosen &= endings.multiplicities == 0
        elif name.outcome is Outcome.FORWARD_RUB:
            synchronous = _at_synchronous_rub(rotor, endings)
            note_rubs(chosen & ~synchronous, replace(name, drifting=True))
            chosen &= synchronous
        note_rubs(chosen, name)
    periodic = np.isin(outcomes, REPEATING) & (endings.multiplicities > 0)
    if periodic.any():
        known = orbits_of(rotor) if orbits is None else orbits
        for chosen, name in _periodic(rotor, endings, np.flatnonzero(periodic), known):
            note(chosen, name)
    return named, tuple(names)


def name_endings(rotor: Rotor, model: Disturbance, endings: Endings) -> tuple[np.ndarray, tuple[MotionName, ...]]:
    """:func:`name_motions` after disturbances of a kind; where these change the machine, by outcome alone: each has orbits of its own."""
    if not model.changes_machine:
        return name_motions(rotor, endings)
    named, names = np.full(endings.outcomes.shape, -1, np.int16), list[MotionName]()
    for code, impacts in np.unique([endings.outcomes.ravel(), endings.multiplicities.ravel()], axis=1).T.tolist():
        if code >= 0:
            named[(endings.outcomes == code) & (endings.multiplicities == impacts)] = len(names)
            names.append(MotionName(Outcome(code), impacts))
    return named, tuple(names)


def _apart(rotor: Rotor, endings: Endings, chosen: np.ndarray, name: MotionName) -> Iterator[np.ndarray]:
    """Motions of one name that end in lasting contact elsewhere: at rest at another place, otherwise at other planes."""
    if name.outcome not in LASTING or exact_results(rotor).rubs:
        yield chosen
        return
    positions = endings.positions.reshape(chosen.size, -1)
    features = positions
    if name != SYNCHRONOUS_RUB:
        features = (np.abs(positions @ rotor.system.planes.T) >= 1.0 - ON_WALL).astype(float)
    left = np.flatnonzero(chosen)
    while len(left):
        same = np.abs(features[left] - features[left[0]]).max(axis=1) < SETTLED_RTOL
        mask = np.zeros(chosen.size, bool)
        mask[left[same]] = True
        yield mask.reshape(chosen.shape)
        left = left[~same]


def _at_synchronous_rub(rotor: Rotor, endings: Endings) -> np.ndarray:
    """Which motions in forward rub are at the synchronous rub, or are proven to converge to it."""
    axes = tuple(range(endings.outcomes.ndim, endings.velocities.ndim))
    still: np.ndarray = np.abs(endings.velocities).max(axis=axes, initial=0.0) < AT_REST
    around = exact_results(rotor).around
    if around is None:
        return still
    along = endings.positions.real * endings.velocities.imag - endings.positions.imag * endings.velocities.real
    return still | around.contains(np.angle(endings.positions), along)


def _periodic(
    rotor: Rotor, endings: Endings, places: np.ndarray, orbits: Sequence[Orbit]
) -> list[tuple[np.ndarray, MotionName]]:
    """Kinds of periodic bouncing: the starts that belong to each, and its name."""
    ends = endings.reshaped(endings.outcomes.size)[places]
    positions, velocities, codes, counts = ends.positions, ends.velocities, ends.outcomes, ends.multiplicities
    radial = positions.real * velocities.real + positions.imag * velocities.imag
    along = positions.real * velocities.imag - positions.imag * velocities.real
    if positions.ndim > 1:
        radial, along = radial.sum(axis=1), along.sum(axis=1)
    first, kinds = _alike(codes, counts, radial.round(DECIMALS), along.round(DECIMALS))
    known: dict[MotionName, SettledMotion] = {}
    found = []
    for kind, place in enumerate(first):
        chosen = np.zeros(endings.outcomes.size, bool)
        chosen[places[kinds == kind]] = True
        if kind < LOOKED_AT:
            name = _name_of(settled_motion(simulate(rotor, ends.state(int(place)), settle=True)), known, orbits)
        else:
            name = MotionName(Outcome(codes[place]), int(counts[place]))
        found.append((chosen.reshape(endings.outcomes.shape), name))
    return found


def _name_of(settled: SettledMotion, known: dict[MotionName, SettledMotion], orbits: Sequence[Orbit]) -> MotionName:
    """Name of a settled motion; if it is none of those known, it is added to them with a new name."""
    for name, other in known.items():
        if same_motion(other, settled):
            return name
    orbit = known_orbit(settled.orbit, orbits)
    drifting = settled.outcome is Outcome.FORWARD_RUB and not settled.synchronous
    name = MotionName(settled.outcome, settled.multiplicity, drifting, orbit.name if orbit else None)
    alike = sum(replace(other, number=1) == name for other in known)
    name = replace(name, number=alike + 1)
    known[name] = settled
    return name


def _alike(*features: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """First member of each group of equal features, and the group of each member."""
    groups = np.zeros(len(features[0]), np.int64)
    first = np.zeros(1, np.int64)
    for feature in features:  # one at a time: sorting rows is a hundred times slower than sorting numbers
        _, ranks = np.unique(feature, return_inverse=True)
        _, first, groups = np.unique(groups * (ranks.max() + 1) + ranks, return_index=True, return_inverse=True)
    return first, groups


def orbits_of(rotor: Rotor) -> Sequence[Orbit]:
    """Orbits known in closed form; empty for rotors without, and where their search fails."""
    try:
        return orbits_within_reach(rotor)
    except CaromError:
        return ()
