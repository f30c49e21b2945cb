"""A response over speed as JSON: the document that ``carom response --json`` prints."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import version
from typing import Any

import numpy as np

from carom.closed_forms import SynchronousResponse
from carom.models import rotor_of
from carom.parameters.fields import RPM
from carom.results import fields_of
from carom.studies.response_data import ResponseData, Stretch
from carom.studies.standards import ASSUMPTIONS, vibration_limit


def response_document(response: ResponseData, words: Sequence[str]) -> dict[str, Any]:
    """Return the document of a response over speed: speeds in rad/s and rpm, amplitudes in clearances and in m."""
    free, margin, rubs = response.contact_free, response.separation, response.rubs
    highest = max(response.criticals, key=lambda each: each.amplitude, default=None)
    numbers = ("amplification_factor", "damping_ratio", "half_power", "natural_frequency")
    own = dict.fromkeys(numbers) if free is None else fields_of(free, *numbers)
    return {
        "name": response.case.name,
        "carom": version("carom"),
        **rotor_of(response.case).document(),
        "speeds_si": list(response.interval),
        "present": _at(response, response.present) | {"steady": response.steady_at_present._asdict()},
        "critical": None if highest is None else _at(response, highest.speed),
        "half_power_si": None if own["half_power"] is None else list(own["half_power"]),
        "amplification_factor": highest.factor if highest else None,
        "damping_ratio": own["damping_ratio"],
        "natural_frequency_si": own["natural_frequency"],
        "criticals": [
            fields_of(each, "bearing", amplification_factor="factor", speed_si="speed", amplitude_si="amplitude")
            | {"rpm": each.speed / RPM, "separation": fields_of(each.separation, "side", "actual", "required", "met")}
            for each in response.criticals
        ],
        "operating_si": list(response.operating),
        "separation": None if margin is None else fields_of(margin, "side", "actual", "required", "met"),
        "zone_limits": list(response.case.zones.limits),
        "zones": [_stretch(entry) | {"zone": entry.what or None} for entry in response.zones],
        "exceeds_api_617": [_stretch(entry) for entry in response.exceeds_api_617 if entry.what],
        "saturates": [_stretch(entry) for entry in response.saturating if entry.what],
        "steady": [_stretch(entry) | entry.what._asdict() for entry in response.stretches],
        "curve": {
            "speed_si": response.speeds.tolist(),
            "amplitude": response.amplitude.tolist(),
            "peak_to_peak_si": response.peak_to_peak_si.tolist(),
            "lag": response.lag.tolist(),
            "stable_rub_lag": _over_curve(response, 0),
            "unstable_rub_lag": _over_curve(response, 1),
            "api_617_limit_si": vibration_limit(response.speeds).tolist(),
        },
        "touchdowns": _bearings(response.whirl),
        "rubs": None
        if rubs is None
        else {
            "speed_si": rubs.speeds.tolist(),
            "stable_radius": rubs.radii[0].tolist(),
            "unstable_radius": rubs.radii[1].tolist(),
        },
        "words": list(words),
        "assumptions": list(ASSUMPTIONS),
    }


def _over_curve(response: ResponseData, which: int) -> list[float]:
    """Lags of rubs at the speeds of the curve; NaN where there is none or none was looked for."""
    lags, rubs = np.full(len(response.speeds), np.nan), response.rubs
    if rubs is not None:
        lags[np.searchsorted(response.speeds, rubs.speeds)] = rubs.lags[which]
    found: list[float] = lags.tolist()
    return found


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


def _stretch(stretch: Stretch) -> dict[str, Any]:
    return {"from_si": stretch.low, "to_si": stretch.high, "from_rpm": stretch.low / RPM, "to_rpm": stretch.high / RPM}
