"""Types of operations, inferred once for all kernels.

For each operation of each function, Numba's type inference tries all definitions that anybody has registered: those of a sum for
numbers, arrays, strings, lists, dates.  Kernels repeat the same few hundred operations on the same types.
"""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, ClassVar

from numba.core import types
from numba.core.targetconfig import ConfigStack
from numba.core.types import unliteral  # type: ignore[attr-defined]
from numba.core.typing import signature

from carom.core.compiling.instructions import EXTREMES

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numba.core.compiler import Flags
    from numba.core.typing.context import Context
    from numba.core.typing.templates import Signature


class RecallingContext:
    """Numba's typing context that recalls the types of operations; calls of kernels are not operations.

    Parameters
    ----------
    context : Numba's typing context
    flags : Numba's flags of the function that is compiled
        Operations that Numba compiles from Python source inherit some of them; here they are the same for all kernels, inlined or not.
    """

    _known: ClassVar[dict[tuple[object, ...], Signature | types.Type | None]] = {}

    def __init__(self, context: Context, flags: Flags) -> None:
        self._context = context
        self._flags = flags.copy()
        self._flags.forceinline = False

    def __getattr__(self, name: str) -> object:
        return getattr(self._context, name)

    def resolve_function_type(
        self, function: object, args: tuple[types.Type, ...], keywords: Mapping[str, types.Type]
    ) -> Signature | None:
        """The signature of a call, None if there is none."""
        if not isinstance(function, types.Type):  # an operation that is no name in the kernel
            function = self._context._lookup_global(function) or function
        if keywords or not isinstance(function, types.BaseFunction | types.BoundFunction):
            return self._context.resolve_function_type(function, args, keywords)
        return self._recalled(function, args)

    def _recalled(
        self, function: types.BaseFunction | types.BoundFunction, args: tuple[types.Type, ...]
    ) -> Signature | None:
        if (function, args) not in self._known:
            plain = tuple(map(unliteral, args))
            if function.typing_key in EXTREMES and len(plain) > 1 and set(plain) in ({types.float64}, {types.int64}):
                found = signature(plain[0], *plain)
            else:
                with ConfigStack().enter(self._flags):
                    found = self._context.resolve_function_type(function, args, {})
            self._known[function, args] = found
        return self._known[function, args]

    def resolve_setitem(self, target: types.Type, index: types.Type, value: types.Type) -> Signature | None:
        """The signature of an assignment to an item, None if there is none."""
        return self.resolve_function_type(
            self._context.resolve_value_type(operator.setitem), (target, index, value), {}
        )

    def resolve_getattr(self, kind: types.Type, name: str) -> types.Type | None:
        """The type of an attribute of a value of this type, None if there is none."""
        if (kind, name) not in self._known:
            self._known[kind, name] = self._context.resolve_getattr(kind, name)
        return self._known[kind, name]
