"""Files: one is written completely, or what was there stays; a directory receives all its files or none; documents in JSON.

Files are synchronised to the disk.  In documents complex numbers are ``[re, im]``, and values that are not finite ``null``.  Datasets are
netCDF files with a checksum at the end, where readers of netCDF ignore it: without it a changed number would go unnoticed, and the
library that reads such files is not robust against damaged ones.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import re
import secrets
import shutil
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from carom.base.outcome import InputError

if TYPE_CHECKING:
    import xarray

ABANDONED = 86_400.0
"""Seconds after which nobody writes to an unfinished file any more."""
_PART = re.compile(r"\.carom\.[0-9a-f]{16}\.part")
_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_MARK = b"\ncarom sha256 "
_LENGTH = len(_MARK) + 65
_COMPRESSION = {"zlib": True, "complevel": 2, "shuffle": True}
FIGURES = "figures"
MANIFEST = "study.json"


def write_whole(target: Path, data: bytes, parts: Path | None = None) -> None:
    """Write a file atomically: under a temporary name until all of it is on the disk.

    An existing file is replaced; if an OSError occurs, it is unchanged.  The unfinished file is in ``parts``, a directory on the same
    file system, by default that of the target.
    """
    with unfinished(parts or target.parent) as part:
        with part.open("wb", buffering=0) as stream:
            view = memoryview(data)
            while view:
                view = view[stream.write(view) :]
            os.fsync(stream.fileno())
        target.parent.mkdir(parents=True, exist_ok=True)
        os.replace(part, target)  # noqa: PTH105  (tests let it fail)


def try_place(target: Path) -> None:
    """Test whether a file can be written, and leave no trace; OSError if not."""
    with unfinished(target.parent):
        pass


@contextmanager
def unfinished(directory: Path, *, folder: bool = False) -> Iterator[Path]:
    """Provide a new file or folder of a temporary name; at the end it is removed if it is still there.

    One that a killed process has left is removed when another is made in the same directory a day later.
    """
    with suppress(OSError), os.scandir(directory) as entries:
        for entry in entries:
            if _PART.fullmatch(entry.name) and time.time() - entry.stat().st_mtime > ABANDONED:
                _remove(Path(entry.path))
    # Chosen before it is made, so that it is removed after an interruption at any moment.
    part = directory / f".carom.{secrets.token_hex(8)}.part"
    try:
        if folder:
            part.mkdir()
        else:
            part.touch(exist_ok=False)
        yield part
    finally:
        _remove(part)


def _remove(part: Path) -> None:
    with suppress(OSError):
        if part.is_dir():
            shutil.rmtree(part, ignore_errors=True)
        else:
            part.unlink(missing_ok=True)


def sync_directory(directory: Path) -> None:
    """Synchronise new names in a directory to the disk, where the operating system supports this."""
    with suppress(OSError):
        handle = os.open(directory, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def check_directory(path: str, option: str) -> Path:
    """Refuse early a path that is not, or cannot become, a writable directory; `option` is its name in errors.

    Permissions alone do not decide this (read-only and special file systems, quotas, names too long), so writing is
    tried and undone.
    """
    allowed = "must be a directory to write to, existing or new"
    if not path.strip() or "\0" in path:
        raise InputError(option, repr(path), allowed)
    directory = Path(path)
    if directory.is_file():
        raise InputError(option, path, f"{allowed}; this is a file")
    try:
        with _staging(directory) as made:
            if not directory.exists():
                made.rename(directory)
                directory.rmdir()
    except OSError as problem:
        raise InputError(option, path, f"{allowed}; it cannot be written ({problem.strerror})") from None
    return directory


@contextmanager
def staged_directory(path: str, option: str) -> Iterator[Path]:
    """Provide an empty staging directory; when the block ends, move its files to the target directory.

    Files of the same name are replaced, each atomically.  Figures of an earlier study that this one does not have are
    removed; all other files stay as they are.  If an error occurs before the move, nothing is changed.  The staging
    directory lies inside the target, or beside it if the target does not exist yet.
    """
    target = check_directory(path, option)
    try:
        with _staging(target) as made:
            yield made
            _move(made, target)
    except OSError as problem:
        raise InputError(option, path, f"cannot be written ({problem.strerror}); give another directory") from None


@contextmanager
def _staging(target: Path) -> Iterator[Path]:
    """Create an empty directory on the file system of a target; at the end remove it, and created parents if empty."""
    there = target.exists()
    home = target if there else target.absolute().parent
    missing = [directory for directory in (home, *home.parents) if not directory.exists()]
    try:
        home.mkdir(parents=True, exist_ok=True)
        with unfinished(home, folder=True) as made:
            yield made
    finally:
        for directory in missing:
            with suppress(OSError):
                directory.rmdir()


def _move(made: Path, target: Path) -> None:
    if not target.exists():
        made.rename(target)
        return
    files = sorted(file.relative_to(made) for file in made.rglob("*") if file.is_file())
    _remove_stale_figures(target, files)
    # The page and the manifest, which refer to the figures, come last.
    for file in sorted(files, key=lambda name: len(name.parts), reverse=True):
        (target / file).parent.mkdir(parents=True, exist_ok=True)
        (made / file).replace(target / file)


def _remove_stale_figures(target: Path, files: list[Path]) -> None:
    """Remove the figures that the existing study lists as its own, except those about to be replaced."""
    try:
        names = json.loads((target / MANIFEST).read_text(encoding="utf-8"))["figures"]
        stale = [Path(name) for name in names]
    except (OSError, ValueError, KeyError, TypeError, RecursionError):  # missing or damaged: keep the figures
        return
    for file in stale:
        if len(file.parts) == 2 and file.parts[0] == FIGURES and file.parts[1] != ".." and file not in files:
            with suppress(OSError, ValueError):  # ValueError: a name that no file can have
                (target / file).unlink(missing_ok=True)


def as_json(document: dict[str, object]) -> str:
    """Return a document as the text of one JSON object; characters that are not printable are escaped."""
    text = json.dumps(_plain(document), indent=2, ensure_ascii=False, allow_nan=False)
    if text.replace("\n", "").isprintable():
        return text
    return "".join(sign if sign.isprintable() or sign == "\n" else json.dumps(sign)[1:-1] for sign in text)


def write_json(target: Path, document: dict[str, object]) -> None:
    """Write a document to a file."""
    target.write_text(as_json(document) + "\n", encoding="utf-8")


def _plain(value: object) -> object:
    """Convert a value to the types of JSON."""
    if isinstance(value, dict):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, complex):
        return [_plain(value.real), _plain(value.imag)]
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value


def save_dataset(dataset: xarray.Dataset, path: str | os.PathLike[str]) -> None:
    """Write a dataset atomically: the file is complete, or as it was before; InputError if it cannot be written."""
    encoding = {str(name): dict(_COMPRESSION) for name in dataset.data_vars}
    try:
        # Encoded in memory first: the library that writes such files crashes the process when the disk is full.
        content = bytes(dataset.to_netcdf(engine="h5netcdf", encoding=encoding))
        write_whole(Path(path), content + _checksum(content))
    except (OSError, ValueError) as problem:  # a ValueError tells of a null character
        number = getattr(problem, "errno", None)
        reason = os.strerror(number) if number else "this file system refuses"
        raise InputError("file", str(path), f"cannot be written ({reason}); give another path") from None


def load_dataset(path: str | os.PathLike[str], needed: Sequence[str]) -> xarray.Dataset:
    """Read a dataset into memory; ``needed`` are the variables that it must contain.

    A file that cannot be read, is damaged or does not contain them is refused.
    """
    import xarray

    _check_checksum(Path(path), needed)
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


def _check_checksum(path: Path, needed: Sequence[str]) -> None:
    """Refuse a file that does not agree with its checksum."""
    try:
        data = path.read_bytes()
    except OSError as problem:
        raise InputError("file", str(path), f"cannot be read ({problem.strerror})") from None
    if not data.startswith(_SIGNATURE):
        raise InputError("file", str(path), "cannot be read (not netCDF)")
    if _checksum(data[:-_LENGTH]) == data[-_LENGTH:]:
        return
    if data[-_LENGTH:].startswith(_MARK):
        raise InputError("file", str(path), "is damaged: it does not agree with its checksum; restore it from a backup")
    wanted = f"must hold the variables {', '.join(needed)}, and end with the checksum that carom writes"
    raise InputError("file", str(path), f"{wanted}; it was cut short, or written or changed by something else")


def _checksum(data: bytes) -> bytes:
    return _MARK + hashlib.sha256(data).hexdigest().encode() + b"\n"
