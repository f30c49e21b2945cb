"""Disturbances as an engineer names them, and the starts they give a rotor.

A *model* says what happens to the rotor and with which coordinates it varies (size and direction of a kick, say).  A
*plan* says which of these are tried: a :class:`Grid` of cells, each represented by its middle, or a seeded
:class:`Sample` with every coordinate even over its range.  Both give :class:`Starts`: states in the co-rotating frame,
from which the motion is free.

=======================  =====================================================================================
:class:`VelocityKick`    a blow: the velocity changes at once, by a size and in a direction
:class:`KickPlane`       the same by radial and tangential parts, seen from the bearing centre
:class:`BaseShock`       the housing is accelerated by a half-sine pulse (peak, duration, direction)
:class:`UnbalanceStep`   the unbalance becomes what it is now, from another size and phase
:class:`ContactRelease`  levitation is switched on with the rotor on the touchdown bearing
:class:`StateSlice`      any position, at a given velocity
:class:`AnyState`        any position and any velocity
=======================  =====================================================================================

Models and plans load no kernel before a shock is followed: sweeps are planned without them.
Numbers are dimensionless, as everywhere behind the door: lengths in clearances, times in ``1/Ω``.  The constructors
``in_si`` take SI numbers and the scales of a machine.
"""

from carom.disturbances.blows import GRAVITY, BaseShock, KickPlane, VelocityKick, outward_from
from carom.disturbances.coordinates import Coordinate, Starts
from carom.disturbances.kinds import MODELS
from carom.disturbances.model import FASTEST, Disturbance
from carom.disturbances.plans import Grid, Plan, Sample, kick_grid
from carom.disturbances.states import AnyState, ContactRelease, StateSlice, UnbalanceStep

__all__ = [
    "FASTEST",
    "GRAVITY",
    "MODELS",
    "AnyState",
    "BaseShock",
    "ContactRelease",
    "Coordinate",
    "Disturbance",
    "Grid",
    "KickPlane",
    "Plan",
    "Sample",
    "Starts",
    "StateSlice",
    "UnbalanceStep",
    "VelocityKick",
    "kick_grid",
    "outward_from",
]
