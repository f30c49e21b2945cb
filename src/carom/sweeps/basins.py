"""What a sweep of basins computes at a point of its grid: where disturbances end."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from carom.base.outcome import Outcome
from carom.base.results import in_si
from carom.disturbances import Grid, KickPlane, Plan, Sample, VelocityKick
from carom.disturbances.echo import plan_words
from carom.sweeps.variables import LEVITATES, Dimension, Variable, with_si

if TYPE_CHECKING:
    from carom.disturbances import Disturbance, Starts
    from carom.models import Rotor
    from carom.parameters import Case, Scales

ENDINGS = (
    *(outcome for outcome in Outcome if outcome.settled),
    *(Outcome.TIME_REACHED, Outcome.EVENT_LIMIT, Outcome.GRAZING, Outcome.LOW_BOUNCES),
    *(Outcome.BEYOND_MODEL, Outcome.STALLED),
)
OUTCOMES = Dimension(
    "outcome",
    tuple(int(ending) for ending in ENDINGS),
    "where the motion ends",
    tuple(ending.label for ending in ENDINGS),
)
BATCH = 65_536
"""Starts followed at a time, so that memory use does not grow with their total number."""
_COST, _COST_OF_START = 0.002, 1e-4


@dataclass(frozen=True)
class BasinsTask:
    """Disturbances followed at each point of the grid."""

    tried: Plan
    """The disturbances.  Of a sample the model and the number count: each point draws its own."""
    in_si: tuple[str, ...] = ()
    """Fields of the model that keep their size in SI units where an axis changes the scales; others keep their number."""
    scales: Scales | None = None
    """Scales for which the sizes are given, if mass, clearance and speed are known; results are then stored in SI units
    too."""

    kind: ClassVar[str] = "basins"
    dimensions: ClassVar[tuple[Dimension, ...]] = (OUTCOMES,)

    @property
    def variables(self) -> tuple[Variable, ...]:
        """What is stored for each point."""
        found: tuple[Variable, ...] = (
            LEVITATES,
            Variable("possible", "disturbances that are possible", "count"),
            Variable("counts", "disturbances that ended so", "count", along=OUTCOMES),
            Variable("recovered", f"share of {self.tried.model.noun} that came back to levitation, by area"),
            Variable("recovered_low", "lower end of its 95 % confidence interval (Clopper and Pearson)"),
            Variable("recovered_high", "upper end of its 95 % confidence interval (Clopper and Pearson)"),
            Variable("mean_impacts", "impacts until it was known where the motion ends, mean"),
        )
        if self._kicks:
            found += (
                Variable("smallest_unrecovered_kick", "smallest kick tried that does not come back", scale="velocity"),
                Variable(
                    "smallest_unrecovered_kick_angle",
                    "its direction, from the real axis of the co-rotating frame",
                    unit="rad",
                ),
                Variable(
                    "smallest_unrecovered_kick_instant",
                    "angle by which the shaft has turned then, where the instant matters",
                    unit="rad",
                ),
            )
        return with_si(found, self.scales is not None)

    @property
    def starts(self) -> int:
        """Disturbances at each point."""
        return self.tried.count

    @property
    def words(self) -> str:
        """Say which disturbances are tried at each point."""
        return f"{plan_words(self.tried, None, self.scales, drawn='a sample of its own')}, at each point"

    @property
    def seconds(self) -> float:
        """Estimated computing time of a point, in seconds."""
        return _COST + _COST_OF_START * self.starts

    @property
    def _kicks(self) -> bool:
        return isinstance(self.tried.model, VelocityKick | KickPlane)

    def describe(self) -> dict[str, Any]:
        """Return what identifies the task, as plain data for JSON."""
        number = (
            {"cells": list(self.tried.shape), "instant": self.tried.instant}
            if isinstance(self.tried, Grid)
            else {"starts": self.starts}
        )
        return {"kind": self.kind, **number, "disturbance": self.tried.model.describe(), "in_si": list(self.in_si)}

    def model(self, scales: Scales | None) -> Disturbance:
        """Return the disturbance model for a machine with these scales."""
        return self.tried.model.rescaled(self.scales, scales, self.in_si)

    def evaluate(self, case: Case | Rotor, seed: np.random.SeedSequence) -> dict[str, Any]:
        """Compute the values of one machine by variable name; a variable without a value is left out."""
        from carom.basins.losses import smallest_lost
        from carom.basins.shares import Share
        from carom.disturbances.following import NO_START, follow
        from carom.models import rotor_of

        rotor = rotor_of(case)
        counts = np.zeros(len(ENDINGS), np.int64)
        if rotor.system.decay < 0.0 and not rotor.system.levitates:
            return {"levitates": False, "possible": 0, "counts": counts}
        impacts, kicks = 0, []
        for starts in self._batches(rotor, seed):
            endings = follow(rotor, starts, threads=1)
            counts += np.array([endings.count(ending) for ending in ENDINGS])
            impacts += int(endings.impacts.sum())
            if self._kicks and (kick := smallest_lost(rotor, starts, endings.outcomes)):
                kicks.append(kick)
        possible = int(counts.sum())
        found: dict[str, Any] = {"levitates": rotor.system.levitates, "possible": possible, "counts": counts}
        if possible:
            share = Share.of(int(counts[0]), possible, drawn=True)
            if isinstance(self.tried, Grid):  # one batch
                exists, back = endings.outcomes != NO_START, endings.outcomes == Outcome.LEVITATED
                share = Share.over(self.tried, back, exists, rotor.scales)
            found |= {"recovered": share.fraction, "recovered_low": share.low, "recovered_high": share.high}
            found["mean_impacts"] = impacts / possible
        if kicks:
            smallest, direction, instant = min(kicks)
            found |= {"smallest_unrecovered_kick": smallest, "smallest_unrecovered_kick_angle": direction}
            if rotor.depends_on_instant:
                found["smallest_unrecovered_kick_instant"] = instant
            found |= in_si(found, rotor.scales, smallest_unrecovered_kick="velocity")
        return found

    def _batches(self, rotor: Rotor, seed: np.random.SeedSequence) -> Iterator[Starts]:
        model = self.model(rotor.scales)
        if isinstance(self.tried, Grid):
            yield Grid(model, self.tried.shape, self.tried.instant).starts(rotor)
            return
        for batch, first in enumerate(range(0, self.starts, BATCH)):
            own = np.random.SeedSequence(seed.entropy, spawn_key=(*seed.spawn_key, batch))
            number = int(own.generate_state(1, np.uint64)[0])
            yield Sample(model, min(BATCH, self.starts - first), number).starts(rotor)
