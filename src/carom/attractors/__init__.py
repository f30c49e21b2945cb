"""Where disturbances end: every attractor that a sample of starts and the known motions lead to.

``starts``      the standard set of disturbances, and starts next to every motion known in closed form
``cycles``      what a settled motion repeats, and when two motions repeat the same
``following``   each start followed to where it settles
``survival``    :class:`Survival`: how long irregular motion lasts
``groups``      :class:`Attractor`: motions that have settled to the same
``search``      :func:`find_attractors`, :class:`AttractorSet`
"""

from carom.attractors.following import Ending
from carom.attractors.groups import Attractor, motion_name
from carom.attractors.search import AttractorSet, find_attractors
from carom.attractors.starts import DisturbanceSet, Start, disturbances, known_starts
from carom.attractors.survival import Survival, document_of, follow_out

__all__ = [
    "Attractor",
    "AttractorSet",
    "DisturbanceSet",
    "Ending",
    "Start",
    "Survival",
    "disturbances",
    "document_of",
    "find_attractors",
    "follow_out",
    "known_starts",
    "motion_name",
]
