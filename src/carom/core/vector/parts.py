"""Arithmetic of lanes as instructions of the compiler's intermediate language.

Here a number is a pair of its real and its imaginary part; ``None`` stands for an imaginary part of zero.
"""

from __future__ import annotations

from llvmlite import ir
from numba.core import types

from carom.core.layout import OCTET
from carom.core.vector.kinds import COMPLEX, COUNT, DOUBLES, ComplexLanes, RealLanes

FREEDOM = ("contract", "nsz")
"""Compiler flags of all kernels: a product and a sum may be fused (rounded once); the sign of zero is ignored."""


def each(build, compute, *values):
    """Apply a function to every vector of the lanes."""
    vectors = [compute(*(build.extract_value(value, i) for value in values)) for i in range(COUNT)]
    return all_of(build, vectors)


def spread(build, number):
    """One number in all lanes."""
    blank, everywhere = (
        ir.Constant(DOUBLES, ir.Undefined),
        ir.Constant(ir.VectorType(ir.IntType(32), OCTET), [0] * OCTET),
    )
    first = build.insert_element(blank, number, ir.Constant(ir.IntType(32), 0))
    return all_of(build, [build.shuffle_vector(first, blank, everywhere)] * COUNT)


def constant(build, number):
    """A compile-time constant in all lanes."""
    return spread(build, ir.Constant(ir.DoubleType(), number))


def all_of(build, vectors):
    """Lanes made of these vectors."""
    lanes = ir.Constant(ir.ArrayType(vectors[0].type, COUNT), ir.Undefined)
    for i, vector in enumerate(vectors):
        lanes = build.insert_value(lanes, vector, i)
    return lanes


def parts(context, build, kind, value):
    """Real and imaginary part of lanes, or of one number that is copied to all lanes."""
    if isinstance(kind, RealLanes):
        return value, None
    if isinstance(kind, ComplexLanes):
        number = context.make_helper(build, kind, value)
        return number.real, number.imag
    if isinstance(kind, types.Complex):
        number = context.make_helper(build, types.complex128, context.cast(build, value, kind, types.complex128))
        return spread(build, number.real), spread(build, number.imag)
    return spread(build, context.cast(build, value, kind, types.float64)), None


def complex_of(context, build, real, imag):
    """Complex lanes with these real and imaginary parts."""
    value = context.make_helper(build, COMPLEX)
    value.real, value.imag = real, imag
    return value._getvalue()


def plus(build, a, b):
    """Sum."""
    imag = _add(build, a[1], b[1]) if a[1] is not None and b[1] is not None else a[1] or b[1]
    return _add(build, a[0], b[0]), imag


def minus(build, a, b):
    """Difference."""
    return plus(build, a, negative(build, b))


def negative(build, a):
    """The number with its sign changed."""
    return tuple(None if part is None else each(build, build.fneg, part) for part in a)


def times(build, a, b):
    """Product."""
    if a[1] is None:
        a, b = b, a
    if b[1] is None:
        return _multiply(build, a[0], b[0]), None if a[1] is None else _multiply(build, a[1], b[0])
    squares = minus(build, (_multiply(build, a[0], b[0]), None), (_multiply(build, a[1], b[1]), None))
    return squares[0], _add(build, _multiply(build, a[0], b[1]), _multiply(build, a[1], b[0]))


def _add(build, x, y):
    return each(build, lambda u, v: build.fadd(u, v, flags=FREEDOM), x, y)


def _multiply(build, x, y):
    return each(build, lambda u, v: build.fmul(u, v, flags=FREEDOM), x, y)
