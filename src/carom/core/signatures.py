"""Types of operations, inferred once for all kernels.

For each operation of each function, Numba's type inference tries all definitions that anybody has registered: those of a sum for
numbers, arrays, strings, lists, dates.  Kernels repeat the same few hundred operations on the same types.
"""

from __future__ import annotations

import operator
from collections import defaultdict
from typing import Any, ClassVar

from numba.core import types


class RecallingContext:
    """Numba's typing context that recalls the types of operations; calls of kernels are not operations.

    Parameters
    ----------
    context : Numba's typing context
    flags : Numba's flags of the function that is compiled
        Definitions that Numba compiles from Python source inherit some of them, so each set of flags has its own types.
    """

    _known: ClassVar[dict[str, dict[Any, Any]]] = defaultdict(dict)

    def __init__(self, context: Any, flags: Any) -> None:
        self._context = context
        self._found = self._known[flags.summary()]

    def __getattr__(self, name: str) -> Any:
        return getattr(self._context, name)

    def resolve_function_type(self, function: Any, args: Any, keywords: Any) -> Any:
        """The signature of a call, None if there is none."""
        if not isinstance(function, types.Type):  # an operation that is no name in the kernel
            function = self._context._lookup_global(function) or function
        if keywords or not isinstance(function, types.BaseFunction | types.BoundFunction):
            return self._context.resolve_function_type(function, args, keywords)
        key = function, args
        if key not in self._found:
            self._found[key] = self._context.resolve_function_type(function, args, keywords)
        return self._found[key]

    def resolve_setitem(self, target: Any, index: Any, value: Any) -> Any:
        """The signature of an assignment to an item, None if there is none."""
        return self.resolve_function_type(
            self._context.resolve_value_type(operator.setitem), (target, index, value), {}
        )

    def resolve_getattr(self, kind: Any, name: str) -> Any:
        """The type of an attribute of a value of this type, None if there is none."""
        key = kind, name
        if key not in self._found:
            self._found[key] = self._context.resolve_getattr(kind, name)
        return self._found[key]
