"""Complex numbers, loops over ranges, and items of arrays, as instructions for LLVM.

Each function appends to a block of code with an ``IRBuilder`` of llvmlite.  Numba goes through memory for what holds more than one number, and
through functions of its own for products, maxima and minima.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Sequence
from functools import partial, reduce
from typing import TYPE_CHECKING

from llvmlite.ir import Constant, IntType, Undefined

if TYPE_CHECKING:
    from llvmlite.ir import IRBuilder, Type, Value
    from numba.core.datamodel.models import DataModel


def variable(builder: IRBuilder, kind: Type, name: str = "") -> Value:
    """Place of a variable in the frame of the function."""
    with builder.goto_entry_block():
        return builder.alloca(kind, name=name)


def struct(builder: IRBuilder, kind: Type, *values: Value) -> Value:
    """Struct of these values."""
    packed = Constant(kind, Undefined)
    for i, value in enumerate(values):
        packed = builder.insert_value(packed, value, i)
    return packed


def _termwise(name: str, builder: IRBuilder, first: Value, second: Value) -> Value:
    """Sum or difference of two complex numbers."""
    parts = [getattr(builder, name)(builder.extract_value(first, i), builder.extract_value(second, i)) for i in (0, 1)]
    return struct(builder, first.type, *parts)


def _product(builder: IRBuilder, first: Value, second: Value) -> Value:
    """Product of two complex numbers."""
    a, b = (builder.extract_value(first, i) for i in (0, 1))
    c, d = (builder.extract_value(second, i) for i in (0, 1))
    real = builder.fsub(builder.fmul(a, c), builder.fmul(b, d))
    imaginary = builder.fadd(builder.fmul(a, d), builder.fmul(b, c))
    return struct(builder, first.type, real, imaginary)


COMPLEX_OPERATIONS: dict[Callable[..., object], Callable[..., Value]] = {
    operator.add: partial(_termwise, "fadd"),
    operator.sub: partial(_termwise, "fsub"),
    operator.mul: _product,
}
"""Operations on two complex numbers that are a few instructions."""


def conjugate(builder: IRBuilder, number: Value) -> Value:
    """Complex conjugate."""
    return builder.insert_value(number, builder.fneg(builder.extract_value(number, 1)), 1)


EXTREMES: dict[Callable[..., object], str] = {max: ">", min: "<"}
"""Functions of several numbers that are one of them, with the comparison by which a later one replaces an earlier one."""


def extreme(builder: IRBuilder, function: Callable[..., object], numbers: Sequence[Value]) -> Value:
    """Largest or smallest of several numbers of one type, chosen as Python does where one of them is no number."""
    floats = not isinstance(numbers[0].type, IntType)
    compare = builder.fcmp_ordered if floats else builder.icmp_signed

    def choose(first: Value, second: Value) -> Value:
        return builder.select(compare(EXTREMES[function], second, first), second, first)

    return reduce(choose, numbers)


def range_of(builder: IRBuilder, kind: Type, limits: Sequence[Value]) -> Value:
    """A range in steps of one: its start, its stop, its step."""
    start, stop = limits if len(limits) == 2 else (Constant(limits[0].type, 0), limits[0])
    return struct(builder, kind, start, stop, Constant(stop.type, 1))


def begin_range(builder: IRBuilder, kind: Type, limits: Value) -> Value:
    """Iterator over a range in steps of one: place of the next number, stop, step, place of the count of what is left."""
    start, stop, step = (builder.extract_value(limits, i) for i in range(3))
    number, count = variable(builder, start.type), variable(builder, start.type)
    builder.store(start, number)
    left = builder.sub(stop, start)
    none = Constant(start.type, 0)
    builder.store(builder.select(builder.icmp_signed(">", left, none), left, none), count)
    return struct(builder, kind, number, stop, step, count)


def next_in_range(builder: IRBuilder, kind: Type, iterator: Value) -> Value:
    """The next number of a range, and whether there is one."""
    place, step, counter = (builder.extract_value(iterator, i) for i in (0, 2, 3))
    number, count = builder.load(place), builder.load(counter)
    builder.store(builder.add(number, step), place)
    builder.store(builder.sub(count, Constant(count.type, 1), flags=["nsw"]), counter)
    return struct(builder, kind, number, builder.icmp_signed(">", count, Constant(count.type, 0)))


def array_in_record(builder: IRBuilder, model: DataModel, data: Value) -> Value:
    """Description of an array that is part of a record and owns no memory: constants of its type, and its address."""
    kind, array = model.get_value_type(), model.fe_type
    known = {"nitems": math.prod(array.shape), "itemsize": array.size, "shape": array.shape, "strides": array.strides}
    parts = [_constant(part, known.get(name)) for part, name in zip(kind.elements, model._fields, strict=True)]
    return builder.insert_value(Constant(kind, parts), data, model.get_field_position("data"))


def _constant(kind: Type, value: int | tuple[int, ...] | None) -> Constant:
    """Whole numbers, or null if there is no value."""
    parts = [Constant(kind.element, number) for number in value] if isinstance(value, tuple) else value
    return Constant(kind, parts)


def item_address(builder: IRBuilder, data: Value, shape: Sequence[Value], numbers: Sequence[Value]) -> Value:
    """Address of the item of an array whose last axis varies fastest; negative numbers count from the end."""
    places = [_from_the_start(builder, number, size) for number, size in zip(numbers, shape, strict=True)]
    place = places[0]
    for size, number in zip(shape[1:], places[1:], strict=True):
        place = builder.add(builder.mul(place, size), number)
    return builder.gep(data, [place])


def _from_the_start(builder: IRBuilder, number: Value, size: Value) -> Value:
    if isinstance(number, Constant) and number.constant >= 0:
        return number
    negative = builder.icmp_signed("<", number, Constant(number.type, 0))
    return builder.select(negative, builder.add(number, size), number)
