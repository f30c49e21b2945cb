"""Forces on a rotor, as they are given: their check, and the same in other units."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from carom.base.arguments import kind_of_numbers
from carom.base.outcome import InputError, shown
from carom.models.forcing import Force
from carom.models.mode_arrays import EQUAL, STEADY
from carom.parameters import Scales

WITHOUT_FORCES = "needs a rotor without gravity or other forces that change with time in its frame; a setting gravity=0 leaves weight out"
ISOTROPIC_ALONE = (
    "isotropic bearings; without these carom.simulate, carom.settle, carom.drop, carom.study, carom.find_attractors, "
    "carom.find_orbits with impacts and carom.map_basins work"
)
"""What is asked for where forces that change with time, and anisotropic bearings, are refused."""


def checked_forces(given: object, shape: tuple[int, ...]) -> tuple[Force, ...]:
    """Forces on a rotor with coordinates of this shape; refuse what is none."""
    listed = tuple(given) if isinstance(given, Sequence) and not isinstance(given, Force) else ()
    if not listed or not all(isinstance(each, Force) for each in listed):
        raise InputError("forces", shown(given), "carom.models.Force, one or more")
    return tuple(_checked_force(each, shape) for each in listed)


def _checked_force(force: Force, shape: tuple[int, ...]) -> Force:
    """The force as complex numbers; refuse those that are none, or not as many as there are coordinates."""
    exponent, accelerations = complex_numbers(force.exponent), complex_numbers(force.accelerations)
    if exponent is None or exponent.shape:
        raise InputError("exponent", shown(force.exponent), "a finite number")
    if accelerations is None or accelerations.shape != shape:
        raise InputError("accelerations", shown(force.accelerations), f"finite numbers of shape {shape}")
    return Force(complex(exponent), accelerations)


def complex_numbers(given: object) -> np.ndarray | None:
    """Array of finite numbers, a copy; ``None`` if they are no such numbers."""
    return None if kind_of_numbers(given) == "-" else np.array(given, complex)


def gravity_among(forces: Sequence[Force], along: np.ndarray, scales: Scales | None) -> tuple[int, float] | None:
    """Which of these forces is weight, which pulls all masses alike, and its acceleration in m/s²; ``None`` without scales or weight."""
    for place, force in enumerate(forces if scales else ()):
        pull = np.vdot(along, force.accelerations) / np.vdot(along, along)
        alike = np.abs(force.accelerations - pull * along).max() <= EQUAL * abs(pull)
        if scales and pull and alike and abs(force.exponent - STEADY) <= EQUAL:
            return place, float(abs(pull)) * scales.acceleration
    return None


def in_scales(force: Force, before: Scales | None, after: Scales | None) -> Force:
    """The same force, seen from the fixed frame, in other units of the equations."""
    if before is None or after is None or before == after:
        return force
    exponent = (force.exponent + 1j) * (before.speed / after.speed) - 1j
    return Force(exponent, force.accelerations * (before.acceleration / after.acceleration))
