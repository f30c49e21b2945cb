"""Numba's steps of compilation, as kernels need them."""

from __future__ import annotations

from typing import Any

from numba.core.compiler import Compiler
from numba.core.typed_passes import InlineOverloads, NativeLowering, NopythonRewrites
from numba.core.untyped_passes import InlineClosureLikes, InlineInlinables, RewriteSemanticConstants

from carom.core.calls import KernelContext
from carom.core.lowering import KernelLowering
from carom.core.shapes import RecordShapes
from carom.core.signatures import RecallingContext

LEFT_OUT = InlineClosureLikes, InlineOverloads, NopythonRewrites
"""Steps that change nothing in kernels: for closures, for overloads that are inlined, and for expressions of whole arrays."""


class KernelCompiler(Compiler):  # type: ignore[misc]
    """Numba's compiler with steps of its own for kernels.

    Shapes of records become constants before branches are pruned, and again after functions are inlined.
    """

    def define_pipelines(self) -> Any:
        """The steps of compilation."""
        self.state.targetctx.__class__ = KernelContext  # of the copy that Numba makes for each compilation
        self.state.typingctx = RecallingContext(self.state.typingctx, self.state.flags)
        (pipeline,) = super().define_pipelines()
        for step in RewriteSemanticConstants, InlineInlinables:
            pipeline.add_pass_after(RecordShapes, step)
        pipeline.add_pass_after(KernelLowering, NativeLowering)
        pipeline.passes = [step for step in pipeline.passes if step[0] not in (*LEFT_OUT, NativeLowering)]
        pipeline.finalize()
        return [pipeline]
