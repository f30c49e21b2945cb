"""Kernels that are called by other kernels: compiled to intermediate code for the caller, and no further.

For each version of a function, Numba generates machine code and wrappers for callers from Python and C.  It does so
even for functions that only other functions call, and each such caller gets its own copy of the code.  Most kernels are
called by kernels only, so most of their machine code would never run.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numba
from numba.core.compiler import CompileResult
from numba.core.dispatcher import _FunctionCompiler  # type: ignore[attr-defined]
from numba.core.registry import CPUDispatcher
from numba.core.types import unliteral  # type: ignore[attr-defined]

from carom.core.compiling.libraries import CallerLibrary, IntermediateLibrary
from carom.core.compiling.steps import KernelCompiler

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numba.core.compiler import Flags
    from numba.core.compiler_machinery import PassManager
    from numba.core.types import Type
    from numba.core.typing.templates import CallableTemplate


def compile_once(function: Callable[..., object], options: Mapping[str, object], share: bool) -> CPUDispatcher:
    """A kernel that other kernels use as intermediate code or, if it is to be shared, as machine code; Python calls either."""
    kernel = numba.jit(**options, pipeline_class=_CallerPipeline)(function)
    (_share_machine_code if share else _serve_kernels)(kernel)
    return kernel


def _serve_kernels(kernel: CPUDispatcher) -> None:
    """Make a kernel provide intermediate code only to the kernels that call it."""
    options = {**kernel.targetoptions, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    twin = _IntermediateKernel(kernel.py_func, locals={}, targetoptions=options, pipeline_class=_Pipeline)
    twin._compiler = _IntermediateCompiler(kernel.py_func, twin.targetdescr, options, {}, _Pipeline)
    kernel.get_call_template, kernel.get_overload = twin.get_call_template, twin.get_overload


def _share_machine_code(kernel: CPUDispatcher) -> None:
    """Make the kernels that call a kernel use its machine code, which is compiled once for them and for Python.

    Callers are kept on the disk with the name that they call, which is the same in each process (:mod:`carom.core.compiling.names`).
    """
    add_overload, get_call_template = kernel.add_overload, kernel.get_call_template

    def add(result: CompileResult) -> None:
        result.library.version = kernel.py_func.__module__, kernel.py_func.__name__, result.signature.args
        add_overload(result)

    kernel.add_overload = add
    kernel.get_call_template = lambda args, kws: get_call_template(tuple(map(unliteral, args)), kws)


class _IntermediateKernel(CPUDispatcher):  # type: ignore[misc]
    """The versions of a kernel for calls from other kernels: one for all numbers of a type, literal or not."""

    def get_call_template(self, args: tuple[Type, ...], kws: Mapping[str, Type]) -> CallableTemplate:
        """Type a call with arguments of these types."""
        return super().get_call_template(tuple(map(unliteral, args)), kws)

    def add_overload(self, cres: CompileResult) -> None:
        """Store a version without offering it to callers from Python."""
        self.overloads[tuple(cres.signature.args)] = cres


class _CallerPipeline(KernelCompiler):
    """Numba's compiler pipeline for kernels that Python calls."""

    def define_pipelines(self) -> list[PassManager]:
        """The steps of compilation."""
        self.state.library = CallerLibrary(self.state.targetctx.codegen(), self.state.func_id.func_qualname)
        self.state.library.enable_object_caching()
        return super().define_pipelines()


class _Pipeline(KernelCompiler):
    """Numba's compiler pipeline for kernels that other kernels call."""

    def define_pipelines(self) -> list[PassManager]:
        """The steps of compilation."""
        self.state.library = IntermediateLibrary(self.state.targetctx.codegen(), self.state.func_id.func_qualname)
        return super().define_pipelines()


class _IntermediateCompiler(_FunctionCompiler):  # type: ignore[misc]
    """Compile a version, and register it for the compilation of its callers."""

    def _customize_flags(self, flags: Flags) -> Flags:
        flags.no_compile = True
        return flags

    def compile(self, args: tuple[Type, ...], return_type: Type | None) -> CompileResult:
        """Compile a version for given argument types."""
        result = super().compile(args, return_type)
        result = result._replace(entry_point=object())  # Numba's key of the version; there is no machine code to call
        result.library.apart = not self.targetoptions.get("forceinline", False)
        libraries = [result.library, *result.library.left_out()]
        result.target_context.insert_user_function(result.entry_point, result.fndesc, libraries)
        return result
