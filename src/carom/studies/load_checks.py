"""Loads of touchdowns against the limits that are stated for a touchdown bearing."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from carom.arguments import checked
from carom.attractors import AttractorSet, MotionName
from carom.disturbances import BaseShock, BladeLoss
from carom.models import Rotor
from carom.motions import DropLoads, TouchdownLoads, Trajectory, drop_loads, simulate, touchdown_loads
from carom.motions.budget import present_question
from carom.outcome import InputError
from carom.parameters import LIMIT_FIELDS, LoadLimits, Required
from carom.parameters.told import number
from carom.results import record

DIRECTIONS = 24
"""Directions of a shock, and phases of the change of the unbalance by the loss of a blade, that are followed at their full size."""


@dataclass(frozen=True)
class LoadCheck:
    """A load against its limit, in the SI unit of the limit.

    Attributes
    ----------
    name : {"impulse", "force", "power", "heat", "depth", "pressure", "impacts"}
    value : float
        Load of the motion, up to where its end was known.
    limit : float
    endless : bool
        Whether the load goes on growing, because the motion has settled in contact.
    after : float
        Seconds after the end was known until the growing load reaches its limit: 0 if it has, infinite if it does not grow.
    touchdown_bearing : int or None
        Counted from 1, of a rotor with several.
    """

    name: str
    value: float
    limit: float
    endless: bool
    after: float
    touchdown_bearing: int | None = None

    @property
    def exceeded(self) -> bool:
        """Whether the load exceeds its limit, now or if the motion goes on."""
        return self.value > self.limit or self.endless

    @property
    def words(self) -> str:
        """The check in words."""
        value, limit = (LoadLimits.told(self.name, each) for each in (self.value, self.limit))
        where = "" if self.touchdown_bearing is None else f" at touchdown bearing {self.touchdown_bearing}"
        text = f"{LIMIT_FIELDS[self.name].words}{where}: {value}, limit {limit}"
        if self.value > self.limit:
            return f"{text}: exceeded{', and it goes on' if self.endless else ''}"
        if not self.endless:
            return f"{text}: kept"
        when = f" {number(self.after, 3)} s later" if math.isfinite(self.after) else ""
        return f"{text}: exceeded{when}, as the motion goes on in contact"

    def document(self) -> dict[str, Any]:
        """As plain data for JSON; values in the SI unit of the limit."""
        return record(self, "name exceeded endless value_si=value limit_si=limit reached_after_si=after")


@checked
def check_loads(loads: TouchdownLoads, limits: LoadLimits) -> tuple[LoadCheck, ...]:
    """Compare the loads of a motion with the limits that are stated; nothing without scales.

    Heat and impacts of a motion that has settled in contact have no end, so they exceed any limit in time.

    Raises
    ------
    InputError
        There is a limit of the pressure, but the touchdown bearing does not state its balls.
    """
    si = loads.si()
    if si is None:
        return ()
    if limits.pressure is not None and loads.pressure is None:
        raise InputError("pressure", limits.pressure, "a limit needs balls in the table [touchdown]")
    values = {**si, "impacts": float(loads.impacts)}
    found = []
    for name, limit in limits.given.items():
        grows = {"heat": loads.goes_on and si["lasting_power"] > 0.0, "impacts": loads.goes_on_bouncing}
        endless, value = grows.get(name, False), values[name]
        after = math.inf
        if value > limit:
            after = 0.0
        elif endless and name == "heat":
            after = (limit - value) / si["lasting_power"]
        found.append(LoadCheck(name, value, limit, endless, after))
    return tuple(found)


def checks_of_planes(loads: DropLoads, limits: LoadLimits) -> tuple[LoadCheck, ...]:
    """The loads of all planes against the limits that are stated; of several the checks name theirs."""
    several = len(loads.planes) > 1
    return tuple(
        replace(check, touchdown_bearing=place if several else None)
        for place, plane in enumerate(loads.planes, start=1)
        for check in check_loads(plane.loads, limits)
    )


@dataclass(frozen=True)
class WorstLoads:
    """The largest of each load over many motions.

    Attributes
    ----------
    checks : tuple of LoadCheck
        The worst of each limit.
    motions : tuple of str
        Name of the motion in which each of these disturbances ended.
    exceeding : tuple of int
        Number of disturbances that exceed each limit.
    disturbances : int
        Number of disturbances followed that touched the wall.
    """

    checks: tuple[LoadCheck, ...]
    motions: tuple[str, ...]
    exceeding: tuple[int, ...]
    disturbances: int

    @property
    def exceeded(self) -> bool:
        """Whether a limit is exceeded by some disturbance."""
        return any(check.exceeded for check in self.checks)

    @property
    def words(self) -> str:
        """The worst of each load in words."""
        if not self.disturbances:
            return "None of the disturbances tried touched the bearing: no load to compare with the limits stated."
        lines = [f"Largest loads of the {self.disturbances} disturbances that touched, against the limits stated."]
        for check, motion, count in zip(self.checks, self.motions, self.exceeding, strict=True):
            words = LIMIT_FIELDS[check.name].words
            value, limit = (LoadLimits.told(check.name, each) for each in (check.value, check.limit))
            grows = " and growing" if check.endless else ""
            kept = f"exceeded by {count} of {self.disturbances}" if count else "kept by all"
            lines.append(f"{words[0].upper()}{words[1:]}: {value}{grows} (ends in {motion}), limit {limit}: {kept}.")
        return "\n".join(lines)

    def document(self) -> dict[str, Any]:
        """The same as JSON."""
        parts = zip(self.checks, self.motions, self.exceeding, strict=True)
        return {
            "disturbances": self.disturbances,
            "limits": [check.document() | {"motion": motion, "exceeding": count} for check, motion, count in parts],
        }


@checked
def worst_loads(found: AttractorSet, limits: LoadLimits, required: Required | None = None) -> WorstLoads:
    """Follow all disturbances that touch to their ends and find the worst load for each limit.

    Parameters
    ----------
    required : Required, optional
        The shock of the base and the loss of a blade that must be survived are followed too, at their full size, each in 24
        directions; a shock from its beginning, with the contacts while it lasts.
    """
    question = present_question()
    checked: list[tuple[str, Sequence[LoadCheck]]] = []
    for ending in found.disturbances:
        if ending.touched and question.affords():
            motion = simulate(ending.rotor, ending.start.state, settle=True)
            checked.append((ending.attractor, check_loads(touchdown_loads(motion), limits)))
    for motion in _of_required(found.rotor, required) if required else ():
        name = MotionName(motion.outcome, motion.multiplicity)
        touching = [plane for plane in drop_loads(motion).planes if plane.contacts or plane.loads.contact_time]
        checked += [(name, check_loads(plane.loads, limits)) for plane in touching]
    if not checked:
        return WorstLoads((), (), (), 0)
    worst, names, counts = [], [], []
    for each in zip(*(checks for _, checks in checked), strict=True):
        place = max(
            range(len(each)), key=lambda of: (each[of].exceeded, each[of].value > each[of].limit, each[of].value)
        )
        worst.append(each[place])
        names.append(str(checked[place][0]))
        counts.append(sum(check.exceeded for check in each))
    return WorstLoads(tuple(worst), tuple(names), tuple(counts), len(checked))


def _of_required(rotor: Rotor, required: Required) -> Iterator[Trajectory]:
    """Motions after the shock and the loss of a blade that must be survived, in all directions; none without levitation."""
    if rotor.system.rest_radius >= 1.0:
        return
    question = present_question()
    for angle in (2.0 * math.pi * place / DIRECTIONS for place in range(DIRECTIONS)):
        if required.shock and question.affords():
            shock = BaseShock(required.shock.peak, required.shock.duration)
            yield simulate(*shock.apply(rotor, angle), settle=True)
        if required.blade_loss and question.affords():
            yield simulate(*BladeLoss(required.blade_loss, required.blade_loss_node).apply(rotor, angle), settle=True)
