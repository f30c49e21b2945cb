"""Basins of drops: how a drop ends, and what the touchdown bearing bears, against two numbers of the release or of the machine."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar, cast

import numpy as np

from carom.attractors import MotionName
from carom.base.arguments import Count, checked
from carom.base.outcome import STEADY_WORDS, InputError
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.basins.dataset import about, outcome_flags
from carom.basins.maps import Entry, Measure, Over, OverPlane, map_over
from carom.core.processors import available_cores
from carom.disturbances import Drop, Single, VelocityKick
from carom.disturbances.following import NO_START
from carom.disturbances.plans import Quantity
from carom.models import Axis, Rotor, Subject, axis, rotor_of
from carom.models.axes import Ends
from carom.motions import DropLoads, follow_loads
from carom.motions.starts import Until
from carom.parameters import LIMIT_FIELDS, Case, Field, LoadLimits, Scales, own_size, own_time
from carom.parameters.formats import number

if TYPE_CHECKING:
    import xarray

_End = TypeVar("_End")
MOST_STEPS = 100_000
"""Default number of impacts and steps of contact after which a drop is given up: several seconds of a machine on its bearing."""
USUAL = {"phase": 24, "speed": 16}
MEASURES = {
    "force": Quantity("N", "peak force"),
    "impulse": Quantity("N s", "largest impulse"),
    "depth": Quantity("m", "largest depth in the bearing"),
    "heat": Quantity("J", "slip energy, turned into heat"),
    "power": Quantity("W", "largest friction power"),
    "pressure": Quantity("Pa", "ball pressure"),
    "static_share": Quantity("1", "force over the static rating"),
    "life_share": Quantity("1", "share of the bearing life"),
    "temperature": Quantity("degC", "highest temperature"),
    "contacts": Quantity("1", "contacts, or impacts on a rigid wall"),
    "contact_time": Quantity("s", "time in contact"),
    "settled_at": Quantity("s", "time after the release from which the rotor rests or whirls"),
    "time": Quantity("s", "simulated time after the release"),
    "whirl": Quantity("Hz", "whirl at the end, negative backward"),
    "still_growing": Quantity("1", "touchdown bearings whose force was still growing when the simulation stopped"),
}
"""Numbers of each drop, with unit and words: the largest of all planes, or the sum of contacts, heat and time."""
TURN = 2.0 * math.pi
RPM = TURN / 60.0
_RELEASED = (
    ("phase", "phase of the unbalance at the release", "an angle", "rad", -1e6, '"90 deg"', "°", math.radians(1.0)),
    ("regained_after", "time until levitation returns", "a time", "s", 1e-9, '"50 ms"', "ms", 1e-3),
    ("race_speed", "speed of the race at the release", "an angular speed", "rad/s", -1e6, '"500 rpm"', "rpm", RPM),
)
RELEASED = {
    name: Axis(Field(name, "", words, kind, unit, lowest, 1e6, example, usual=usual, usual_size=size))
    for name, words, kind, unit, lowest, example, usual, size in _RELEASED
}
"""What of the release itself can be varied, besides the parameters of the machine."""
_OWN_UNITS = {"regained_after": "time", "race_speed": "speed"}
"""Those that a drop has in units of the equations."""
LIMITED = {"impacts": "contacts"}
"""Numbers of a drop that a limit of another name is about."""


def varied_of(rotor: Rotor, name: str) -> Axis:
    """What is varied under a name: of the release, or a parameter of the machine."""
    return RELEASED[name] if name in RELEASED else axis(rotor, name)


@checked
@dataclass(frozen=True, eq=False, repr=False)
class DropMap(OverPlane):
    """How drops end, and what they ask of the touchdown bearing, against two numbers.

    Attributes
    ----------
    dataset : xarray.Dataset
        Dimensions are the two that are varied, in SI units.  Variables: ``outcome`` (code of :class:`~carom.base.outcome.Outcome`, −1
        where levitation does not hold the rotor off the wall), ``motion`` (index of its name), and in SI units those of :data:`MEASURES`,
        NaN where a drop has none: a force of impacts on a rigid wall, whirl of a rotor that does not go round.
    """

    figure: ClassVar[str] = "drop_map"
    shown: ClassVar[tuple[str, ...]] = ("rotor", "plane", "ends", "worst")
    needed: ClassVar[tuple[str, ...]] = ("outcome", "motion", "force", "impulse", "whirl", "still_growing")

    def varied(self, name: str) -> Axis:
        """What is varied under a name."""
        return varied_of(self.rotor, name)

    @property
    def fractions(self) -> dict[MotionName, float]:
        """Share of the drops tried that ends in each motion, the largest first."""
        index, tried = self.dataset["motion"].values, max(int(self.exists.sum()), 1)
        shares = {name: float((index == place).sum() / tried) for place, name in enumerate(self.motions)}
        return dict(sorted(shares.items(), key=lambda entry: -entry[1]))

    @property
    def ends(self) -> str:
        """These in words."""
        return ", ".join(f"{name.words} {number(100.0 * share, 3)} %" for name, share in self.fractions.items())

    @property
    def limits(self) -> dict[str, float]:
        """Limits of the touchdown bearing that are stated, in SI units."""
        return dict(json.loads(self.dataset.attrs["load_limits"]))

    def exceeding(self, limit: str) -> np.ndarray:
        """Which drops exceed a limit that is stated, bool; none does what it has not."""
        values = self.dataset[LIMITED.get(limit, limit)].values
        return np.nan_to_num(values) > self.limits[limit]

    @property
    def backward(self) -> np.ndarray:
        """Which drops whirl backward at the end, bool."""
        return np.asarray(self.dataset["whirl"].values < 0.0)

    @property
    def still_growing(self) -> np.ndarray:
        """Of which drops the force still grew at the end, so that it is not their largest, bool."""
        return np.asarray(self.dataset["still_growing"].values > 0.0)

    @property
    def hardest(self) -> str:
        """The load by which drops are compared: ``"force"``, or ``"impulse"`` on a rigid wall."""
        return "force" if bool(self.dataset.attrs["is_compliant"]) else "impulse"

    @property
    def hardest_words(self) -> str:
        """Words and unit of this load."""
        unit, words, _ = MEASURES[self.hardest]
        return f"{words} ({unit})"

    @property
    def worst(self) -> str:
        """The hardest drop in words."""
        values = self.dataset[self.hardest].values
        if not np.isfinite(values).any():
            return "none touched"
        at = np.unravel_index(np.nanargmax(values), values.shape)
        where = [float(self.dataset[axis.name].values[place]) for axis, place in zip(self.axes, at, strict=True)]
        unit, words, _ = MEASURES[self.hardest]
        growing = ", still growing" if self.still_growing[at] else ""
        return f"{words} {number(float(values[at]), 4)} {unit}{growing} at {self.at(where)}"


@checked
@shows_progress
def map_drops(
    machine: Subject,
    released: Drop | None = None,
    over: Over = USUAL,
    *,
    until: Until | None = None,
    max_events: Count = MOST_STEPS,
    threads: Count | None = None,
    source: Mapping[str, str] | None = None,
    progress: ShowProgress = None,
) -> DropMap:
    """Drop a machine at each point of a plane of two numbers, and keep how it ends and what its touchdown bearing bears.

    Each drop is followed and evaluated as :func:`carom.motions.follow_loads` would, one by one on all cores: a
    race that turns and stages are followed too.  The result does not depend on the number of threads.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        One that states no weight falls by 9.81 m/s² downward; the limits of a case are kept beside the loads.
    released : Drop, optional
        By default ``carom.drop()``.  Where the speed of the shaft is varied, sizes with a unit stay what they are.
    over : mapping of str to tuple or int
        What is varied: ``"phase"``, ``"regained_after"`` or ``"race_speed"`` of the release, or any of :func:`carom.models.axis`, as for
        :func:`map_gains`.  How many alone is over a whole turn for the phase, in cells of which the middles are tried.
    until : float or str, optional
        Time after which a drop that has not settled is given up, in ``1/Ω`` of the present machine or text with a unit.
    max_events : int
        Impacts and steps of contact after which one is given up.
    threads : int, optional
        By default the number of available cores.
    source : mapping of str to str, optional
        Further attributes of the dataset, such as the file of the machine.

    Raises
    ------
    InputError
        A rotor without scales, a name or a range cannot be used, or none of the machines can be dropped.

    See Also
    --------
    carom.drop : one of them
    carom.map_basins : kicks and other disturbances out of levitation
    carom.plots.drop_map : draw it

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/dropped-rotor.toml")
    >>> found = cm.basins.map_drops(machine, over={"phase": 4, "friction": (0.05, 0.3, 2)})
    >>> {str(name): share for name, share in found.fractions.items()}
    {'rest on the touchdown bearing': 1.0}
    """
    rotor, released = rotor_of(machine), released or Drop()
    released.stages(rotor)  # refuses what cannot be dropped at all
    scales = rotor.scales
    if scales is None:
        raise InputError("machine", "no scales", "a rotor with mass, clearance and speed, in which weight is in m/s^2")
    longest = None if until is None else own_time("until", until, scales) * scales.time
    measure = Landing(released, longest, max_events, threads or available_cores())
    dataset, rows = map_over(rotor, measure, over, Reporter.of(progress, "following drops"))
    if not any(rows):
        allowed = "static sag and whirl must stay inside the wall: below 1"
        raise InputError(STEADY_WORDS["contact-free"], "of none of the machines", allowed)
    dataset = dataset.assign(_ends(rows, dataset))
    limits = machine.limits if isinstance(machine, Case) else LoadLimits()
    dataset.attrs |= {
        **(source or {}),
        **about(rotor, "How drops of a rotor on its touchdown bearing end, against two numbers"),
        "released": repr(released),
        "load_limits": json.dumps(limits.given),
        "is_compliant": int(any(rotor.system.arrays.stiffness > 0.0)),
    }
    return DropMap(dataset)


def in_threads(
    follow: Callable[[Rotor, Drop], _End], drops: Sequence[tuple[Rotor, Drop]], threads: int
) -> Iterator[_End]:
    """What is found of drops, in their order, several at a time; when the caller stops, no other one is begun."""
    with ThreadPoolExecutor(threads) as pool:
        try:
            yield from pool.map(lambda one: follow(*one), drops)
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


@dataclass(frozen=True)
class Landing(Measure):
    """How drops end, and what the touchdown bearing bears; ``longest`` is in seconds."""

    released: Drop
    longest: float | None
    max_events: int
    threads: int

    stated: ClassVar[Mapping[str, Quantity]] = MEASURES

    def varied(self, rotor: Rotor, name: str) -> Axis:
        """What is varied under a name."""
        return varied_of(rotor, name)

    def present(self, rotor: Rotor, varied: Axis) -> float:
        """Value of the present machine and release, in SI units; NaN if it has none."""
        if varied.name not in RELEASED:
            return super().present(rotor, varied)
        if varied.name == "phase":
            return math.remainder(self.released.unbalance_angle(rotor) - rotor.acting.direction_of_fall, TURN) % TURN
        given = getattr(self.released, varied.name)
        if given is None:
            return 0.0 if varied.name == "race_speed" else math.nan
        kind = _OWN_UNITS[varied.name]
        return own_size(varied.name, given, kind, rotor.scales) * float(getattr(rotor.scales, kind))

    def values(self, varied: Axis, present: float, given: Ends | None, count: int) -> np.ndarray:
        """Values over a range; those of the phase are the middles of cells that fill a turn, unless a range is given."""
        if given is None and varied.name == "phase":
            return TURN * (np.arange(count) + 0.5) / count
        if given is None and varied.name in RELEASED and not present > 0.0:
            raise InputError("over", None, f"needed: the drop states no {varied.name} around which a range could be")
        return super().values(varied, present, given, count)

    def entries(self, rotor: Rotor, axes: tuple[Axis, Axis], nodes: Sequence[tuple[float, float]]) -> Iterator[Entry]:
        """Drop all nodes in their order, several at a time; when the caller stops, no other one is begun."""
        return in_threads(self._dropped, [self._moved(rotor, axes, node) for node in nodes], self.threads)

    def _moved(self, rotor: Rotor, axes: tuple[Axis, Axis], node: tuple[float, float]) -> tuple[Rotor, Drop]:
        """Machine and release of a node; the release comes last, for its units may be those of the machine."""
        released = self.released
        for varied, value in sorted(zip(axes, node, strict=True), key=lambda pair: pair[0].name in RELEASED):
            if varied.name not in RELEASED:
                rotor = varied.move(rotor, value)
            else:
                kind = _OWN_UNITS.get(varied.name)
                unit = 1.0 if kind is None else float(getattr(rotor.scales, kind))
                changes: dict[str, Any] = {varied.name: value / unit}
                released = replace(released, **changes)
        return rotor, released

    def _dropped(self, rotor: Rotor, released: Drop) -> Entry:
        """The name of its end, and its numbers in SI units; nothing if there is nothing to drop."""
        kicked = isinstance(released.at, Single) and isinstance(released.at.model, VelocityKick)
        if (released.at is None or kicked) and rotor.system.rest_radius >= 1.0:
            return {}
        scales = cast("Scales", rotor.scales)
        until = None if self.longest is None else self.longest / scales.time
        found = follow_loads(rotor, released, until, settle=True, max_events=self.max_events, progress=False)
        return {"name": MotionName(found.outcome, found.multiplicity)} | _numbers(found, scales)


def _numbers(found: DropLoads, scales: Scales) -> dict[str, float]:
    """Numbers of a drop by the names of :data:`MEASURES`, in SI units."""
    si = [plane.si() or {} for plane in found.planes]
    soft = any(plane.is_compliant for plane in found.planes)
    largest = (MEASURES.keys() & LIMIT_FIELDS.keys()) - ({"heat"} if soft else {"heat", "force", "depth"})
    whirls = [plane.whirl for plane in found.planes if plane.whirl is not None and plane.whirl.direction]
    turning = max((whirl.angular_speed for whirl in whirls), key=abs, default=math.nan)
    return dict.fromkeys(MEASURES, math.nan) | {
        **{name: max((each[name] for each in si if name in each), default=math.nan) for name in largest},
        "heat": sum(each["heat"] for each in si),
        "contacts": float(sum(plane.contacts for plane in found.planes)),
        "contact_time": sum(each["contact_time"] for each in si),
        "settled_at": math.nan if found.settled_at is None else found.settled_at * scales.time,
        "time": found.time * scales.time,
        "whirl": turning * scales.speed / TURN,
        "still_growing": float(sum(plane.still_growing for plane in found.planes)),
    }


def _ends(rows: Sequence[Entry], dataset: xarray.Dataset) -> dict[str, object]:
    """Outcomes, and indices of the names of motions, over the nodes of a dataset."""
    (dimensions, shape), first = (tuple(zip(*dataset.sizes.items(), strict=True)), [row.get("name") for row in rows])
    names = sorted({name for name in first if name is not None}, key=lambda name: (name.outcome, str(name)))
    outcomes = [NO_START if name is None else int(name.outcome) for name in first]
    motions = [-1 if name is None else names.index(name) for name in first]
    notes = {"long_name": "motion in which it ends", "motions": json.dumps([asdict(name) for name in names])}
    return {
        "outcome": (dimensions, np.array(outcomes, np.int8).reshape(shape), outcome_flags()),
        "motion": (dimensions, np.array(motions, np.int16).reshape(shape), notes),
    }
