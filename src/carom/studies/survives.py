"""What a machine survives: kicks, shocks and losses of a blade, in absolute sizes.

For each kind of disturbance three sizes matter: up to the first contact is proven to be impossible, up to the second every one
tried came back, and the third is the smallest found that is lost (:func:`carom.basins.smallest_unrecovered`).  They do not depend on
what the machine must survive; whether that is met follows from them.

What must be survived is also followed at its full size, all around, for what the touchdown bearings bear.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar, NamedTuple, cast

import numpy as np

from carom.attractors import AttractorSet
from carom.base.outcome import Outcome
from carom.base.progress import Reporter
from carom.base.results import Result, record
from carom.basins import Share, SmallestUnrecovered, smallest_unrecovered
from carom.basins.sizes import contact_free_size
from carom.basins.unrecovered import GOLDEN
from carom.closed_forms.contact_free import shift_by_unbalance
from carom.disturbances import BaseRecord, BaseShock, BladeLoss, Disturbance, VelocityKick
from carom.disturbances.coordinates import TURN
from carom.disturbances.kicks_and_shocks import LONGEST_SHOCK
from carom.models import Rotor
from carom.motions import DropLoads, State, TouchdownLoads, Trajectory, drop_loads, simulate
from carom.motions.budget import Budget, present_question
from carom.motions.loads import MagnetReach
from carom.parameters import DIMENSIONLESS_FIELDS, SHOCK_DURATION, LoadLimits, Required, Scales
from carom.rotors.reduction_errors import ReductionError, reduction_error
from carom.studies.drops import LoadCheck, check_loads, worst_of
from carom.studies.questions import FEWEST, LABELS, SMALLEST, Kind, events_for, required_kinds
from carom.studies.trials import Check
from carom.studies.wording import SIZES as SIZES_OF

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
FULL_SIZE = "kind size whirls reduction magnets touchdown_bearings=bearings limits=checks"
REACH = 4.0
"""Largest kick and shock searched, as a multiple of what must be survived or is proven to be contact-free."""
BELOW = 0.999
"""Largest unbalance after a loss of a blade, relative to that with which levitation would fill the clearance."""
SURVIVED = (
    "harmless_up_to=contact_free:{kind} all_up_to=all_back:{kind} smallest_lost=size:{kind} searched_up_to=largest:{kind} "
    "tried fresh angle instant neighbours neighbours_lost complete lost_to=outcome.label"
)


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

    def document(self) -> dict[str, object]:
        """As plain data for JSON."""
        return record(self, BEARING, self.scales)


@dataclass(frozen=True, eq=False, repr=False)
class FullSize(Result):
    """Disturbances of one kind that must be survived, at their full size in all directions.

    Attributes
    ----------
    kind : {"kick", "shock", "base_record", "blade_loss"}
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

    def document(self) -> dict[str, object]:
        """As plain data for JSON."""
        return record(self, FULL_SIZE) | {"at_largest": record(self, "came_back=back.count lost total=back.total")}


def at_full_size(rotor: Rotor, required: Required, limits: LoadLimits = NO_LIMITS) -> tuple[FullSize, ...]:
    """Follow each kind that must be survived at its full size in all directions."""
    return tuple(_of_kind(rotor, *each, limits) for each in required_kinds(required))


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


def _followed(rotor: Rotor, start: State, pair: tuple[float, float]) -> _Followed:
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


@dataclass(frozen=True, eq=False, repr=False)
class Survives(Result):
    """What a machine survives of each kind of disturbance.

    Attributes
    ----------
    kick : SmallestUnrecovered
        Kicks out of levitation; sizes in ``c_r Ω``.
    shock : SmallestUnrecovered or None
        Half-sine shocks of the base of ``duration``; sizes are peaks in ``c_r Ω²``.  ``None`` where none is required and the
        usual duration is not known in turns, or is too many, or where the state after a shock is more than places and speeds.
    duration : float
        Duration of the shocks, in ``1/Ω``.
    blade_loss : SmallestUnrecovered or None
        Sizes are changes of the unbalance by the loss of a blade, as eccentricities in ``c_r``, at the worst phase.
    base_record : SmallestUnrecovered or None
        The recorded motion of the base, where one is required; sizes are peaks in ``c_r Ω²``.
    """

    kick: SmallestUnrecovered
    shock: SmallestUnrecovered | None
    duration: float
    blade_loss: SmallestUnrecovered | None
    base_record: SmallestUnrecovered | None = None

    @property
    def known_scales(self) -> Scales | None:
        """Scales of the machine."""
        return self.kick.scales

    def items(self) -> tuple[tuple[Kind, SmallestUnrecovered], ...]:
        """The kinds that were searched, by name."""
        return tuple((kind, found) for kind in LABELS if (found := getattr(self, kind)) is not None)

    def document(self) -> dict[Kind, dict[str, object]]:
        """What of each kind is survived, as plain data for JSON."""
        return {
            kind: record(found, SURVIVED.format(kind=SIZES_OF[kind]), found.scales)
            | ({"duration": self.duration} if kind == "shock" else {})
            for kind, found in self.items()
        }


def survives(rotor: Rotor, required: Required, budget: Budget, tell: Reporter) -> Survives | None:
    """Search for the smallest disturbance of each kind that is lost; ``None`` where there is no levitation to come back to."""
    if not comes_to_rest(rotor):
        return None
    found: dict[Kind, SmallestUnrecovered] = {}
    duration = _duration(rotor, required)
    for kind, largest in _searched(rotor, required, duration):
        words = SMALLEST.format(largest.noun)
        tell(len(found) / len(LABELS), words)
        with budget.question(words, events_for(rotor, words)):
            found[kind] = smallest_unrecovered(rotor, largest)
    return Survives(found["kick"], found.get("shock"), duration, found.get("blade_loss"), found.get("base_record"))


def _searched(rotor: Rotor, required: Required, duration: float) -> Iterator[tuple[Kind, Disturbance]]:
    """The kinds that can be searched, at their largest size: kicks and shocks up to a multiple of what is required, or of what cannot touch if that is more."""
    yield "kick", VelocityKick(_times(rotor, VelocityKick(required.kick)) * required.kick)
    if duration:
        peak = required.shock.peak if required.shock else math.pi * required.kick / (2.0 * duration)
        yield "shock", BaseShock(_times(rotor, BaseShock(peak, duration)) * peak, duration)
    if (record := required.base_record) is not None:
        yield "base_record", replace(cast("BaseRecord", record), largest=REACH * record.largest)
    if (change := largest_change(rotor)) > 0.0:
        yield "blade_loss", BladeLoss(change)


def _times(rotor: Rotor, model: VelocityKick | BaseShock) -> float:
    return REACH * max(1.0, contact_free_size(rotor, model) / model.coordinates[0].high)


def comes_to_rest(rotor: Rotor) -> bool:
    """Whether there is stable levitation inside the wall, to which a disturbed rotor can come back."""
    return rotor.system.rest_radius < 1.0 and rotor.system.decay > 0.0


def largest_change(rotor: Rotor) -> float:
    """Largest change of the unbalance, in ``c_r``, after which the rotor can levitate at any phase.

    Larger ones that add to the unbalance before lead to no levitation inside the wall; just below it motions do not settle.  Zero for a model whose
    unbalance is not known by one number, and of a shaft whose speed changes.
    """
    system, before = rotor.system, rotor.definition.unbalance_along() if "rho" in rotor.varied else None
    if before is None or system.is_anisotropic or system.shaft is not None:
        return 0.0
    sags = np.abs(system.arrays["rows"] @ system.outer)
    shifts = np.abs(system.planes @ shift_by_unbalance(rotor))
    return min(float((BELOW * (1.0 - sags) / shifts).min()), DIMENSIONLESS_FIELDS["rho"].highest) - before


def _duration(rotor: Rotor, required: Required) -> float:
    """Duration of the shocks: that required, otherwise the usual one where times are known; else 0."""
    if required.shock:
        return required.shock.duration
    if rotor.system.why_not_stationary is not None or rotor.scales is None:
        return 0.0
    usual = SHOCK_DURATION / rotor.scales.time
    return usual if usual <= LONGEST_SHOCK else 0.0


def has_unrecovered(found: SmallestUnrecovered, size: float) -> bool:
    """Whether some disturbances up to a size are lost, or it is larger than all that are possible."""
    return (found.size is not None and found.size <= size) or (found.complete and size > found.largest)


def decides(present: Check | None) -> bool:
    """Whether enough of what must be survived was followed to say that it came back, where none is lost."""
    return present is not None and min(each.total for each in present.returned) >= FEWEST


def unrecovered_kinds(
    required: Required,
    survives: Survives | None,
    present: Check | None,
    attractors: AttractorSet,
    full_size: Sequence[FullSize] = (),
) -> list[tuple[Kind, Share | None]]:
    """The kinds that must be survived and of which some were lost, with the share of them that came back, if any were drawn.

    Drawn ones count, those at their full size all around, those that the search for the smallest has found, and kicks among the disturbances whose
    ends are described.
    """
    if survives is None or present is None:
        return []
    lost: list[tuple[Kind, Share | None]] = []
    described = attractors.smallest_unrecovered_kick
    for place, (kind, size, _) in enumerate(required_kinds(required)):
        drawn, largest, entry = present.returned[place], present.largest[place], getattr(survives, kind)
        seen = drawn.count < drawn.total or largest.count < largest.total
        seen |= kind == "kick" and described is not None and described <= size
        seen |= any(each.lost for each in full_size if each.kind == kind)
        if seen or (entry is not None and has_unrecovered(entry, size)):
            lost.append((kind, drawn if drawn.total else None))
    return lost
