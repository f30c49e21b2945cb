"""Disturbances of a flexible machine, followed with contact: what comes back, and what its touchdown bearings bear."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, ClassVar, NamedTuple

import numpy as np

from carom.attractors import MotionName
from carom.attractors.naming import name_endings
from carom.basins import Share
from carom.basins.losses import GOLDEN
from carom.basins.shares import Population
from carom.disturbances import BaseShock, BladeLoss, Disturbance, Sample, VelocityKick
from carom.disturbances.coordinates import TURN
from carom.disturbances.echo import instants_words
from carom.disturbances.following import follow, require_start
from carom.models import Model
from carom.motions import Trajectory, drop_loads, kick, simulate
from carom.motions.bearing_loads import DropLoads, PlaneLoads
from carom.motions.budget import Budget, present_question
from carom.motions.magnets import MagnetReach, magnet_reach
from carom.motions.reduction_errors import ReductionError, reduction_error
from carom.motions.starts import State
from carom.outcome import Outcome
from carom.parameters import Case, LoadLimits, Required, Scales
from carom.progress import Reporter
from carom.results import Result
from carom.studies.load_checks import LoadCheck, checks_of_planes
from carom.studies.questions import ALL_ROUND, DRAWN, EVENTS_OF_FLEXIBLE, LARGER
from carom.studies.verdict_facts import KINDS

DIRECTIONS = 12
"""Directions of a kick or a shock, and phases of the change of the unbalance by the loss of a blade, that are followed at their full size; each
at an instant of its own, where this matters."""
IN_TURN, LEAST_DIRECTIONS = (0, 4, 8, 2, 6, 10, 1, 5, 9, 3, 7, 11), 3
"""Order in which they are followed, and how many of them are in any case."""
TIMES = (2.0, 4.0, 8.0)
"""Multiples of the required kick that are tried in these directions."""
SEED = 1
LOOKED, SAMPLES = 100, 20_000
"""Turns of the shaft for which a motion without contact is looked at, which is known at once to settle, and instants at which."""
MOST_EVENTS = 20_000
"""Events up to which one motion with loads is followed: what then still touches is lost."""


@dataclass(frozen=True, eq=False, repr=False)
class AtPlane(Result):
    """What the touchdown bearing at a plane bears in the worst of several motions, in SI units.

    Attributes
    ----------
    touchdown_bearing : int
        Counted from 1.
    radius : float
        Largest distance of the shaft from the centre, m; beyond the clearance it is pressed into the bearing.
    force : float
        N.
    contact_time : float
        s.
    contacts : int
    """

    shown: ClassVar = ("touchdown_bearing", "radius", "force", "contact_time", "contacts")

    touchdown_bearing: int
    radius: float
    force: float
    contact_time: float
    contacts: int


@dataclass(frozen=True, eq=False, repr=False)
class FlexibleTrial(Result):
    """Disturbances of one kind of a flexible machine.

    Attributes
    ----------
    kind : {"kick", "shock", "blade_loss"}
    size : float
        The largest, in units of the equations.
    drawn : Share
        Of those drawn up to this size, how many came back.
    ends : tuple of tuple
        Where those drawn ended: name and number.
    largest : Share
        Of those at this size in all directions, how many came back.
    planes : tuple of AtPlane
        The worst of these, until their ends were known.
    whirls : tuple of str
        In which directions the rotor went round at the end of those that stay in contact.
    checks : tuple of LoadCheck
        The worst of these against each limit that is stated.
    worst : Trajectory
        The one with the largest force, or without contact the widest orbit.
    reduction : ReductionError or None
        Error of the reduction along that one.
    """

    shown: ClassVar = ("kind", "size", "drawn", "largest", "planes")

    kind: str
    size: float
    drawn: Share
    ends: tuple[tuple[MotionName, int], ...]
    largest: Share
    planes: tuple[AtPlane, ...]
    whirls: tuple[str, ...]
    checks: tuple[LoadCheck, ...]
    worst: Trajectory
    reduction: ReductionError | None = None

    @property
    def beyond_model(self) -> int:
        """How many of those drawn went beyond the model."""
        return sum(count for name, count in self.ends if name.outcome is Outcome.BEYOND_MODEL)

    @cached_property
    def magnets(self) -> MagnetReach | None:
        """How near the rotor comes to its magnets along that one, where their air gaps are known."""
        return magnet_reach(self.worst)

    @property
    def survived(self) -> bool:
        """Whether all that were tried came back."""
        return self.drawn.count == self.drawn.total and self.largest.count == self.largest.total

    def document(self) -> dict[str, Any]:
        """As plain data for JSON."""
        return {
            "kind": self.kind,
            "size": self.size,
            "drawn": self.drawn.document,
            "ends": {str(name): count for name, count in self.ends},
            "beyond_model": self.beyond_model,
            "at_largest": {"came_back": self.largest.count, "total": self.largest.total},
            "whirls": list(self.whirls),
            "reduction": None if self.reduction is None else self.reduction.document(),
            "magnets": None if self.magnets is None else self.magnets.document(),
            "touchdown_bearings": [
                {
                    "touchdown_bearing": each.touchdown_bearing,
                    "radius_si": each.radius,
                    "force_si": each.force,
                    "contact_time_si": each.contact_time,
                    "contacts": each.contacts,
                }
                for each in self.planes
            ],
            "limits": [{"name": each.name, "touchdown_bearing": each.touchdown_bearing, "value_si": each.value, "limit_si": each.limit, "exceeded": each.exceeded} for each in self.checks],
        }  # fmt: skip


def trials_of(
    case: Case, rotor: Model, required: Required, count: int, budget: Budget, tell: Reporter
) -> tuple[FlexibleTrial, ...]:
    """Follow the kinds of disturbances that must be survived: drawn up to their size, and at it in all directions."""
    kinds: list[tuple[str, float, Disturbance, Callable[..., tuple[Model, Any]]]] = []
    kicks = VelocityKick(required.kick)
    kinds.append(("kick", required.kick, kicks, lambda rotor, *at: _kick(rotor, required.kick, *at)))
    if required.shock is not None:
        shock = BaseShock(required.shock.peak, required.shock.duration)
        kinds.append(("shock", shock.peak, shock, shock.stages))
    if required.blade_loss is not None:
        loss = BladeLoss(required.blade_loss, required.blade_loss_node)
        kinds.append(("blade_loss", required.blade_loss, loss, loss.release))
    found = []
    for place, (kind, size, model, at) in enumerate(kinds):
        part = tell.part(place / len(kinds), (place + 1) / len(kinds))
        part(0.0, f"disturbances: {KINDS[kind].lower()}")  # type: ignore[index]
        drawn, all_round = (EVENTS_OF_FLEXIBLE[each] // len(kinds) for each in (DRAWN, ALL_ROUND))
        with budget.question(DRAWN.format(_WORDS[kind]), drawn):
            share, ends = _drawn(rotor, model, count)
        with budget.question(ALL_ROUND.format(_WORDS[kind]), all_round):
            tried = list(_all_round(partial(at, rotor)))
        trial = _trial(kind, size, share, ends, [each for _, each in tried], case.limits)
        worst = next(pair for pair, each in tried if each.motion is trial.worst)
        found.append(replace(trial, reduction=_reduction(rotor, trial.worst, at, worst)))
    return tuple(found)


_WORDS = {"kick": "kicks", "shock": "shocks", "blade_loss": "losses of a blade"}


def _drawn(rotor: Model, model: Disturbance, count: int) -> tuple[Share, Counter[MotionName]]:
    """Of disturbances that are drawn, the share that comes back, and where they end."""
    starts = Sample(model, count, SEED).starts(rotor)
    require_start(rotor, starts)
    ends = follow(rotor, starts)
    ends = ends[ends.outcomes >= 0]
    index, names = name_endings(rotor, model, ends)
    population = Population.of_model(model, rotor.scales, instants_words(rotor))
    share = Share.of(int(ends.recovered.sum()), ends.outcomes.size, drawn=True, population=population)
    return share, Counter(names[place] for place in index.tolist())


def _reduction(
    rotor: Model, motion: Trajectory, at: Callable[..., tuple[Model, Any]], pair: tuple[float, float]
) -> ReductionError | None:
    reduced = rotor.finite_elements
    return (
        None if reduced is None else reduction_error(reduced, drop_loads(motion), lambda finer: at(finer.model, *pair))
    )


def all_round() -> list[tuple[float, float]]:
    """Directions all around, each with an instant of the turn of its own, spread evenly over both, rad."""
    numbers = np.arange(DIRECTIONS)
    return list(zip((TURN * numbers / DIRECTIONS).tolist(), (TURN * (GOLDEN * numbers % 1.0)).tolist(), strict=True))


def kicks_beyond(
    rotor: Model, required: Required, kicks: FlexibleTrial, budget: Budget
) -> tuple[tuple[float, Share], ...]:
    """Multiples of the required kick, and how many of those all around came back; up to the first of which some are lost."""
    found = [(1.0, kicks.largest)]
    with budget.question(LARGER, EVENTS_OF_FLEXIBLE[LARGER]) as question:
        for times in TIMES:
            if found[-1][1].count < found[-1][1].total or not question.affords():
                break
            back = [each.back for _, each in _all_round(partial(_kick, rotor, times * required.kick))]
            found.append((times, Share.of(sum(back), len(back), drawn=False)))
    return tuple(found)


def _all_round(at: Callable[..., tuple[Model, Any]]) -> Iterator[tuple[tuple[float, float], _Followed]]:
    """Motions all around, each with its direction and instant; where the events do not suffice, in the first directions, which are apart."""
    directions, question = all_round(), present_question()
    for tried, place in enumerate(IN_TURN):
        if question.affords() or tried < LEAST_DIRECTIONS:
            yield directions[place], _ended(*at(*directions[place]))


class _Followed(NamedTuple):
    """A motion as far as it is looked at, and whether it comes back."""

    motion: Trajectory
    back: bool


def _kick(rotor: Model, speed: float, angle: float, instant: float) -> tuple[Model, State]:
    return rotor, kick(speed, angle, instant).state(rotor)


def _ended(rotor: Model, start: Any) -> _Followed:
    """Follow a motion until its end is known; one without contact, whose end is known at once, for some turns."""
    motion = simulate(rotor, start, settle=True, max_events=MOST_EVENTS)
    back = motion.outcome is Outcome.LEVITATED
    if back and not any(plane.contacts for plane in drop_loads(motion).planes):
        motion = simulate(rotor, start, 2.0 * math.pi * LOOKED)
    return _Followed(motion, back)


def _trial(
    kind: str, size: float, drawn: Share, ends: Counter[MotionName], followed: list[_Followed], limits: LoadLimits
) -> FlexibleTrial:
    motions, back = [each.motion for each in followed], sum(each.back for each in followed)
    loads = [drop_loads(motion) for motion in motions]
    planes = tuple(at_plane(motions, loads, plane) for plane in range(len(loads[0].planes)))
    # The largest force; without contact the widest orbit.
    sizes = [max(plane.loads.force for plane in each.planes) for each in loads]
    if not any(sizes):
        sizes = [
            max(_reach(motion, plane) for plane in each.planes) for motion, each in zip(motions, loads, strict=True)
        ]
    whirls = {
        plane.whirl.direction
        for each, end in zip(loads, followed, strict=True)
        if not end.back
        for plane in each.planes
        if plane.whirl is not None and plane.whirl.direction
    }
    return FlexibleTrial(
        kind=kind,
        size=size,
        drawn=drawn,
        ends=tuple(ends.most_common()),
        largest=Share.of(back, len(motions), drawn=False),
        planes=planes,
        whirls=tuple(sorted(whirls)),
        checks=worst_checks(loads, limits),
        worst=motions[int(np.argmax(sizes))],
    )


def at_plane(motions: list[Trajectory], loads: list[DropLoads], plane: int) -> AtPlane:
    """The largest of each load at a plane, from 0."""
    seen = [each.planes[plane] for each in loads]
    scales = seen[0].scales or Scales(1.0, 1.0, 1.0)  # a flexible machine has some
    return AtPlane(
        touchdown_bearing=plane + 1,
        radius=max(_reach(motion, each) for motion, each in zip(motions, seen, strict=True)) * scales.length,
        force=max(each.loads.force for each in seen) * scales.force,
        contact_time=max(each.loads.contact_time for each in seen) * scales.time,
        contacts=max(each.contacts for each in seen),
    )


def _reach(motion: Trajectory, loads: PlaneLoads) -> float:
    """Largest distance from the centre, in clearances of the plane: by the depth in the bearing, or as sampled of a motion without contact."""
    if loads.loads.depth > 0.0:
        return 1.0 + loads.loads.depth
    parts = [part.seen_at(loads.plane) for part in motion.parts]
    return max(float(part.radius(np.linspace(0.0, part.time, SAMPLES)).max()) for part in parts)


def worst_checks(loads: list[DropLoads], limits: LoadLimits) -> tuple[LoadCheck, ...]:
    """The worst of many motions, at any plane, against each limit that is stated."""
    checks = [check for each in loads for check in checks_of_planes(each, limits)]
    names = dict.fromkeys(each.name for each in checks)
    return tuple(
        max((each for each in checks if each.name == name), key=lambda each: (each.exceeded, each.value))
        for name in names
    )
