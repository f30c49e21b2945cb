"""Find the attractors of a rotor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import compress
from typing import ClassVar

import numpy as np

from carom.attractors.following import SLOWER, Ending, Survival, follow_in_stages
from carom.attractors.groups import Attractor, attractor_of
from carom.attractors.naming import name_motions, orbits_of
from carom.attractors.starts import DISTURBANCES, DisturbanceSet, Start, disturbances_of, known_starts, starts_at
from carom.base.arguments import Count, Seed, Whole, checked
from carom.base.outcome import IRREGULAR_BOUNCING, InputError, Outcome
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.base.results import Members, in_a_line
from carom.closed_forms.exact_results import exact_results
from carom.disturbances import Disturbance, Plan, Sample, Single, Starts
from carom.disturbances.following import refuse_another_machine
from carom.models import Rotor, Subject, rotor_of
from carom.motions import PATIENCE, Endings, State
from carom.motions.budget import NOT_FOLLOWED
from carom.orbits import Orbit

RECOGNISED = (
    "Levitation is proven. A rub at rest in the co-rotating frame is recognised by its linearised sliding, other rubs by a full turn "
    f"that repeats, periodic bouncing by recurrence of the state; {IRREGULAR_BOUNCING} is stated only for as long as it was followed."
)
"""How ends of motions are known, for rotors without closed forms."""


@dataclass(frozen=True, eq=False, repr=False)
class AttractorSet(Members[Attractor]):
    """All attractors found; look one up by name, ``found["B1,d"]``.

    Attributes
    ----------
    rotor : Model
        The machine of the motions: that after the disturbance, if the disturbance changes it.
    members : tuple of Attractor
        Sorted by the number of disturbances, the largest first; motions given up come last.
    endings : tuple of Ending
        Every start, the disturbances first.
    sample : DisturbanceSet, Grid, Sample or None
        The disturbances; ``None`` if they were given one by one.
    patience : int
        Impacts without recurrence after which bouncing counts as irregular.
    asked : int
        Number of disturbances that were to be followed; those that the budget of a study did not suffice for are left out.
    """

    figure: ClassVar[str] = "attractors"
    called: ClassVar[str] = "attractor"

    rotor: Rotor
    members: tuple[Attractor, ...]
    endings: tuple[Ending, ...]
    sample: DisturbanceSet | Plan | None
    patience: int
    asked: int

    def rows(self) -> list[tuple[str, str]]:
        """Each motion found, and how many starts ended on it."""
        lines = [(each.name, f"{each.count} disturbances, {each.known} starts next to it") for each in self.members]
        return [("rotor", in_a_line(self.rotor)), ("starts", str(len(self.endings))), *lines]

    @property
    def disturbances(self) -> tuple[Ending, ...]:
        """Where the disturbances ended."""
        return tuple(ending for ending in self.endings if ending.start.disturbance)

    @property
    def touched(self) -> tuple[Ending, ...]:
        """The disturbances in which the rotor touched the wall."""
        return tuple(ending for ending in self.disturbances if ending.touched)

    @property
    def hardest_impulse(self) -> float:
        """Largest normal impulse in any disturbance, in ``m c_r Ω``."""
        return max((ending.hardest_impulse for ending in self.disturbances), default=0.0)

    @checked
    def ending_on(self, name: str) -> tuple[Ending, ...]:
        """Disturbances and other starts that ended on an attractor."""
        return tuple(ending for ending in self.endings if ending.attractor == name)

    def example_of(self, member: Attractor) -> Ending:
        """The first to settle of the starts that end on an attractor, among disturbances with contact if there are any."""
        endings = self.ending_on(member.name)
        disturbed = [ending for ending in endings if ending.start.disturbance]
        return min(disturbed, key=lambda ending: (not ending.impacts, ending.time), default=endings[0])

    @property
    def transient(self) -> Survival | None:
        """How long irregular bouncing lasts, if it occurred and was seen to end; otherwise ``None``."""
        seen = (ending.survival for ending in self.endings)
        return next((survival for survival in seen if survival and survival.transient), None)

    @property
    def smallest_unrecovered_kick(self) -> float | None:
        """Smallest kick tried that did not come back to levitation, in ``c_r Ω``; ``None`` if all did."""
        kicks = [each.start.state for each in self.endings if each.start.kind == "kick" and not each.recovered]
        pushes = (self.rotor.system.translation_velocity(kick.velocity, kick.time) for kick in kicks)
        return min((float(abs(push)) for push in pushes), default=None)

    @property
    def fastest(self) -> float:
        """Largest speed of the disturbances in the fixed frame (of kicks: size), in ``c_r Ω``."""
        if isinstance(self.sample, DisturbanceSet):
            return self.sample.fastest
        return max((entry.start.speed for entry in self.disturbances), default=0.0)

    def words(self) -> str:
        """Say which disturbances were tried."""
        followed = f", of which {len(self.disturbances)} were followed" if len(self.disturbances) < self.asked else ""
        if isinstance(self.sample, DisturbanceSet):
            return self.sample.words(self.rotor) + followed
        kind = f" of the kind {self.sample.model.kind}" if self.sample else ""
        return f"{self.asked} given disturbances{kind}{followed}"

    @property
    def argument(self) -> str:
        """The evidence for the list, in a sentence or two."""
        known = len(self.endings) - len(self.disturbances)
        general = "" if exact_results(self.rotor).rubs else f" {RECOGNISED}"
        return (
            f"{self.words()}, and {known} starts next to motions known in closed form, which do not count in the shares, were "
            "simulated until they settled. This is evidence, not proof: an attractor that none of them reaches is not listed."
            f"{general}"
        )


@checked
@shows_progress
def find_attractors(
    machine: Subject,
    disturbances: DisturbanceSet | Plan | Disturbance | Sequence[State | Single] | None = None,
    *,
    seed: Seed = 0,
    count: Count = DISTURBANCES,
    known: bool = True,
    patience: Whole = PATIENCE,
    threads: Count | None = None,
    progress: ShowProgress = None,
) -> AttractorSet:
    """Follow disturbances, and starts next to every known motion, to the attractors on which they settle.

    Shares count the disturbances alone: a start next to a known motion shows that the motion attracts, not that any
    disturbance leads to it.  The same arguments give the same result.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    disturbances : DisturbanceSet, Grid, Sample, Disturbance or sequence of State or Single, optional
        Disturbances to follow instead of the standard set (:class:`~carom.attractors.DisturbanceSet`): a plan, a model
        of :mod:`carom.disturbances`, of which a sample is drawn, or single starts.  Those that are not possible are
        left out.
    seed, count : int
        Seed and size of the standard set or of the sample; ``DisturbanceSet.of(machine, count, seed, fastest)`` is a standard set of other speeds.
    known : bool
        Whether to add starts next to the motions known in closed form; see :func:`~carom.attractors.known_starts`.
    patience : int
        Impacts without recurrence after which bouncing counts as irregular.  How long it lasts is then measured
        (:class:`~carom.attractors.Survival`).  If it is transient, motions are followed beyond the patience until they
        settle, unless that would take too long.
    threads : int, optional
        By default the number of available cores; the result does not depend on it.

    Raises
    ------
    InputError
        A start lies outside the wall, none of the disturbances is possible, or there is nothing to follow.

    See Also
    --------
    carom.map_basins : the end of each disturbance of a grid
    carom.find_orbits : orbits, stable or not

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> found = cm.find_attractors(machine, count=40, seed=1)
    >>> found.members[0].name
    'B1,d'
    """
    rotor, tell = rotor_of(machine), Reporter.of(progress, "following disturbances")
    given: DisturbanceSet | Plan | Sequence[State | Single]
    if disturbances is None:
        given = DisturbanceSet.of(rotor, count, seed)
    else:
        given = Sample(disturbances, count, seed) if isinstance(disturbances, Disturbance) else disturbances
    refuse_another_machine(given)
    tried, starts = disturbances_of(rotor, given)
    orbits = orbits_of(rotor)
    nearby = known_starts(rotor, orbits) if known else ()
    if nearby:
        tried += nearby
        starts = Starts.joined([starts, starts_at(rotor, [start.state for start in nearby])])
    if not tried:
        raise InputError("count", count, "at least one start to follow")
    divisor = 1 if rotor.system.is_planar else SLOWER
    ends, lasted, survival = follow_in_stages(rotor, starts, patience, threads, tell.part(0.0, 0.9), divisor)
    followed = ends.outcomes != NOT_FOLLOWED
    asked, tried = sum(each.disturbance for each in tried), list(compress(tried, followed))
    starts, ends, lasted = starts.some(followed), ends[followed], lasted[followed]
    endings, members = _grouped(rotor, orbits, starts, ends, tried, [survival if each else None for each in lasted])
    tell(1.0)
    return AttractorSet(rotor, members, endings, None if isinstance(given, Sequence) else given, patience, asked)


def _grouped(
    rotor: Rotor,
    orbits: Sequence[Orbit],
    starts: Starts,
    ends: Endings,
    tried: Sequence[Start],
    survivals: Sequence[Survival | None],
) -> tuple[tuple[Ending, ...], tuple[Attractor, ...]]:
    """Where each start ended, and the attractors, those on which most disturbances end first."""
    index, names = name_motions(rotor, ends, orbits)
    touched = starts.touched | (ends.impacts > 0) | (ends.outcomes > Outcome.LEVITATED)
    endings = tuple(
        Ending(
            rotor,
            start,
            names[index[place]],
            time=float(ends.times[place]),
            impacts=int(ends.impacts[place]),
            touched=bool(touched[place]),
            survival=survivals[place],
        )
        for place, start in enumerate(tried)
    )
    members = []
    for name, place in sorted(zip(*np.unique(index, return_index=True), strict=True), key=lambda found: found[1]):
        state = ends.state(int(place))
        members.append(attractor_of(names[name], endings, state))
    ordered = sorted(members, key=lambda member: (not member.settled, -member.count, -member.known))
    return endings, tuple(ordered)
