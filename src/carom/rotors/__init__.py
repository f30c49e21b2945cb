"""Flexible rotors by finite elements, in SI units.

========================  =================================================================
``shaft_parts``           :class:`ShaftSection`, its :class:`Material` and element; :class:`Disc`; :class:`ModalDamping`, :class:`ProportionalDamping`
``state_spaces``          :class:`StateSpace`: linear systems, sampled ones with their hold
``controllers``           :class:`PID`, :class:`TransferFunction` and others, filters in :class:`Series`, and those of other libraries
``shared_controller``     :class:`SharedController`: of several bearings at once, such as of translation and tilt
``filters``               :class:`Notch`, :class:`LeadLag`, :class:`LowPass`
``bearing_limits``        limits of magnetic bearings as those of a model
``magnetic_bearing``      :class:`MagneticBearing`: magnet, sensors, and what is between both
``support``               :class:`Support`: a seal, a fluid-film bearing, a spring
``free_rotor``            what all rotors have in common, however their matrices are made, and their free modes
``flexible_rotor``        :class:`FlexibleRotor`: a shaft with discs as finite elements
``matrix_rotor``          :class:`MatrixRotor`: a rotor by its matrices
``rigid_body``            :class:`RigidRotor`: four degrees of freedom
``rotor_files``           :func:`read_rotor`, :func:`write_rotor`: files of matrices
``array_reader``          the program that reads arrays of a file, in a process of its own
``ross_reader``           the program that reads rotors with ROSS, in a process of its own
``ross_import``           :func:`import_rotor`: a rotor of ROSS, or of matrices
``starter``               a machine file to start from, for an imported rotor
``attachments``           :class:`Unbalance`, :class:`TouchdownPlane`, :class:`Housing`
``reduction``             few vectors in place of all coordinates
``equations``             equations of motion in SI units
``free_motions``          free motions, which of them grow, and the speeds at which levitation begins or ceases to be stable
``flexible_machine``      :class:`FlexibleMachine`: the rotor with all that is attached to it; :func:`rigid_rotor`
``machine_parameters``    named parameters of a machine and of its parts
``reduced_machine``       :class:`ReducedMachine`: by a few vectors, as a model
``flexible_model``        :class:`FlexibleDefinition`: what defines its rotor, by the parameters of the machine
``part_tables``           what each table of a machine file with ``[rotor]`` may hold, and the part that it makes; written too
``machine_file``          :func:`load_machine`; tables of a machine file -> its case
``whirls``                :func:`find_whirls`, :func:`campbell`: free whirls, and how they change with the speed
``synchronous``           :func:`synchronous_response`: contact-free response to unbalance at any speed, of any rotor
``reduction_errors``      by how much the vectors left out change a motion with contact
``loop_sensitivity``      :func:`sensitivity`: of the loops of the bearings, and whirls that their sensors miss
========================  =================================================================
"""

from carom.rotors.attachments import Housing, TouchdownPlane, Unbalance
from carom.rotors.controllers import PID, SecondOrderSections, Series, TransferFunction, VoltagePID, ZerosPolesGain
from carom.rotors.filters import LeadLag, LowPass, Notch
from carom.rotors.flexible_machine import FlexibleMachine, rigid_rotor
from carom.rotors.flexible_model import FlexibleDefinition
from carom.rotors.flexible_rotor import FlexibleRotor
from carom.rotors.loop_sensitivity import Sensitivity, sensitivity
from carom.rotors.machine_file import load_machine
from carom.rotors.magnetic_bearing import MagneticBearing
from carom.rotors.matrix_rotor import MatrixRotor
from carom.rotors.reduced_machine import ReducedMachine
from carom.rotors.rigid_body import RigidRotor
from carom.rotors.ross_import import ImportedRotor, import_rotor
from carom.rotors.rotor_files import read_rotor, write_rotor
from carom.rotors.shaft_parts import Disc, Material, ModalDamping, ProportionalDamping, ShaftSection
from carom.rotors.shared_controller import ForcePID, MomentPID, SharedController
from carom.rotors.state_spaces import StateSpace
from carom.rotors.support import Support
from carom.rotors.synchronous import Ellipses, SynchronousResponse, synchronous_response
from carom.rotors.whirls import Campbell, WhirlMode, campbell, find_whirls

__all__ = [
    "PID",
    "Campbell",
    "Disc",
    "Ellipses",
    "FlexibleDefinition",
    "FlexibleMachine",
    "FlexibleRotor",
    "ForcePID",
    "Housing",
    "ImportedRotor",
    "LeadLag",
    "LowPass",
    "MagneticBearing",
    "Material",
    "MatrixRotor",
    "ModalDamping",
    "MomentPID",
    "Notch",
    "ProportionalDamping",
    "ReducedMachine",
    "RigidRotor",
    "SecondOrderSections",
    "Sensitivity",
    "Series",
    "ShaftSection",
    "SharedController",
    "StateSpace",
    "Support",
    "SynchronousResponse",
    "TouchdownPlane",
    "TransferFunction",
    "Unbalance",
    "VoltagePID",
    "WhirlMode",
    "ZerosPolesGain",
    "campbell",
    "find_whirls",
    "import_rotor",
    "load_machine",
    "read_rotor",
    "rigid_rotor",
    "sensitivity",
    "synchronous_response",
    "write_rotor",
]
