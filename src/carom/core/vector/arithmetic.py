"""The compiled form of operators and functions on lanes."""

from __future__ import annotations

import operator

from llvmlite import ir
from numba.core import types
from numba.extending import lower_builtin, overload, type_callable

from carom.core.layout import OCTET
from carom.core.vector.kinds import (
    COMPLEX,
    CONDITION,
    DOUBLES,
    REAL,
    ComplexLanes,
    Condition,
    RealLanes,
    are_numbers,
    common,
)
from carom.core.vector.parts import FREEDOM, complex_of, constant, each, minus, negative, parts, plus, times
from carom.core.vector.uncompiled import fma, join, sqrt, truncate, where

SCALARS = (types.Float, types.Integer, types.Complex)
COMPARISONS = {operator.lt: "<", operator.le: "<=", operator.gt: ">", operator.ge: ">=", operator.eq: "=="}


def register() -> None:
    """Register the operations with the compiler."""
    for operation, compute in ((operator.add, plus), (operator.sub, minus), (operator.mul, times)):
        _register_numbers(operation, compute)
    _register_reals(operator.truediv, REAL, 2, lambda build, a, b: build.fdiv(a, b, flags=FREEDOM))
    for comparison, sign in COMPARISONS.items():
        _register_reals(comparison, CONDITION, 2, _comparison(sign))
    for function, name in ((abs, "fabs"), (sqrt, "sqrt"), (truncate, "trunc")):
        _register_reals(function, REAL, 1, _by_processor(name))
    _register_conditions(operator.and_, 2, lambda build, a, b: build.and_(a, b))
    _register_conditions(operator.or_, 2, lambda build, a, b: build.or_(a, b))
    _register_conditions(operator.invert, 1, lambda build, a: build.not_(a))
    _register_negative()
    _register_where()
    _register_join()
    _register_for_one_number()
    _register_fma()


def _operands(context, build, signature, values):
    return [parts(context, build, *pair) for pair in zip(signature.args, values, strict=True)]


def _pairs(lanes, scalars):
    """Types of two operands of which at least one is lanes."""
    return [(a, b) for a in lanes for b in (*lanes, *scalars)] + [(a, b) for a in scalars for b in lanes]


def _register_numbers(function, compute):
    """An operator on numbers, real and complex."""

    @type_callable(function)
    def kind_of(context):
        return lambda a, b: common(a, b) if are_numbers(a, b) else None

    def lower(context, build, signature, values):
        real, imag = compute(build, *_operands(context, build, signature, values))
        return real if imag is None else complex_of(context, build, real, imag)

    for pair in _pairs((RealLanes, ComplexLanes), SCALARS):
        lower_builtin(function, *pair)(lower)


def _register_reals(function, result, count, compute):
    """A function of one or two reals; ``compute`` takes vectors."""

    @type_callable(function)
    def kind_of(context):
        def kind(*kinds):
            return result if are_numbers(*kinds) and common(*kinds) == REAL else None

        return (lambda a: kind(a)) if count == 1 else (lambda a, b: kind(a, b))

    def lower(context, build, signature, values):
        reals = (real for real, _ in _operands(context, build, signature, values))
        return each(build, lambda *vectors: compute(build, *vectors), *reals)

    for kinds in [(RealLanes,)] if count == 1 else _pairs((RealLanes,), (types.Float, types.Integer)):
        lower_builtin(function, *kinds)(lower)


def _comparison(sign):
    return lambda build, a, b: build.fcmp_ordered(sign, a, b)


def _by_processor(name):
    def compute(build, vector):
        kind = ir.FunctionType(DOUBLES, [DOUBLES])
        return build.call(build.module.declare_intrinsic(f"llvm.{name}.v{OCTET}f64", (), kind), [vector])

    return compute


def _register_conditions(function, count, compute):
    @type_callable(function)
    def kind_of(context):
        def kind(*kinds):
            return CONDITION if all(isinstance(kind, Condition) for kind in kinds) else None

        return (lambda a: kind(a)) if count == 1 else (lambda a, b: kind(a, b))

    @lower_builtin(function, *[Condition] * count)
    def lower(context, build, signature, values):
        return each(build, lambda *vectors: compute(build, *vectors), *values)


def _register_negative():
    @type_callable(operator.neg)
    def kind_of(context):
        return lambda a: a if isinstance(a, RealLanes | ComplexLanes) else None

    @lower_builtin(operator.neg, RealLanes)
    @lower_builtin(operator.neg, ComplexLanes)
    def lower(context, build, signature, values):
        real, imag = negative(build, parts(context, build, signature.args[0], values[0]))
        return real if imag is None else complex_of(context, build, real, imag)


def _register_where():
    @type_callable(where)
    def kind_of(context):
        def kind(condition, chosen, other):
            numbers = isinstance(condition, Condition) and are_numbers(REAL, chosen, other)
            return common(chosen, other) if numbers else None

        return kind

    @lower_builtin(where, Condition, types.Any, types.Any)
    def lower(context, build, signature, values):
        chosen, other = (parts(context, build, *pair) for pair in zip(signature.args[1:], values[1:], strict=True))
        real = each(build, build.select, values[0], chosen[0], other[0])
        if signature.return_type == REAL:
            return real
        imag = each(build, build.select, values[0], *(part or constant(build, 0.0) for _, part in (chosen, other)))
        return complex_of(context, build, real, imag)


def _register_join():
    @type_callable(join)
    def kind_of(context):
        return lambda real, imag: COMPLEX if real == imag == REAL else None

    @lower_builtin(join, RealLanes, RealLanes)
    def lower(context, build, signature, values):
        return complex_of(context, build, *values)


def _register_for_one_number():
    """Choice and complex numbers for a single motion, so that one formula serves both."""

    @overload(where)
    def choose(condition, chosen, other):
        if isinstance(condition, types.Boolean) and isinstance(chosen, types.Float) and isinstance(other, types.Float):
            return lambda condition, chosen, other: chosen if condition else other
        return None

    @overload(join)
    def pair(real, imag):
        if isinstance(real, types.Float) and isinstance(imag, types.Float):
            return lambda real, imag: complex(real, imag)
        return None


def _register_fma():
    @type_callable(fma)
    def kind_of(context):
        return lambda a, b, c: COMPLEX if are_numbers(a, b, c) and COMPLEX in (a, b, c) else None

    @lower_builtin(fma, types.Any, types.Any, types.Any)
    def lower(context, build, signature, values):
        a, b, c = _operands(context, build, signature, values)

        def add(total, x, y):
            if x is None or y is None:
                return total
            return plus(build, (total, None), times(build, (x, None), (y, None)))[0]

        real = add(c[0], a[0], b[0])
        if a[1] is not None and b[1] is not None:
            real, _ = minus(build, (real, None), times(build, (a[1], None), (b[1], None)))
        imag = add(add(c[1] or constant(build, 0.0), a[0], b[1]), a[1], b[0])
        return complex_of(context, build, real, imag)
