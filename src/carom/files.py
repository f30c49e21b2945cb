"""Files that are there whole or not at all, on the disk and not only on their way to it."""

from __future__ import annotations

import os
import secrets
from contextlib import suppress
from pathlib import Path

__all__ = ["sync_directory", "write_whole"]


def write_whole(target: Path, data: bytes, parts: Path) -> None:
    """Write a file: under another name until all of it is on the disk.

    Parameters
    ----------
    target : Path
        Replaced if it is there.
    data : bytes
    parts : Path
        Directory on the same file system for the unfinished file.
    """
    part = parts / f".{secrets.token_hex(8)}.part"
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


def sync_directory(directory: Path) -> None:
    """Bring new names in a directory to the disk, where the system knows how."""
    with suppress(OSError):
        handle = os.open(directory, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
