"""WIDTH numbers as one value, so that a formula for one motion advances many motions side by side.

A kernel loads WIDTH numbers of an array with :func:`load` and then treats them as one number: arithmetic, comparisons,
``abs``, ``real``, ``imag`` and ``conjugate()`` act on every lane alike, and :func:`where` selects lane by lane.
Uncompiled, such a value is a NumPy array, and the functions are those of ``uncompiled``.  Compiled, it is held in
vector registers of the processor: ``kinds`` declares the types to the compiler, ``arithmetic`` and ``memory`` define
the operations.  Lanes do not affect each other, and only :func:`lanes_of` combines them.
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
