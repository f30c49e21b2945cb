"""A response over speed as JSON: the document that ``carom response --json`` prints."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import version
from typing import Any

import numpy as np

from carom.parameters.fields import RPM
from carom.results import fields_of
from carom.studies.response_data import ResponseData, Stretch
from carom.studies.standards import ASSUMPTIONS, vibration_limit


def response_document(response: ResponseData, words: Sequence[str]) -> dict[str, Any]:
    """Return the document of a response over speed: speeds in rad/s and rpm, amplitudes in clearances and in m."""
    free, margin = response.contact_free, response.separation
    return {
        "name": response.case.name,
        "carom": version("carom"),
        "parameters": response.case.parameters.as_dict(),
        "speeds_si": list(response.interval),
        "present": _at(response, response.present) | {"steady": response.steady_at_present._asdict()},
        "critical": None if free.critical_speed is None else _at(response, free.critical_speed),
        "half_power_si": None if free.half_power is None else list(free.half_power),
        **fields_of(free, "amplification_factor", "damping_ratio", natural_frequency_si="natural_frequency"),
        "operating_si": list(response.operating),
        "separation": None if margin is None else fields_of(margin, "side", "actual", "required", "met"),
        "zone_limits": list(response.case.zones.limits),
        "zones": [_stretch(entry) | {"zone": entry.what or None} for entry in response.zones],
        "exceeds_api_617": [_stretch(entry) for entry in response.exceeds_api_617 if entry.what],
        "steady": [_stretch(entry) | entry.what._asdict() for entry in response.stretches],
        "curve": {
            "speed_si": response.speeds.tolist(),
            "amplitude": np.abs(response.displacement).tolist(),
            "peak_to_peak_si": response.peak_to_peak_si.tolist(),
            "lag": response.lag.tolist(),
            "stable_rub_lag": response.rub_lags[0].tolist(),
            "unstable_rub_lag": response.rub_lags[1].tolist(),
            "api_617_limit_si": vibration_limit(response.speeds).tolist(),
        },
        "words": list(words),
        "assumptions": list(ASSUMPTIONS),
    }


def _at(response: ResponseData, speed: float) -> dict[str, Any]:
    """Contact-free response at a speed."""
    place = complex(response.contact_free.displacement(np.array(speed)))
    return {
        "speed_si": speed,
        "rpm": speed / RPM,
        "amplitude": abs(place),
        "peak_to_peak_si": 2.0 * response.scales.clearance * abs(place),
        "lag": -float(np.angle(place)),
        "admissible": abs(place) < 1.0,
        "zone": response.zone_at(speed) or None,
        "api_617_limit_si": float(vibration_limit(np.array(speed))),
    }


def _stretch(stretch: Stretch) -> dict[str, Any]:
    return {"from_si": stretch.low, "to_si": stretch.high, "from_rpm": stretch.low / RPM, "to_rpm": stretch.high / RPM}
