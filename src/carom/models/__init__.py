"""Rotors: from parameters to the arrays that the kernels use.

========================  =================================================================
``axes``                  :class:`Axis`: any named parameter of any model, to vary
``spans``                 :class:`Span`: an interval of a parameter, with what happens at its ends
``model``                 :class:`Model`: what every description of a rotor offers
``mode_arrays``           modes and contact planes as arrays for the kernels
``system``                :class:`System`: any linear rotor by these, its states and what repeats
``nodes``                 nodes of orbits: states, and under weight its direction
``from_modes``            systems from their modes
``jeffcott``              :class:`Jeffcott`: the planar rigid rotor, by its parameters
``linear``                :class:`LinearRotor`: any linear rotor, by its matrices
``mirror``                its system where bearings act differently in two directions
``directions``            the whirl there
``linear_parameters``     its named parameters
``in_bearing``            :class:`InBearing`: the planar rotor in a touchdown bearing that gives way
``limited``               :class:`Limited`: a rotor on magnetic bearings that have limits
``excess``                what is asked of bearings beyond their limits
``touchdown``             :class:`Touchdown`: a contact plane, and the laws of its wall
``race``                  :class:`Race`: a race that turns
``shaft``                 :class:`Shaft`: a shaft whose speed changes
``modes``                 modes of a matrix, in pairs where two nearly coincide
``forcing``               :class:`Force`: forces that change with time, as modes of their own
``stages``                :class:`Staged`: a rotor that changes when a trigger ends a stage; :class:`Forced`: with further forces
``weight``                gravity, and a rotor without its levitation
``subjects``              :func:`model_of`, :func:`case_of`: any description of a rotor -> its model, its case
========================  =================================================================
"""

from carom.core.laws.falling import FallingRestitution
from carom.core.laws.hunt_crossley import HuntCrossley
from carom.core.laws.kelvin_voigt import KelvinVoigt
from carom.core.laws.rigid import Rigid
from carom.models.axes import Axis, axis
from carom.models.forcing import Force
from carom.models.from_modes import second_order_system
from carom.models.in_bearing import InBearing
from carom.models.jeffcott import Jeffcott
from carom.models.limited import Limit, Limited
from carom.models.linear import LinearRotor
from carom.models.model import Matrices, Model, Rates
from carom.models.race import Race
from carom.models.shaft import Shaft
from carom.models.spans import Edge, Span
from carom.models.stages import Forced, Stage, Staged, Trigger, depends_on_instant
from carom.models.subjects import Subject, case_of, jeffcott_of, model_from, model_of, planar_case_of
from carom.models.system import System
from carom.models.touchdown import Touchdown

__all__ = [
    "Axis",
    "Edge",
    "FallingRestitution",
    "Force",
    "Forced",
    "HuntCrossley",
    "InBearing",
    "Jeffcott",
    "KelvinVoigt",
    "Limit",
    "Limited",
    "LinearRotor",
    "Matrices",
    "Model",
    "Race",
    "Rates",
    "Rigid",
    "Shaft",
    "Span",
    "Stage",
    "Staged",
    "Subject",
    "System",
    "Touchdown",
    "Trigger",
    "axis",
    "case_of",
    "depends_on_instant",
    "jeffcott_of",
    "model_from",
    "model_of",
    "planar_case_of",
    "second_order_system",
]
