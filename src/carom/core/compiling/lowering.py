"""The code of a kernel for LLVM, without what kernels do not need.

Numba looks up the implementation of an operation by inferring its types again, copies complex numbers, ranges and the
descriptions of arrays to memory before it reads their parts, clears variables that own nothing, and describes variables to debuggers.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from functools import cache, partial
from typing import TYPE_CHECKING, cast

from llvmlite.ir import Constant, IntType
from numba.core import cgutils, ir
from numba.core.compiler_machinery import register_pass
from numba.core.datamodel import default_manager
from numba.core.ir_utils import get_definition, guard
from numba.core.lowering import Lower
from numba.core.typed_passes import BaseNativeLowering
from numba.core.types import (  # type: ignore[attr-defined]
    Array,
    BaseTuple,
    Integer,
    NestedArray,
    RangeIteratorType,
    RangeType,
    complex128,
    float64,
    int64,
    intp,
)
from numba.np.arrayobj import load_item, store_item

from carom.core.compiling.instructions import (
    COMPLEX_OPERATIONS,
    EXTREMES,
    array_in_record,
    begin_range,
    conjugate,
    extreme,
    item_address,
    next_in_range,
    range_of,
    variable,
)

if TYPE_CHECKING:
    from llvmlite.ir import Value
    from numba.core.compiler import StateDict
    from numba.core.types import Record, Type
    from numba.core.typing.templates import Signature

    from carom.core.compiling.signatures import RecallingContext

PARTS = "real", "imag"


@register_pass(mutates_CFG=True, analysis_only=False)
class KernelLowering(BaseNativeLowering):  # type: ignore[misc]
    """Numba's step from a typed function to code, for kernels."""

    _name = "carom_lowering"

    def run_pass(self, state: StateDict) -> bool:
        """Generate the code of one function."""
        self._typing = state.typingctx
        return super().run_pass(state)

    @property
    def lowering_class(self) -> Callable[..., Lower]:
        """Makes what generates the code."""
        return partial(_Lower, self._typing)


class _Lower(Lower):  # type: ignore[misc]
    """Numba's generation of code, with operations and items of arrays on shorter ways.

    Parameters
    ----------
    typing : RecallingContext
        Recalls the types of the operations.
    others : Numba's arguments
    """

    def __init__(self, typing: RecallingContext, *others: object, **named: object) -> None:
        super().__init__(*others, **named)
        self._typing = typing

    def lower_expr(self, resty: Type, expr: ir.Expr) -> Value:
        """Evaluate an expression."""
        lowered = _SHORTER.get(expr.op)
        value = None if lowered is None else lowered(self, resty, expr)
        return super().lower_expr(resty, expr) if value is None else value

    def lower_binop(self, resty: Type, expr: ir.Expr, op: Callable[..., object]) -> Value:
        """Apply an operator; Numba tries other implementations where an operand is a literal."""
        if expr.static_lhs is not ir.UNDEFINED or expr.static_rhs is not ir.UNDEFINED:
            return super().lower_binop(resty, expr, op)
        return self._operation(op, self.fndesc.calltypes[expr], (expr.lhs, expr.rhs), resty)

    def lower_getitem(self, resty: Type, expr: ir.Expr, value: ir.Var, index: ir.Var, signature: Signature) -> Value:
        """Read an item."""
        place = self._place(value, index, signature)
        if place is None:
            return self._operation(operator.getitem, signature, (value, index), resty)
        item = load_item(self.context, self.builder, self.typeof(value.name), place)
        return self.context.cast(self.builder, item, signature.return_type, resty)

    def lower_setitem(self, target_var: ir.Var, index_var: ir.Var, value_var: ir.Var, signature: Signature) -> None:
        """Write an item."""
        place = self._place(target_var, index_var, signature)
        if place is None:
            return self._operation(operator.setitem, signature, (target_var, index_var, value_var))
        kind = self.typeof(target_var.name)
        return store_item(self.context, self.builder, kind, self._cast_var(value_var, kind.dtype), place)

    def _operation(
        self,
        operation: Callable[..., object],
        signature: Signature,
        operands: tuple[ir.Var, ...],
        resty: Type | None = None,
    ) -> Value:
        values = [self._cast_var(operand, kind) for operand, kind in zip(operands, signature.args, strict=True)]
        if operation in COMPLEX_OPERATIONS and signature.args == (complex128, complex128):
            result = COMPLEX_OPERATIONS[operation](self.builder, *values)
        else:
            function = self.context.typing_context.resolve_value_type(operation)
            typed = self._typing.resolve_function_type(function, signature.args, {})
            result = self.context.get_function(function, typed)(self.builder, values)
        return result if resty is None else self.context.cast(self.builder, result, signature.return_type, resty)

    def _place(self, array: ir.Var, index: ir.Var, signature: Signature) -> Value | None:
        """Address of the item of an array at whole numbers, None for other indices."""
        kind, chosen = self.typeof(array.name), signature.args[1]
        several = isinstance(chosen, BaseTuple)
        axes = tuple(chosen) if several else (chosen,)
        whole = all(isinstance(axis, Integer) for axis in axes)
        if not (whole and isinstance(kind, Array) and kind.layout == "C" and kind.ndim == len(axes) > 0):
            return None
        number = self._cast_var(index, chosen)
        numbers = cgutils.unpack_tuple(self.builder, number) if several else [number]
        places = [self.context.cast(self.builder, n, axis, intp) for n, axis in zip(numbers, axes, strict=True)]
        return item_address(self.builder, *self._layout(kind, self.loadvar(array.name)), places)

    def _layout(self, kind: Array, descriptor: Value) -> tuple[Value, list[Value]]:
        """Address and shape of an array; the shape of one in a record is constant."""
        model = default_manager[kind]
        data = model.get(self.builder, descriptor, "data")
        if isinstance(kind, NestedArray):
            return data, [Constant(IntType(64), size) for size in kind.shape]
        return data, cgutils.unpack_tuple(self.builder, model.get(self.builder, descriptor, "shape"))

    def _attribute(self, resty: Type, expr: ir.Expr) -> Value | None:
        """Part of a complex number, or the description of an array in a record."""
        kind = self.typeof(expr.value.name)
        if isinstance(resty, NestedArray):
            return self._array_in_record(kind, expr.attr, self.loadvar(expr.value.name))
        if kind == complex128 and expr.attr in PARTS:
            return self.builder.extract_value(self.loadvar(expr.value.name), PARTS.index(expr.attr))
        return None

    def _array_in_record(self, kind: Record, name: str, record: Value) -> Value:
        """Description of an array in a record."""
        array = cast("NestedArray", kind.typeof(name))
        item = self.context.get_data_type(array.dtype)
        data = cgutils.get_record_member(self.builder, record, kind.offset(name), item)
        return array_in_record(self.builder, default_manager[array], data)

    def _lower_call_normal(self, fnty: Type, expr: ir.Expr, signature: Signature) -> Value:
        """Call a function: the conjugate of a number, the largest or smallest of several, a range, or any other."""
        called, kinds = getattr(fnty, "typing_key", None), signature.args
        if called == "complex.conjugate" and signature.recvr == complex128:
            return conjugate(self.builder, self.loadvar(expr.func.name))
        simple = not (expr.kws or expr.vararg)
        if simple and called in EXTREMES and len(kinds) > 1 and set(kinds) in ({float64}, {int64}):
            return extreme(self.builder, called, [self._cast_var(argument, kinds[0]) for argument in expr.args])
        if simple and called is range and len(kinds) < 3:
            limits = [self._cast_var(argument, kind) for argument, kind in zip(expr.args, kinds, strict=True)]
            return range_of(self.builder, self.context.get_value_type(signature.return_type), limits)
        return super()._lower_call_normal(fnty, expr, signature)

    def _iterator(self, resty: Type, expr: ir.Expr) -> Value | None:
        """Iterator over a range in steps of one."""
        made = guard(get_definition, self.func_ir, expr.value)
        called = isinstance(made, ir.Expr) and made.op == "call" and len(made.args) < 3
        if not (called and isinstance(self.typeof(expr.value.name), RangeType)):
            return None
        kind = self.context.get_value_type(resty)
        return begin_range(self.builder, kind, self.loadvar(expr.value.name))

    def _next(self, resty: Type, expr: ir.Expr) -> Value | None:
        """Next number of a range."""
        if not isinstance(self.typeof(expr.value.name), RangeIteratorType):
            return None
        return next_in_range(self.builder, self.context.get_value_type(resty), self.loadvar(expr.value.name))

    def _of_pair(self, resty: Type, expr: ir.Expr) -> Value | None:
        """Member of a pair."""
        if _is_counted(resty):
            return None
        place = 0 if expr.op == "pair_first" else 1
        return self.builder.extract_value(self.loadvar(expr.value.name), place)

    def storevar(self, value: Value, name: str, argidx: int | None = None) -> None:
        """Store a variable."""
        kind = self.typeof(name)
        if _is_counted(kind):
            super().storevar(value, name, argidx)
            return
        self._alloca_var(name, kind)
        if name in self._singly_assigned_vars:
            self._blk_local_varmap[name] = value
        else:
            self.builder.store(value, self.getvar(name))

    def delvar(self, name: str) -> None:
        """Release what a variable refers to."""
        if _is_counted(self.typeof(name)):
            super().delvar(name)

    def alloca(self, name: str, type: Type) -> Value:
        """Reserve the place of a variable."""
        if _is_counted(type):
            return super().alloca(name, type)
        return variable(self.builder, self.context.get_value_type(type), name)

    def incref(self, typ: Type, val: Value) -> None:
        """Count a reference."""
        if _is_counted(typ):
            super().incref(typ, val)

    def decref(self, typ: Type, val: Value) -> None:
        """Count one reference less."""
        if _is_counted(typ):
            super().decref(typ, val)


@cache
def _is_counted(kind: Type) -> bool:
    """Whether references to values of a type are counted."""
    return not isinstance(kind, NestedArray) and bool(default_manager[kind].contains_nrt_meminfo())


_SHORTER: dict[str, Callable[[_Lower, Type, ir.Expr], Value | None]] = {
    "getattr": _Lower._attribute,
    "getiter": _Lower._iterator,
    "iternext": _Lower._next,
    "pair_first": _Lower._of_pair,
    "pair_second": _Lower._of_pair,
}
"""Expressions with a shorter way for some types; the method returns None for others."""
