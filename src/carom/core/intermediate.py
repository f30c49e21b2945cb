"""Kernels as other kernels see them: compiled as far as the code that is put into the caller, and no further.

Numba makes of each version of a function machine code, and wrappers for callers from Python and C, also where nobody but
another function calls it, and gives that one a copy of its own.  Most kernels are of that kind, and most of what they are
compiled to would never run.
"""

from __future__ import annotations

from typing import Any

from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, CompileResult
from numba.core.dispatcher import _FunctionCompiler  # type: ignore[attr-defined]
from numba.core.registry import CPUDispatcher

__all__ = ["serve_kernels"]


def serve_kernels(kernel: Any) -> None:
    """Have a kernel serve its callers among kernels with intermediate code alone."""
    options = {**kernel.targetoptions, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    twin = _IntermediateKernel(kernel.py_func, locals={}, targetoptions=options, pipeline_class=_Pipeline)
    twin._compiler = _IntermediateCompiler(kernel.py_func, twin.targetdescr, options, {}, _Pipeline)
    kernel.get_call_template, kernel.get_overload = twin.get_call_template, twin.get_overload


class _IntermediateKernel(CPUDispatcher):  # type: ignore[misc]
    """The versions of a kernel that other kernels call."""

    def add_overload(self, cres: CompileResult) -> None:
        """Keep a version, without showing it to callers from Python."""
        self.overloads[tuple(cres.signature.args)] = cres


class _IntermediateLibrary(JITCodeLibrary):  # type: ignore[misc]
    """Code that is made ready for its callers, not for the processor.

    A kernel that is not compiled into its callers is brought in by the last of them alone, which Python calls: each caller
    on the way would take a copy along and optimise it again.
    """

    apart = False
    """Whether it is the code of such a kernel."""

    def finalize(self) -> None:
        """Bring in what is called and not apart, and optimise."""
        self._left_out = self.left_out()
        self._linking_libraries[:] = [library for library in self._linking_libraries if library not in self._left_out]
        super().finalize()

    def left_out(self) -> list[Any]:
        """Code that is called, and left to the last caller to bring in."""
        if self._finalized:
            return self._left_out
        return [library for library in self._linking_libraries if getattr(library, "apart", False)]

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True


class _Pipeline(Compiler):  # type: ignore[misc]
    """Numba's own, with such a library."""

    def define_pipelines(self) -> Any:
        """The steps of compilation."""
        self.state.library = _IntermediateLibrary(self.state.targetctx.codegen(), self.state.func_id.func_qualname)
        return super().define_pipelines()


class _IntermediateCompiler(_FunctionCompiler):  # type: ignore[misc]
    """Compiles a version, and tells Numba where to find it when a caller is compiled."""

    def _customize_flags(self, flags: Any) -> Any:
        flags.no_compile = True
        return flags

    def compile(self, args: Any, return_type: Any) -> CompileResult:
        """Compile a version for types of arguments."""
        result = super().compile(args, return_type)
        result = result._replace(entry_point=object())  # by which Numba knows a version; there is nothing to enter
        result.library.apart = not self.targetoptions.get("forceinline", False)
        libraries = [result.library, *result.library.left_out()]
        result.target_context.insert_user_function(result.entry_point, result.fndesc, libraries)
        return result
