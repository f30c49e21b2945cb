"""Parameters of a rotor: input in SI units or as text, dimensionless numbers for the computation.

========================  ========================================================================================================================
``fields``                names, symbols, units and ranges of all numbers
``terms``                 terms that stand for the numbers of a machine, with their formulas; entries in whatever terms -> numbers
``tables``                tables that files of all machines share, each entry declared once: :class:`Zones`, :class:`Gravity` and the like
``quantities``            text with units -> float in SI units, and exact numbers for proofs
``toml_reader``           TOML file -> raw tables
``scaling``               :class:`Scales` and their units; dimensionless numbers from and to SI units
``numbers``               :class:`Parameters`, :class:`Numbers`: the same plain, unchecked
``machine``               :class:`Machine`, conversion to parameters and back
``touchdown_bearing``     :class:`TouchdownBearing`: a compliant touchdown bearing
``ball_heat``             its entries about torque and temperature
``balls``                 balls of a touchdown bearing: contacts by Hertz, the force of all balls, inertia
``indentation``           whether a rigid wall is a valid model under a load
``restitution``           restitution and what a compliant wall dissipates
``requirement``           :class:`Requirement`: what a machine must survive
``recovery``              :class:`RecoveryAction`: when levitation is regained after a drop, and with which actions
``machine_file``          :class:`Case`: what the tables of a planar rotor and settings describe
``formats``               sizes and numbers as people write and read them: mm/s, g, degrees; those of starts and disturbances
``in_terms``              :func:`in_terms_of`: values in the terms of the file
========================  ========================================================================================================================
"""

from carom.parameters.fields import (
    DIMENSIONLESS_FIELDS,
    MACHINE_FIELDS,
    PARAMETERS,
    PHYSICAL_PARTNER,
    WALL_FIELDS,
    Field,
    unknown_name,
)
from carom.parameters.formats import Size, own_size, own_time, read_size
from carom.parameters.in_terms import InTerms, in_terms_of
from carom.parameters.machine import ControlLimit, Machine
from carom.parameters.machine_file import SETTINGS, Case, field_to_set
from carom.parameters.numbers import Numbers, Parameters
from carom.parameters.quantities import read_quantity
from carom.parameters.recovery import RecoveryAction
from carom.parameters.requirement import SHOCK_DURATION, Required, Requirement, Shock, usual_kick
from carom.parameters.scaling import GRAVITY, UNITS, Scales
from carom.parameters.tables import LIMIT_FIELDS, Drive, Gravity, LoadLimits, Zones
from carom.parameters.terms import HELPER_FIELDS, TERM_FIELDS, TERMS, field_to_vary
from carom.parameters.touchdown_bearing import TOUCHDOWN_FIELDS, TouchdownBearing

__all__ = [
    "DIMENSIONLESS_FIELDS",
    "GRAVITY",
    "HELPER_FIELDS",
    "LIMIT_FIELDS",
    "MACHINE_FIELDS",
    "PARAMETERS",
    "PHYSICAL_PARTNER",
    "SETTINGS",
    "SHOCK_DURATION",
    "TERMS",
    "TERM_FIELDS",
    "TOUCHDOWN_FIELDS",
    "UNITS",
    "WALL_FIELDS",
    "Case",
    "ControlLimit",
    "Drive",
    "Field",
    "Gravity",
    "InTerms",
    "LoadLimits",
    "Machine",
    "Numbers",
    "Parameters",
    "RecoveryAction",
    "Required",
    "Requirement",
    "Scales",
    "Shock",
    "Size",
    "TouchdownBearing",
    "Zones",
    "field_to_set",
    "field_to_vary",
    "in_terms_of",
    "own_size",
    "own_time",
    "read_quantity",
    "read_size",
    "unknown_name",
    "usual_kick",
]
