"""Datasets as netCDF files, whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from carom.outcome import InputError

if TYPE_CHECKING:
    import xarray

__all__ = ["load", "save"]

COMPRESSION = {"zlib": True, "complevel": 2, "shuffle": True}


def save(dataset: xarray.Dataset, path: str | os.PathLike[str]) -> None:
    """Write a dataset under another name first: the file is there complete, or as it was.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    target = Path(path)
    part = target.with_name(f".{target.name}.{os.getpid()}.part")
    try:
        dataset.to_netcdf(
            part, engine="h5netcdf", encoding={str(name): dict(COMPRESSION) for name in dataset.data_vars}
        )
        part.replace(target)
    except OSError as problem:
        reason = os.strerror(problem.errno) if problem.errno else "this file system refuses"
        raise InputError("file", str(path), f"cannot be written ({reason}); give another path") from None
    finally:
        with suppress(OSError):
            part.unlink(missing_ok=True)


def load(path: str | os.PathLike[str], needed: Sequence[str]) -> xarray.Dataset:
    """Read a dataset into memory.

    Parameters
    ----------
    path : path
    needed : sequence of str
        Variables that must be there.

    Raises
    ------
    InputError
        The file cannot be read or is another one.
    """
    import xarray

    try:
        with xarray.open_dataset(path, engine="h5netcdf") as opened:
            dataset = opened.load()
        for variable in dataset.variables.values():
            if "flag_values" in variable.attrs:  # a single one comes back as a number
                variable.attrs["flag_values"] = np.atleast_1d(variable.attrs["flag_values"])
    except (OSError, ValueError) as problem:
        reason = os.strerror(problem.errno) if isinstance(problem, OSError) and problem.errno else "not netCDF"
        raise InputError("file", str(path), f"cannot be read ({reason})") from None
    if any(name not in dataset for name in needed):
        raise InputError("file", str(path), f"must hold the variables {', '.join(needed)}")
    return dataset
