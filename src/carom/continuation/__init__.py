"""Pseudo-arclength continuation of ``F(u, p) = 0`` with location of special points, for any equations.

=============  =======================================================
``branch``     the settings and the result
``tracer``     the algorithm: prediction, correction, special points
``roots``      bracketed root of a function of one variable
=============  =======================================================
"""

from carom.continuation.branch import Branch, SpecialPoint, Steps, Watch
from carom.continuation.tracer import continue_branch, refined_points

__all__ = ["Branch", "SpecialPoint", "Steps", "Watch", "continue_branch", "refined_points"]
