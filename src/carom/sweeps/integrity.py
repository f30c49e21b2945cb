"""What tells a whole file of a store from a damaged one: a checksum that was written with it.

Chunks end with their checksum, in the way of Zarr's codec ``crc32c``, so that every reader of Zarr notices.  What carom writes
beside them are records: JSON with the checksum of its content.  One of these holds the sums of all files that are written
before the first chunk.
"""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

from google_crc32c import value as crc32c

__all__ = ["SUMS", "DamagedError", "damaged_metadata", "is_whole", "read_record", "record", "seal", "sums", "unseal"]

SUMS = "checksums.json"
_SEAL = 4


class DamagedError(Exception):
    """A record is not as it was written."""


def seal(data: bytes) -> bytes:
    """Append the checksum of data."""
    return data + crc32c(data).to_bytes(_SEAL, "little")


def is_whole(sealed: bytes, size: int) -> bool:
    """Whether data are as long as they should be and agree with the checksum at their end.

    The length matters: eight bytes of ones, say, agree with their end, and so does the checksum of nothing.
    """
    return len(sealed) == size + _SEAL and seal(unseal(sealed)) == sealed


def unseal(sealed: bytes) -> bytes:
    """Data without the checksum at their end."""
    return sealed[:-_SEAL]


def record(content: Any) -> bytes:
    """JSON of content with its checksum."""
    return json.dumps({"content": content, "crc32c": crc32c(json.dumps(content).encode())}, indent=1).encode()


def read_record(file: Path) -> Any:
    """Return the content of a record.

    Raises
    ------
    DamagedError
    OSError
        It is not there, or cannot be read.
    """
    data = file.read_bytes()
    try:
        content = json.loads(data)["content"]
        if data == record(content):
            return content
    except (ValueError, LookupError, TypeError, RecursionError):
        pass
    raise DamagedError


def sums(path: Path) -> bytes:
    """Record of the checksums of all files in a directory."""
    files = sorted(file for file in path.rglob("*") if file.is_file())
    return record({file.relative_to(path).as_posix(): _sum(file) for file in files})


def damaged_metadata(path: Path) -> str | None:
    """Name of the first file of a store, of those written before its chunks, that is not as it was written.

    Raises
    ------
    OSError
        One cannot be read.
    """
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
