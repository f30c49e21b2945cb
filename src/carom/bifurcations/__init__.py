"""Bifurcations of equilibria and single-impact orbits: branches, diagrams, curves in two parameters, regions."""

from carom.bifurcations.axes import Axis, Numbers, axis, value_of, vary
from carom.bifurcations.branches import Bifurcation, OrbitBranch, continue_orbit
from carom.bifurcations.curves import KINDS, Codimension2Point, Curve, Plane, continue_curve
from carom.bifurcations.diagrams import Diagram, EquilibriumBranch, SpecialValue, bifurcation_diagram
from carom.bifurcations.regions import Motions, Region, RegionMap, motions_at, region_map

__all__ = [
    "KINDS",
    "Axis",
    "Bifurcation",
    "Codimension2Point",
    "Curve",
    "Diagram",
    "EquilibriumBranch",
    "Motions",
    "Numbers",
    "OrbitBranch",
    "Plane",
    "Region",
    "RegionMap",
    "SpecialValue",
    "axis",
    "bifurcation_diagram",
    "continue_curve",
    "continue_orbit",
    "motions_at",
    "region_map",
    "value_of",
    "vary",
]
