"""Disturbances in engineering terms, and the starts of motions that result from them.

A *model* says what happens to the rotor and by which coordinates it varies (for example size and direction of a kick).
A *plan* says which of these disturbances are tried: a :class:`Grid` of cells, each represented by its middle, or a
seeded :class:`Sample` with every coordinate uniformly distributed.  Both give :class:`Starts`: states in the
co-rotating frame, from which the motion is free.

=======================  =====================================================================================
:class:`VelocityKick`    a kick: the velocity changes at once, given by size and direction
:class:`KickPlane`       the same, given by radial and tangential parts, seen from the bearing centre
:class:`BaseShock`       the housing is accelerated by a half-sine pulse (peak, duration, direction)
:class:`BaseRecord`      the housing moves as recorded, by samples of its acceleration along two axes
:class:`BladeLoss`       the unbalance of the machine changes by a vector of a size, at any phase
:class:`ContactRelease`  levitation is switched on with the rotor on the touchdown bearing
:class:`StateSlice`      any position, at a given velocity
:class:`AnyState`        any position and any velocity
:class:`GivenState`      one state of the planar rotor, in the co-rotating frame
:class:`Whirl`           a whirl about the centre of the bearing
:class:`Drop`            levitation is lost, perhaps for a while
=======================  =====================================================================================

A subclass of :class:`Disturbance` is a model too, wherever one can be given.

``model`` says what any disturbance offers, ``coordinates`` by what it varies and what starts are; the models are in ``kicks_and_shocks``
and ``recorded`` (``base_motion`` is what these share, and ``shocks`` follows a rotor through it), ``states`` and ``machine_changes`` (with ``recovering``, levitation that is regained).  ``response_spectra`` says what oscillators on the base and on the rotor feel.  ``plans`` has
grids and samples and says what is measured of them, ``single`` is one disturbance, read from text and said in a sentence, ``following`` follows their starts to where
they end.

Models and plans load the kernels only when a shock is followed, so that sweeps are planned without them.
Numbers are dimensionless: lengths in clearances, times in ``1/Ω``.  ``VelocityKick.of(machine, "50 mm/s")`` takes text with
units.
"""

from carom.disturbances.coordinates import Coordinate, Starts
from carom.disturbances.kicks_and_shocks import BaseShock, KickPlane, VelocityKick, kick, outward_from
from carom.disturbances.machine_changes import BladeLoss, Drop, drop
from carom.disturbances.model import FASTEST, MODELS, Disturbance
from carom.disturbances.plans import Grid, Plan, Sample
from carom.disturbances.recorded import BaseRecord
from carom.disturbances.response_spectra import BaseCourse, ShockResponse, shock_response
from carom.disturbances.single import Single
from carom.disturbances.states import AnyState, ContactRelease, GivenState, StateSlice, Whirl, whirl

__all__ = [
    "FASTEST",
    "MODELS",
    "AnyState",
    "BaseCourse",
    "BaseRecord",
    "BaseShock",
    "BladeLoss",
    "ContactRelease",
    "Coordinate",
    "Disturbance",
    "Drop",
    "GivenState",
    "Grid",
    "KickPlane",
    "Plan",
    "Sample",
    "ShockResponse",
    "Single",
    "Starts",
    "StateSlice",
    "VelocityKick",
    "Whirl",
    "drop",
    "kick",
    "outward_from",
    "shock_response",
    "whirl",
]
