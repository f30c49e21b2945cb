"""What a sweep of basins computes at a point of its grid: where the disturbances of a seeded sample end."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from carom.disturbances import MODELS
from carom.outcome import Outcome
from carom.sweeps.variables import Dimension, Variable, with_si

if TYPE_CHECKING:
    from carom.disturbances import Disturbance, Starts
    from carom.models import Jeffcott
    from carom.parameters import Case, Scales

__all__ = ["BasinsTask"]

ENDINGS = (
    Outcome.LEVITATED,
    Outcome.BOUNCING,
    Outcome.MIXED,
    Outcome.FORWARD_RUB,
    Outcome.BACKWARD_WHIRL,
    Outcome.ROLLING,
    Outcome.TIME_REACHED,
    Outcome.EVENT_LIMIT,
    Outcome.GRAZING,
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
_KICKS = ("kick", "kick-plane")


@dataclass(frozen=True)
class BasinsTask:
    """A sample of disturbances at each point of the grid.

    Attributes
    ----------
    starts : int
        Disturbances at each point.
    disturbance : str
        Kind of disturbance: the name of a model of :mod:`carom.disturbances`.
    sizes : tuple of (str, value, bool)
        Arguments of that model: name, value, and whether the value is in SI units.  A value in SI units is the same at
        all points; it is converted with the scales of each point.
    has_scales : bool
        Whether mass, clearance and speed are known, so that results are stored in SI units too.
    """

    starts: int
    disturbance: str
    sizes: tuple[tuple[str, Any, bool], ...]
    has_scales: bool

    kind: ClassVar[str] = "basins"
    dimensions: ClassVar[tuple[Dimension, ...]] = (OUTCOMES,)

    @property
    def variables(self) -> tuple[Variable, ...]:
        """What is stored for each point."""
        found: tuple[Variable, ...] = (
            Variable("possible", "disturbances of the sample that are possible", "count"),
            Variable("counts", "disturbances that ended so", "count", along=OUTCOMES),
            Variable("recovered", "share of the possible disturbances that came back to levitation"),
            Variable("recovered_low", "lower end of its 95 % confidence interval (Wilson)"),
            Variable("recovered_high", "upper end of its 95 % confidence interval (Wilson)"),
            Variable("mean_impacts", "impacts until it was known where the motion ends, mean"),
        )
        if self.disturbance in _KICKS:
            found += (
                Variable(
                    "smallest_unrecovered_kick", "smallest kick of the sample that does not come back", scale="velocity"
                ),
                Variable(
                    "smallest_unrecovered_kick_angle",
                    "its direction, from the real axis of the co-rotating frame",
                    unit="rad",
                ),
            )
        return with_si(found, self.has_scales)

    @property
    def seconds(self) -> float:
        """Estimated computing time of a point, in seconds."""
        return _COST + _COST_OF_START * self.starts

    def describe(self) -> dict[str, Any]:
        """Return what identifies the task, as plain data for JSON."""
        sizes = {name: {"value": _plain(value), "si": si} for name, value, si in self.sizes}
        return {"kind": self.kind, "starts": self.starts, "disturbance": {"kind": self.disturbance, **sizes}}

    def model(self, scales: Scales | None) -> Disturbance:
        """Return the disturbance model for a machine with these scales."""
        chosen = MODELS[self.disturbance]
        sizes = {}
        for name, value, si in self.sizes:
            sizes[name] = value / getattr(scales, chosen.measured_in[name]) if si else value
        model: Disturbance = chosen(**sizes)
        return model

    def evaluate(self, case: Case, seed: np.random.SeedSequence) -> dict[str, Any]:
        """Compute the values of one machine by variable name; a variable without a value is left out.

        Parameters
        ----------
        case : Case
        seed : SeedSequence
            Seed of this point.
        """
        from carom.basins.losses import smallest_lost
        from carom.basins.shares import Share
        from carom.models import Jeffcott

        rotor = Jeffcott(case.parameters)
        counts = np.zeros(len(ENDINGS), np.int64)
        impacts, kicks = 0, []
        for starts in self._batches(rotor, seed):
            outcomes, struck = _follow(rotor, starts)
            counts += np.array([np.count_nonzero(outcomes == ending) for ending in ENDINGS])
            impacts += struck
            if self.disturbance in _KICKS and (kick := smallest_lost(starts.velocities[starts.exists], outcomes)):
                kicks.append(kick)
        possible = int(counts.sum())
        found: dict[str, Any] = {"possible": possible, "counts": counts}
        if possible:
            share = Share.of(int(counts[0]), possible, drawn=True)
            found |= {"recovered": share.fraction, "recovered_low": share.low, "recovered_high": share.high}
            found["mean_impacts"] = impacts / possible
        if kicks:
            smallest, direction = min(kicks)
            found |= {"smallest_unrecovered_kick": smallest, "smallest_unrecovered_kick_angle": direction}
            if rotor.scales is not None:
                found["smallest_unrecovered_kick_si"] = smallest * rotor.scales.velocity
        return found

    def _batches(self, rotor: Jeffcott, seed: np.random.SeedSequence) -> Iterator[Starts]:
        from carom.disturbances import Sample

        model = self.model(rotor.scales)
        for batch, first in enumerate(range(0, self.starts, BATCH)):
            own = np.random.SeedSequence(seed.entropy, spawn_key=(*seed.spawn_key, batch))
            number = int(own.generate_state(1, np.uint64)[0])
            yield Sample(model, min(BATCH, self.starts - first), number).starts(rotor)


def _plain(value: Any) -> Any:
    """Return a size as plain data for JSON: a complex number as a list of two."""
    return [value.real, value.imag] if isinstance(value, complex) else value


def _follow(rotor: Jeffcott, starts: Starts) -> tuple[np.ndarray, int]:
    """Return the outcomes of the starts that exist, and the total number of their impacts."""
    from carom.motions.ensembles import settle

    decided = starts.exists & ~starts.undecided
    endings = settle(rotor, starts.positions[decided], starts.velocities[decided], threads=1)
    outcomes = np.full(decided.shape, Outcome.GRAZING, np.int8)
    outcomes[decided] = endings.outcomes
    return outcomes[starts.exists], int(endings.impacts.sum())
