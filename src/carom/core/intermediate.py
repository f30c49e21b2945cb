"""Kernels that are called by other kernels: compiled to intermediate code for the caller, and no further.

For each version of a function, Numba generates machine code and wrappers for callers from Python and C.  It does so
even for functions that only other functions call, and each such caller gets its own copy of the code.  Most kernels are
called by kernels only, so most of their machine code would never run.
"""

from __future__ import annotations

import gc
from hashlib import sha256
from typing import Any

from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompileResult
from numba.core.dispatcher import _FunctionCompiler  # type: ignore[attr-defined]
from numba.core.funcdesc import default_mangler
from numba.core.registry import CPUDispatcher
from numba.core.types import unliteral  # type: ignore[attr-defined]

from carom.core.steps import KernelCompiler


def serve_kernels(kernel: Any) -> None:
    """Make a kernel provide intermediate code only to the kernels that call it."""
    options = {**kernel.targetoptions, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    twin = _IntermediateKernel(kernel.py_func, locals={}, targetoptions=options, pipeline_class=_Pipeline)
    twin._compiler = _IntermediateCompiler(kernel.py_func, twin.targetdescr, options, {}, _Pipeline)
    kernel.get_call_template, kernel.get_overload = twin.get_call_template, twin.get_overload


def share_machine_code(kernel: Any) -> None:
    """Make the kernels that call a kernel use its machine code, which is compiled once for them and for Python.

    Callers are kept on the disk with the name that they call, which :class:`SharedPipeline` makes the same in each process.
    """
    add_overload, get_call_template = kernel.add_overload, kernel.get_call_template

    def add(result: CompileResult) -> None:
        result.library.version = kernel.py_func.__module__, kernel.py_func.__name__, result.signature.args
        add_overload(result)

    kernel.add_overload = add
    kernel.get_call_template = lambda args, kws: get_call_template(tuple(map(unliteral, args)), kws)


class _IntermediateKernel(CPUDispatcher):  # type: ignore[misc]
    """The versions of a kernel for calls from other kernels: one for all numbers of a type, literal or not."""

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Type a call with arguments of these types."""
        return super().get_call_template(tuple(map(unliteral, args)), kws)

    def add_overload(self, cres: CompileResult) -> None:
        """Store a version without offering it to callers from Python."""
        self.overloads[tuple(cres.signature.args)] = cres


class _IntermediateLibrary(JITCodeLibrary):  # type: ignore[misc]
    """Intermediate code for callers, without machine code.

    A kernel that is not inlined is linked only into the outermost caller, which Python calls.  Otherwise each caller in
    between would contain a copy and optimise it again.
    """

    apart = False
    """Whether this is the code of a kernel that is not inlined."""

    def finalize(self) -> None:
        """Link the callees that are inlined, and optimise."""
        self._left_out = self.left_out()
        self._linking_libraries[:] = [library for library in self._linking_libraries if library not in self._left_out]
        super().finalize()
        self.defined, self.called = _functions(self, True), _functions(self, False)

    def left_out(self) -> list[Any]:
        """Code of callees that the outermost caller has to link."""
        if self._finalized:
            return self._left_out
        return list({library: None for library in self._linking_libraries if _is_left_out(library)})

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True


class _CallerLibrary(JITCodeLibrary):  # type: ignore[misc]
    """Code of a kernel that Python calls, with that of all kernels it reaches except those that share theirs."""

    def __init__(self, *args: Any) -> None:
        super().__init__(*args)
        self.needs: dict[Any, None] = {}
        """Versions of kernels whose machine code this one calls."""

    def add_linking_library(self, library: Any) -> None:
        """Add the code of a callee, unless it shares its machine code."""
        version = getattr(library, "version", None)
        if version is None:
            super().add_linking_library(library)
        else:
            self.needs[version] = None

    def finalize(self) -> None:
        """Link the callees that are inlined, then the others, and optimise."""
        self._apart = [library for library in self._linking_libraries if getattr(library, "apart", False)]
        self._linking_libraries[:] = [library for library in self._linking_libraries if library not in self._apart]
        super().finalize()

    def _optimize_final_module(self) -> None:
        for library in _callers_first(_functions(self, False), self._apart):
            self._final_module.link_in(library._get_module_for_linking(), preserve=True)
        super()._optimize_final_module()


def _is_left_out(library: Any) -> bool:
    return getattr(library, "apart", False) or hasattr(library, "version")


def _callers_first(called: set[str], libraries: list[_IntermediateLibrary]) -> list[_IntermediateLibrary]:
    """The libraries that functions of these names reach, each after all its callers.

    The linker drops a function that nothing linked before it calls, and Numba does not link it a second time.
    """
    makers = {name: library for library in libraries for name in library.defined}
    ordered: dict[_IntermediateLibrary, None] = {}

    def visit(names: set[str]) -> None:
        for name in sorted(names & makers.keys()):
            if makers[name] not in ordered:
                visit(makers[name].called)
                ordered[makers[name]] = None

    visit(called)
    return list(reversed(ordered))


def _functions(library: Any, defined: bool) -> set[str]:
    """Names of the functions that a library defines, or of those that it only declares."""
    return {function.name for function in library._final_module.functions if function.is_declaration != defined}


class CallerPipeline(KernelCompiler):
    """Numba's compiler pipeline for kernels that Python calls."""

    def compile_extra(self, func: Any) -> Any:
        """Compile a version; garbage is collected afterwards, which saves a seventh of the time."""
        collecting = gc.isenabled()
        gc.disable()
        try:
            return super().compile_extra(func)
        finally:
            if collecting:
                gc.enable()

    def define_pipelines(self) -> Any:
        """The steps of compilation."""
        self.state.library = _CallerLibrary(self.state.targetctx.codegen(), self.state.func_id.func_qualname)
        self.state.library.enable_object_caching()
        return super().define_pipelines()


class SharedPipeline(CallerPipeline):
    """Numba's compiler pipeline for kernels that share their machine code."""

    def define_pipelines(self) -> Any:
        """The steps of compilation."""
        self.state.targetctx.mangler = self._symbol
        return super().define_pipelines()

    def _symbol(self, name: str, kinds: Any, *, abi_tags: Any = (), uid: int | None = None) -> str:
        """Name in the machine code: that of Numba counts functions and records, and so differs between processes."""
        if uid != self.state.func_id.unique_id:  # a function that Numba compiles for this one
            return default_mangler(name, kinds, abi_tags=abi_tags, uid=uid)
        return default_mangler(name, (), abi_tags=(sha256(repr(kinds).encode()).hexdigest(),))


class _Pipeline(KernelCompiler):
    """Numba's compiler pipeline for kernels that other kernels call."""

    def define_pipelines(self) -> Any:
        """The steps of compilation."""
        self.state.library = _IntermediateLibrary(self.state.targetctx.codegen(), self.state.func_id.func_qualname)
        return super().define_pipelines()


class _IntermediateCompiler(_FunctionCompiler):  # type: ignore[misc]
    """Compile a version, and register it for the compilation of its callers."""

    def _customize_flags(self, flags: Any) -> Any:
        flags.no_compile = True
        return flags

    def compile(self, args: Any, return_type: Any) -> CompileResult:
        """Compile a version for given argument types."""
        result = super().compile(args, return_type)
        result = result._replace(entry_point=object())  # Numba's key of the version; there is no machine code to call
        result.library.apart = not self.targetoptions.get("forceinline", False)
        libraries = [result.library, *result.library.left_out()]
        result.target_context.insert_user_function(result.entry_point, result.fndesc, libraries)
        return result
