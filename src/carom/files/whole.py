"""Atomic and durable writing: a file is complete or absent, and is synchronised to the disk."""

from __future__ import annotations

import os
import secrets
from contextlib import suppress
from pathlib import Path


def write_whole(target: Path, data: bytes, parts: Path | None = None) -> None:
    """Write a file atomically: under a temporary name until all of it is on the disk.

    An existing file is replaced; if an OSError occurs, it is unchanged.  The unfinished file is in ``parts``, a directory on the same
    file system, by default that of the target.
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
    """Test whether a file can be written, and leave no trace; OSError if not."""
    part = target.parent / _unfinished()
    try:
        part.touch(exist_ok=False)
    finally:
        with suppress(OSError):
            part.unlink(missing_ok=True)


def _unfinished() -> str:
    """A temporary name for an unfinished file."""
    return f".{secrets.token_hex(8)}.part"


def sync_directory(directory: Path) -> None:
    """Synchronise new names in a directory to the disk, where the operating system supports this."""
    with suppress(OSError):
        handle = os.open(directory, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
