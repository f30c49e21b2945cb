"""Create a store without chunks: its arrays, their attributes, and the plan it belongs to."""

from __future__ import annotations

import json
import platform
import warnings
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from carom.base.files import sync_directory, unfinished
from carom.base.outcome import InputError
from carom.base.results import flags
from carom.core.compiling.target import processor
from carom.sweeps.chunk_record import RECORDS
from carom.sweeps.plan import SweepPlan
from carom.sweeps.versions import other_version, versions

OPTION, ROOT = "--out", "zarr.json"
"""Name of the directory in errors, and of the file that describes what a store holds."""
PARTS = ".parts"


def is_new(path: Path) -> bool:
    """Whether a store must be created; refuse a directory that holds something else."""
    if not path.exists():
        return True
    if not path.is_dir():
        raise InputError(OPTION, path, "must be a directory, existing or new; this is a file")
    if _is_store(path):
        return False
    if any(path.iterdir()):
        raise InputError(OPTION, path, "holds something other than a sweep; give another directory")
    return True


def _is_store(path: Path) -> bool:
    """Whether a directory holds a store, intact or damaged."""
    return (path / ROOT).exists() or (path / RECORDS).exists()


def attributes_of(path: Path, option: str) -> dict[str, Any]:
    """Return the attributes of a store; refuse a directory without one, or with damaged metadata."""
    if not _is_store(path):
        raise InputError(option, path, "must be a directory that a sweep was written to")
    try:
        attributes = json.loads((path / ROOT).read_bytes())["attributes"]
        if attributes["plan_digest"] and attributes["versions"]:
            return dict(attributes)
    except (FileNotFoundError, ValueError, LookupError, TypeError, RecursionError):
        pass
    remedy = "restore it from a backup, or start anew in another directory"
    raise InputError(option, path, f"its file {ROOT} is damaged, missing or not of a sweep; {remedy}")


def check_same(path: Path, plan: SweepPlan) -> None:
    """Refuse a store with another plan, with other versions, or with damage outside its chunks."""
    attributes = attributes_of(path, OPTION)
    there, wanted = json.loads(attributes["plan"]), json.loads(json.dumps(plan.describe()))
    if there != wanted:
        where = ", ".join(key for key in {**there, **wanted} if there.get(key) != wanted.get(key))
        raise InputError(OPTION, path, f"belongs to another plan (another {where}); give another directory")
    if other := other_version(attributes["versions"], versions()):
        name, then, now = other
        allowed = f"was begun with {name} {then}, this is {now}; resume it with {then}, or start anew"
        raise InputError(OPTION, path, allowed)


def create(path: Path, plan: SweepPlan) -> None:
    """Create the store in a staging directory and move it into place, unless another sweep has just created it."""
    home = path.absolute().parent
    home.mkdir(parents=True, exist_ok=True)
    try:
        with unfinished(home, folder=True) as made:
            _lay_out(made, plan)
            made.rename(path)
            sync_directory(home)
    except OSError:
        if not (path.is_dir() and _is_store(path)):
            raise


def description_of(plan: SweepPlan) -> dict[str, object]:
    """Return the attributes of the results of a plan."""
    return {
        "Conventions": "CF-1.11",
        "title": f"Sweep of {plan.name}: {plan.task.kind}",
        "source": f"carom {versions()['carom']}",
        "history": f"{datetime.now(UTC):%Y-%m-%dT%H:%M:%SZ} begun",
        "versions": versions() | {"python": platform.python_version()},
        "processor": processor(),
        "seed": plan.seed,
        "plan": json.dumps(plan.describe()),
        "plan_digest": plan.digest,
        **plan.sources,
    }


def coordinates_of(plan: SweepPlan) -> dict[str, tuple[np.ndarray, dict[str, Any]]]:
    """Return the values and attributes of each axis and of each further dimension of a plan."""
    found = {}
    for axis in plan.axes:
        found[axis.name] = axis.values, {"long_name": axis.field.words, "units": axis.field.unit or "1"}
    for further in {variable.along for variable in plan.variables if variable.along}:
        meanings = flags(list(further.values), further.flags)
        found[further.name] = np.array(further.values, np.int8), {"long_name": further.words, **meanings}
    return found


def _lay_out(path: Path, plan: SweepPlan) -> None:
    import zarr
    from zarr.codecs import Crc32cCodec

    names = [axis.name for axis in plan.axes]
    group = zarr.create_group(path, zarr_format=3, attributes=description_of(plan))
    add = partial(group.create_array, compressors=Crc32cCodec())
    for name, (values, words) in coordinates_of(plan).items():
        size = values.shape
        add(name, shape=size, chunks=size, dtype=values.dtype, dimension_names=[name], attributes=words)[:] = values
    for variable in plan.variables:
        add(
            variable.name,
            shape=plan.shape + variable.shape,
            chunks=plan.chunk_shape + variable.shape,
            dtype=variable.dtype,
            fill_value=variable.fill,
            dimension_names=[*names, variable.along.name] if variable.along else names,
            attributes=variable.attributes,
            filters=None,
        )
    with warnings.catch_warnings():
        # Zarr warns that its specification 3 does not describe consolidated metadata yet, which spare readers a search.
        warnings.simplefilter("ignore")
        zarr.consolidate_metadata(path)
