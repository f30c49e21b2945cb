"""Files that are there whole or not at all, on the disk and not only on their way to it."""

from __future__ import annotations

import os
import secrets
from contextlib import suppress
from pathlib import Path

__all__ = ["sync_directory", "try_place", "write_whole"]


def write_whole(target: Path, data: bytes, parts: Path | None = None) -> None:
    """Write a file: under another name until all of it is on the disk.

    Parameters
    ----------
    target : Path
        Replaced if it is there.
    data : bytes
    parts : Path, optional
        Directory on the same file system for the unfinished file; by default that of the target.

    Raises
    ------
    OSError
        It cannot be written; what was there is as it was.
    """
    part = (parts or target.parent) / _unfinished()
    try:
        with part.open("xb", buffering=0) as stream:
            view = memoryview(data)
            while view:
                view = view[stream.write(view) :]
            os.fsync(stream.fileno())
        target.parent.mkdir(parents=True, exist_ok=True)
        os.replace(part, target)  # noqa: PTH105  (tests let it fail)
    except BaseException:
        with suppress(OSError):
            part.unlink(missing_ok=True)
        raise


def try_place(target: Path) -> None:
    """Try whether a file can be written, without a trace.

    Raises
    ------
    OSError
        It cannot.
    """
    part = target.parent / _unfinished()
    try:
        part.touch(exist_ok=False)
    finally:
        with suppress(OSError):
            part.unlink(missing_ok=True)


def _unfinished() -> str:
    """Name of a file that is not finished."""
    return f".{secrets.token_hex(8)}.part"


def sync_directory(directory: Path) -> None:
    """Bring new names in a directory to the disk, where the system knows how."""
    with suppress(OSError):
        handle = os.open(directory, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
