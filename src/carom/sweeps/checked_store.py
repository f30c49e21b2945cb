"""The store of a sweep as Zarr reads it: a damaged or missing chunk raises an error and is never read as data."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from zarr.storage import LocalStore, WrapperStore

from carom.outcome import InputError
from carom.sweeps.integrity import is_intact
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
        arrays = json.loads((store.root / ROOT).read_bytes())["consolidated_metadata"]["metadata"]
        self._sizes = {name: _size(array) for name, array in arrays.items()}

    @classmethod
    def at(cls, path: Path) -> Self:
        """Open the store in a directory."""
        return cls(LocalStore(path, read_only=True))

    async def get(self, key: str, prototype: BufferPrototype, byte_range: ByteRequest | None = None) -> Buffer | None:
        """Return the bytes of a file, or None if it does not exist and need not exist.

        Raises
        ------
        InputError
            The file belongs to a finished chunk and is damaged or missing.
        """
        found = await self._store.get(key, prototype, byte_range)
        name, _, place = key.partition("/c/")
        if place and found is None and self._finished(place):
            found = await self._store.get(key, prototype, byte_range)  # it may have been written since
            if found is None:
                raise self._damage(key, "missing")
        if place and found is not None and not is_intact(found.to_bytes(), self._sizes[name]):
            raise self._damage(key, "damaged")
        return found

    def _finished(self, place: str) -> bool:
        """Whether a chunk has a status file; the key of a variable with a dimension of its own has one more index."""
        status = self._store.root / STATUS.name / "c" / place
        return status.is_file() or status.parent.is_file()

    def _damage(self, key: str, words: str) -> InputError:
        remedy = "the carom sweep that wrote it computes this chunk again"
        return InputError("store", self._store.root, f"its file {key} is {words}; {remedy}")


def _size(array: dict[str, Any]) -> int:
    """Return the number of bytes of a chunk of an array."""
    return math.prod(array["chunk_grid"]["configuration"]["chunk_shape"]) * np.dtype(array["data_type"]).itemsize
