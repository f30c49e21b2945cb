"""Rotors: from parameters to the arrays that the kernels use.

========================  =================================================================
``axes``                  :class:`Axis`: any named parameter of any model, to vary; :class:`Span`: an interval of one
``rotor``                 :class:`Rotor`: every rotor, asked for what it has
``acting``                :class:`Acting`: the forces that act, and what bias currents carry
``definition``            :class:`Definition`: its named parameters, equations and matrices
``documents``             a rotor as plain data, and back
``mode_arrays``           modes and contact planes as arrays for the kernels
``system``                :class:`System`: any linear rotor by these, its states and what repeats
``from_modes``            systems from their modes, and modes of a matrix, in pairs where two nearly coincide
``planar``                :func:`jeffcott`: the planar rigid rotor by its parameters, in a touchdown bearing of any kind
``linear``                :class:`LinearEquations`: the equations of any linear rotor, by its matrices
``linear_system``         its system, also where bearings are anisotropic
``linear_parameters``     its named parameters
``limits``                :class:`Limit`: limits of magnetic bearings, and what is asked for beyond them
``touchdown``             :class:`Touchdown`: a contact plane, and the laws of its wall
``turning``               :class:`Race`: a race that turns; :class:`Shaft`: a shaft whose speed changes
``forcing``               :class:`Force`: forces that change with time, as modes of their own
``forcing_modes``         forces of a base that moves in sections: their modes, found once
``stages``                :func:`in_stages`: a rotor that changes when a trigger ends a stage
``subjects``              :func:`rotor_of`, :func:`case_of`: any description of a rotor -> its model, its case
========================  =================================================================
"""

from carom.core.laws.falling import FallingRestitution
from carom.core.laws.hunt_crossley import HuntCrossley
from carom.core.laws.kelvin_voigt import KelvinVoigt
from carom.core.laws.rigid import Rigid
from carom.models.axes import Axis, Edge, Span, axis
from carom.models.definition import Definition, Matrices
from carom.models.forcing import Force
from carom.models.from_modes import second_order_system
from carom.models.limits import Limit
from carom.models.linear import LinearEquations, from_matrices
from carom.models.planar import Planar, jeffcott
from carom.models.rotor import Rotor
from carom.models.stages import Stage, Trigger, in_stages
from carom.models.subjects import Subject, case_of, exact_rotor_of, rotor_from, rotor_of
from carom.models.system import System
from carom.models.touchdown import Touchdown
from carom.models.turning import Race, Shaft

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
