"""Basins and gain maps as JSON documents.

Times are in ``1/Ω`` and lengths in ``c_r``, in the co-rotating frame, unless the key ends in ``_si``.  Such keys exist
where the machine is known.
"""

from __future__ import annotations

import json
import math

import numpy as np

from carom.attractors import MotionName
from carom.base.outcome import Outcome
from carom.base.results import Column, in_si, record
from carom.basins.classification import Basin
from carom.basins.drops import MEASURES, DropMap
from carom.basins.maps import WANTED, GainMap
from carom.basins.shares import Share
from carom.basins.sizes import SmallestUnrecovered, contact_free_size
from carom.disturbances import BaseShock, BladeLoss
from carom.disturbances.plans import plan_words
from carom.parameters import Case, in_terms_of
from carom.parameters.formats import format_quantity, number
from carom.parameters.scaling import SCALING


def _interval(name: MotionName, basin: Basin) -> str:
    share = basin.share_of(name)
    return f"{100 * share.low:.3g} to {100 * share.high:.3g} %" if share.drawn else ""


def _decided(name: MotionName, basin: Basin) -> str:
    index, times = basin.dataset["motion"].values, basin.dataset["time"].values
    return format_quantity(float(np.median(times[index == basin.motions.index(name)])), "time", basin.scales)


MOTION = (
    Column("", "where they end", lambda name, _: name.words),
    Column("", "starts", lambda name, basin: str(basin.share_of(name).count)),
    Column("", "share", lambda name, basin: f"{100 * basin.share_of(name).fraction:.4g} %"),
    Column("", "95 % interval", _interval),
    Column("", "decision time (median)", _decided),
)
"""Of each motion, by its name, what people see of a basin."""


def _of(measure: str, name: MotionName, found: DropMap) -> np.ndarray:
    values: np.ndarray = found.dataset[measure].values[found.dataset["motion"].values == found.motions.index(name)]
    return values


def _loads(name: MotionName, found: DropMap) -> str:
    loads = _of(found.hardest, name, found)
    return f"{number(float(loads.min()), 3)} to {number(float(loads.max()), 3)}"


def _settled(name: MotionName, found: DropMap) -> str:
    since = _of("settled_at", name, found)
    known = sorted(since[np.isfinite(since)].tolist())
    return f"{number(1e3 * known[len(known) // 2], 3)} ms" if known else ""


DROPPED = (
    Column("", "how they end", lambda name, _: name.words),
    Column("", "drops", lambda name, found: str(len(_of("time", name, found)))),
    Column("", "share", lambda name, found: f"{100.0 * found.fractions[name]:.3g} %"),
    Column("", "{0.hardest_words}", _loads),
    Column("", "at rest or whirling since (median)", _settled),
)
"""Of each motion, by its name, what people see of a map of drops."""
LOSS = (
    "{name}=size{kind} {name}_bracket=bracket{kind} {name}_angle=angle {name}_instant=instant {name}_outcome=outcome.label "
    "{name}_tolerance=tolerance {several}_tried=tried {several}_tried_afresh=fresh {several}_lost_below=share_below"
)
"""Of the smallest unrecovered size."""


def basin_document(
    basin: Basin,
    smallest: SmallestUnrecovered | None,
    contact_free: float,
    gains: GainMap | None = None,
    in_terms_of: Case | None = None,
) -> dict[str, object]:
    """Document of all results about a basin.

    The smallest unrecovered one is of the same kind of disturbance; ``None`` if that has no size, or if there is no levitation to
    return to.  Kicks up to the speed ``contact_free`` provably never reach the wall.  With a machine ``in_terms_of``, the values of a gain map are there in the terms of its file too.
    """
    scales, attributes = basin.scales, basin.dataset.attrs
    document: dict[str, object] = {
        **record(basin, "starts fractions beyond_model unresolved irregular"),
        **_loss(smallest, basin, "kick"),
        "harmless_kick": contact_free,
        "recovered": _share(basin.share_recovered),
        "share": basin.share_recovered.document(),
        "touching": int(basin.touched.sum()),
        "touching_recovered": int((basin.touched & basin.recovered).sum()),
        **basin.rotor.document(),
        "disturbances": {
            **json.loads(attributes["disturbances"]),
            "words": plan_words(basin.plan, basin.rotor.value("rho"), scales, at=basin.instants),
        },
        "criteria": attributes["criteria"],
        "source": attributes["source"],
    }
    document |= in_si(document, scales, harmless_kick="velocity")
    if scales is not None:
        document["scales_si"] = record(scales, " ".join(SCALING))
    model = basin.plan.model
    if smallest is not None and smallest.kind != "kick":
        document |= _loss(smallest, basin, smallest.kind)
    proven: dict[str, float] = {}
    if isinstance(model, BladeLoss | BaseShock):
        proven[f"harmless_{model.kind.replace('-', '_')}"] = contact_free_size(basin.rotor, model)
    kind = "acceleration" if isinstance(model, BaseShock) else "unbalance"
    document |= proven | in_si(proven, scales, **dict.fromkeys(proven, kind))
    if gains is not None:
        terms = {} if in_terms_of is None else {"terms": _terms(gains, in_terms_of)}
        document["gains"] = _gains(gains) | terms
    return document


def _loss(smallest: SmallestUnrecovered | None, basin: Basin, kind: str) -> dict[str, object]:
    """Entries of the smallest unrecovered size of a kind; all ``None`` if it was not searched."""
    found = smallest if smallest is not None and smallest.kind == kind else None
    key = kind.replace("-", "_")
    name = f"smallest_unrecovered_{key}"
    several = f"{key}es" if key.endswith("s") else f"{key}s"
    quantity = found.quantity if found else "velocity"
    columns = LOSS.format(name=name, several=several, kind=f":{quantity}" if quantity else "")
    return record(found, columns, basin.scales)


def _share(share: Share) -> dict[str, object]:
    method = "Clopper-Pearson, 95 %" if share.drawn else "grid, cells weighted by area"
    return record(share, "fraction count low high") | {"method": method}


def _terms(gains: GainMap, case: Case) -> list[dict[str, object]]:
    """Both parameters of a gain map in the terms of a machine's file: entry, unit and values."""
    shown = []
    for varied in gains.axes:
        stated = [in_terms_of(case, varied.name, float(value), digits=6) for value in gains.dataset[varied.name].values]
        shown.append(record(stated[0], "entry unit") | {"values": [each.value for each in stated]})
    return shown


def _gains(gains: GainMap) -> dict[str, object]:
    first, second = gains.axes
    return {
        "parameters": [first.name, second.name],
        "units": [first.field.unit, second.field.unit],
        "values": [gains.dataset[first.name].values.tolist(), gains.dataset[second.name].values.tolist()],
        "recovered": np.round(gains.dataset["recovered"].values, 12).tolist(),
        "levitates": (gains.dataset["levitates"].values > 0.0).tolist(),
        "present": list(gains.present),
        "present_recovered": _share(gains.present_share),
        "machines_reaching": int((gains.dataset["recovered"].values >= WANTED).sum()),
        "machines_sure": int((gains.dataset["recovered_low"].values >= WANTED).sum()),
    }


def drop_map_document(found: DropMap) -> dict[str, object]:
    """Document of a map of drops: how many end in which motion, what exceeds limits, and all numbers in SI units, by rows of the first."""
    dataset, first = found.dataset, found.dataset["outcome"]
    labels = ["no-start" if code < 0 else Outcome(int(code)).label for code in first.values.ravel()]
    columns = first.shape[1]
    grids = {
        f"{name}_si" if unit != "1" else name: _grid(dataset[name].values) for name, (unit, *_) in MEASURES.items()
    }
    return {
        "plane": {name: dataset[name].values.tolist() for name in map(str, first.dims)},
        "units": {name: str(dataset[name].attrs["units"]) for name in map(str, first.dims)},
        "present": [None if math.isnan(value) else value for value in found.present],
        "released": dataset.attrs["released"],
        "drops": int(found.exists.sum()),
        "fractions": {str(name): share for name, share in found.fractions.items()},
        "hardest": found.worst,
        "drops_still_growing": int(found.still_growing.sum()),
        "limits": [
            {"name": name, "limit_si": limit, "exceeding": int(found.exceeding(name).sum())}
            for name, limit in found.limits.items()
        ],
        "outcomes": [labels[start : start + columns] for start in range(0, len(labels), columns)],
        **grids,
        "source": dataset.attrs["source"],
    }


def _grid(values: np.ndarray) -> list[list[float | None]]:
    """Numbers by rows, nothing where there is none."""
    return [[None if math.isnan(value) else value for value in row] for row in values.tolist()]
