"""Periodic orbits, and maps from impact to impact.

====================  ====================================================================
``orbit``             a periodic orbit of any word, with its margins
``word``              which segments follow one another in it
``shooting``          its equations and Newton's method
``admissibility``     whether it is a motion of the machine
``single_impact``     all orbits with one impact a period
``search``            orbits of the planar rotor with any number of impacts, from simulated starts
``searched``          what a search has tried
``flow``              the flow of any machine as a map, with derivatives by differences
``happenings``        what happens along a motion, in order
``simulated``         periodic motions of any machine
``closing``           closing them on that flow, by Newton's method
``simulated_search``  the search for these
``flow_exponents``    Lyapunov exponents by the flow
``extremes``          largest radius, depth and force
``recognising``       the orbit that a simulated motion repeats
``rubbing``           periodic motions with lasting contact, from one lift-off to the next
``chatter``           a chatter as one segment
``landings``          how far a chatter is from the onset of lasting contact
``exponents``         Lyapunov exponents of motions and of orbits
``names``             names of orbits
``maps``              impact map and stroboscopic map, with their derivatives
``stability``         multipliers of an orbit
====================  ====================================================================
"""

from carom.orbits.exponents import LyapunovExponents, lyapunov_exponents, orbit_exponents
from carom.orbits.maps import ImpactMap, Section, StroboscopicMap, impact_map, stroboscopic_map
from carom.orbits.orbit import Margins, Orbit, orbit_near
from carom.orbits.recognising import orbit_of_motion
from carom.orbits.rubbing import LiftOff, lift_off_of, rubbing_orbits
from carom.orbits.single_impact import OrbitSet, find_orbits, orbits_within_reach, period_condition
from carom.orbits.stability import Multipliers, multipliers
from carom.orbits.word import Kind, Segment, Word

__all__ = [
    "ImpactMap",
    "Kind",
    "LiftOff",
    "LyapunovExponents",
    "Margins",
    "Multipliers",
    "Orbit",
    "OrbitSet",
    "Section",
    "Segment",
    "StroboscopicMap",
    "Word",
    "find_orbits",
    "impact_map",
    "lift_off_of",
    "lyapunov_exponents",
    "multipliers",
    "orbit_exponents",
    "orbit_near",
    "orbit_of_motion",
    "orbits_within_reach",
    "period_condition",
    "rubbing_orbits",
    "stroboscopic_map",
]
