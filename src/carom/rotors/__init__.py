"""Flexible rotors by finite elements, in SI units.

========================  =================================================================
``entries``               numbers of a part, in SI units or as text with a unit
``sections``              :class:`Section`: a cylindrical section of a shaft; :class:`Material`
``discs``                 :class:`Disc`: a rigid disc
``damping``               :class:`ModalDamping`, :class:`ProportionalDamping`
``beams``                 matrices of an element of Timoshenko's beam
``free_modes``            modes of a free body
``flexible_rotor``        :class:`FlexibleRotor`: a shaft with discs as finite elements
========================  =================================================================
"""

from carom.rotors.damping import ModalDamping, ProportionalDamping
from carom.rotors.discs import Disc
from carom.rotors.flexible_rotor import FlexibleRotor
from carom.rotors.sections import Material, Section

__all__ = ["Disc", "FlexibleRotor", "Material", "ModalDamping", "ProportionalDamping", "Section"]
