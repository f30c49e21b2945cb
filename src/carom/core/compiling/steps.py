"""Numba's steps of compilation, as kernels need them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from numba.core.typed_passes import NativeLowering
from numba.core.untyped_passes import InlineInlinables, RewriteSemanticConstants

from carom.core.compiling.lowering import KernelLowering
from carom.core.compiling.names import NamingCompiler
from carom.core.compiling.shapes import RecordShapes
from carom.core.compiling.signatures import RecallingContext

if TYPE_CHECKING:
    from numba.core.compiler_machinery import PassManager


class KernelCompiler(NamingCompiler):
    """Numba's compiler with steps of its own for kernels.

    Shapes of records become constants before branches are pruned, and again after functions are inlined.
    """

    def define_pipelines(self) -> list[PassManager]:
        """The steps of compilation."""
        self.state.typingctx = RecallingContext(self.state.typingctx, self.state.flags)
        (pipeline,) = super().define_pipelines()
        for step in RewriteSemanticConstants, InlineInlinables:
            pipeline.add_pass_after(RecordShapes, step)
        pipeline.add_pass_after(KernelLowering, NativeLowering)
        pipeline.passes = [step for step in pipeline.passes if step[0] is not NativeLowering]
        pipeline.finalize()
        return [pipeline]
