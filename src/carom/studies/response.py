"""Unbalance response over the speed of the shaft, with contact where the rotor touches."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from carom.arguments import checked
from carom.closed_forms import speed_response
from carom.models import Axis, Subject, axis, case_of
from carom.models.axes import Ends, read_interval
from carom.outcome import InputError
from carom.parameters import read_quantity
from carom.parameters.fields import RPM
from carom.results import in_a_line
from carom.studies.response_data import ResponseData, steady_at, stretches_between

SPEEDS = 801
"""Number of speeds of the curves."""
AROUND = (0.25, 1.5)
"""Default range: these multiples of the smaller and of the larger one of critical and operating speed."""


@dataclass(frozen=True, eq=False, repr=False)
class UnbalanceResponse(ResponseData):
    """Response of a machine to its unbalance over the speed of the shaft.

    Its attributes are those of :class:`~carom.studies.response_data.ResponseData`.
    """

    figure: ClassVar[str] = "unbalance_response"

    def rows(self) -> list[tuple[str, str]]:
        """The machine, the range, and what is said of it."""
        ends = " to ".join(f"{speed / RPM:,.6g}" for speed in self.interval)
        return [("case", self.case.name), ("speeds", f"{ends} rpm"), *(("", in_a_line(line)) for line in self.words)]

    @cached_property
    def words(self) -> tuple[str, ...]:
        """What the response says about the machine, in sentences."""
        from carom.studies.response_words import sentences  # only here: a study does without

        return sentences(self)

    def to_dict(self) -> dict[str, Any]:
        """Return the response as ``carom response --json`` prints it."""
        from carom.studies.response_document import response_document  # only here: a study does without

        return response_document(self, self.words)


@checked
def unbalance_response(
    machine: Subject, interval: Ends | None = None, *, operating: Ends | None = None
) -> UnbalanceResponse:
    """Response to the unbalance over the speed of the shaft, with contact where the rotor touches.

    The contact-free response is linear and known in closed form (:func:`~carom.closed_forms.speed_response`).  Where it
    would leave the clearance it is virtual, and the rotor runs in contact.  The steady motions in contact are given with
    their stability; bouncing is not, see :func:`~carom.find_bifurcations` along ``"speed"``.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        The planar rotor, with mass, clearance and speed.  Mass, damping, stiffness and eccentricity stay the same in SI
        units at every speed.
    interval : tuple of float or str, optional
        Range of speeds in rad/s, or text such as ``("500 rpm", "12000 rpm")``.
    operating : tuple of float or str, optional
        Lowest and highest operating speed, for the separation margin; by default the present speed.

    Raises
    ------
    InputError
        Another model, a rotor without scales, or a range that cannot be read.

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> response = cm.studies.unbalance_response(machine, ("500 rpm", "4000 rpm"))
    >>> round(response.contact_free.amplification_factor, 3)
    4.797
    """
    case = case_of(machine)
    free = speed_response(case)
    along = axis(case, "speed")
    present = along.value(free.rotor)
    run = (present, present) if operating is None else _read_operating(along, operating)
    known = [free.critical_speed or free.natural_frequency, *run]
    low, high = read_interval(along, interval or (AROUND[0] * min(known), AROUND[1] * max(known)))
    marks = [speed for speed in (free.critical_speed, present, *free.contact_changes()) if speed is not None]
    speeds = np.unique([*np.linspace(low, high, SPEEDS), *(speed for speed in marks if low <= speed <= high)])
    steady = stretches_between((low, high), free.contact_changes(), lambda speed: steady_at(case, along, speed))
    return UnbalanceResponse(
        case, free, (low, high), run, speeds, free.displacement(speeds), free.rub_angles(speeds), steady
    )


def _read_operating(along: Axis, given: Ends) -> tuple[float, float]:
    """Read the operating speeds; both may be the same."""
    low, high = (read_quantity(along.field, end) for end in given)
    if low > high:
        raise InputError("operating", f"{low:g} to {high:g}", "the lowest operating speed, then the highest")
    return low, high
