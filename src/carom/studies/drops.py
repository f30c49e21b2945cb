"""Loads of touchdowns over all stages of a motion, against limits, in rows for people and as JSON; and a drop for the designer of a touchdown bearing."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import chain

from carom.attractors import MotionName
from carom.base.arguments import checked
from carom.base.outcome import InputError, Outcome
from carom.base.results import Result, record
from carom.disturbances import Drop, drop
from carom.disturbances.machine_changes import ASSUMED
from carom.disturbances.single import Echo
from carom.models import Rotor, rotor_of
from carom.motions import (
    Braking,
    DropLoads,
    LastWhirl,
    SpinDown,
    State,
    TouchdownLoads,
    Trajectory,
    drop_loads,
    simulate,
)
from carom.motions.loads import MEASURED
from carom.motions.settling import REPEATING
from carom.parameters import LIMIT_FIELDS, Case, LoadLimits
from carom.parameters.formats import number
from carom.rotors.reduction_errors import ReductionError, reduction_error
from carom.studies.standstill import spin_down_entries, spin_down_rows, standstill_words
from carom.studies.wording import Wording

PLANE = "is_compliant contacts bounces restitution force_at:time impulse_at:time in_contact_since:time race_at_end:speed fastest_race:speed"
LOADS = f"impacts=contacts {' '.join(f'{name}:' for name in MEASURED)} goes_on still_growing"
_IN_BOTH = (
    ("observed restitution", "{restitution} in the fastest impact (includes the effect of unbalance and weight)"),
    ("slip energy (heat)", "{heat}"),
    ("heating continues", "at {lasting_power}"),
    ("friction power", "up to {power}"),
    ("inner race", "{race_at_end:speed} at the end, at most {fastest_race:speed}"),
    ("race over shaft", "{turning.speed_ratio} of its speed at the end"),
    ("race up to speed", "{turning.up_to_speed_at:time} after {since} (95 % of the shaft's surface speed)"),
    ("cage", "{turning.cage_speed:speed} at the end, if the balls roll"),
    ("traction of balls", "{turning.ball_traction:percent} of their load, to follow the race while the rotor slips"),
    ("heat of balls", "{turning.heat:energy}"),
    ("torque of balls", "{turning.torque_words}"),
    ("starting torque", "overcome by friction from a force of {turning.starts_at:newton}"),
    ("in contact to the end", "since {in_contact_since:time} after {since}"),
)
COMPLIANT = (
    ("peak force", "{force}, {force_at:time} after {since}"),
    ("depth", "{depth}"),
    ("ball pressure", "{pressure:pressure} on the most loaded ball, which bears {catalogue.ball_load:newton}"),
    ("static rating", "{catalogue.static_share:percent} of it at the peak force"),
    ("rolling fatigue", "{catalogue.life_share:percent} of the life L10"),
    ("such landings left", "{landings}"),
    ("largest impulse", "{impulse} in one contact, {impulse_at:time} after {since}"),
    ("contacts", "{contacts:contact}, {contact_time} in contact"),
    ("lift-offs", "{bounces:bounce}"),
    *_IN_BOTH,
)
RIGID = (
    ("hardest impact", "impulse {impulse}, {impulse_at:time} after {since} (a rigid wall has no peak force)"),
    ("contacts", "{contacts:impact}"),
    ("lasting contact", "force up to {force}, {contact_time} in total"),
    *_IN_BOTH,
)
"""Loads of a touchdown bearing as shown to people: labels, and attributes by name and kind; zero or unknown ones are left out."""
NONE_LEFT = ("such landings left", "none: above the static rating, or 4.2 GPa where none is stated, races are indented")
TURNING = "speed_ratio cage_speed:speed up_to_speed_at:time ball_traction heat:energy torque_si=torque neglected drag_si=drag starts_at_si=starts_at"
CATALOGUE = "ball_load_si=catalogue.ball_load pressure_si=catalogue.pressure static_share=catalogue.static_share life_share=catalogue.life_share landings"
WHIRL = "direction angular_speed: turned lasted:time since:time goes_on"
FALLING = "0.2 s"
"""Time for which the drop of a study is followed, if it does not settle before."""
MOST_EVENTS = 20_000
DROP, SHAFT = (
    "time: settled_at:time outcome=outcome.label meaning=outcome.meaning magnets",
    "speed_at_end:speed left_out:speed",
)


@dataclass(frozen=True)
class LoadCheck:
    """A load against its limit, in the SI unit of the limit.

    Attributes
    ----------
    name : {"impulse", "force", "power", "heat", "depth", "pressure", "static_share", "life_share", "temperature", "impacts"}
    value : float
        Load of the motion, up to where its end was known.
    limit : float
    endless : bool
        Whether the load goes on growing, because the motion has settled in contact.
    still_growing : bool
        Whether the load grew up to the end of the motion, whose further course it may exceed.
    settled : bool
        Whether the motion had settled: otherwise a limit is kept up to its end alone.
    after : float
        Seconds after the end was known until the growing load reaches its limit: 0 if it has, infinite if it does not grow.
    touchdown_bearing : int or None
        Counted from 1, of a rotor with several.
    begins : float
        Load before the motion: the temperature then.
    """

    name: str
    value: float
    limit: float
    endless: bool
    still_growing: bool
    settled: bool
    after: float
    touchdown_bearing: int | None = None
    begins: float = 0.0

    @property
    def exceeded(self) -> bool:
        """Whether the load exceeds its limit, now or if the motion goes on."""
        return self.value > self.limit or self.endless

    @property
    def margin(self) -> float:
        """Share of the limit that is left, below zero where the load exceeds it."""
        reached, most = self.value - self.begins, self.limit - self.begins
        return 1.0 - reached / most if most > 0.0 else -math.inf if reached else 0.0

    @property
    def words(self) -> str:
        """The check in words."""
        value, limit = (LoadLimits.format(self.name, each) for each in (self.value, self.limit))
        where = "" if self.touchdown_bearing is None else f" at touchdown bearing {self.touchdown_bearing}"
        text = f"{LIMIT_FIELDS[self.name].words}{where}: {value}, limit {limit}"
        if self.value > self.limit:
            return f"{text}: exceeded{', and still growing' if self.endless else ''}"
        if not self.endless:
            unsettled = "" if self.settled else " so far (not settled)"
            return f"{text}: kept{', but still growing at the end' if self.still_growing else unsettled}"
        when = f" {number(self.after, 3)} s later" if math.isfinite(self.after) else ""
        return f"{text}: exceeded{when} if contact continues"

    def document(self) -> dict[str, object]:
        """As plain data for JSON; values in the SI unit of the limit."""
        return record(
            self, "name exceeded endless still_growing value_si=value limit_si=limit margin reached_after_si=after"
        )


@checked
def check_loads(loads: TouchdownLoads, limits: LoadLimits) -> tuple[LoadCheck, ...]:
    """Compare the loads of a motion with the limits that are stated; nothing without scales.

    Heat and impacts of a motion that has settled in contact have no end, so they exceed any limit in time.

    Raises
    ------
    InputError
        There is a limit of what the touchdown bearing does not state: the pressure of its balls, or a share of a rating.
    """
    si = loads.si()
    if si is None:
        return ()
    values, found = {**si, "impacts": float(loads.contacts)}, []
    grows = {
        "heat": loads.goes_on and si["lasting_power"] > 0.0,
        "impacts": loads.outcome in REPEATING,
        "life_share": loads.goes_on and si.get("life_share", 0.0) > 0.0 and loads.race_at_end != 0.0,
    }
    rated = {"static_share": 1.0} if "static_share" in si else {}
    for name, limit in {**rated, **limits.given}.items():
        if name not in values:
            raise InputError(name, limit, f"a limit needs {limits.needed[name]} in the table [touchdown]")
        endless, value = grows.get(name, False), values[name]
        after = 0.0 if value > limit else math.inf
        if endless and name == "heat" and value <= limit:
            after = (limit - value) / si["lasting_power"]
        growing = loads.still_growing and name in ("force", "depth", "pressure", "static_share")
        growing |= name == "temperature" and grows["heat"]
        begins = float(loads.temperatures.values[0, 0]) if loads.temperatures and name == "temperature" else 0.0
        found.append(LoadCheck(name, value, limit, endless, growing, loads.outcome.settled, after, begins=begins))
    return tuple(found)


def checks_of_planes(loads: DropLoads, limits: LoadLimits, stands: bool = False) -> tuple[LoadCheck, ...]:
    """The loads of all planes against the limits that are stated; of several the checks name theirs.  Where the shaft stands, nothing is open."""
    several = len(loads.planes) > 1
    return tuple(
        replace(check, touchdown_bearing=place if several else None, settled=check.settled or stands)
        for place, plane in enumerate(loads.planes, start=1)
        for check in check_loads(plane, limits)
    )


def worst_of(checks: Iterable[Sequence[LoadCheck]]) -> tuple[LoadCheck, ...]:
    """The worst check of each limit over several motions."""
    found: dict[str, list[LoadCheck]] = {}
    for check in chain.from_iterable(checks):
        # A bearing with a static rating has a limit that others have not.
        found.setdefault(check.name, []).append(check)
    return tuple(
        max(each, key=lambda check: (check.exceeded, check.value > check.limit, check.value)) for each in found.values()
    )


def load_tables(loads: DropLoads, since: str) -> list[tuple[str, list[tuple[str, str]]]]:
    """For each plane a title, empty if there is one plane alone, and labels with what they say; times count from ``since``."""
    planes = loads.planes
    tables = [
        (f"Touchdown bearing {each.plane + 1}" if len(planes) > 1 else "", _rows(each, loads, since)) for each in planes
    ]
    if loads.shaft is not None:
        tables[-1][1].append(("shaft", _shaft_words(loads.shaft)))
    return tables


def _shaft_words(shaft: Braking) -> str:
    """Its speed at the end, and what the drive would do where its torque is left out."""
    before, end = (Wording(shaft.scales).write(each, "speed") for each in (1.0, shaft.speed_at_end))
    text = f"{end} at the end, {before} before"
    if shaft.left_out == 0.0:
        return text
    change = f"{'+' if shaft.left_out > 0.0 else '−'}{Wording(shaft.scales).write(abs(shaft.left_out), 'speed')}"
    return f"{text}; the drive torque is neglected in flight, where it would change it by {change}"


def load_entries(loads: DropLoads, limits: LoadLimits) -> list[dict[str, object]]:
    """The loads of each plane as JSON, with the limits, and the touchdown bearing where it states its balls or ratings."""
    stated = [loads.rotor.definition.bearing_at(plane.plane) for plane in loads.planes]
    return [
        _entry(plane, limits) | ({"touchdown": bearing.document()} if bearing else {})
        for plane, bearing in zip(loads.planes, stated, strict=True)
    ]


def _rows(plane: TouchdownLoads, loads: DropLoads, since: str) -> list[tuple[str, str]]:
    if plane.is_compliant and plane.force_at is None:
        rows = [("peak force", "none: no contact")]
    else:
        rows = Wording(plane.scales).rows(COMPLIANT if plane.is_compliant else RIGID, plane, since=since)
        if plane.still_growing:
            label, words = rows[0]
            further = "" if loads.outcome is Outcome.BEYOND_MODEL else ": follow the motion longer"
            rows[0] = (label, f"{words}, still growing at the end{further}")
    bearing = loads.rotor.definition.bearing_at(plane.plane)
    if bearing and (law := bearing.law_of_balls):
        beyond = "; the peak force lies above" if (plane.si() or {})["force"] > law.highest else ""
        rows.append(("stiffness of balls", law.words + beyond))
    rows += [NONE_LEFT] if plane.landings == 0.0 else []
    rows += plane.temperatures.rows() if plane.temperatures else []
    return rows if plane.whirl is None else [*rows, ("whirl at the end", _whirl_words(plane.whirl, loads.outcome))]


def _entry(plane: TouchdownLoads, limits: LoadLimits) -> dict[str, object]:
    whirl, loads = plane.whirl, record(plane, LOADS, plane.scales)
    loads |= {name: value for name, value in record(plane, CATALOGUE).items() if value is not None}
    if not plane.is_compliant:
        # Impacts on a rigid wall have no force; this one is that of lasting contact.
        loads["force_is_of_lasting_contact"] = True
    often = {} if whirl is None or whirl.frequency_si is None else {"frequency_si": whirl.frequency_si}
    return {
        "touchdown_bearing": plane.plane + 1,
        **record(plane, PLANE, plane.scales),
        "loads": loads,
        "turning": None if plane.race_at_end is None else record(plane.turning, TURNING, plane.scales),
        **record(plane, "temperatures"),
        "whirl": whirl and record(whirl, WHIRL, whirl.scales) | often,
        "limits": [check.document() for check in check_loads(plane, limits)],
    }


def _whirl_words(whirl: LastWhirl, outcome: Outcome) -> str:
    """Sense and frequency, and whether it goes on."""
    turns = number(whirl.lasted / (2.0 * math.pi), 3)
    if whirl.direction is None:
        return "none"
    rate = f"{number(abs(whirl.angular_speed), 4)} Ω"
    if whirl.frequency_si is not None:
        times = number(whirl.angular_speed, 3)
        by_shaft = "synchronous with the shaft" if times == "1" else f"{times.lstrip('-')} times the shaft speed"
        rate = f"{number(whirl.frequency_si, 4)} Hz ({by_shaft})"
    if whirl.goes_on:
        return f"{whirl.direction}, {rate}; it persists"
    seen = "; it may not persist" if not outcome.settled else ""
    return f"{whirl.direction}, {rate}, mean of the last {turns} turns of the shaft{seen}"


@dataclass(frozen=True, eq=False, repr=False)
class DropStudy(Result):
    """A drop of a machine.

    Attributes
    ----------
    case : Case
        The machine, with the limits of its touchdown bearing.
    echo : Echo
        What was done to it.
    loads : DropLoads
        What the touchdown bearing bears.
    reduction : ReductionError or None
        Error of the reduction of a flexible machine along it.
    motion : Trajectory or None
        ``None`` where its loads alone were followed.
    spin_down : carom.motions.SpinDown or None
        How the shaft slowed down, where it was followed to standstill.
    """

    case: Case
    echo: Echo
    loads: DropLoads
    reduction: ReductionError | None = None
    motion: Trajectory | None = None
    spin_down: SpinDown | None = None

    @property
    def assumed(self) -> bool:
        """Whether the weight is that of free fall downward because none is stated."""
        return self.case.gravity is None

    @property
    def checks(self) -> tuple[LoadCheck, ...]:
        """The loads of all planes against the limits that are stated."""
        return checks_of_planes(self.loads, self.case.limits, self.spin_down is not None and self.spin_down.stands)

    @property
    def headline(self) -> str:
        """How the motion ended, and up to when it was followed."""
        say, loads = Wording(self.case.parameters.scales), self.loads
        if self.spin_down is not None:
            return standstill_words(self.spin_down)
        if loads.outcome is Outcome.BEYOND_MODEL:
            return f"Beyond the model from {say.time(loads.time)} after the release: {loads.outcome.meaning}"
        if not loads.outcome.settled:
            why = "" if loads.outcome is Outcome.TIME_REACHED else f" ({loads.outcome.words})"
            return f"Not settled after {say.time(loads.time)}{why}."
        persists = "" if loads.outcome is Outcome.LEVITATED else ", which persists"
        how = persists if loads.settled_at is None else f" from {say.time(loads.settled_at)} after the release"
        name = MotionName(loads.outcome).words
        return f"{name[0].upper()}{name[1:]}{how}; followed for {say.time(loads.time)}."

    @property
    def tables(self) -> list[tuple[str, list[tuple[str, str]]]]:
        """For each plane a title, empty if there is one plane alone, and labels with what they say."""
        tables = load_tables(self.loads, "the release")
        if self.spin_down is None:
            return tables
        if self.spin_down.stands:  # over a speed of zero
            tables = [(title, [row for row in rows if row[0] != "race over shaft"]) for title, rows in tables]
        return [*tables, ("Spin-down", spin_down_rows(self.spin_down))]

    def document(self) -> dict[str, object]:
        """The drop as JSON."""
        case, loads = self.case, self.loads
        gravity, scales = case.gravity or ASSUMED, loads.scales
        law = None if loads.planes[0].is_compliant else {"law": "rigid"}
        return {
            "name": case.name,
            "disturbance": self.echo.document(scales),
            **rotor_of(case).document(),
            "gravity": {"acceleration_si": gravity.acceleration, "direction": gravity.direction},
            "gravity_assumed": self.assumed,
            "touchdown": case.touchdown.document() if case.touchdown else law,
            **record(loads, DROP, scales),
            **record(self, "reduction"),
            "shaft": loads.shaft and record(loads.shaft, SHAFT, scales),
            "touchdown_bearings": load_entries(loads, case.limits),
            "spin_down": self.spin_down and spin_down_entries(self.spin_down),
        }


def drop_of(case: Case) -> DropStudy | None:
    """Levitation lost, followed for a while; ``None`` of a machine that cannot fall: without scales, or of which it is not known what is left without levitation."""
    if case.parameters.scales is None:
        return None
    try:
        rotor, state, echo = release(case, drop())
    except InputError:
        return None
    motion = simulate(rotor, state, FALLING, max_events=MOST_EVENTS)
    loads, reduced = drop_loads(motion), rotor_of(case).finite_elements
    error = None
    if reduced is not None:
        error = reduction_error(
            reduced, loads, lambda finer: release(replace(case, parameters=finer.limited), drop())[:2]
        )
    return DropStudy(case, echo, loads, error, motion)


def release(case: Case, released: Drop) -> tuple[Rotor, State, Echo]:
    """The rotor that falls, its start, and what was taken of a release.

    Raises
    ------
    InputError
        As of :meth:`carom.disturbances.Drop.apply`.
    """
    rotor, state = released.apply(case)
    return rotor, state, released.echo_at(rotor_of(case), rotor, state, case.gravity)
