"""Calls from one kernel to another, as code for LLVM.

A compiled function returns zero; any other number stands for an exception in it, such as for want of memory.  Numba tells six
outcomes of a call apart, and looks for a ``try`` around it; kernels have none.
"""

from __future__ import annotations

from typing import Any

from llvmlite.ir import Constant, IntType
from numba.core.callconv import RETCODE_OK, CPUCallConv, Status
from numba.core.cpu import CPUContext
from numba.core.types import Optional  # type: ignore[attr-defined]

from carom.core.instructions import variable

EXCEPTION = "excinfo"
"""Name of the argument of a compiled function where it describes an exception."""


class _Calls(CPUCallConv):  # type: ignore[misc]
    """Numba's rules of calls, with less code at the place of a call from a kernel."""

    def call_function(
        self, builder: Any, callee: Any, resty: Any, argtys: Any, args: Any, attrs: Any = None
    ) -> tuple[Any, Any]:
        """Call a compiled function; an exception in it is described where the caller describes its own."""
        caller = builder.function.args
        if isinstance(resty, Optional) or attrs is not None or len(caller) < 2 or caller[1].name != EXCEPTION:
            return super().call_function(builder, callee, resty, argtys, args, attrs)
        place = variable(builder, self.get_return_type(resty).pointee)
        arguments = self._get_arg_packer(argtys).as_arguments(builder, args)
        code = builder.call(callee, [place, caller[1], *arguments])
        value = self.context.get_returned_value(builder, resty, builder.load(place))
        return _status(builder, code), value

    def return_status_propagate(self, builder: Any, status: Any) -> None:
        """Return from the caller too."""
        if status.excinfoptr is None:
            builder.ret(status.code)
        else:
            super().return_status_propagate(builder, status)


def _status(builder: Any, code: Any) -> Any:
    """Outcome of the call of a function that always returns a value."""
    failed = builder.icmp_signed("!=", code, RETCODE_OK)
    known = dict.fromkeys(Status._fields)
    return Status(**{**known, "code": code, "is_error": failed, "is_none": Constant(IntType(1), 0)})


class KernelContext(CPUContext):  # type: ignore[misc]
    """What Numba knows of the processor and of types, with these calls."""

    @property
    def call_conv(self) -> Any:
        """How compiled functions are called."""
        return _Calls(self)
