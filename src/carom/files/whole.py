"""Atomic and durable writing: a file is complete or absent, and is synchronised to the disk."""

from __future__ import annotations

import os
import re
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

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

    One that a killed process has left is removed when the next is made in the same directory.  That its process is still alive is
    told by a lock; where the file system has none, nothing is removed.
    """
    _clear(directory)
    handle, part = None, directory
    try:
        while handle is None:
            # Chosen before it is made, so that it is removed after an interruption at any moment; never used twice, since
            # another process may still be about to remove what had the name before.
            part = directory / f".carom.{secrets.token_hex(8)}.part"
            handle = _made(part, folder)
        yield part
    finally:
        if handle is not None:
            os.close(handle)
        if part != directory:
            _remove(part)


def _made(part: Path, folder: bool) -> int | None:
    """Make and lock a file or folder, and return its handle; None if another has taken it for left before it was locked."""
    if folder:
        part.mkdir()
    else:
        part.touch(exist_ok=False)
    try:
        handle = os.open(part, os.O_RDONLY)
    except FileNotFoundError:
        return None
    _lock(handle, wait=True)
    if part.exists():
        return handle
    os.close(handle)
    return None


def _clear(directory: Path) -> None:
    """Remove what killed processes have left in a directory."""
    with suppress(OSError), os.scandir(directory) as entries:
        for entry in entries:
            if not _PART.fullmatch(entry.name):
                continue
            with suppress(OSError):
                handle = os.open(entry.path, os.O_RDONLY)
                try:
                    if _lock(handle):
                        _remove(Path(entry.path))
                finally:
                    os.close(handle)


def _lock(handle: int, *, wait: bool = False) -> bool:
    """Lock an open file or folder until it is closed; whether this was possible."""
    try:
        import fcntl

        fcntl.flock(handle, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except (ImportError, OSError):
        return False
    return True


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
