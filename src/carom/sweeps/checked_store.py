"""The store of a sweep as Zarr reads it: a damaged, missing or misplaced file raises an error and is never read as data."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from zarr.storage import LocalStore, WrapperStore

from carom.base.outcome import InputError
from carom.sweeps.chunk_record import ChunkRecord, record_file
from carom.sweeps.integrity import DamagedError
from carom.sweeps.layout import ROOT
from carom.sweeps.variables import STATUS

if TYPE_CHECKING:
    from zarr.abc.buffer import Buffer
    from zarr.abc.store import ByteRequest
    from zarr.core.buffer import BufferPrototype


class CheckedStore(WrapperStore[LocalStore]):
    """A read-only store whose metadata have been checked before; each chunk is checked when it is read."""

    def __init__(self, store: LocalStore) -> None:
        super().__init__(store)
        root = json.loads((store.root / ROOT).read_bytes())
        self._plan = root["attributes"]["plan_digest"]
        arrays = root["consolidated_metadata"]["metadata"]
        status = arrays[STATUS.name]
        self._grid = [-(-count // chunk) for count, chunk in zip(status["shape"], _chunk(status), strict=True)]
        axes = status["dimension_names"]
        self._sizes = {
            name: _size(array)
            for name, array in arrays.items()
            if name not in axes and array["dimension_names"][: len(axes)] == axes
        }

    @classmethod
    def at(cls, path: Path) -> Self:
        """Open the store in a directory."""
        return cls(LocalStore(path, read_only=True))

    async def get(self, key: str, prototype: BufferPrototype, byte_range: ByteRequest | None = None) -> Buffer | None:
        """Return the bytes of a file, or None if it does not exist and need not exist.

        What the file of a chunk without a status says does not count.

        Raises
        ------
        InputError
            The file belongs to a finished chunk, and it or the record of the chunk is damaged, missing or another's.
        """
        name, _, place = key.partition("/c/")
        if not place or name not in self._sizes:
            return await self._store.get(key, prototype, byte_range)
        chunk = tuple(map(int, place.split("/")[: len(self._grid)]))
        wrong = ""
        for _ in range(2):  # a chunk that was read while it was written again is not what it was
            if not (self._store.root / STATUS.name / "c" / "/".join(map(str, chunk))).is_file():
                return None
            found = await self._store.get(key, prototype, byte_range)
            wrong = self._problem(name, int(np.ravel_multi_index(chunk, self._grid)), key, found)
            if not wrong:
                return found
        raise InputError("store", self._store.root, f"{wrong}; the carom sweep that wrote it computes this chunk again")

    def _problem(self, name: str, number: int, key: str, found: Buffer | None) -> str:
        """What is wrong with a file of a finished chunk; empty if nothing is."""
        if found is None:
            return f"its file {key} is missing"
        root = self._store.root
        try:
            record = ChunkRecord.read(root, self._plan, number)
        except (DamagedError, OSError):
            return f"its file {record_file(root, number).relative_to(root)} is damaged, missing or another's"
        if not record.agrees(name, found.to_bytes(), self._sizes[name]):
            return f"its file {key} is damaged or another's"
        return ""


def _chunk(array: dict[str, Any]) -> list[int]:
    """Return the shape of a chunk of an array."""
    shape: list[int] = array["chunk_grid"]["configuration"]["chunk_shape"]
    return shape


def _size(array: dict[str, Any]) -> int:
    """Return the number of bytes of a chunk of an array."""
    return math.prod(_chunk(array)) * np.dtype(array["data_type"]).itemsize
