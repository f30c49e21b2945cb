"""Rotors: from parameters to the arrays that the kernels use.

========================  =================================================================
``system``                :class:`System`: modes and contact planes of any linear rotor
``jeffcott``              :class:`Jeffcott`: the planar rigid rotor, by its parameters
``subjects``              :func:`model_of`, :func:`case_of`: any description of a rotor -> its model, its case
========================  =================================================================
"""

from carom.models.jeffcott import Jeffcott
from carom.models.subjects import Subject, case_of, model_of
from carom.models.system import System, second_order_system

__all__ = ["Jeffcott", "Subject", "System", "case_of", "model_of", "second_order_system"]
