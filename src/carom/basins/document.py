"""Basins and gain maps as JSON documents.

Times are in ``1/Ω`` and lengths in ``c_r``, in the co-rotating frame, unless the key ends in ``_si``; those keys are there
where the machine is known.
"""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from carom.basins.changes import GainChange
from carom.basins.classification import Basin
from carom.basins.entropy import basin_entropy
from carom.basins.gains import GainMap
from carom.basins.integrity import integrity
from carom.basins.kicks import SmallestKick, harmless_shock
from carom.basins.shares import Share
from carom.disturbances import BaseShock
from carom.outcome import InputError

__all__ = ["basin_document"]


def basin_document(
    basin: Basin,
    smallest: SmallestKick | None,
    harmless: float,
    gains: GainMap | None = None,
    change: GainChange | None = None,
) -> dict[str, Any]:
    """Everything known of a basin.

    Parameters
    ----------
    basin : Basin
    smallest : SmallestKick or None
        ``None`` if no kick tried is lost, or there is no levitation to be kicked out of.
    harmless : float
        Speed up to which kicks provably never reach the wall.
    gains : GainMap, optional
    change : GainChange, optional
        Least change of the two parameters that reaches the wanted share.
    """
    scales = basin.scales
    attributes = basin.dataset.attrs
    document: dict[str, Any] = {
        "starts": basin.starts,
        "fractions": basin.fractions,
        "unresolved": basin.unresolved,
        "smallest_unrecovered_kick": smallest.speed if smallest else None,
        "smallest_unrecovered_kick_angle": smallest.angle if smallest else None,
        "smallest_unrecovered_kick_outcome": smallest.outcome.label if smallest else None,
        "smallest_unrecovered_kick_tolerance": smallest.tolerance if smallest else None,
        "kicks_tried": smallest.tried if smallest else None,
        "harmless_kick": harmless,
        "recovered": _share(basin.share_recovered),
        "integrity": _integrity(basin),
        "basin_entropy": _entropy(basin),
        "parameters": basin.parameters.as_dict(),
        "disturbances": json.loads(attributes["disturbances"]),
        "criteria": attributes["criteria"],
        "source": attributes["source"],
    }
    if scales is not None:
        document["smallest_unrecovered_kick_si"] = smallest.speed * scales.velocity if smallest else None
        document["harmless_kick_si"] = harmless * scales.velocity
        document["scales_si"] = {name: getattr(scales, name) for name in ("mass", "clearance", "speed")}
    model = basin.plan.model
    if isinstance(model, BaseShock):
        document["harmless_shock"] = harmless_shock(basin.rotor, model.duration)
        if scales is not None:
            document["harmless_shock_si"] = document["harmless_shock"] * scales.acceleration
    if gains is not None:
        document["gains"] = _gains(gains, change)
    return document


def _share(share: Share) -> dict[str, Any]:
    return {
        "fraction": share.fraction,
        "low": share.low,
        "high": share.high,
        "method": "Wilson, 95 %" if share.drawn else "grid, no sampling error",
    }


def _integrity(basin: Basin) -> dict[str, Any] | None:
    try:
        found = integrity(basin)
    except InputError:
        return None
    return {"local": found.local, "largest": found.largest, "whole": found.whole}


def _entropy(basin: Basin) -> dict[str, Any] | None:
    try:
        found = basin_entropy(basin)
    except InputError:
        return None
    return {"whole": found.whole, "boundary": found.boundary, "side": found.side, "fractal": found.fractal}


def _gains(gains: GainMap, change: GainChange | None) -> dict[str, Any]:
    first, second = gains.axes
    return {
        "parameters": [first.name, second.name],
        "units": [first.field.unit, second.field.unit],
        "values": [gains.dataset[first.name].values.tolist(), gains.dataset[second.name].values.tolist()],
        "recovered": np.round(gains.dataset["recovered"].values, 12).tolist(),
        "levitates": (gains.dataset["levitates"].values > 0.0).tolist(),
        "present": list(gains.present),
        "present_recovered": _share(gains.present_share),
        "least_change": None
        if change is None
        else {
            "wanted": change.wanted,
            "values": list(change.values),
            "changes": list(change.changes),
            "recovered": _share(change.share),
        },
    }
