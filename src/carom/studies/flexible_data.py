"""What a study has found of a flexible machine, before it is told in words."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

from carom.attractors import AttractorSet
from carom.basins import Share
from carom.models import Model
from carom.motions import DropLoads, Trajectory, drop_loads
from carom.motions.budget import Question
from carom.motions.reduction_errors import ReductionError
from carom.parameters import Case, Required
from carom.results import Result
from carom.rotors import ReducedMachine
from carom.studies.flexible_levitation import FlexibleLevitation
from carom.studies.flexible_trials import FlexibleTrial
from carom.studies.wording import Wording


@dataclass(frozen=True, eq=False, repr=False)
class FlexibleData(Result):
    """What a study has found of a flexible machine, before it is told in words.

    Attributes
    ----------
    case : Case
    rotor : Model
        The reduced machine with its weight, in which motions with contact are followed.
    reduced : ReducedMachine
        The same with the machine behind it, and the error of the reduction.
    levitation : FlexibleLevitation
        From all modes.
    attractors : AttractorSet
        The motions in which kicks, starts elsewhere and starts in backward whirl end; others may exist.
    trials : tuple of FlexibleTrial
        What must be survived, one kind after another; empty where the rotor does not levitate without contact.
    beyond : tuple of tuple
        Multiples of the required kick, and how many of the directions tried came back.
    fall : Trajectory or None
        The drop after a loss of levitation; ``None`` of a rotor without weight.
    fall_reduction : ReductionError or None
        Error of the reduction along that drop.
    unfinished : tuple of Question
        The questions for which the budget of events, or a time limit, did not suffice.
    """

    shown: ClassVar = ("case", "levitates")
    rests_on: ClassVar = ("api617", "iso14839")

    case: Case
    rotor: Model
    reduced: ReducedMachine
    levitation: FlexibleLevitation
    attractors: AttractorSet
    trials: tuple[FlexibleTrial, ...]
    beyond: tuple[tuple[float, Share], ...]
    fall: Trajectory | None
    fall_reduction: ReductionError | None = None
    unfinished: tuple[Question, ...] = ()

    @property
    def levitates(self) -> bool:
        """Whether it runs without contact; a machine whose controllers do not hold it is refused before."""
        return self.rotor.system.rest_radius < 1.0

    @property
    def elsewhere(self) -> Share:
        """Of the starts spread over the clearance, which nothing requires to come back, how many did."""
        ends = [each.recovered for each in self.attractors.disturbances if each.start.kind == "start"]
        return Share.of(sum(ends), len(ends), drawn=True)

    @property
    def required(self) -> Required:
        """What the machine must survive, in units of the equations."""
        return self.case.requirement.own(self.rotor.scales)

    @property
    def zone(self) -> str:
        """Zone of ISO 14839-2 of the whirl by unbalance and of the static sag together, at the worst plane."""
        return self.case.zones.zone(min(self.rotor.system.rest_radius, 1.0))

    @property
    def wording(self) -> Wording:
        """Formatter of the results of this study as text."""
        return Wording(self.rotor.scales, in_terms=False)

    @cached_property
    def fall_loads(self) -> DropLoads | None:
        """What the touchdown bearings bear in the drop."""
        return None if self.fall is None else drop_loads(self.fall)
