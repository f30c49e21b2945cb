"""Shapes of arrays in records as constants, so that code for other shapes is dropped before it is compiled.

Branches like ``if rotor.rows.shape[0] > 1`` are decided by the type of the record.  Numba infers types of both sides
and generates code for both, unless the condition consists of constants.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from numba.core import ir, types
from numba.core.compiler_machinery import FunctionPass, register_pass
from numba.core.ir_utils import build_definitions, find_const, get_definition, guard

if TYPE_CHECKING:
    from numba.core.compiler import StateDict


@register_pass(mutates_CFG=False, analysis_only=False)
class RecordShapes(FunctionPass):  # type: ignore[misc]
    """Replace ``record.array.shape[i]`` by its value, for records that are arguments."""

    _name = "carom_record_shapes"

    def __init__(self) -> None:
        super().__init__()

    def run_pass(self, state: StateDict) -> bool:
        """Rewrite one function before its types are inferred; returns whether it has changed."""
        found = False
        for block in state.func_ir.blocks.values():
            for assignment in block.find_insts(ir.Assign):
                length = guard(_length, state.func_ir, state.args, assignment.value)
                if length is not None:
                    assignment.value = ir.Const(length, assignment.loc)
                    found = True
        if found:
            state.func_ir._definitions = build_definitions(state.func_ir.blocks)
        return found


def _length(function: ir.FunctionIR, arguments: tuple[types.Type, ...], item: object) -> int | None:
    """Value of an expression ``record.array.shape[i]``, None for any other expression."""
    if not (isinstance(item, ir.Expr) and item.op in ("getitem", "static_getitem")):
        return None
    shape = get_definition(function, item.value)
    if not _is_attribute(shape) or shape.attr != "shape":
        return None
    array = get_definition(function, shape.value)
    if not _is_attribute(array):
        return None
    record = get_definition(function, array.value)
    kind = arguments[record.index] if isinstance(record, ir.Arg) else None
    if not isinstance(kind, types.Record) or array.attr not in kind.fields:
        return None
    axis = item.index if item.op == "static_getitem" else find_const(function, item.index)
    return int(cast("types.NestedArray", kind.typeof(array.attr)).shape[axis])


def _is_attribute(expression: object) -> bool:
    return isinstance(expression, ir.Expr) and expression.op == "getattr"
