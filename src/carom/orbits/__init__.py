"""Periodic orbits, and maps from impact to impact.

====================  ====================================================================
``orbit``             a periodic orbit of any word, with its margins
``word``              which impacts follow one another in it
``shooting``          its equations and Newton's method
``admissibility``     whether it is a motion of the machine
``single_impact``     all orbits with one impact a period
``search``            orbits of the planar rotor with any number of impacts, from simulated starts
``searched``          what a search has tried
``flow``              the flow of any machine as a map, with derivatives by differences
``happenings``        what happens along a motion, in order, and how far it goes
``simulated``         periodic motions of any machine
``closing``           closing them on that flow, by Newton's method
``simulated_search``  the search for these, and the orbit that a simulated motion repeats
``exponents``         Lyapunov exponents of motions and of orbits
``names``             names of orbits
``maps``              the impact map, with its derivative; multipliers
====================  ====================================================================
"""

from carom.orbits.exponents import LyapunovExponents, lyapunov_exponents, orbit_exponents
from carom.orbits.maps import ImpactMap, Multipliers, Section, impact_map, multipliers
from carom.orbits.orbit import Margins, Orbit, orbit_near
from carom.orbits.simulated_search import orbit_of_motion
from carom.orbits.single_impact import OrbitSet, find_orbits, orbits_within_reach, period_condition
from carom.orbits.word import Kind, Word

__all__ = [
    "ImpactMap",
    "Kind",
    "LyapunovExponents",
    "Margins",
    "Multipliers",
    "Orbit",
    "OrbitSet",
    "Section",
    "Word",
    "find_orbits",
    "impact_map",
    "lyapunov_exponents",
    "multipliers",
    "orbit_exponents",
    "orbit_near",
    "orbit_of_motion",
    "orbits_within_reach",
    "period_condition",
]
