"""Numba's steps of compilation, as kernels need them."""

from __future__ import annotations

from typing import Any

from numba.core.compiler import Compiler
from numba.core.untyped_passes import InlineInlinables, RewriteSemanticConstants

from carom.compiling.shapes import RecordShapes


class KernelCompiler(Compiler):  # type: ignore[misc]
    """Numba's compiler; shapes of records become constants before branches are pruned, and again after functions are inlined."""

    def define_pipelines(self) -> Any:
        """The steps of compilation."""
        (pipeline,) = super().define_pipelines()
        for step in RewriteSemanticConstants, InlineInlinables:
            pipeline.add_pass_after(RecordShapes, step)
        pipeline.finalize()
        return [pipeline]
