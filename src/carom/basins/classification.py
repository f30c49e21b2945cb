"""Follow disturbances until they settle, and classify where they end."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from carom.attractors import MotionName, Survival, document_of, follow_until_settled
from carom.attractors.naming import name_endings
from carom.base.arguments import Count, Whole, checked
from carom.base.outcome import STEADY_WORDS, InputError, Outcome
from carom.base.progress import ShowProgress, shows_progress
from carom.basins.dataset import Mapped, dataset_of, provenance
from carom.basins.shares import Share
from carom.disturbances import Coordinate, Plan, Starts
from carom.disturbances.following import follow, require_start
from carom.disturbances.plans import instants_words
from carom.models import Rotor, Subject, rotor_of
from carom.motions import PATIENCE, Endings
from carom.motions.ensembles import MOST_EVENTS
from carom.motions.settling import longest_time
from carom.motions.starts import Until
from carom.parameters import Scales, own_time

CRITERIA = (
    "levitated: by the moduli of the modes no later flight can reach the wall (proof). "
    f"forward_rub: slides in a neighbourhood of the {STEADY_WORDS['rub']} where all sliding converges to that rub (proof), or "
    "within 1e-9 of the rub, or forward by the next criterion. "
    "rolling: whirls backward faster than the speed from which it is certain to run away to rolling (proof), or by the next "
    "criterion. backward_whirl: after a turn along the wall without flight the state has changed by less than 1e-9. "
    "bouncing, mixed: the state at an impact recurs to within 1e-9 twice in a row (multiplicity: impacts a period, if an "
    "orbit closes there), or has not recurred in {patience} impacts (multiplicity 0: irregular; where such motion was seen "
    "to end, it was followed on). "
    "grazing: double precision cannot decide. time_reached, event_limit: not settled by {until:g}/Omega or {events} "
    "events. Criteria not called a proof are evidence."
)


@dataclass(frozen=True, eq=False)
class Cells:
    """Where the disturbances of a plan end, as pictures need it.

    Attributes
    ----------
    plan : Grid or Sample
    scales : Scales or None
    index : ndarray of int
        Place of the motion among ``motions``, of the shape of the plan; −1 where there is no start.
    motions : tuple of MotionName
    """

    plan: Plan
    scales: Scales | None
    index: np.ndarray
    motions: tuple[MotionName, ...]


@checked
@dataclass(frozen=True, eq=False, repr=False)
class Basin(Mapped):
    """Where each of many disturbances ends.

    Attributes
    ----------
    dataset : xarray.Dataset
        Dimensions are the coordinates of a grid, or ``start``.  Variables: ``outcome``
        (:class:`~carom.base.outcome.Outcome`, −1 where there is no start), ``motion`` (index of the motion in its attribute ``motions``),
        ``time`` until the outcome was known, ``impacts`` until then, ``touched`` (whether the rotor met the wall, even
        if only during a shock or because it started there), ``multiplicity`` (impacts per period), ``weight`` (of the
        start in shares: the area of its cell, one on average), and the starts
        ``start_x``, ``start_y``, ``start_vx``, ``start_vy`` in the co-rotating frame.  Lengths in ``c_r``, times in
        ``1/Ω``; coordinates ending in ``_si`` exist where the machine is known.  Attributes hold what is needed to
        repeat the computation: parameters, disturbance, seed, criteria, versions.
    """

    figure: ClassVar[str] = "basin"
    shown: ClassVar[tuple[str, ...]] = ("rotor", "coordinates", "starts", "fractions", "beyond_model", "unresolved")

    needed: ClassVar[tuple[str, ...]] = ("outcome", "motion", "time", "touched", "weight")

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Coordinates by which the disturbances vary."""
        return self.plan.model.coordinates

    @property
    def instants(self) -> str:
        """At which instants of the turn they come, in words; empty where that does not matter."""
        return instants_words(self.rotor, self.plan)

    @property
    def recovered(self) -> np.ndarray:
        """Which starts return to levitation and stay there."""
        return self.outcomes == Outcome.LEVITATED

    @property
    def touched(self) -> np.ndarray:
        """Which starts led the rotor to the wall, or began there."""
        return self.dataset["touched"].values > 0

    @property
    def resolved(self) -> np.ndarray:
        """Which starts have a known end."""
        return self.outcomes >= Outcome.LEVITATED

    @property
    def irregular(self) -> dict[str, object] | None:
        """How long irregular bouncing lasts, as plain data; ``None`` if no start led to it."""
        return json.loads(self.dataset.attrs["irregular"])

    @property
    def starts(self) -> int:
        """Number of starts."""
        return int(self.exists.sum())

    @property
    def beyond_model(self) -> int:
        """Number of starts whose motion went beyond the model."""
        return int((self.outcomes == Outcome.BEYOND_MODEL).sum())

    @property
    def unresolved(self) -> int:
        """Number of starts that were given up otherwise."""
        return int((self.exists & ~self.resolved).sum()) - self.beyond_model

    @property
    def cells(self) -> Cells:
        """Where the disturbances end, without the rest of the dataset."""
        return Cells(self.plan, self.scales, self.dataset["motion"].values, self.motions)

    @property
    def fractions(self) -> dict[MotionName, float]:
        """Share of the disturbances that end on each motion, the largest first; unresolved ones last."""
        shares = {name: self.share_of(name).fraction for name in self.motions}
        order = sorted(shares, key=lambda name: (not name.outcome.settled, -shares[name]))
        return {name: shares[name] for name in order}

    @property
    def share_recovered(self) -> Share:
        """Share that returns to levitation; starts that were given up, or went beyond the model, count as unrecovered.  Cells of a disc weigh by their area."""
        return Share.over(self.plan, self.recovered, self.exists, self.scales, at=self.instants)

    @checked
    def share_of(self, motion: str) -> Share:
        """Share of the disturbances that end on a motion.

        Raises
        ------
        InputError
            No start ends on such a motion.
        """
        if motion not in self.motions:
            raise InputError("motion", motion, f"one of: {', '.join(self.motions)}")
        chosen = self.dataset["motion"].values == self.motions.index(motion)
        return Share.over(self.plan, chosen, self.exists, self.scales, f"end in {motion}", self.instants)


@checked
@shows_progress
def map_basins(
    machine: Subject,
    disturbances: Plan,
    *,
    until: Until | None = None,
    patience: Whole = PATIENCE,
    max_events: Count = MOST_EVENTS,
    threads: Count | None = None,
    source: Mapping[str, str] | None = None,
    progress: ShowProgress = None,
) -> Basin:
    """Follow disturbances until they settle.

    The same arguments give the same result, bit for bit.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    disturbances : Grid or Sample
        Plan for a model of :mod:`carom.disturbances`.
    until : float or str
        Time after which a motion that has not settled is given up, in ``1/Ω`` or text with a unit; by default
        :func:`~carom.motions.settling.longest_time`.
    patience : int
        Impacts without recurrence after which bouncing counts as irregular.
    max_events : int
        Impacts and steps of lasting contact after which a motion is given up.
    threads : int, optional
        By default the number of available cores; the result does not depend on it.
    source : mapping of str to str, optional
        Further attributes of the dataset that say where the machine comes from, such as its file.

    Raises
    ------
    InputError
        None of the disturbances is possible: a rotor that cannot levitate cannot be kicked out of levitation.

    See Also
    --------
    carom.basins.smallest_unrecovered : the smallest disturbance that does not come back
    carom.map_gains : the share that comes back over two parameters
    carom.find_attractors : names and periods of the motions found

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> kicks = cm.disturbances.VelocityKick.of(machine, "100 mm/s")
    >>> basin = cm.map_basins(machine, cm.Grid(kicks, (6, 12)))
    >>> basin.share_recovered.count, basin.share_recovered.total
    (6, 72)
    """
    rotor = rotor_of(machine)
    until = longest_time(rotor) if until is None else own_time("until", until, rotor.scales)
    starts, endings, survival = _followed(
        rotor, disturbances, until, patience=patience, max_events=max_events, threads=threads, progress=progress
    )
    motions, names = name_endings(rotor, disturbances.model, endings)
    attributes = {
        **(source or {}),
        **provenance(rotor, disturbances),
        "irregular": json.dumps(document_of(survival) if survival else None),
        "criteria": CRITERIA.format(patience=patience, until=until, events=max_events),
    }
    return Basin(dataset_of(rotor, disturbances, starts, endings, motions, names, attributes))


@checked
def map_cells(machine: Subject, disturbances: Plan) -> Cells:
    """What pictures need of the basin that :func:`map_basins` finds; without a dataset, which takes longer to load than to fill."""
    rotor, plan = rotor_of(machine), disturbances
    _, endings, _ = _followed(rotor, plan, longest_time(rotor))
    return Cells(plan, rotor.scales, *name_endings(rotor, plan.model, endings))


def _followed(
    rotor: Rotor,
    plan: Plan,
    until: float,
    *,
    patience: int = PATIENCE,
    max_events: int = MOST_EVENTS,
    threads: int | None = None,
    progress: ShowProgress = None,
) -> tuple[Starts, Endings, Survival | None]:
    """The starts of a plan, where they end, and how long irregular bouncing lasts."""
    starts = plan.starts(rotor)
    require_start(rotor, starts)
    endings = follow(
        rotor, starts, until=until, patience=patience, max_events=max_events, threads=threads, progress=progress
    )
    if plan.model.changes_machine:  # irregular motions of many machines have no half-life in common
        return starts, endings, None
    return starts, *follow_until_settled(rotor, endings, impacts=patience, threads=threads)
