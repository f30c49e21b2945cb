"""The code of a kernel for LLVM, without what kernels do not need.

Numba looks up the implementation of an operation by inferring its types again, copies the description of an array to memory
before it reads an item, clears variables that own nothing, and describes variables to debuggers.
"""

from __future__ import annotations

import operator
from functools import cache, partial
from typing import Any

from llvmlite.ir import Constant, IntType
from numba.core import cgutils, ir
from numba.core.compiler_machinery import register_pass
from numba.core.datamodel import default_manager
from numba.core.lowering import Lower
from numba.core.typed_passes import BaseNativeLowering
from numba.core.types import Array, BaseTuple, Integer, NestedArray  # type: ignore[attr-defined]
from numba.np.arrayobj import fix_integer_index, load_item, store_item


@register_pass(mutates_CFG=True, analysis_only=False)
class KernelLowering(BaseNativeLowering):  # type: ignore[misc]
    """Numba's step from a typed function to code, for kernels."""

    _name = "carom_lowering"

    def run_pass(self, state: Any) -> Any:
        """Generate the code of one function."""
        self._typing = state.typingctx
        return super().run_pass(state)

    @property
    def lowering_class(self) -> Any:
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

    def __init__(self, typing: Any, *others: Any, **named: Any) -> None:
        super().__init__(*others, **named)
        self._typing = typing

    def lower_binop(self, resty: Any, expr: Any, op: Any) -> Any:
        """Apply an operator; Numba tries other implementations where an operand is a literal."""
        if expr.static_lhs is not ir.UNDEFINED or expr.static_rhs is not ir.UNDEFINED:
            return super().lower_binop(resty, expr, op)
        return self._operation(op, self.fndesc.calltypes[expr], (expr.lhs, expr.rhs), resty)

    def lower_getitem(self, resty: Any, expr: Any, value: Any, index: Any, signature: Any) -> Any:
        """Read an item."""
        place = self._place(value, index, signature)
        if place is None:
            return self._operation(operator.getitem, signature, (value, index), resty)
        item = load_item(self.context, self.builder, self.typeof(value.name), place)
        return self.context.cast(self.builder, item, signature.return_type, resty)

    def lower_setitem(self, target_var: Any, index_var: Any, value_var: Any, signature: Any) -> Any:
        """Write an item."""
        place = self._place(target_var, index_var, signature)
        if place is None:
            return self._operation(operator.setitem, signature, (target_var, index_var, value_var))
        kind = self.typeof(target_var.name)
        return store_item(self.context, self.builder, kind, self._cast_var(value_var, kind.dtype), place)

    def _operation(self, operation: Any, signature: Any, operands: tuple[Any, ...], resty: Any = None) -> Any:
        function = self.context.typing_context.resolve_value_type(operation)
        values = [self._cast_var(operand, kind) for operand, kind in zip(operands, signature.args, strict=True)]
        typed = self._typing.resolve_function_type(function, signature.args, {})
        result = self.context.get_function(function, typed)(self.builder, values)
        return result if resty is None else self.context.cast(self.builder, result, signature.return_type, resty)

    def _place(self, array: Any, index: Any, signature: Any) -> Any:
        """Address of the item of an array at whole numbers, None for other indices."""
        kind, chosen = self.typeof(array.name), signature.args[1]
        several = isinstance(chosen, BaseTuple)
        axes = tuple(chosen) if several else (chosen,)
        whole = all(isinstance(axis, Integer) for axis in axes)
        if not (whole and isinstance(kind, Array) and kind.ndim == len(axes)):
            return None
        number = self._cast_var(index, chosen)
        numbers = cgutils.unpack_tuple(self.builder, number) if several else [number]
        data, shape, strides = self._layout(kind, self.loadvar(array.name))
        places = [
            fix_integer_index(self.context, self.builder, axis, number, size)
            for axis, number, size in zip(axes, numbers, shape, strict=True)
        ]
        return cgutils.get_item_pointer2(self.context, self.builder, data, shape, strides, kind.layout, places)

    def _layout(self, kind: Any, descriptor: Any) -> tuple[Any, list[Any], list[Any]]:
        """Address, shape and strides of an array; those of an array in a record are constants."""
        model = default_manager[kind]
        data = model.get(self.builder, descriptor, "data")
        if isinstance(kind, NestedArray):
            shape, strides = ([Constant(IntType(64), size) for size in sizes] for sizes in (kind.shape, kind.strides))
        else:
            parts = (model.get(self.builder, descriptor, name) for name in ("shape", "strides"))
            shape, strides = (cgutils.unpack_tuple(self.builder, part) for part in parts)
        return data, shape, strides

    def storevar(self, value: Any, name: str, argidx: int | None = None) -> None:
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

    def alloca_lltype(self, name: str, lltype: Any, datamodel: Any = None) -> Any:
        """Reserve the place of a variable."""
        return cgutils.alloca_once(self.builder, lltype, name=name)

    def incref(self, typ: Any, val: Any) -> None:
        """Count a reference."""
        if _is_counted(typ):
            super().incref(typ, val)

    def decref(self, typ: Any, val: Any) -> None:
        """Count one reference less."""
        if _is_counted(typ):
            super().decref(typ, val)


@cache
def _is_counted(kind: Any) -> bool:
    """Whether references to values of a type are counted."""
    return bool(default_manager[kind].contains_nrt_meminfo())
