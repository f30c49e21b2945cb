"""Bifurcations of equilibria and orbits: branches, diagrams, curves in two parameters, regions.

======================  ====================================================================================================
``diagrams``            bifurcation diagrams along one parameter
``steady``              levitation, synchronous rubs and rolling along it
``branches``            a branch of orbits of any word
``words``               following such a branch, and switching to others
``word_equations``      equations of a word, and what vanishes at special points, and the word beyond
``followed``            orbits that searches and special points lead to, for diagrams
``points``              special points of branches
``boundary``            where levitation meets the wall
``windows``             ranges of a parameter in which orbits are motions
``curve_results``       a curve of bifurcations in two parameters, points on it, and what the equations of all have in common
``curves``              following one of a bifurcation that has a closed form
``conditions``          orbits with one impact by their closed form: solutions, names and test functions; those of equilibria
``planes``              the plane of two parameters
``regions``             regions of a plane with the same motions
``cells``               groups of neighbouring cells
``motions``             the simple motions of a machine, or those on which disturbances end
``survey``              the search for curves that explain each change
``changes``             changes between two points, and their causes
``documents``           results as plain data for JSON
``simulated``           branches of orbits of any machine, closed on the flow of the simulator
``simulated_family``    their equations
======================  ====================================================================================================
"""

from carom.bifurcations.boundary import BoundaryEquilibrium, boundary_equilibria
from carom.bifurcations.branches import OrbitBranch
from carom.bifurcations.cells import Region
from carom.bifurcations.changes import UnexplainedChange
from carom.bifurcations.curve_results import Codimension2Point, Curve
from carom.bifurcations.curves import KINDS, continue_curve
from carom.bifurcations.diagrams import Diagram, find_bifurcations
from carom.bifurcations.motions import Motions, motions_at
from carom.bifurcations.planes import Plane
from carom.bifurcations.points import Bifurcation
from carom.bifurcations.regions import RegionMap, map_regions
from carom.bifurcations.steady import EquilibriumBranch, RollingBranch
from carom.bifurcations.windows import OrbitWindows, orbit_windows
from carom.bifurcations.words import continue_orbit, switch

__all__ = [
    "KINDS",
    "Bifurcation",
    "BoundaryEquilibrium",
    "Codimension2Point",
    "Curve",
    "Diagram",
    "EquilibriumBranch",
    "Motions",
    "OrbitBranch",
    "OrbitWindows",
    "Plane",
    "Region",
    "RegionMap",
    "RollingBranch",
    "UnexplainedChange",
    "boundary_equilibria",
    "continue_curve",
    "continue_orbit",
    "find_bifurcations",
    "map_regions",
    "motions_at",
    "orbit_windows",
    "switch",
]
