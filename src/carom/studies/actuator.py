"""What the limits of the magnetic bearings do in the motions of a study.

A limit of force or current acts in the motion (:mod:`carom.models.limits`): which disturbances come to it, and how many of these come back, is counted.
"""

from __future__ import annotations

from dataclasses import dataclass

from carom.attractors import AttractorSet
from carom.base.results import record
from carom.core.limits import WITHIN
from carom.models import rotor_of
from carom.motions.simulation import simulate
from carom.parameters import Case, ControlLimit

SHORTEST = 1e-6
"""Time for which a disturbance is followed whose end is known at once."""


@dataclass(frozen=True)
class BearingDemand:
    """What the largest control force of the magnetic bearings does in the motions of a study.

    Attributes
    ----------
    control : ControlLimit
        That force.
    at_limit, came_back_at_limit, total : int
        Numbers of the disturbances that come to it, of those among them that come back, and of all.
    """

    control: ControlLimit
    at_limit: int
    came_back_at_limit: int
    total: int

    @property
    def words(self) -> str:
        """What the limit does in the motions."""
        back = f", and {self.came_back_at_limit} of these came back" if self.at_limit else ""
        return (
            f"The magnetic bearings are limited to {self.control.words}, which every simulated motion respects. "
            f"{self.at_limit or 'None'} of {self.total} disturbances reach this limit{back}."
        )

    def document(self) -> dict[str, object]:
        """As plain data for JSON."""
        return {
            "control": record(self.control, "force_si=force pull_si=pull"),
            "disturbances": record(self, "at_limit came_back_at_limit"),
        }


def bearing_demand(case: Case, found: AttractorSet) -> BearingDemand | None:
    """What the limit of the magnetic bearings does in motions; ``None`` if they have none."""
    control, tried = rotor_of(case).limits, found.disturbances
    if not isinstance(control, ControlLimit):
        return None
    # Until their ends are known.
    motions = ((each, simulate(each.rotor, each.start.state, max(each.time, SHORTEST))) for each in tried)
    back = [each.recovered for each, motion in motions if (motion.segment_limits > WITHIN).any()]
    return BearingDemand(control, len(back), sum(back), len(tried))
