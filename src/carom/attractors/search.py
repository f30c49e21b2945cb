"""Find the attractors of a rotor."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from carom.attractors.following import Ending, endings_of
from carom.attractors.groups import Attractor, Groups
from carom.attractors.starts import DISTURBANCES, DisturbanceSet, Start, disturbances, known_starts
from carom.attractors.survival import Survival
from carom.disturbances import FASTEST
from carom.models import Jeffcott, Subject, model_of
from carom.motions.settling import PATIENCE
from carom.motions.starts import Kick, State
from carom.orbits.single_impact import orbits_within_reach
from carom.outcome import InputError, Outcome
from carom.results import Result, in_a_line

__all__ = ["AttractorSet", "find_attractors"]


@dataclass(frozen=True, eq=False, repr=False)
class AttractorSet(Result):
    """All attractors found; look one up by name, ``found["B1,d"]``.

    Attributes
    ----------
    rotor : Jeffcott
    members : tuple of Attractor
        Sorted by the number of disturbances, the largest first; motions given up come last.
    endings : tuple of Ending
        Every start, the disturbances first.
    sample : DisturbanceSet or None
        The disturbances; ``None`` if they were given one by one.
    patience : int
        Impacts without recurrence after which bouncing counts as irregular.
    """

    rotor: Jeffcott
    members: tuple[Attractor, ...]
    endings: tuple[Ending, ...]
    sample: DisturbanceSet | None
    patience: int

    def rows(self) -> list[tuple[str, str]]:
        """Each motion found, and how many starts ended on it."""
        return [
            ("rotor", in_a_line(self.rotor)),
            ("starts", str(len(self.endings))),
            *(
                (member.name, f"{member.count} disturbances, {member.known} starts next to it")
                for member in self.members
            ),
        ]

    def __len__(self) -> int:
        return len(self.members)

    def __iter__(self) -> Iterator[Attractor]:
        return iter(self.members)

    def __contains__(self, name: object) -> bool:
        return any(member.name == name for member in self.members)

    def __getitem__(self, name: str) -> Attractor:
        for member in self.members:
            if member.name == name:
                return member
        raise InputError("attractor", name, f"one of: {', '.join(member.name for member in self.members)}")

    @property
    def disturbances(self) -> tuple[Ending, ...]:
        """Where the disturbances ended."""
        return tuple(ending for ending in self.endings if ending.start.disturbance)

    def ending_on(self, name: str) -> tuple[Ending, ...]:
        """Disturbances and other starts that ended on an attractor."""
        return tuple(ending for ending in self.endings if ending.attractor == name)

    @property
    def transient(self) -> Survival | None:
        """How long irregular bouncing lasts, if it occurred and was seen to end; otherwise ``None``."""
        seen = (ending.survival for ending in self.endings)
        return next((survival for survival in seen if survival and survival.transient), None)

    @property
    def touching(self) -> tuple[Attractor, ...]:
        """Attractors on which the rotor keeps touching the bearing."""
        return tuple(member for member in self.members if member.touches)

    @property
    def recovered(self) -> float:
        """Share of the disturbances that came back to levitation."""
        return sum(member.share for member in self.members if member.outcome is Outcome.LEVITATED)

    @property
    def smallest_unrecovered_kick(self) -> float | None:
        """Smallest kick tried that did not come back to levitation, in ``c_r Ω``; ``None`` if all did."""
        kicks = [ending for ending in self.endings if ending.start.kind == "kick"]
        speeds = [ending.start.speed for ending in kicks if ending.outcome is not Outcome.LEVITATED]
        return min(speeds, default=None)

    @property
    def fastest(self) -> float:
        """Largest speed of the disturbances (of kicks: size), in ``c_r Ω``."""
        return (
            self.sample.fastest if self.sample else max((entry.start.speed for entry in self.disturbances), default=0.0)
        )

    def words(self, speed: Callable[[float], str] | None = None) -> str:
        """Say which disturbances were tried; ``speed`` writes one given in ``c_r Ω``."""
        if self.sample is None:
            return f"{len(self.disturbances)} given disturbances"
        return self.sample.words(self.rotor, speed)

    @property
    def argument(self) -> str:
        """The evidence for the list, in a sentence or two."""
        known = len(self.endings) - len(self.disturbances)
        return (
            f"{self.words()}, and {known} starts next to motions known in closed form, which count for no share, were "
            "simulated to where they settle. This is evidence, not proof: an attractor that none of them reaches is not listed."
        )


def find_attractors(
    machine: Subject,
    starts: Sequence[State | Kick] | None = None,
    *,
    seed: int = 0,
    count: int = DISTURBANCES,
    fastest: float = FASTEST,
    known: bool = True,
    patience: int = PATIENCE,
    progress: Callable[[float], None] | None = None,
) -> AttractorSet:
    """Follow disturbances, and starts next to every known motion, to the attractors on which they settle.

    Shares count the disturbances alone: a start next to a known motion shows that the motion attracts, not that any
    disturbance leads to it.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    starts : sequence of State or Kick, optional
        Disturbances to follow instead of the seeded sample.
    seed, count, fastest : int, int, float
        Seed, size and largest speed of the standard set; see :class:`~carom.attractors.DisturbanceSet`.
    known : bool
        Whether to add starts next to the motions known in closed form; see :func:`~carom.attractors.known_starts`.
    patience : int
        Impacts without recurrence after which bouncing counts as irregular.  How long it lasts is then measured
        (:class:`~carom.attractors.Survival`).  If it is transient, motions are followed beyond the patience until they
        settle, unless that would take too long.
    progress : callable, optional
        Called with the fraction done, 0 to 1.

    Returns
    -------
    AttractorSet
        The same for the same arguments.

    Raises
    ------
    InputError
        A start lies outside the wall, or there is nothing to follow.
    """
    rotor = model_of(machine)
    chosen = DisturbanceSet(count, seed, fastest) if starts is None else None
    if starts is None:
        sample = disturbances(rotor, count, seed, fastest)
    else:
        sample = tuple(_given(rotor, start) for start in starts)
    orbits = tuple(orbits_within_reach(rotor))
    sample += known_starts(rotor, orbits) if known else ()
    if not sample:
        raise InputError("count", count, "at least one start to follow")
    groups = Groups(orbits)
    found = endings_of(rotor, sample, patience, groups.name_of, progress or (lambda share: None))
    endings = tuple(sorted(found, key=lambda ending: not ending.start.disturbance))
    members = tuple(groups.attractor(name, endings) for name in groups.names)
    ordered = sorted(members, key=lambda member: (not member.settled, -member.count, -member.known))
    return AttractorSet(rotor, tuple(ordered), endings, chosen, patience)


def _given(rotor: Jeffcott, start: State | Kick) -> Start:
    if isinstance(start, Kick):
        state = start.state(rotor)
        return Start("kick", state, f"a kick of {abs(state.velocity):.3g} c_r Omega")
    return Start("start", start, "a given start")
