"""Pseudo-arclength continuation of ``F(u, p) = 0`` with location of special points, for any equations.

==============  =======================================================
``branch``      the settings and the result
``tracer``      the algorithm: steps, their ends, special points
``equations``   the equations in scaled unknowns, and Newton's method
``refinement``  points between those of a branch, to draw it
==============  =======================================================
"""

from carom.continuation.branch import Branch, SpecialPoint, Steps, Watch
from carom.continuation.equations import Equations
from carom.continuation.refinement import refined_points
from carom.continuation.tracer import continue_branch

__all__ = ["Branch", "Equations", "SpecialPoint", "Steps", "Watch", "continue_branch", "refined_points"]
