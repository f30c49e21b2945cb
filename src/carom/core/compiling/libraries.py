"""The code of kernels for LLVM: what is linked into which kernel, and where it is optimised.

Numba optimises each function three times: by itself, with the functions that are inlined into it, and with all that the
outermost caller reaches.  The last time decides how fast the kernel is; before, no more is done than keeps the code short.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from numba.core.codegen import JITCodeLibrary

if TYPE_CHECKING:
    from llvmlite.binding import ModulePassManager, ModuleRef, PassBuilder


class _Library(JITCodeLibrary):  # type: ignore[misc]
    """Code of a kernel, optimised in full by the kernel that Python calls."""

    def _optimize_functions(self, module: ModuleRef) -> None:
        """Keep variables in registers instead of memory, and drop empty blocks."""
        module.data_layout = self._codegen._data_layout
        for function in module.functions:
            if not function.is_declaration:
                passes, builder = self._codegen._function_pass_manager(opt=0)
                passes.add_sroa_pass()
                passes.add_simplify_cfg_pass()
                passes.run(function, builder)

    def _optimize_final_module(self) -> None:
        passes, builder = self._passes()
        passes.run(self._final_module, builder)

    def _passes(self) -> tuple[ModulePassManager, PassBuilder]:
        """Passes over all functions."""
        return self._codegen._module_pass_manager()


class IntermediateLibrary(_Library):
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

    def left_out(self) -> list[JITCodeLibrary]:
        """Code of callees that the outermost caller has to link."""
        if self._finalized:
            return self._left_out
        return list({library: None for library in self._linking_libraries if _is_left_out(library)})

    def _passes(self) -> tuple[ModulePassManager, PassBuilder]:
        passes, builder = self._codegen._module_pass_manager(opt=0)
        passes.add_sroa_pass()
        return passes, builder

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True


class CallerLibrary(_Library):
    """Code of a kernel that Python calls, with that of all kernels it reaches except those that share theirs."""

    def __init__(self, *args: object) -> None:
        super().__init__(*args)
        self.needs: dict[tuple[object, ...], None] = {}
        """Versions of kernels whose machine code this one calls."""

    def add_linking_library(self, library: JITCodeLibrary) -> None:
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


def _is_left_out(library: JITCodeLibrary) -> bool:
    return getattr(library, "apart", False) or hasattr(library, "version")


def _callers_first(called: set[str], libraries: list[IntermediateLibrary]) -> list[IntermediateLibrary]:
    """The libraries that functions of these names reach, each after all its callers.

    The linker drops a function that nothing linked before it calls, and Numba does not link it a second time.
    """
    makers = {name: library for library in libraries for name in library.defined}
    ordered: dict[IntermediateLibrary, None] = {}

    def visit(names: set[str]) -> None:
        for name in sorted(names & makers.keys()):
            if makers[name] not in ordered:
                visit(makers[name].called)
                ordered[makers[name]] = None

    visit(called)
    return list(reversed(ordered))


def _functions(library: JITCodeLibrary, defined: bool) -> set[str]:
    """Names of the functions that a library defines, or of those that it only declares."""
    return {function.name for function in library._final_module.functions if function.is_declaration != defined}
