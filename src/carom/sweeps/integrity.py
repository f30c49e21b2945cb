"""Checksums that tell an intact file of a store from a damaged one.

Chunks end with their checksum, as Zarr's codec ``crc32c`` writes it, so that every Zarr reader detects damage.  The
other files that carom writes are records: JSON with the checksum of its content.  One record holds the checksums of all
files that are written before the first chunk.
"""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

from google_crc32c import value as crc32c

SUMS = "checksums.json"
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
    return len(sealed) == size + _SEAL and seal(unseal(sealed)) == sealed


def unseal(sealed: bytes) -> bytes:
    """Return data without the checksum at their end."""
    return sealed[:-_SEAL]


def record(content: Any) -> bytes:
    """Return content as JSON with its checksum."""
    return json.dumps({"content": content, "crc32c": crc32c(json.dumps(content).encode())}, indent=1).encode()


def read_record(file: Path) -> Any:
    """Return the content of a record; :class:`DamagedError` if it does not match its checksum, OSError if it cannot be read."""
    data = file.read_bytes()
    try:
        content = json.loads(data)["content"]
        if data == record(content):
            return content
    except (ValueError, LookupError, TypeError, RecursionError):
        pass
    raise DamagedError


def sums(path: Path) -> bytes:
    """Return a record of the checksums of all files in a directory."""
    files = sorted(file for file in path.rglob("*") if file.is_file())
    return record({file.relative_to(path).as_posix(): _sum(file) for file in files})


def damaged_metadata(path: Path) -> str | None:
    """Return the name of the first damaged or missing file of those written before the chunks, or None."""
    name = SUMS
    try:
        for name, wanted in read_record(path / SUMS).items():
            if _sum(path / name) != wanted:
                return name
    except (DamagedError, FileNotFoundError):
        return name
    return None


def _sum(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()
