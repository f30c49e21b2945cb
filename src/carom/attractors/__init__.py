"""Attractors that a sample of disturbances, and starts next to the known motions, lead to.

==============  =======================================================================================================
``starts``      the standard set of disturbances, and starts next to every motion known in closed form
``following``   starts followed until they settle
``intervals``   :func:`exact_interval`: what a sample says of a probability
``survival``    :class:`Survival`: how long irregular motion lasts
``settled``     what a settled motion repeats, and whether two repeat the same
``names``       :class:`MotionName`: what a motion is called
``naming``      the motions on which starts end, by name
``groups``      :class:`Attractor`: motions that have settled to the same one
``exponents``   :func:`exponents_of`: how fast disturbed motions return to it, or separate on it
``search``      :func:`find_attractors`, :class:`AttractorSet`
==============  =======================================================================================================
"""

from carom.attractors.exponents import exponents_of
from carom.attractors.following import Ending
from carom.attractors.groups import Attractor
from carom.attractors.intervals import exact_interval
from carom.attractors.names import MotionName
from carom.attractors.search import AttractorSet, find_attractors
from carom.attractors.starts import DisturbanceSet, Start, known_starts
from carom.attractors.survival import Survival, document_of, follow_until_settled

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
