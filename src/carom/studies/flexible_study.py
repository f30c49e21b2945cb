"""The study of a flexible machine: how it levitates, from all its modes, and what it survives, from the reduced rotor in contact."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

from carom.attractors import AttractorSet, DisturbanceSet, find_attractors
from carom.models import Model
from carom.models.weight import weight_of
from carom.motions import DropLoads, Trajectory, drop, drop_loads, simulate
from carom.parameters import Case, Required
from carom.progress import Reporter
from carom.results import Result
from carom.rotors import ReducedMachine
from carom.studies.facts import Fact
from carom.studies.flexible_levitation import FlexibleLevitation, levitation_of_machine
from carom.studies.flexible_trials import MOST_EVENTS, FlexibleTrial, kicks_beyond, trials_of
from carom.studies.verdict import Verdict
from carom.studies.wording import Wording

DRAWN = 200
"""Disturbances of each kind that are drawn."""
FALLING = 0.2
"""Time in s for which a drop is followed, if it does not settle before."""


@dataclass(frozen=True, eq=False, repr=False)
class FlexibleStudy(Result):
    """The study of a flexible machine.

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
        Multiples of the required kick, and how many of twelve directions came back.
    fall : Trajectory or None
        The drop after a loss of levitation; ``None`` of a rotor without weight.
    """

    shown: ClassVar = ("case", "levitates")
    rests_on: ClassVar = ("api617", "iso14839")

    case: Case
    rotor: Model
    reduced: ReducedMachine
    levitation: FlexibleLevitation
    attractors: AttractorSet
    trials: tuple[FlexibleTrial, ...]
    beyond: tuple[tuple[float, int], ...]
    fall: Trajectory | None

    def rows(self) -> list[tuple[str, str]]:
        """The machine and the verdict."""
        return [("case", self.case.name), ("verdict", self.verdict.headline)]

    @property
    def levitates(self) -> bool:
        """Whether it runs without contact; a machine whose controllers do not hold it is refused before."""
        return self.rotor.system.rest_radius < 1.0

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

    @cached_property
    def facts(self) -> tuple[Fact, ...]:
        """All that was found, in the order in which it is told."""
        from carom.studies.flexible_facts import facts_of_machine  # which tells of this class

        return tuple(facts_of_machine(self))

    @cached_property
    def verdict(self) -> Verdict:
        """The verdict, in words."""
        from carom.studies.flexible_facts import verdict_of_machine

        return verdict_of_machine(self, self.facts)

    def to_dict(self) -> dict[str, Any]:
        """Return the study as it is written to ``study.json``."""
        from carom.studies.flexible_document import machine_document

        return machine_document(self)


def study_of_machine(case: Case, rotor: Model, reduced: ReducedMachine, tell: Reporter) -> FlexibleStudy:
    """Study a flexible machine."""
    required = case.requirement.own(rotor.scales)
    tell(0.0, "whirls, response and sensitivity of all modes")
    levitation = levitation_of_machine(reduced.machine)
    tell(0.1, "where disturbances end (the kernels are compiled on first use)")
    disturbances = DisturbanceSet(count=DRAWN, fastest=required.kick)
    found = find_attractors(rotor, disturbances, progress=tell.part(0.1, 0.4))
    holds = rotor.system.rest_radius < 1.0
    trials = trials_of(case, rotor, required, DRAWN, tell.part(0.4, 0.7)) if holds else ()
    tell(0.7, "larger kicks")
    beyond = kicks_beyond(rotor, required) if holds else ()
    tell(0.85, "the drop")
    fall = None
    if weight_of(rotor) is not None and holds:
        fall = simulate(rotor, drop(), f"{FALLING} s", max_events=MOST_EVENTS)
    return FlexibleStudy(case, rotor, reduced, levitation, found, trials, beyond, fall)
