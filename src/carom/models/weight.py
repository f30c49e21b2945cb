"""A rotor that weighs something, and what is left of it when levitation is lost.

In the fixed frame weight is a constant force.  In the frame that turns with the shaft it turns backward once per turn, which is a
:class:`~carom.models.forcing.Force` with the exponent ``−i``.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import replace

import numpy as np

from carom.models.forcing import Force
from carom.models.in_bearing import InBearing
from carom.models.jeffcott import Jeffcott
from carom.models.limited import Limited
from carom.models.linear import LinearRotor
from carom.models.mode_arrays import EQUAL, STEADY
from carom.models.model import Model
from carom.models.stages import Around, Forced, forces_of
from carom.models.touchdown import Rigid, Touchdown
from carom.outcome import InputError, shown
from carom.parameters import Gravity

_WITHOUT = (
    "needs a rotor without gravity or other forces that change with time in its frame; under these carom.simulate, carom.settle, "
    "carom.drop, carom.study, carom.find_attractors, carom.find_orbits with impacts, carom.continue_orbit, and carom.map_basins of kicks, shocks, "
    "losses of a blade, steps of the unbalance, releases and states work; a setting gravity=0 leaves weight out"
)


def weighted(rotor: Model, gravity: Gravity) -> Forced:
    """The rotor with its weight; all its masses fall alike, along the translation.

    Raises
    ------
    InputError
        Its scales are not known.
    """
    if rotor.scales is None:
        raise InputError(
            "gravity", gravity.words, "a rotor with mass, clearance and speed: without them nothing is in m/s^2"
        )
    return Forced(rotor, (Force(STEADY, gravity.pull(rotor.scales) * rotor.system.translated),))


def weight_of(model: Model) -> np.ndarray | None:
    """Accelerations (n,) of the coordinates by forces that are constant in the fixed frame; ``None`` if none acts."""
    steady = [force.accelerations for force in forces_of(model) if abs(force.exponent - STEADY) <= EQUAL]
    total: np.ndarray = np.sum(steady, axis=0)
    return total if steady and total.any() else None


def direction_of_fall(model: Model) -> float:
    """Angle of the weight in the fixed frame, in rad; that of the negative y axis if none acts."""
    weight = weight_of(model)
    return -0.5 * math.pi if weight is None else cmath.phase(complex(weight @ model.system.translated.conj()))


def refuse_forces(model: Model) -> None:
    """Refuse a rotor on which forces act that change with time in its frame: it never is at rest there."""
    if model.system.shaft is not None or model.system.mirrored is not None:
        model.system.refuse_forces()
    if model.system.forced is not None:
        acting = "forces that change with time" if weight_of(model) is None else "gravity"
        raise InputError("machine", f"a rotor under {acting}", _WITHOUT)


def refuse_unsteady(model: Model) -> None:
    """Refuse a rotor that levitates neither at rest nor in a circle: its speed changes, or a force changes in the fixed frame."""
    if model.system.shaft is not None or model.system.shaken:
        model.system.refuse_unsteady()


def levitation_of(model: Model) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates and their rates, both (n,), where the rotor levitates at time zero: its whirl about the static sag.

    Raises
    ------
    InputError
        The whirl reaches the wall, or nothing holds the rotor.
    """
    reach = model.system.rest_radius
    if reach >= 1.0:
        reaches = (
            "none, nothing holds the rotor" if reach == np.inf else f"up to {reach:.4g} clearances from the centre"
        )
        raise InputError("levitation", reaches, "static sag and whirl must stay inside the wall: below 1")
    return model.system.kicked(0.0)


def carry_at_regain(model: Model) -> np.ndarray | None:
    """Coordinates and rates with which levitation begins again per those at the end of the fall, shape (2n, 2n); ``None`` if they stay."""
    while isinstance(model, Around):
        model = model.rotor
    kept = model.regained if isinstance(model, LinearRotor) else None
    return None if kept is None else np.diag(np.concatenate([kept, kept]))


def without_levitation(model: Model) -> Model:
    """The rotor without the stiffness and damping of its levitation, under the same forces.

    Raises
    ------
    InputError
        It has several coordinates, and does not say what is left without levitation, which cannot be told from its shaft.
    """
    if isinstance(model, Forced):
        return Forced(without_levitation(model.rotor), model.forces)
    if isinstance(model, Limited):
        return without_levitation(model.rotor)
    if isinstance(model, InBearing):
        return replace(model, levitates=False)
    if isinstance(model, Jeffcott):
        at = model.parameters
        touchdowns: tuple[Touchdown, ...] = (Touchdown((1.0,), Rigid(at.d), at.mu, at.radius_ratio + 1.0),)
    elif isinstance(model, LinearRotor) and (len(model.mass) == 1 or model.unlevitated is not None):
        touchdowns = tuple(model.touchdowns)
    else:
        allowed = "a rotor of one coordinate, or one that says by its unlevitated matrices what is left without its levitation"
        raise InputError("machine", shown(model), allowed)
    mass, _, gyroscopic, _, forcing = model.matrices
    left = model.unlevitated if isinstance(model, LinearRotor) else None
    damping, stiffness = np.zeros((2, *mass.shape)) if left is None else left
    return LinearRotor.in_fixed_frame(
        mass=mass,
        damping=damping,
        stiffness=stiffness,
        gyroscopic=gyroscopic,
        forcing=forcing,
        touchdowns=touchdowns,
        translation=model.system.translated,
        scales=model.scales,
        shaft=model.shaft if isinstance(model, LinearRotor) else None,
        conjugate=model.conjugate if isinstance(model, LinearRotor) else None,
        magnets=model.magnets if isinstance(model, LinearRotor) else None,
    )
