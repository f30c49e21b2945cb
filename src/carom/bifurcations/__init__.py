"""Bifurcations of equilibria and orbits: branches, diagrams, curves in two parameters, regions."""

from carom.bifurcations.borders import Border, examine_border
from carom.bifurcations.boundary import BoundaryEquilibrium, boundary_equilibria
from carom.bifurcations.branches import OrbitBranch
from carom.bifurcations.cells import Region
from carom.bifurcations.changes import UnexplainedChange
from carom.bifurcations.curves import KINDS, Codimension2Point, Curve, continue_curve
from carom.bifurcations.diagrams import Diagram, find_bifurcations
from carom.bifurcations.motions import Motions, motions_at
from carom.bifurcations.onsets import ONSETS
from carom.bifurcations.planes import Plane
from carom.bifurcations.points import Bifurcation
from carom.bifurcations.regions import RegionMap, map_regions
from carom.bifurcations.rubbing import RubbingBranch, RubbingOrbit, continue_rubbing, rubbing_orbits
from carom.bifurcations.samples import AttractorSample, sample_attractors
from carom.bifurcations.steady import EquilibriumBranch, RollingBranch
from carom.bifurcations.windows import OrbitWindows, Window, WindowEnd, orbit_windows
from carom.bifurcations.words import continue_orbit

__all__ = [
    "KINDS",
    "ONSETS",
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
    "RubbingBranch",
    "RubbingOrbit",
    "UnexplainedChange",
    "Window",
    "WindowEnd",
    "boundary_equilibria",
    "continue_curve",
    "continue_orbit",
    "continue_rubbing",
    "examine_border",
    "find_bifurcations",
    "map_regions",
    "motions_at",
    "orbit_windows",
    "rubbing_orbits",
    "sample_attractors",
]
