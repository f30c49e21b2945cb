"""Rotors: from parameters to the arrays that the kernels use.

========================  =================================================================
``axes``                  :class:`Axis`: any named parameter of any model, to vary
``spans``                 :class:`Span`: an interval of a parameter, with what happens at its ends
``rotor``                 :class:`Rotor`: every rotor, asked for what it has
``definition``            :class:`Definition`: its named parameters and equations
``documents``             a rotor as plain data, and back
``matrices``              its matrices
``mode_arrays``           modes and contact planes as arrays for the kernels
``system``                :class:`System`: any linear rotor by these, its states and what repeats
``nodes``                 nodes of orbits: states, and under weight its direction
``from_modes``            systems from their modes
``planar``                :func:`jeffcott`: the planar rigid rotor by its parameters, in a touchdown bearing of any kind
``linear``                :class:`LinearEquations`: the equations of any linear rotor
``linear_system``         its system
``by_matrices``           :func:`from_matrices`: any linear rotor, by its matrices
``anisotropic``           its system where bearings are anisotropic
``linear_parameters``     its named parameters
``limits``                :class:`Limit`: limits of magnetic bearings
``saturation``            what is asked of bearings beyond their limits
``touchdown``             :class:`Touchdown`: a contact plane, and the laws of its wall
``race``                  :class:`Race`: a race that turns
``shaft``                 :class:`Shaft`: a shaft whose speed changes
``modes``                 modes of a matrix, in pairs where two nearly coincide
``forcing``               :class:`Force`: forces that change with time, as modes of their own
``forces``                forces as they are given
``stages``                :func:`in_stages`: a rotor that changes when a trigger ends a stage
``subjects``              :func:`rotor_of`, :func:`case_of`: any description of a rotor -> its model, its case
========================  =================================================================
"""

from carom.core.laws.falling import FallingRestitution
from carom.core.laws.hunt_crossley import HuntCrossley
from carom.core.laws.kelvin_voigt import KelvinVoigt
from carom.core.laws.rigid import Rigid
from carom.models.axes import Axis, axis
from carom.models.definition import Definition
from carom.models.forcing import Force
from carom.models.from_modes import second_order_system
from carom.models.limits import Limit
from carom.models.linear import LinearEquations, from_matrices
from carom.models.matrices import Matrices
from carom.models.planar import Planar, jeffcott
from carom.models.race import Race
from carom.models.rotor import Rotor
from carom.models.shaft import Shaft
from carom.models.spans import Edge, Span
from carom.models.stages import Stage, Trigger, in_stages
from carom.models.subjects import Subject, case_of, exact_rotor_of, rotor_from, rotor_of
from carom.models.system import System
from carom.models.touchdown import Touchdown

__all__ = [
    "Axis",
    "Definition",
    "Edge",
    "FallingRestitution",
    "Force",
    "HuntCrossley",
    "KelvinVoigt",
    "Limit",
    "LinearEquations",
    "Matrices",
    "Planar",
    "Race",
    "Rigid",
    "Rotor",
    "Shaft",
    "Span",
    "Stage",
    "Subject",
    "System",
    "Touchdown",
    "Trigger",
    "axis",
    "case_of",
    "exact_rotor_of",
    "from_matrices",
    "in_stages",
    "jeffcott",
    "rotor_from",
    "rotor_of",
    "second_order_system",
]
