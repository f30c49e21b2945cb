"""The record of a finished chunk: what binds its files to their place, and what failed."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

RECORDS = "records"
"""Directory of the records in a store."""


@dataclass(frozen=True)
class ChunkRecord:
    """What a store keeps of a chunk besides its numbers.

    It is written before the status of its chunk, and so belongs to each chunk that has one.
    """

    plan: str
    """Digest of the plan."""
    number: int
    sums: Mapping[str, str]
    """Checksum of each file of the chunk, by the variable's name."""
    failures: list[dict[str, object]]
    """Index in the grid, parameters and error of each failed point."""

    @property
    def data(self) -> bytes:
        """Content of its file."""
        return json.dumps(vars(self), indent=1).encode()

    @classmethod
    def read(cls, store: Path, plan: str, number: int) -> ChunkRecord | None:
        """Return the record of a chunk of a plan; ``None`` if it is damaged or another's, OSError if there is none."""
        try:
            found = cls(**json.loads(record_file(store, number).read_bytes()))
        except (ValueError, TypeError, RecursionError):
            return None
        whole = isinstance(found.sums, dict) and isinstance(found.failures, list)
        return found if whole and (found.plan, found.number) == (plan, number) else None


def checksum(data: bytes) -> str:
    """Checksum of the content of a file."""
    return hashlib.sha256(data).hexdigest()


def record_file(store: Path, number: int) -> Path:
    """Return the file of a chunk's record."""
    return store / RECORDS / f"{number:07d}.json"
