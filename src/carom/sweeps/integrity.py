"""Checksums that tell an intact file of a store from a damaged one, and from one that belongs elsewhere.

Files of chunks end with their checksum, as Zarr's codec ``crc32c`` writes it, so that every Zarr reader detects damage.
The other files that carom writes are records: JSON with the checksum of its content.  One record holds the checksums of
all files that are written before the first chunk.  Each finished chunk has one that names its plan and its number and
repeats the checksums of its files: an intact file in another's place does not agree with it.
"""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

from google_crc32c import value as crc32c

SUMS = "checksums.json"
_SUMS = "checksums of what describes a store"
_SEAL = 4


class DamagedError(Exception):
    """A record does not match its checksum."""


def seal(data: bytes) -> bytes:
    """Append the checksum of data."""
    return data + crc32c(data).to_bytes(_SEAL, "little")


def is_intact(sealed: bytes, size: int) -> bool:
    """Whether data have the expected length and agree with the checksum at their end.

    The length must be checked too: eight bytes with all bits set happen to agree with the checksum at their end, and so
    does an empty file with its checksum appended.
    """
    return len(sealed) == size + _SEAL and seal(sealed[:-_SEAL]) == sealed


def seal_of(sealed: bytes) -> str:
    """Return the checksum at the end of data as text."""
    return sealed[-_SEAL:].hex()


def record(kind: str, content: Any) -> bytes:
    """Return content of a kind as JSON with its checksum."""
    told = {"kind": kind, "content": content}
    return json.dumps(told | {"crc32c": crc32c(json.dumps(told).encode())}, indent=1).encode()


def read_record(kind: str, file: Path) -> Any:
    """Return the content of a record; OSError if it cannot be read.

    :class:`DamagedError` if it does not match its checksum or is of another kind.
    """
    data = file.read_bytes()
    try:
        content = json.loads(data)["content"]
        if data == record(kind, content):
            return content
    except (ValueError, LookupError, TypeError, RecursionError):
        pass
    raise DamagedError


def sums(path: Path) -> bytes:
    """Return a record of the checksums of all files in a directory, in the order of their names."""
    files = {file.relative_to(path).as_posix(): file for file in path.rglob("*") if file.is_file()}
    return record(_SUMS, {name: _sum(files[name]) for name in sorted(files)})


def damaged_metadata(path: Path) -> str | None:
    """Return the name of the first damaged or missing file of those written before the chunks, or None."""
    name = SUMS
    try:
        for name, wanted in read_record(_SUMS, path / SUMS).items():
            if _sum(path / name) != wanted:
                return name
    except (DamagedError, FileNotFoundError):
        return name
    return None


def _sum(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()
