"""What must be survived at its full size, all around: what the touchdown bearings bear, for any rotor."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, NamedTuple

import numpy as np

from carom.base.outcome import Outcome
from carom.base.results import Result, record
from carom.basins import Share
from carom.basins.unrecovered import GOLDEN
from carom.disturbances import Disturbance
from carom.disturbances.coordinates import TURN
from carom.models import Rotor
from carom.motions import State, Trajectory, drop_loads, simulate
from carom.motions.budget import present_question
from carom.motions.loads import DropLoads, TouchdownLoads
from carom.motions.magnets import MagnetReach
from carom.parameters import LoadLimits, Required, Scales
from carom.rotors.reduction_errors import ReductionError, reduction_error
from carom.studies.kinds import Kind, required_disturbances, required_kinds
from carom.studies.load_checks import LoadCheck, check_loads, worst_of

DIRECTIONS = 12
"""Directions of a kick or a shock, and phases of the change of the unbalance by the loss of a blade, that are followed at their full size; each
at an instant of its own, where this matters."""
IN_TURN, LEAST_DIRECTIONS = (0, 4, 8, 2, 6, 10, 1, 5, 9, 3, 7, 11), 3
"""Order in which they are followed, and how many of them are in any case."""
LOOKED, SAMPLES = 100, 20_000
"""Turns of the shaft for which a motion without contact is looked at, which is known at once to settle, and instants at which."""
MOST_EVENTS = 5_000
"""Events up to which one motion with loads is followed: of what then still touches the end is not known."""
NO_LIMITS = LoadLimits()
BEARING = "touchdown_bearing radius:length force: impulse: contact_time:time contacts"


@dataclass(frozen=True)
class AtBearing:
    """The largest of each load of a touchdown bearing in several motions, in units of the equations at that bearing.

    Attributes
    ----------
    touchdown_bearing : int
        Counted from 1.
    radius : float
        Largest distance of the shaft from the centre; beyond the clearance it is pressed into the bearing.
    force, impulse, contact_time : float
        On a rigid wall the force is that of lasting contact alone.
    contacts : int
    is_compliant : bool
    scales : Scales or None
    """

    touchdown_bearing: int
    radius: float
    force: float
    impulse: float
    contact_time: float
    contacts: int
    is_compliant: bool
    scales: Scales | None

    def document(self) -> dict[str, Any]:
        """As plain data for JSON."""
        return record(self, BEARING, self.scales)


@dataclass(frozen=True, eq=False, repr=False)
class FullSize(Result):
    """Disturbances of one kind that must be survived, at their full size in all directions.

    Attributes
    ----------
    kind : {"kick", "shock", "blade_loss"}
    size : float
        In units of the equations.
    back : Share
        How many of them came back.
    lost : int
        How many end elsewhere; of others the end is not known.
    bearings : tuple of AtBearing
        The worst of these, until their ends were known.
    whirls : tuple of str
        In which directions the rotor went round at the end of those that stay in contact.
    worst : Trajectory
        The one with the largest force, on a rigid wall the largest impulse, or without contact the widest orbit.
    reduction : ReductionError or None
        Error of the reduction of a flexible machine along that one.
    checks : tuple of LoadCheck
        The worst load of all of them at all bearings against each limit that is stated.
    """

    shown: ClassVar = ("kind", "size", "back", "bearings")

    kind: Kind
    size: float
    back: Share
    lost: int
    bearings: tuple[AtBearing, ...]
    whirls: tuple[str, ...]
    worst: Trajectory
    reduction: ReductionError | None = None
    checks: tuple[LoadCheck, ...] = ()

    @cached_property
    def magnets(self) -> MagnetReach | None:
        """How near the rotor comes to its magnets along the worst, where their air gaps are known."""
        return drop_loads(self.worst).magnets

    def document(self) -> dict[str, Any]:
        """As plain data for JSON."""
        return {
            **record(self, "kind size"),
            "at_largest": {"came_back": self.back.count, "lost": self.lost, "total": self.back.total},
            "whirls": list(self.whirls),
            "reduction": self.reduction and self.reduction.document(),
            "magnets": self.magnets and self.magnets.document(),
            "touchdown_bearings": [each.document() for each in self.bearings],
            "limits": [each.document() for each in self.checks],
        }


def at_full_size(rotor: Rotor, required: Required, limits: LoadLimits = NO_LIMITS) -> tuple[FullSize, ...]:
    """Follow each kind that must be survived at its full size in all directions."""
    each = zip(required_kinds(required), required_disturbances(required, 1), strict=True)
    return tuple(_of_kind(rotor, kind, size, sample.model, limits) for (kind, size), sample in each)


class _Followed(NamedTuple):
    """A motion as far as it is looked at, with its direction and instant, its loads, and whether it comes back."""

    motion: Trajectory
    pair: tuple[float, float]
    loads: DropLoads
    back: bool
    lost: bool

    @property
    def size(self) -> tuple[float, float]:
        """By what motions are compared: force or impulse; without contact the width of the orbit."""
        planes = self.loads.planes
        peak_load = max(each.force if each.is_compliant else each.impulse for each in planes)
        return peak_load, 0.0 if peak_load else max(_reach(self.motion, each) for each in planes)


def _of_kind(rotor: Rotor, kind: Kind, size: float, model: Disturbance, limits: LoadLimits) -> FullSize:
    def at(rotor: Rotor, angle: float, instant: float) -> tuple[Rotor, State]:
        return model.apply(rotor, angle, instant=instant)

    tried = [_followed(*at(rotor, *pair), pair) for pair in _affordable()]
    whirls = {
        plane.whirl.direction
        for each in tried
        if not each.back
        for plane in each.loads.planes
        if plane.whirl is not None and plane.whirl.direction
    }
    worst, reduced = max(tried, key=lambda each: each.size), rotor.finite_elements
    error = None
    if reduced is not None:
        error = reduction_error(reduced, worst.loads, lambda finer: at(finer.model, *worst.pair))
    return FullSize(
        kind,
        size,
        Share.of(sum(each.back for each in tried), len(tried), drawn=False),
        sum(each.lost for each in tried),
        tuple(_worst_at(tried, place) for place in range(len(worst.loads.planes))),
        tuple(sorted(whirls)),
        worst.motion,
        error,
        worst_of(check_loads(plane, limits) for each in tried for plane in each.loads.planes),
    )


def all_round() -> list[tuple[float, float]]:
    """Directions all around, each with an instant of the turn of its own, spread evenly over both, rad."""
    numbers = np.arange(DIRECTIONS)
    return list(zip((TURN * numbers / DIRECTIONS).tolist(), (TURN * (GOLDEN * numbers % 1.0)).tolist(), strict=True))


def _affordable() -> Iterator[tuple[float, float]]:
    """Pairs of these; where the events do not suffice the first, which are apart."""
    pairs, question = all_round(), present_question()
    for tried, place in enumerate(IN_TURN):
        if question.affords() or tried < LEAST_DIRECTIONS:
            yield pairs[place]


def _followed(rotor: Rotor, start: Any, pair: tuple[float, float]) -> _Followed:
    """Follow a motion until its end is known; one without contact, whose end is known at once, for some turns."""
    motion = simulate(rotor, start, settle=True, max_events=MOST_EVENTS)
    back, loads = motion.outcome is Outcome.LEVITATED, drop_loads(motion)
    lost = motion.outcome is Outcome.BEYOND_MODEL or (motion.outcome.settled and not back)
    if back and not any(plane.contacts for plane in loads.planes):
        motion = simulate(rotor, start, TURN * LOOKED)
        loads = drop_loads(motion)
    return _Followed(motion, pair, loads, back, lost)


def _worst_at(tried: list[_Followed], place: int) -> AtBearing:
    """The largest of each load at a touchdown bearing, from 0."""
    seen = [each.loads.planes[place] for each in tried]
    largest = {name: max(getattr(plane, name) for plane in seen) for name in ("force", "impulse", "contact_time")}
    return AtBearing(
        touchdown_bearing=place + 1,
        radius=max(_reach(each.motion, plane) for each, plane in zip(tried, seen, strict=True)),
        contacts=max(plane.contacts for plane in seen),
        is_compliant=seen[0].is_compliant,
        scales=seen[0].scales,
        **largest,
    )


def _reach(motion: Trajectory, plane: TouchdownLoads) -> float:
    """Largest distance from the centre, in clearances of the plane: by the depth in the bearing, or as sampled of a motion without contact."""
    if plane.depth > 0.0:
        return 1.0 + plane.depth
    if plane.contacts:
        return 1.0
    parts = [part.seen_at(plane.plane) for part in motion.parts]
    return max(float(part.radius(np.linspace(0.0, part.time, SAMPLES)).max()) for part in parts)
