"""Gain maps: the share of disturbances that recover, against two parameters of the machine."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import tee
from typing import Any, ClassVar, TypeAlias

import numpy as np

from carom.base.arguments import Count, Whole, checked
from carom.base.outcome import Outcome
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.base.results import record
from carom.basins.dataset import Mapped, provenance
from carom.basins.maps import Entry, Measure, OverPlane, Several, map_over
from carom.basins.shares import Population, Share
from carom.basins.unrecovered import smallest_unrecovered_kick
from carom.disturbances import KickPlane, Plan, Sample, Starts, VelocityKick
from carom.disturbances.following import NO_START, follow_machines
from carom.disturbances.measures import KICKS, SHARES, SMALLEST, Quantity
from carom.disturbances.plans import instants_words
from carom.models import Axis, Rotor, Subject, axis, rotor_of
from carom.models.axes import Ends
from carom.motions.ensembles import MOST_EVENTS
from carom.motions.settling import PATIENCE

Node: TypeAlias = tuple[Plan, tuple[float, float]]
"""Disturbances, and values of the two parameters."""
WANTED = 0.99
"""Share that machines of a map are counted by."""
CHUNK = 50_000
"""Approximate number of starts in memory at a time."""


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
    names: tuple[str, str] | None = None,
    *,
    ranges: tuple[Ends | None, Ends | None] = (None, None),
    shape: tuple[Several, Several] = (16, 16),
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
    names : tuple of str
        The two parameters, such as ``("stiffness", "damping")`` (P and D gain) or ``("omega", "gamma")``; any of
        :func:`carom.models.axis`, of a flexible machine such as ``("proportional", "derivative")``, which are the default there.
    ranges : tuple of tuple of float or str, optional
        Ranges of both, in SI units if physical, or texts with a unit; by default half to twice the present value.
    shape : tuple of int
        Number of values of both, ends included.
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
    >>> gains = cm.map_gains(machine, cm.Grid(kicks, (4, 6)), shape=(3, 3))
    >>> dict(gains.dataset.sizes)
    {'stiffness': 3, 'damping': 3}
    """
    rotor = rotor_of(machine)
    names = names or usual_gains(rotor)
    limits = {"patience": patience, "max_events": max_events}
    measure = RecoveryMeasure(disturbances, {**limits, "threads": threads})
    tell = Reporter.of(progress, "following starts of other gains")
    dataset, _ = map_over(rotor, measure, names, ranges, shape, tell)
    axes = axis(rotor, names[0]), axis(rotor, names[1])
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


def measured(rotor: Rotor, axes: tuple[Axis, Axis], nodes: list[Node], limits: Mapping[str, Any]) -> Iterator[Entry]:
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
    """What is measured of the disturbances of a plan: :data:`~carom.disturbances.measures.SHARES`, of kicks ``KICKS``, and the share itself."""
    exists, at = outcomes != NO_START, instants_words(rotor, plan)
    if not exists.any():
        population = Population.of_model(plan.model, rotor.scales, at)
        return {"share": Share(0.0, 0.0, 0.0, 0, plan.count, isinstance(plan, Sample), population)}
    share = Share.over(plan, outcomes == Outcome.LEVITATED, exists, rotor.scales, at=at)
    given_up = Share.over(plan, exists & (outcomes < Outcome.LEVITATED), exists, rotor.scales)
    shares = share.fraction, share.low, share.high, given_up.fraction
    found: dict[str, Any] = {"share": share} | dict(zip(SHARES, shares, strict=True))
    if isinstance(plan.model, VelocityKick | KickPlane):
        smallest = smallest_unrecovered_kick(rotor, starts, outcomes) or (math.nan, math.nan, math.nan)
        found |= dict(list(zip(KICKS, smallest, strict=True))[: 3 if rotor.depends_on_instant else 2])
    return found


_LEVITATES = Quantity("1", "1 where the rotor levitates without contact and no motion about that grows, else 0")


@dataclass(frozen=True)
class RecoveryMeasure(Measure):
    """Where disturbances of a plan end; each node draws its own sample."""

    plan: Plan
    limits: Mapping[str, Any]

    stated: ClassVar[Mapping[str, Quantity]] = SHARES | {"levitates": _LEVITATES} | KICKS

    def entries(self, rotor: Rotor, axes: tuple[Axis, Axis], nodes: Sequence[tuple[float, float]]) -> Iterator[Entry]:
        """Measures of each node."""
        tried = [(self.plan.fresh(number), node) for number, node in enumerate(nodes)]
        return measured(rotor, axes, tried, self.limits)
