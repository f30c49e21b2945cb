"""What a sweep of basins computes at a point of its grid: where disturbances end."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from carom.base.outcome import Outcome
from carom.base.results import in_si
from carom.disturbances import Grid, KickPlane, Plan, Sample, VelocityKick
from carom.disturbances.plans import KICKS, SHARES, SMALLEST, plan_words
from carom.sweeps.variables import LEVITATES, Dimension, Variable, with_si

if TYPE_CHECKING:
    from carom.disturbances import Disturbance
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

    @property
    def variables(self) -> tuple[Variable, ...]:
        """What is stored for each point."""
        measured = SHARES | (KICKS if isinstance(self.tried.model, VelocityKick | KickPlane) else {})
        found = (
            LEVITATES,
            Variable("possible", "disturbances that are possible", "count"),
            Variable("counts", "disturbances that ended so", "count", along=OUTCOMES),
            *(Variable(name, each.words, unit=each.unit, scale=each.scale) for name, each in measured.items()),
            Variable("mean_impacts", "impacts until it was known where the motion ends, mean"),
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

    def describe(self) -> dict[str, object]:
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

    def plan(self, scales: Scales | None, seed: np.random.SeedSequence) -> Plan:
        """The disturbances of a machine with these scales; of a sample its own."""
        model = self.model(scales)
        if isinstance(self.tried, Grid):
            return replace(self.tried, model=model)
        own = np.random.SeedSequence(seed.entropy, spawn_key=(*seed.spawn_key, 0))
        return Sample(model, self.starts, int(own.generate_state(1, np.uint64)[0]))

    def evaluate(self, case: Case | Rotor, seed: np.random.SeedSequence) -> dict[str, object]:
        """Compute the values of one machine by variable name; a variable without a value is left out."""
        from carom.basins.maps import recovery
        from carom.disturbances.following import follow
        from carom.models import rotor_of

        rotor = rotor_of(case)
        counts = np.zeros(len(ENDINGS), np.int64)
        if rotor.system.decay < 0.0 and not rotor.system.levitates:
            return {"levitates": False, "possible": 0, "counts": counts}
        plan = self.plan(rotor.scales, seed)
        starts = plan.starts(rotor)
        endings = follow(rotor, starts, threads=1)
        counts += np.array([endings.count(ending) for ending in ENDINGS])
        possible = int(counts.sum())
        found = {"levitates": rotor.system.levitates, "possible": possible, "counts": counts}
        if possible:
            found |= recovery(plan, rotor, starts, endings.outcomes)
            found["mean_impacts"] = int(endings.impacts.sum()) / possible
            del found["share"]
        return found | in_si(found, rotor.scales, **{name: "velocity" for name in found if name == SMALLEST})
