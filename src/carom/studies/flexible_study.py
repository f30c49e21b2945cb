"""The study of a flexible machine: how it levitates, from all its modes, and what it survives, from the reduced rotor in contact."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from carom.attractors import DisturbanceSet, find_attractors
from carom.models import Model
from carom.motions import drop, drop_loads, simulate
from carom.motions.budget import Budget
from carom.motions.reduction_errors import reduction_error
from carom.parameters import Case
from carom.progress import Reporter
from carom.rotors import ReducedMachine
from carom.studies.facts import Fact
from carom.studies.flexible_data import FlexibleData
from carom.studies.flexible_document import machine_document
from carom.studies.flexible_facts import facts_of_machine, verdict_of_machine
from carom.studies.flexible_levitation import levitation_of_machine
from carom.studies.flexible_trials import MOST_EVENTS, kicks_beyond, trials_of
from carom.studies.questions import DESCRIBED, EVENTS_OF_FLEXIBLE
from carom.studies.verdict import Verdict

DRAWN = 200
"""Disturbances of each kind that are drawn."""
FALLING = 0.2
"""Time in s for which a drop is followed, if it does not settle before."""


@dataclass(frozen=True, eq=False, repr=False)
class FlexibleStudy(FlexibleData):
    """The study of a flexible machine: what was found, and the verdict.

    Its attributes are those of :class:`carom.studies.flexible_data.FlexibleData`.
    """

    def rows(self) -> list[tuple[str, str]]:
        """The machine and the verdict."""
        return [("case", self.case.name), ("verdict", self.verdict.headline)]

    @cached_property
    def facts(self) -> tuple[Fact, ...]:
        """All that was found, in the order in which it is told."""
        return tuple(facts_of_machine(self))

    @cached_property
    def verdict(self) -> Verdict:
        """The verdict, in words."""
        return verdict_of_machine(self, self.facts)

    def to_dict(self) -> dict[str, Any]:
        """Return the study as it is written to ``study.json``."""
        return machine_document(self, self.verdict, self.facts)


def study_of_machine(
    case: Case, rotor: Model, reduced: ReducedMachine, budget: Budget, tell: Reporter
) -> FlexibleStudy:
    """Study a flexible machine."""
    required = case.requirement.own(rotor.scales)
    tell(0.0, "whirls, response and sensitivity of all modes")
    levitation = levitation_of_machine(reduced.machine)
    tell(0.1, "where disturbances end (the kernels are compiled on first use)")
    disturbances = DisturbanceSet(count=DRAWN, fastest=required.kick)
    with budget.question(DESCRIBED, EVENTS_OF_FLEXIBLE[DESCRIBED]):
        found = find_attractors(rotor, disturbances, progress=tell.part(0.1, 0.4))
    holds = rotor.system.rest_radius < 1.0
    trials = trials_of(case, rotor, required, DRAWN, budget, tell.part(0.4, 0.7)) if holds else ()
    tell(0.7, "larger kicks")
    beyond = kicks_beyond(rotor, required, trials[0], budget) if trials else ()
    tell(0.85, "the drop")
    fall = None
    if rotor.weight is not None and holds:
        fall = simulate(rotor, drop(), f"{FALLING} s", max_events=MOST_EVENTS)
    along = None if fall is None else reduction_error(reduced, drop_loads(fall), lambda finer: (finer.model, drop()))
    return FlexibleStudy(case, rotor, reduced, levitation, found, trials, beyond, fall, along, budget.unfinished)
