"""Basins of drops: how a drop ends, and what the touchdown bearing bears, against two numbers of the release or of the machine."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from carom.arguments import Count, checked
from carom.attractors import MotionName
from carom.basins.dataset import Stored, outcome_flags, programs
from carom.basins.drop_axes import TURN, Node, moved, present_of, told_range, told_value, values_of, varied_of
from carom.basins.gains import Several
from carom.core.processors import available_cores
from carom.disturbances.following import NO_START
from carom.models import Axis, Subject, rotor_of
from carom.models.axes import Ends
from carom.motions import Drop, State, Whirl, follow_loads
from carom.motions.bearing_loads import DropLoads
from carom.motions.starts import Until
from carom.outcome import STEADY_WORDS, InputError
from carom.parameters import Case, LoadLimits, Scales, own_time
from carom.parameters.told import number
from carom.progress import Reporter, ShowProgress, shows_progress

if TYPE_CHECKING:
    import xarray

MOST_STEPS = 100_000
"""Default number of impacts and steps of contact after which a drop is given up: several seconds of a machine on its bearing."""
MEASURES = {
    "force": ("N", "peak force"),
    "impulse": ("N s", "largest impulse"),
    "depth": ("m", "largest depth in the bearing"),
    "heat": ("J", "slip energy, turned into heat"),
    "power": ("W", "largest friction power"),
    "pressure": ("Pa", "pressure of balls"),
    "contacts": ("1", "contacts, or impacts on a rigid wall"),
    "contact_time": ("s", "time in contact"),
    "settled_at": ("s", "time from the release since which the rotor rests or whirls"),
    "time": ("s", "time for which it was followed"),
    "whirl": ("Hz", "whirl at the end, negative backward"),
}
"""Numbers of each drop, with unit and words: the largest of all planes, or the sum of contacts, heat and time."""
LIMITED = {"impacts": "contacts"}
"""Numbers of a drop that a limit of another name is about."""


@checked
@dataclass(frozen=True, eq=False, repr=False)
class DropMap(Stored):
    """How drops end, and what they ask of the touchdown bearing, against two numbers.

    Attributes
    ----------
    dataset : xarray.Dataset
        Dimensions are the two that are varied, in SI units.  Variables: ``outcome`` (code of :class:`~carom.outcome.Outcome`, −1
        where levitation does not hold the rotor off the wall), ``motion`` (index of its name), and in SI units those of :data:`MEASURES`,
        NaN where a drop has none: a force of impacts on a rigid wall, whirl of a rotor that does not go round.
    """

    figure: ClassVar[str] = "drop_map"
    shown: ClassVar[tuple[str, ...]] = ("rotor", "plane", "ends", "worst")
    needed: ClassVar[tuple[str, ...]] = ("outcome", "motion", "force", "impulse")

    @property
    def scales(self) -> Scales | None:
        """Mass, clearance and speed of the present machine."""
        return self.rotor.scales

    @property
    def axes(self) -> tuple[Axis, Axis]:
        """What is varied."""
        first, second = self.dataset["outcome"].dims
        return varied_of(self.rotor, str(first)), varied_of(self.rotor, str(second))

    @property
    def plane(self) -> str:
        """Both with their ranges, in words."""
        return ", ".join(told_range(axis, self.dataset[axis.name].values) for axis in self.axes)

    @property
    def present(self) -> tuple[float, float]:
        """Values of the present machine and release; NaN where levitation is not regained."""
        return tuple(json.loads(self.dataset.attrs["present"]))

    @cached_property
    def motions(self) -> tuple[MotionName, ...]:
        """Names of the motions in which they end, in the order of their index."""
        return tuple(map(MotionName.of, json.loads(self.dataset["motion"].attrs["motions"])))

    @property
    def exists(self) -> np.ndarray:
        """Which of them could be dropped."""
        existing: np.ndarray = self.dataset["outcome"].values != NO_START
        return existing

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
        over: np.ndarray = np.nan_to_num(values) > self.limits[limit]
        return over

    @property
    def hardest(self) -> str:
        """The load by which drops are compared: ``"force"``, or ``"impulse"`` on a rigid wall."""
        return "force" if bool(self.dataset.attrs["gives_way"]) else "impulse"

    @property
    def worst(self) -> str:
        """The hardest drop in words."""
        values = self.dataset[self.hardest].values
        if not np.isfinite(values).any():
            return "none touched"
        at = np.unravel_index(np.nanargmax(values), values.shape)
        where = ", ".join(
            told_value(axis, float(self.dataset[axis.name].values[place]))
            for axis, place in zip(self.axes, at, strict=True)
        )
        unit, words = MEASURES[self.hardest]
        return f"{words} {number(float(values[at]), 4)} {unit} at {where}"


@checked
@shows_progress
def map_drops(
    machine: Subject,
    released: Drop | None = None,
    names: tuple[str, str] = ("phase", "speed"),
    *,
    ranges: tuple[Ends | None, Ends | None] = (None, None),
    shape: tuple[Several, Several] = (24, 16),
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
    names : tuple of str
        What is varied: ``"phase"``, ``"regained_after"`` or ``"race_speed"`` of the release, or any of :func:`carom.models.axis`.
    ranges : tuple of tuple of float or str, optional
        Ranges of both, in SI units, or texts with a unit; by default a whole turn for the phase, in cells of which the middles are tried,
        and half to twice the present value for others.
    shape : tuple of int
        Number of values of both; ends of a range are included.
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
    >>> found = cm.basins.map_drops(machine, names=("phase", "friction"), ranges=(None, (0.05, 0.3)), shape=(4, 2))
    >>> {str(name): share for name, share in found.fractions.items()}
    {'rest on the touchdown bearing': 1.0}
    """
    rotor, released = rotor_of(machine), released or Drop()
    released.stages(rotor)  # refuses what cannot be dropped at all
    axes = varied_of(rotor, names[0]), varied_of(rotor, names[1])
    if axes[0].name == axes[1].name:
        raise InputError("names", ",".join(names), "two different ones")
    scales = rotor.scales
    if scales is None:
        raise InputError("machine", "no scales", "a rotor with mass, clearance and speed, in which weight is in m/s^2")
    present = [present_of(rotor, released, varied) for varied in axes]
    values = [values_of(*each) for each in zip(axes, present, ranges, shape, strict=True)]
    nodes = [moved(rotor, released, axes, (float(x), float(y))) for x in values[0] for y in values[1]]
    longest = None if until is None else own_time("until", until, scales) * scales.time
    tell, rows = Reporter.of(progress, "following drops"), list[_Row]()
    for row in _followed(nodes, longest, max_events, threads or available_cores()):
        rows.append(row)
        tell(len(rows) / len(nodes))
    if all(row.name is None for row in rows):
        raise InputError(
            STEADY_WORDS["contact-free"],
            "of none of the machines",
            "static sag and whirl must stay inside the wall: below 1",
        )
    limits = machine.limits if isinstance(machine, Case) else LoadLimits()
    dataset = _dataset(axes, values, rows)
    dataset.attrs = {
        **(source or {}),
        "Conventions": "CF-1.11",
        "title": "How drops of a rotor on its touchdown bearing end, against two numbers",
        "source": programs(),
        **rotor.attributes(),
        "released": repr(released),
        "present": json.dumps(present),
        "load_limits": json.dumps(limits.given),
        "gives_way": int(any(rotor.system.arrays.stiffness > 0.0)),
    }
    return DropMap(dataset)


@dataclass(frozen=True)
class _Row:
    """A drop: the name of its end, ``None`` if there is nothing to drop, and its numbers in SI units."""

    name: MotionName | None
    numbers: dict[str, float]


def _followed(nodes: list[Node], longest: float | None, max_events: int, threads: int) -> Iterator[_Row]:
    """Drop all nodes in their order, several at a time; when the caller stops, no other one is begun."""
    if threads == 1:
        yield from (_dropped(node, longest, max_events) for node in nodes)
        return
    with ThreadPoolExecutor(threads) as pool:
        try:
            yield from pool.map(lambda node: _dropped(node, longest, max_events), nodes)
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


def _dropped(node: Node, longest: float | None, max_events: int) -> _Row:
    """Drop a node and evaluate it; ``longest`` is in seconds."""
    rotor, released = node
    if not isinstance(released.at, State | Whirl) and rotor.system.rest_radius >= 1.0:
        return _Row(None, {})
    scales: Any = rotor.scales
    until = None if longest is None else longest / scales.time
    found = follow_loads(rotor, released, until, settle=True, max_events=max_events, progress=False)
    return _Row(MotionName(found.outcome, found.multiplicity), _numbers(found, scales))


def _numbers(found: DropLoads, scales: Scales) -> dict[str, float]:
    """Numbers of a drop by the names of :data:`MEASURES`, in SI units."""
    loads = [plane.loads for plane in found.planes]
    si = [each.si() or {} for each in loads]
    soft = any(plane.gives_way for plane in found.planes)
    pressures = [each.pressure for each in loads if each.pressure is not None]
    whirls = [plane.whirl for plane in found.planes if plane.whirl is not None and plane.whirl.direction]
    turning = max((whirl.angular_speed for whirl in whirls), key=abs, default=math.nan)
    return {
        "force": max(each["force"] for each in si) if soft else math.nan,
        "impulse": max(each["impulse"] for each in si),
        "depth": max(each["depth"] for each in si) if soft else math.nan,
        "heat": sum(each["heat"] for each in si),
        "power": max(each["power"] for each in si),
        "pressure": max(pressures, default=math.nan),
        "contacts": float(sum(plane.contacts for plane in found.planes)),
        "contact_time": sum(each["contact_time"] for each in si),
        "settled_at": math.nan if found.settled_at is None else found.settled_at * scales.time,
        "time": found.time * scales.time,
        "whirl": turning * scales.speed / TURN,
    }


def _dataset(axes: tuple[Axis, Axis], values: list[np.ndarray], rows: list[_Row]) -> xarray.Dataset:
    import xarray

    shape, dimensions = (len(values[0]), len(values[1])), (axes[0].name, axes[1].name)
    names = sorted({row.name for row in rows if row.name is not None}, key=lambda name: (name.outcome, str(name)))
    outcomes = [NO_START if row.name is None else int(row.name.outcome) for row in rows]
    motions = [-1 if row.name is None else names.index(row.name) for row in rows]
    notes = {"long_name": "motion in which it ends", "motions": json.dumps([asdict(name) for name in names])}
    variables: dict[str, Any] = {
        "outcome": (dimensions, np.array(outcomes, np.int8).reshape(shape), outcome_flags()),
        "motion": (dimensions, np.array(motions, np.int16).reshape(shape), notes),
    }
    for measure, (unit, words) in MEASURES.items():
        each = np.array([row.numbers.get(measure, math.nan) for row in rows]).reshape(shape)
        variables[measure] = (dimensions, each, {"units": unit, "long_name": words})
    coordinates = {
        varied.name: (varied.name, along, {"units": varied.field.unit or "1", "long_name": varied.field.words})
        for varied, along in zip(axes, values, strict=True)
    }
    return xarray.Dataset(variables, coords=coordinates)
