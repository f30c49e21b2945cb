"""Bifurcations of equilibria and orbits: branches, diagrams, curves in two parameters, regions."""

from carom.bifurcations.borders import Border, examine_border
from carom.bifurcations.boundary import BoundaryEquilibrium, boundary_equilibria
from carom.bifurcations.branches import OrbitBranch
from carom.bifurcations.cells import Region
from carom.bifurcations.changes import UnexplainedChange
from carom.bifurcations.curves import KINDS, Codimension2Point, Curve, continue_curve
from carom.bifurcations.diagrams import Diagram, find_bifurcations
from carom.bifurcations.motions import Motions, motions_at
from carom.bifurcations.planes import Plane
from carom.bifurcations.points import Bifurcation
from carom.bifurcations.regions import RegionMap, map_regions
from carom.bifurcations.samples import AttractorSample, sample_attractors
from carom.bifurcations.steady import EquilibriumBranch, RollingBranch
from carom.bifurcations.windows import OrbitWindows, Window, WindowEnd, orbit_windows
from carom.bifurcations.words import continue_orbit

__all__ = [
    "KINDS",
    "AttractorSample",
    "Bifurcation",
    "Border",
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
    "Window",
    "WindowEnd",
    "boundary_equilibria",
    "continue_curve",
    "continue_orbit",
    "examine_border",
    "find_bifurcations",
    "map_regions",
    "motions_at",
    "orbit_windows",
    "sample_attractors",
]
