"""A drop for the designer of a touchdown bearing: its loads in words and as JSON, against the limits that are stated."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from carom.attractors import MotionName
from carom.base.outcome import InputError, Outcome
from carom.base.results import Result, record
from carom.disturbances import Drop, drop
from carom.disturbances.drops import ASSUMED
from carom.disturbances.echo import Echo
from carom.models import Rotor, rotor_of
from carom.motions import DropLoads, Trajectory, drop_loads, simulate
from carom.motions.starts import State
from carom.parameters import Case
from carom.rotors.reduction_errors import ReductionError, reduction_error
from carom.studies.load_checks import LoadCheck, checks_of_planes
from carom.studies.load_tables import load_entries, load_tables
from carom.studies.wording import Wording

FALLING = "0.2 s"
"""Time for which the drop of a study is followed, if it does not settle before."""
MOST_EVENTS = 20_000
DROP, SHAFT = "time: settled_at:time outcome=outcome.label meaning=outcome.meaning", "speed_at_end:speed left_out:speed"


@dataclass(frozen=True, eq=False, repr=False)
class DropStudy(Result):
    """A drop of a machine.

    Attributes
    ----------
    case : Case
        The machine, with the limits of its touchdown bearing.
    echo : Echo
        What was done to it.
    loads : DropLoads
        What the touchdown bearing bears.
    reduction : ReductionError or None
        Error of the reduction of a flexible machine along it.
    motion : Trajectory or None
        ``None`` where its loads alone were followed.
    """

    case: Case
    echo: Echo
    loads: DropLoads
    reduction: ReductionError | None = None
    motion: Trajectory | None = None

    @property
    def assumed(self) -> bool:
        """Whether the weight is that of free fall downward because none is stated."""
        return self.case.gravity is None

    @property
    def checks(self) -> tuple[LoadCheck, ...]:
        """The loads of all planes against the limits that are stated."""
        return checks_of_planes(self.loads, self.case.limits)

    @property
    def headline(self) -> str:
        """How the motion ended, and up to when it was followed."""
        say, loads = Wording(self.case.parameters.scales), self.loads
        if loads.outcome is Outcome.BEYOND_MODEL:
            return f"Beyond the model since {say.time(loads.time)} after the release: {loads.outcome.meaning}"
        if not loads.outcome.settled:
            why = "" if loads.outcome is Outcome.TIME_REACHED else f" ({loads.outcome.words})"
            return f"Followed for {say.time(loads.time)}, and not settled by then{why}."
        goes_on = "" if loads.outcome is Outcome.LEVITATED else ", and goes on"
        how = goes_on if loads.settled_at is None else f", since {say.time(loads.settled_at)} after the release"
        name = MotionName(loads.outcome).words
        return f"{name[0].upper()}{name[1:]}{how}; followed for {say.time(loads.time)}."

    @property
    def tables(self) -> list[tuple[str, list[tuple[str, str]]]]:
        """For each plane a title, empty if there is one plane alone, and labels with what they say."""
        return load_tables(self.loads, "the release")

    def document(self) -> dict[str, Any]:
        """The drop as JSON."""
        case, loads = self.case, self.loads
        gravity, scales = case.gravity or ASSUMED, loads.scales
        document: dict[str, Any] = {
            "name": case.name,
            "disturbance": self.echo.document(scales),
            **rotor_of(case).document(),
            "gravity": {"acceleration_si": gravity.acceleration, "direction": gravity.direction},
            "gravity_assumed": self.assumed,
            "touchdown": {"law": case.touchdown.law, **case.touchdown.given} if case.touchdown else {"law": "rigid"},
            **record(loads, DROP, scales),
        }
        if loads.shaft is not None:
            document["shaft"] = record(loads.shaft, SHAFT, scales)
        shown = {"reduction": self.reduction, "magnets": loads.magnets}
        document |= {name: part.document() for name, part in shown.items() if part is not None}
        return document | {"touchdown_bearings": load_entries(loads, case.limits)}


def drop_of(case: Case) -> DropStudy | None:
    """Levitation lost, followed for a while; ``None`` of a machine that cannot fall: without scales, or of which it is not known what is left without levitation."""
    if case.parameters.scales is None:
        return None
    try:
        rotor, state, echo = release(case, drop())
    except InputError:
        return None
    motion = simulate(rotor, state, FALLING, max_events=MOST_EVENTS)
    loads, reduced = drop_loads(motion), rotor_of(case).finite_elements
    error = None
    if reduced is not None:
        error = reduction_error(
            reduced, loads, lambda finer: release(replace(case, parameters=finer.limited), drop())[:2]
        )
    return DropStudy(case, echo, loads, error, motion)


def release(case: Case, released: Drop) -> tuple[Rotor, State, Echo]:
    """The rotor that falls, its start, and what was taken of a release.

    Raises
    ------
    InputError
        As of :meth:`carom.disturbances.Drop.apply`.
    """
    rotor, state = released.apply(case)
    return rotor, state, released.echo_at(rotor_of(case), rotor, state, case.gravity)
