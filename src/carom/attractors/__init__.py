"""Attractors that a sample of disturbances, and starts next to the known motions, lead to.

==============  =======================================================================================================
``starts``      the standard set of disturbances, and starts next to every motion known in closed form
``following``   starts followed until they settle, :class:`Survival`: how long irregular motion lasts, and :func:`exact_interval`: what a sample says of a probability
``settled``     what a settled motion repeats, and whether two repeat the same
``naming``      :class:`MotionName`: what a motion is called, and the motions on which starts end
``groups``      :class:`Attractor`: motions that have settled to the same one, and :func:`exponents_of`: how fast disturbed motions return to it, or separate on it
``search``      :func:`find_attractors`, :class:`AttractorSet`
==============  =======================================================================================================
"""

from carom.attractors.following import Ending, Survival, document_of, exact_interval, follow_until_settled
from carom.attractors.groups import Attractor, exponents_of
from carom.attractors.naming import MotionName
from carom.attractors.search import AttractorSet, find_attractors
from carom.attractors.starts import DisturbanceSet, Start, known_starts

__all__ = [
    "Attractor",
    "AttractorSet",
    "DisturbanceSet",
    "Ending",
    "MotionName",
    "Start",
    "Survival",
    "document_of",
    "exact_interval",
    "exponents_of",
    "find_attractors",
    "follow_until_settled",
    "known_starts",
]
