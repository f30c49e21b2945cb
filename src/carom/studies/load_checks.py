"""Loads of touchdowns against the limits that are stated for a touchdown bearing."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.base.results import record
from carom.motions import DropLoads, TouchdownLoads
from carom.parameters import LIMIT_FIELDS, LoadLimits
from carom.parameters.formats import number


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
        value, limit = (LoadLimits.format(self.name, each) for each in (self.value, self.limit))
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
    values = {**si, "impacts": float(loads.contacts)}
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
        for check in check_loads(plane, limits)
    )


def worst_of(checks: Iterable[Sequence[LoadCheck]]) -> tuple[LoadCheck, ...]:
    """The worst check of each limit over several motions."""
    return tuple(
        max(each, key=lambda check: (check.exceeded, check.value > check.limit, check.value))
        for each in zip(*checks, strict=True)
    )
