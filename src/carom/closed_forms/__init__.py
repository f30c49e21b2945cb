"""Exact results: equilibria and disturbances without contact of any linear rotor, impacts of a free mass, the rest of the planar rotor.

=========================  ===================================================
``equilibria``             contact-free and rubbing equilibria of any linear rotor
``sag``                    levitation with or without weight: a circle about the sag
``statics``                forces of rubs at rest, at one plane and at several
``thresholds``             where motions begin and end
``contact_free``           disturbances of any linear rotor that never reach the wall
``unbalance``              rubs over the speed of the shaft, of a rotor with one mass
``whirl``                  backward whirl: runaway and rolling
``absorbing``              neighbourhoods of the rub that sliding never leaves
``periods``                periods of all orbits with one impact a period
``small_cycles_at_walls``  what is born where levitation meets a wall, for any number of modes and both kinds of walls
``compliant_walls``        slipping whirl on compliant walls
``exact_results``          what general code may ask of any rotor
=========================  ===================================================
"""

from carom.closed_forms.absorbing import RubNeighbourhood, rub_neighbourhood
from carom.closed_forms.compliant_walls import SlippingWhirl, slipping_whirls
from carom.closed_forms.contact_free import (
    contact_free_blade_loss,
    contact_free_kick,
    contact_free_shock,
)
from carom.closed_forms.equilibria import Equilibrium, EquilibriumSet, find_equilibria
from carom.closed_forms.periods import PeriodCondition, PeriodRoots
from carom.closed_forms.sag import Levitation, levitation
from carom.closed_forms.small_cycles_at_walls import SmallCycle, WallMeeting, small_cycles
from carom.closed_forms.thresholds import rub_limit
from carom.closed_forms.unbalance import contact_changes, rub_angles
from carom.closed_forms.whirl import Rolling, Runaway, fading_speed, rolling, runaway_speed
from carom.parameters.balls import BallRing, PointContact, PowerLaw, load_integral, point_contact

__all__ = [
    "BallRing",
    "Equilibrium",
    "EquilibriumSet",
    "Levitation",
    "PeriodCondition",
    "PeriodRoots",
    "PointContact",
    "PowerLaw",
    "Rolling",
    "RubNeighbourhood",
    "Runaway",
    "SlippingWhirl",
    "SmallCycle",
    "WallMeeting",
    "contact_changes",
    "contact_free_blade_loss",
    "contact_free_kick",
    "contact_free_shock",
    "fading_speed",
    "find_equilibria",
    "levitation",
    "load_integral",
    "point_contact",
    "rolling",
    "rub_angles",
    "rub_limit",
    "rub_neighbourhood",
    "runaway_speed",
    "slipping_whirls",
    "small_cycles",
]
