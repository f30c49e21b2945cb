"""WIDTH numbers as one value: what lets a formula for one motion move many, side by side.

A kernel that has loaded WIDTH numbers of an array with :func:`load` goes on as if they were one: arithmetic,
comparisons, ``abs``, ``real``, ``imag`` and ``conjugate()`` act on every lane alike, and :func:`where` chooses lane by
lane.  Uncompiled, such a value is a NumPy array, and the functions are those of ``uncompiled``.  Compiled, it is held in
registers of the processor: ``kinds`` tells the compiler what there is, ``arithmetic`` and ``memory`` what becomes of it.
No lane sees another, but in :func:`lanes_of`.
"""

from carom.core.vector import arithmetic as _arithmetic
from carom.core.vector import memory as _memory
from carom.core.vector.uncompiled import (
    align_stack,
    choose,
    fma,
    join,
    lanes_of,
    load,
    sqrt,
    store,
    take,
    truncate,
    where,
)

__all__ = ["align_stack", "choose", "fma", "join", "lanes_of", "load", "sqrt", "store", "take", "truncate", "where"]

_arithmetic.register()
_memory.register()
