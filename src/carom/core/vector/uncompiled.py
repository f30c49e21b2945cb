"""The functions on lanes for NumPy arrays; ``arithmetic`` and ``memory`` register their compiled form."""

from __future__ import annotations

import numpy as np

from carom.core.layout import WIDTH


def load(array, first):
    """WIDTH numbers of an array, from an entry on."""
    return array[first : first + WIDTH].copy()


def store(array, first, values):
    """Write lanes, or one number for all of them, to an array, from an entry on."""
    array[first : first + WIDTH] = values


def join(real, imag):
    """Complex lanes, or a complex number, with these real and imaginary parts."""
    joined = np.empty(np.shape(real), np.complex128)
    joined.real, joined.imag = real, imag
    return joined[()]


def where(condition, chosen, other):
    """Take ``chosen`` in the lanes in which the condition holds, and ``other`` elsewhere; also for one number."""
    return np.where(condition, chosen, other)[()]


def fma(a, b, c):
    """``a b + c`` with at least one complex operand: in fewer instructions than a product and a sum."""
    return a * b + c


def sqrt(values):
    """Square root."""
    return np.sqrt(values)


def truncate(values):
    """Round to whole numbers, towards zero."""
    return np.trunc(values)


def take(row, places):
    """Entries of a row of LANE_NODES numbers, at places that are whole numbers below LANE_NODES."""
    return row[places.astype(np.int64)]


def choose(row, places):
    """Entries of a row of OCTET numbers, at places that are whole numbers below LEVELS."""
    return row[places.astype(np.int64)]


def lanes_of(condition):
    """The lanes in which a condition holds, as the bits of an integer."""
    return int(sum(1 << lane for lane in np.flatnonzero(condition)))


def align_stack():
    """Align the stack of the calling kernel to cache lines, which halves the cost of values spilled to it."""
