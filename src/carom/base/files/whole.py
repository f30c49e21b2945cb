"""Atomic and durable writing: a file is complete or absent, and is synchronised to the disk."""

from __future__ import annotations

import os
import re
import secrets
import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

ABANDONED = 86_400.0
"""Seconds after which nobody writes to an unfinished file any more."""
_PART = re.compile(r"\.carom\.[0-9a-f]{16}\.part")


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
