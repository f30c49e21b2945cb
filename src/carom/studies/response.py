"""Unbalance response over the speed of the shaft, with contact where the rotor touches."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from importlib.metadata import version
from typing import Any, ClassVar

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.base.results import in_a_line
from carom.closed_forms import contact_changes, find_equilibria, rolling, rub_angles
from carom.closed_forms.exact_results import exact_results
from carom.models import Axis, Rotor, Subject, axis, case_of, rotor_of
from carom.models.axes import Ends, read_interval
from carom.parameters import read_quantity
from carom.parameters.fields import RPM
from carom.rotors.synchronous import SynchronousResponse
from carom.studies.critical_speeds import response_curve, usual_range
from carom.studies.levitating import WHIRLS, whirls_of
from carom.studies.response_data import ResponseData, Rubs, SpeedStretch, Steady, stretches_between
from carom.studies.standards import ASSUMPTIONS, FULL_SPEED, vibration_limit

RUB_SPEEDS = 121
"""About as many speeds of the curve at which rubs are looked for."""
NARROWED = 1e-6
"""Relative width to which ends of stretches without a closed form are bisected."""


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
        return _document(self)


@checked
def unbalance_response(
    machine: Subject, interval: Ends | None = None, *, operating: Ends | None = None
) -> UnbalanceResponse:
    """Response to the unbalance over the speed of the shaft, with contact where the rotor touches.

    The contact-free response is linear (:func:`~carom.rotors.synchronous_response`).  Where it would leave the clearance it is virtual, and the rotor runs in contact.  The synchronous rubs in one
    touchdown bearing are given with their stability; bouncing is not, see :func:`~carom.find_bifurcations` along ``"speed"``.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        Any rotor with mass, clearance and speed.  Mass, damping, stiffness and unbalance stay the same in SI units at every speed.
    interval : tuple of float or str, optional
        Range of speeds in rad/s, or text such as ``("500 rpm", "12000 rpm")``.
    operating : tuple of float or str, optional
        Lowest and highest operating speed, for the separation margin; by default the present speed.

    Raises
    ------
    InputError
        A rotor without scales, or a range that cannot be read.

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> response = cm.studies.unbalance_response(machine, ("500 rpm", "4000 rpm"))
    >>> round(response.criticals[0].factor, 3)
    4.797
    """
    case = case_of(machine)
    model = rotor_of(case)
    if model.scales is None:
        allowed = "needed for a response over speed: use a file with a [machine] table, or parameters with scales"
        raise InputError("scales", None, allowed)
    along, present, whirls = axis(case, "speed"), model.scales.speed, whirls_of(model, 4 * WHIRLS)
    run = (present, present) if operating is None else _read_operating(along, operating)
    low, high = read_interval(along, interval or usual_range(whirls, run))
    whirl, criticals = response_curve(case, whirls, (low, high), run, (low, high, present, FULL_SPEED))
    exact = exact_results(model).rubs
    found = UnbalanceResponse(case, whirl, (low, high), run, criticals, None, (), exact)
    rubs = _rubs(found, model, along)
    return replace(found, rubs=rubs, stretches=_stretches(replace(found, rubs=rubs), model, along))


def _rubs(found: ResponseData, model: Rotor, along: Axis) -> Rubs | None:
    """Synchronous rubs over the speed in one touchdown bearing, where nothing stands in the fixed frame."""
    system = model.system
    if found.exact:
        angles = rub_angles(found.case, found.speeds)
        return Rubs(found.speeds, -angles % math.tau, np.where(np.isnan(angles), np.nan, 1.0))
    if len(system.contacts) > 1 or system.outer.any() or system.is_anisotropic or system.shaft is not None:
        return None
    speeds = found.speeds[:: max(1, len(found.speeds) // RUB_SPEEDS)]
    lags, radii = np.full((2, 2, len(speeds)), np.nan)
    for place, speed in enumerate(speeds.tolist()):
        moved = along.move(model, speed)
        for rub in find_equilibria(moved).members[1:]:
            if rub.status == "admissible":
                which = 0 if rub.stable else 1
                lags[which, place] = (moved.unbalance_phase - rub.angle) % math.tau
                radii[which, place] = rub.radius
    return Rubs(speeds, lags, radii)


def _stretches(found: ResponseData, model: Rotor, along: Axis) -> tuple[SpeedStretch, ...]:
    """Ranges of speeds with the same steady motions; their ends are exact, or bisected between the speeds at which rubs were looked for."""

    def steady(speed: float) -> Steady:
        clear = bool(found.at(speed).reach.max() < 1.0)
        if found.rubs is None:
            return Steady(clear, None, None, None)
        moved = along.move(model, speed)
        pushed = [rub.stable for rub in find_equilibria(moved).members[1:] if rub.status == "admissible"]
        rolls = rolling(moved).holds if found.exact and moved.has_closed_forms else None
        return Steady(clear, sum(pushed), len(pushed) - sum(pushed), rolls)

    if found.exact:
        return stretches_between(found.interval, contact_changes(found.case), steady)
    edges = found.reaching(1.0)
    if found.rubs is not None:
        edges += _bisected(found.rubs.speeds.tolist(), lambda speed: steady(speed)[1:])
    return stretches_between(found.interval, edges, steady)


def _bisected(speeds: Iterable[float], what: Any) -> list[float]:
    """Speeds at which something changes, between neighbouring ones at which it differs."""
    edges, before = [], None
    for speed in speeds:
        here = what(speed)
        if before is not None and before[1] != here:
            low, high = before[0], speed
            while high - low > NARROWED * high:
                middle = 0.5 * (low + high)
                low, high = (middle, high) if what(middle) == before[1] else (low, middle)
            edges.append(0.5 * (low + high))
        before = speed, here
    return edges


def _read_operating(along: Axis, given: Ends) -> tuple[float, float]:
    """Read the operating speeds; both may be the same."""
    low, high = (read_quantity(along.field, end) for end in given)
    if low > high:
        raise InputError("operating", f"{low:g} to {high:g}", "the lowest operating speed, then the highest")
    return low, high


def _document(response: UnbalanceResponse) -> dict[str, Any]:
    """Return the document of a response over speed: speeds in rad/s and rpm, amplitudes in clearances and in m."""
    rubs = response.rubs
    highest = max(response.criticals, key=lambda each: each.amplitude, default=None)
    return {
        "name": response.case.name,
        "carom": version("carom"),
        **rotor_of(response.case).document(),
        "speeds_si": list(response.interval),
        "present": _at(response, response.present) | {"steady": response.steady_at_present._asdict()},
        "critical": None if highest is None else _at(response, highest.speed),
        "amplification_factor": highest.factor if highest else None,
        "criticals": [each.document() for each in response.criticals],
        "operating_si": list(response.operating),
        "zone_limits": list(response.case.zones.limits),
        "exceeds_api_617": [_stretch(entry) for entry in response.exceeds_api_617 if entry.what],
        "saturates": [_stretch(entry) for entry in response.saturating if entry.what],
        "steady": [_stretch(entry) | entry.what._asdict() for entry in response.stretches],
        "curve": {
            "speed_si": response.speeds.tolist(),
            "amplitude": response.amplitude.tolist(),
            "peak_to_peak_si": response.peak_to_peak_si.tolist(),
            "api_617_limit_si": vibration_limit(response.speeds).tolist(),
        },
        "touchdowns": _bearings(response.whirl),
        "rubs": rubs and {"speed_si": rubs.speeds.tolist(), "lags": rubs.lags.tolist(), "radii": rubs.radii.tolist()},
        "words": list(response.words),
        "assumptions": list(ASSUMPTIONS),
    }


def _at(response: ResponseData, speed: float) -> dict[str, Any]:
    """Contact-free response at a speed: that of the touchdown bearing where the rotor comes closest, then those of all."""
    found = response.at(speed)
    worst = int(found.reach[0].argmax())
    size = float(found.touchdowns.major[0, worst])
    return {
        "speed_si": speed,
        "rpm": speed / RPM,
        "amplitude": size / float(found.clearances[worst]),
        "peak_to_peak_si": 2.0 * size,
        "lag": float(found.lags[0, worst]),
        "admissible": bool(found.reach.max() < 1.0),
        "zone": response.zone_at(speed) or None,
        "api_617_limit_si": float(vibration_limit(np.array(speed))),
        "touchdowns": _bearings(found),
        "saturation": float(found.saturation.max()) if found.saturation.size else None,
    }


def _bearings(found: SynchronousResponse) -> list[dict[str, Any]]:
    """Amplitudes 0-to-peak at each touchdown bearing, from 1 on, over the speeds of a response."""
    places = zip(found.clearances.tolist(), found.sags.tolist(), strict=True)
    return [
        {
            "bearing": place + 1,
            "clearance_si": clearance,
            "sag_si": sag,
            "amplitude_si": found.touchdowns.major[:, place].tolist(),
            "forward_si": np.abs(found.touchdowns.forward[:, place]).tolist(),
            "backward_si": np.abs(found.touchdowns.backward[:, place]).tolist(),
            "lag": found.lags[:, place].tolist(),
        }
        for place, (clearance, sag) in enumerate(places)
    ]


def _stretch(stretch: SpeedStretch) -> dict[str, Any]:
    return {"from_si": stretch.low, "to_si": stretch.high, "from_rpm": stretch.low / RPM, "to_rpm": stretch.high / RPM}
