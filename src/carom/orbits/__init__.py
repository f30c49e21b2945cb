"""Periodic orbits with one impact a period, and maps from impact to impact.

==================  =======================================================
``single_impact``   all orbits with one impact a period
``names``           names of these orbits
``maps``            impact map and stroboscopic map, with their derivatives
``stability``       multipliers of an orbit
==================  =======================================================
"""

from carom.orbits.maps import ImpactMap, Section, StroboscopicMap, impact_map, stroboscopic_map
from carom.orbits.single_impact import Orbit, OrbitSet, find_orbits, orbits_within_reach, period_condition
from carom.orbits.stability import Multipliers, multipliers

__all__ = [
    "ImpactMap",
    "Multipliers",
    "Orbit",
    "OrbitSet",
    "Section",
    "StroboscopicMap",
    "find_orbits",
    "impact_map",
    "multipliers",
    "orbits_within_reach",
    "period_condition",
    "stroboscopic_map",
]
