"""Pseudo-arclength continuation of ``F(u, p) = 0`` with location of special points.  It knows no rotor.

=============  =======================================================
``branch``     what is asked for and what is found
``tracer``     how it is found: prediction, correction, special points
``roots``      root of a function of one variable, bracketed
=============  =======================================================
"""

from carom.continuation.branch import Branch, SpecialPoint, Steps, Watch
from carom.continuation.tracer import continue_branch, refined_points

__all__ = ["Branch", "SpecialPoint", "Steps", "Watch", "continue_branch", "refined_points"]
