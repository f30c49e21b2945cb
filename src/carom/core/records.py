"""Records: arrays and scalars that kernels take by one address."""

from __future__ import annotations

from functools import cache

import numpy as np

CACHE_LINE = 64


def record(**fields: np.ndarray | np.record) -> np.record:
    """Pack arrays and scalars into one record that kernels take by address."""
    layout = layout_of(tuple([(name, values.dtype, values.shape) for name, values in fields.items()]))
    return filled(layout, tuple(fields.values()))


def filled(layout: np.dtype, values: tuple[object, ...]) -> np.record:
    """A record of these values.  All at once: to set one takes as long as to compute it."""
    room = _room(layout)
    room[0] = values
    values_set: np.record = room[0]
    return values_set


def blank(layout: np.dtype) -> np.record:
    """A record of zeros."""
    empty: np.record = _room(layout)[0]
    return empty


def _room(layout: np.dtype) -> np.ndarray:
    """Array of one record of zeros aligned to a cache line, so that arrays of that length never extend over two of them."""
    room = np.zeros(layout.itemsize + CACHE_LINE, np.uint8)
    first = -room.__array_interface__["data"][0] % CACHE_LINE
    return np.ndarray(1, layout, room, first)


def copy_of(original: np.record) -> np.record:
    """A copy of a record, aligned as records are."""
    room = _room(original.dtype)
    room[0] = original
    copied: np.record = room[0]
    return copied


@cache
def layout_of(fields: tuple[tuple[str, np.dtype, tuple[int, ...]], ...]) -> np.dtype:
    """Type of a record with fields of these names, types and shapes."""
    return np.dtype((np.record, np.dtype(list(fields), align=True)))
