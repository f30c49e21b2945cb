"""Datasets as netCDF files, written atomically and with a checksum.

The checksum is appended to the file, where readers of netCDF ignore it.  Without it a changed number would go
unnoticed, and the library that reads the file is not robust against damaged ones.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from carom.base.files import write_whole
from carom.base.outcome import InputError

if TYPE_CHECKING:
    import xarray

SIGNATURE = b"\x89HDF\r\n\x1a\n"
MARK = b"\ncarom sha256 "
LENGTH = len(MARK) + 65
COMPRESSION = {"zlib": True, "complevel": 2, "shuffle": True}


def save(dataset: xarray.Dataset, path: str | os.PathLike[str]) -> None:
    """Write a dataset atomically: the file is complete, or as it was before; InputError if it cannot be written."""
    encoding = {str(name): dict(COMPRESSION) for name in dataset.data_vars}
    try:
        # Encoded in memory first: the library that writes such files crashes the process when the disk is full.
        content = bytes(dataset.to_netcdf(engine="h5netcdf", encoding=encoding))
        write_whole(Path(path), content + _checksum(content))
    except (OSError, ValueError) as problem:  # a ValueError tells of a null character
        number = getattr(problem, "errno", None)
        reason = os.strerror(number) if number else "this file system refuses"
        raise InputError("file", str(path), f"cannot be written ({reason}); give another path") from None


def load(path: str | os.PathLike[str], needed: Sequence[str]) -> xarray.Dataset:
    """Read a dataset into memory; ``needed`` are the variables that it must contain.

    A file that cannot be read, is damaged or does not contain them is refused.
    """
    import xarray

    _check(Path(path), needed)
    try:
        with xarray.open_dataset(path, engine="h5netcdf") as opened:
            dataset = opened.load()
    except (OSError, ValueError) as problem:
        reason = getattr(problem, "strerror", None) or "not netCDF"
        raise InputError("file", str(path), f"cannot be read ({reason})") from None
    for variable in dataset.variables.values():
        if "flag_values" in variable.attrs:  # a single value is read back as a scalar
            variable.attrs["flag_values"] = np.atleast_1d(variable.attrs["flag_values"])
    if any(name not in dataset for name in needed):
        raise InputError("file", str(path), f"must hold the variables {', '.join(needed)}")
    return dataset


def _check(path: Path, needed: Sequence[str]) -> None:
    """Refuse a file that does not agree with its checksum."""
    try:
        data = path.read_bytes()
    except OSError as problem:
        raise InputError("file", str(path), f"cannot be read ({problem.strerror})") from None
    if not data.startswith(SIGNATURE):
        raise InputError("file", str(path), "cannot be read (not netCDF)")
    if _checksum(data[:-LENGTH]) == data[-LENGTH:]:
        return
    if data[-LENGTH:].startswith(MARK):
        raise InputError("file", str(path), "is damaged: it does not agree with its checksum; restore it from a backup")
    wanted = f"must hold the variables {', '.join(needed)}, and end with the checksum that carom writes"
    raise InputError("file", str(path), f"{wanted}; it was cut short, or written or changed by something else")


def _checksum(data: bytes) -> bytes:
    return MARK + hashlib.sha256(data).hexdigest().encode() + b"\n"
