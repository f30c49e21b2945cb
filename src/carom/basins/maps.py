"""Maps over two numbers of the machine or of what is done to it, and of these gain maps: the share of disturbances that come back.

What is measured at each node is up to a measure: here where disturbances end, in :mod:`carom.basins.drops` how drops end and what the touchdown bearing bears.  :func:`map_over`
makes the dataset of either, and :class:`OverPlane` is what the results have in common.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import tee
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, TypeAlias

import numpy as np

from carom.base.arguments import Count, Whole, checked, whole
from carom.base.outcome import InputError, Outcome
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.base.results import record
from carom.basins.dataset import Mapped, Stored, provenance
from carom.basins.shares import Population, Share
from carom.basins.unrecovered import smallest_unrecovered_kick
from carom.disturbances import KickPlane, Plan, Sample, Starts, VelocityKick
from carom.disturbances.following import NO_START, follow_machines
from carom.disturbances.plans import KICKS, SHARES, SMALLEST, Quantity, instants_words
from carom.models import Axis, Rotor, Subject, axis, rotor_of
from carom.models.axes import Ends, read_interval, usual_range
from carom.motions import PATIENCE
from carom.motions.ensembles import MOST_EVENTS
from carom.parameters.formats import format_entry, format_range

if TYPE_CHECKING:
    import xarray

Several = Annotated[int, whole(2)]
"""A number of values of a parameter."""
Over: TypeAlias = Mapping[str, Several | tuple[float | str, float | str, Several]]
"""Two numbers to vary, by name: first value, last value and how many in all, or how many alone over the usual range."""
Node: TypeAlias = tuple[float, float]
"""Values of the two numbers."""
Entry: TypeAlias = Mapping[str, Any]
"""What is measured at a node, by name."""
Tried: TypeAlias = tuple[Plan, Node]
"""Disturbances, and values of the two parameters."""
WANTED = 0.99
"""Share that machines of a map are counted by."""
USUAL_COUNT = 16
"""Number of values of each parameter."""
CHUNK = 50_000
"""Approximate number of starts in memory at a time."""


class Measure:
    """What is measured at each node of a map over parameters of a machine."""

    stated: ClassVar[Mapping[str, Quantity]]
    """Its variables; of an entry without one of them the value is NaN, and one that no entry has is left out."""

    def varied(self, rotor: Rotor, name: str) -> Axis:
        """What is varied under a name."""
        return axis(rotor, name)

    def present(self, rotor: Rotor, varied: Axis) -> float:
        """Its present value; NaN if it has none."""
        return varied.value(rotor)

    def values(self, varied: Axis, present: float, given: Ends | None, count: int) -> np.ndarray:
        """Evenly spaced values over a range, by default half to twice the present value; ends are included."""
        return np.linspace(*read_interval(varied, given or usual_range(varied, present, "over")), count)

    def entries(self, rotor: Rotor, axes: tuple[Axis, Axis], nodes: Sequence[Node]) -> Iterator[Entry]:
        """What is measured at each node in turn."""
        raise NotImplementedError


def map_over(
    rotor: Rotor,
    measure: Measure,
    over: Over,
    tell: Reporter,
) -> tuple[xarray.Dataset, list[Entry]]:
    """Measure at each node of a grid of two numbers; return the dataset, and the entries in the order of its nodes.

    Raises
    ------
    InputError
        A name or a range cannot be used, or there are not two names.
    """
    import xarray

    if len(over) != 2:
        raise InputError("over", ",".join(over), "two names")
    first, second = (measure.varied(rotor, name) for name in over)
    axes, stated = (
        (first, second),
        [(None, each) if isinstance(each, int) else (each[:2], each[2]) for each in over.values()],
    )
    present = [measure.present(rotor, varied) for varied in axes]
    values = [measure.values(varied, now, *how) for varied, now, how in zip(axes, present, stated, strict=True)]
    nodes, entries = [(float(x), float(y)) for x in values[0] for y in values[1]], list[Entry]()
    for entry in measure.entries(rotor, axes, nodes):
        entries.append(entry)
        tell(len(entries) / len(nodes))
    known = set().union(*entries)
    dimensions, counts = (axes[0].name, axes[1].name), tuple(map(len, values))
    variables = {
        name: (
            dimensions,
            np.array([entry.get(name, np.nan) for entry in entries], float).reshape(counts),
            {"units": unit, "long_name": words},
        )
        for name, (unit, words, _) in measure.stated.items()
        if name in known
    }
    along = {
        varied.name: (varied.name, each, {"units": varied.field.unit or "1", "long_name": varied.field.words})
        for varied, each in zip(axes, values, strict=True)
    }
    return xarray.Dataset(variables, coords=along, attrs={"present": json.dumps(present)}), entries


class OverPlane(Stored):
    """Base of maps over two numbers."""

    def varied(self, name: str) -> Axis:
        """What is varied under a name."""
        return axis(self.rotor, name)

    @property
    def axes(self) -> tuple[Axis, Axis]:
        """What is varied."""
        first, second = self.dataset[self.needed[0]].dims
        return self.varied(str(first)), self.varied(str(second))

    @property
    def plane(self) -> str:
        """Both with their ranges, in words."""
        return self.ranges_of(np.ones(self.dataset[self.needed[0]].shape, bool))

    def ranges_of(self, chosen: np.ndarray) -> str:
        """Ranges of both over the chosen nodes, at least one, in words."""
        values = [self.dataset[axis.name].values[chosen.any(axis=1 - place)] for place, axis in enumerate(self.axes)]
        return _said(self.axes, [format_range(axis.field, each) for axis, each in zip(self.axes, values, strict=True)])

    @property
    def present(self) -> tuple[float, float]:
        """Values of the present machine, and of what is done to it; NaN where there is none."""
        return tuple(json.loads(self.dataset.attrs["present"]))

    def at(self, values: Sequence[float]) -> str:
        """Values of both with their names and units."""
        pairs = zip(self.axes, values, strict=True)
        return _said(self.axes, [format_entry(axis.field, value) for axis, value in pairs])

    def line_of(self, name: str, value: object) -> str:
        """Present values are stated in the units of both."""
        return self.at(self.present) if name == "present" else super().line_of(name, value)


def _said(axes: Sequence[Axis], texts: Sequence[str]) -> str:
    pairs = zip(axes, texts, strict=True)
    return ", ".join(f"{axis.name.replace('_', ' ')} {text}".replace(" °", "°") for axis, text in pairs)


@checked
@dataclass(frozen=True, eq=False, repr=False)
class GainMap(OverPlane, Mapped):
    """Measures of recoverability against two parameters.

    Attributes
    ----------
    dataset : xarray.Dataset
        Dimensions are the two parameters.  Variables: ``recovered`` (share that comes back, by area) with ``recovered_low``
        and ``recovered_high`` (95 % confidence interval of a sample; each machine draws its own), ``unresolved``, ``levitates`` (whether there is
        levitation to return to: inside the wall, and stable).  For kicks also ``smallest_unrecovered_kick`` (of those tried, in ``c_r Ω`` of the present machine) and
        ``smallest_unrecovered_kick_angle`` (rad, co-rotating frame), NaN where all come back; and where the instant of the turn matters
        ``smallest_unrecovered_kick_instant`` (rad by which the shaft has turned).
    """

    figure: ClassVar[str] = "gain_map"
    shown: ClassVar[tuple[str, ...]] = ("rotor", "plane", "present", "present_share")

    needed: ClassVar[tuple[str, ...]] = ("recovered", "levitates")

    @property
    def present_share(self) -> Share:
        """Share that comes back in the present machine."""
        share: dict[str, Any] = json.loads(self.dataset.attrs["present_share"])
        return Share(**share, drawn=isinstance(self.plan, Sample), population=self.population)

    @property
    def population(self) -> Population:
        """Of what the shares are shares."""
        return Population.of_model(self.plan.model, self.rotor.scales, instants_words(self.rotor, self.plan))


@checked
@shows_progress
def map_gains(
    machine: Subject,
    disturbances: Plan,
    over: Over | None = None,
    *,
    patience: Whole = PATIENCE,
    max_events: Count = MOST_EVENTS,
    threads: Count | None = None,
    source: Mapping[str, str] | None = None,
    progress: ShowProgress = None,
) -> GainMap:
    """Measure the share of disturbances that recover, on a grid of two parameters.

    For machines that cannot levitate the share is 0.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        The present machine.
    disturbances : Grid or Sample
        Disturbances of the present machine.  Where a parameter changes the scales (shaft speed, clearance), kicks and
        shocks keep their size in SI units.
    over : mapping of str to tuple or int, optional
        The two parameters, any of :func:`carom.models.axis`, each with its first value, its last and how many in all: ``{"stiffness": ("5e5 N/m", "2e6
        N/m", 10), "damping": (700, 5000, 10)}``, in SI units if physical, or texts with a unit; or how many alone, from half to twice the present value.  By
        default 16 of P and D gain each: ``"stiffness"`` and ``"damping"``, of a flexible machine ``"proportional"`` and ``"derivative"``.
    patience, max_events, threads, source
        As for :func:`~carom.basins.map_basins`.

    Raises
    ------
    InputError
        A name or range that cannot be used.

    See Also
    --------
    carom.run_sweep : over any number of parameters

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> kicks = cm.disturbances.VelocityKick.of(machine, "100 mm/s")
    >>> gains = cm.map_gains(machine, cm.Grid(kicks, (4, 6)), {"stiffness": 3, "damping": 3})
    >>> dict(gains.dataset.sizes)
    {'stiffness': 3, 'damping': 3}
    """
    rotor = rotor_of(machine)
    over = over or dict.fromkeys(usual_gains(rotor), USUAL_COUNT)
    limits = {"patience": patience, "max_events": max_events}
    measure = RecoveryMeasure(disturbances, {**limits, "threads": threads})
    tell = Reporter.of(progress, "following starts of other gains")
    dataset, _ = map_over(rotor, measure, over, tell)
    first, second = over
    axes = axis(rotor, first), axis(rotor, second)
    here = axes[0].value(rotor), axes[1].value(rotor)
    (now,) = measured(rotor, axes, [(disturbances, here)], measure.limits)
    dataset.attrs |= {
        **(source or {}),
        **provenance(rotor, disturbances),
        "title": "Share of disturbances that come back to levitation, against two parameters",
        **limits,
        "present_share": json.dumps(record(now["share"], "fraction low high count total")),
    }
    return GainMap(dataset)


def usual_gains(rotor: Rotor) -> tuple[str, str]:
    """Names of P and D gain: of the controllers, or what they are to the planar rotor, in its units without scales."""
    known = (("proportional", "derivative"), ("stiffness", "damping"), ("omega", "gamma"))
    return next((pair for pair in known if all(name in rotor.varied for name in pair)), known[1])


def measured(
    rotor: Rotor, axes: tuple[Axis, Axis], nodes: list[Tried], limits: Mapping[str, int | None]
) -> Iterator[Entry]:
    """Yield the measures of each node, which has disturbances of its own; nodes are followed in chunks of about CHUNK starts.

    If all nodes of a map shared one sample, a sample with too many unrecovered starts would make the intervals of all of them too
    low at once: they would not cover the true shares of 95 % of the nodes, but of all or of few.
    """
    there, back = tee(_machine(rotor, plan, axes, node) for plan, node in nodes)
    followed = zip(nodes, there, follow_machines(back, CHUNK, **limits), strict=True)
    for (plan, _), (moved, starts), ends in followed:
        own = plan.rescaled(rotor.scales, moved.scales)
        found = dict.fromkeys(SHARES, 0.0) | recovery(own, moved, starts, ends.outcomes)
        if SMALLEST in found and rotor.scales is not None and moved.scales is not None:
            found[SMALLEST] *= moved.scales.velocity / rotor.scales.velocity
        yield found | {"levitates": float((ends.outcomes != NO_START).any())}


def _machine(rotor: Rotor, plan: Plan, axes: tuple[Axis, Axis], node: tuple[float, ...]) -> tuple[Rotor, Starts]:
    """Machine of a node and its starts; none of them exists if it cannot levitate."""
    moved = rotor.replace(**{varied.name: value for varied, value in zip(axes, node, strict=True)})
    if not moved.system.levitates:
        nowhere = np.zeros((plan.count, *moved.system.rest.shape)[: 1 + (moved.system.rest.size > 1)], complex)
        return moved, Starts.of(np.zeros(plan.count), 0j, False)._replace(positions=nowhere, velocities=nowhere)
    return moved, plan.rescaled(rotor.scales, moved.scales).starts(moved)


def recovery(plan: Plan, rotor: Rotor, starts: Starts, outcomes: np.ndarray) -> dict[str, Any]:
    """What is measured of the disturbances of a plan: :data:`~carom.disturbances.plans.SHARES`, of kicks ``KICKS``, and the share itself."""
    exists, at = outcomes != NO_START, instants_words(rotor, plan)
    if not exists.any():
        population = Population.of_model(plan.model, rotor.scales, at)
        return {"share": Share(0.0, 0.0, 0.0, 0, plan.count, isinstance(plan, Sample), population)}
    share = Share.over(plan, outcomes == Outcome.LEVITATED, exists, rotor.scales, at=at)
    given_up = Share.over(plan, exists & (outcomes < Outcome.LEVITATED), exists, rotor.scales)
    shares = share.fraction, share.low, share.high, given_up.fraction
    found = dict(zip(SHARES, shares, strict=True))
    if isinstance(plan.model, VelocityKick | KickPlane):
        smallest = smallest_unrecovered_kick(rotor, starts, outcomes) or (math.nan, math.nan, math.nan)
        found |= dict(list(zip(KICKS, smallest, strict=True))[: 3 if rotor.depends_on_instant else 2])
    return {"share": share} | found


_LEVITATES = Quantity("1", "1 where the rotor levitates without contact and no motion about that grows, else 0")


@dataclass(frozen=True)
class RecoveryMeasure(Measure):
    """Where disturbances of a plan end; each node draws its own sample."""

    plan: Plan
    limits: Mapping[str, int | None]

    stated: ClassVar[Mapping[str, Quantity]] = SHARES | {"levitates": _LEVITATES} | KICKS

    def entries(self, rotor: Rotor, axes: tuple[Axis, Axis], nodes: Sequence[tuple[float, float]]) -> Iterator[Entry]:
        """Measures of each node."""
        tried = [(self.plan.fresh(number), node) for number, node in enumerate(nodes)]
        return measured(rotor, axes, tried, self.limits)
