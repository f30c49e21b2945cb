"""The record of a finished chunk: what binds its files to their place, who computed it, and what failed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from carom.sweeps.integrity import DamagedError, is_intact, read_record, record, seal_of

RECORDS = "records"
"""Directory of the records in a store."""
_KIND = "a finished chunk"


@dataclass(frozen=True)
class ChunkRecord:
    """What a store keeps of a chunk besides its numbers.

    It is written before the status of its chunk, and so belongs to each chunk that has one.
    """

    plan: str
    """Digest of the plan."""
    number: int
    seals: Mapping[str, str]
    """Checksum at the end of each file of the chunk, by the variable's name."""
    processor: str
    """Kind of the processor that computed it; empty if it was not computed."""
    failures: list[dict[str, Any]]
    """Index in the grid, parameters and error of each failed point."""

    @property
    def data(self) -> bytes:
        """Content of its file."""
        return record(_KIND, vars(self))

    @classmethod
    def read(cls, store: Path, plan: str, number: int) -> ChunkRecord:
        """Return the record of a chunk of a plan; DamagedError if it is damaged or another's, OSError if there is none."""
        found: ChunkRecord = cls(**read_record(_KIND, record_file(store, number)))
        if (found.plan, found.number) != (plan, number):
            raise DamagedError
        return found

    def agrees(self, name: str, sealed: bytes, size: int) -> bool:
        """Whether a file is intact, and that of this variable in this chunk; `size` is its length without checksum."""
        return is_intact(sealed, size) and seal_of(sealed) == self.seals.get(name)


def record_file(store: Path, number: int) -> Path:
    """Return the file of a chunk's record."""
    return store / RECORDS / f"{number:07d}.json"
