"""Names of kernels in machine code: the same in every process, and different for different code.

Numba names a function after how many functions were compiled before it, and a record among its arguments after how many types were met before
it.  Two processes thus give one name to different code.  Both are kept on the disk, and where a third process loads both, a call runs whichever was loaded first.
"""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from numba.core.compiler import Compiler
from numba.core.funcdesc import default_mangler
from numba.core.serialize import dumps

if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import FunctionType

    from numba.core.compiler_machinery import PassManager
    from numba.core.types import Type


class NamingCompiler(Compiler):  # type: ignore[misc]
    """Numba's compiler, which names what it compiles by what it is compiled from."""

    def define_pipelines(self) -> list[PassManager]:
        """The steps of compilation."""
        self.state.targetctx.mangler = self._symbol
        return super().define_pipelines()

    def _symbol(self, name: str, kinds: Sequence[Type], *, abi_tags: Sequence[str] = (), uid: int | None = None) -> str:
        if uid != self.state.func_id.unique_id:  # a function that Numba compiles for this one
            return default_mangler(name, kinds, abi_tags=abi_tags, uid=uid)
        origin = type(self).__name__, source_of(self.state.func_id.func), kinds
        return default_mangler(name, (), abi_tags=(hashlib.sha256(repr(origin).encode()).hexdigest(),))


def source_of(function: FunctionType) -> tuple[str, str, int, bytes]:
    """What identifies a function in every process: its module, its source, its place there and what it closes over."""
    code, cells = function.__code__, function.__closure__ or ()
    contents = dumps(tuple(cell.cell_contents for cell in cells))
    return function.__module__, _hash(code.co_filename), code.co_firstlineno, contents


@cache
def _hash(path: str) -> str:
    """Hash of a source file."""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()
