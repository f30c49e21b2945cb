"""What walls that give way take of a rotor's energy, in many states at a time."""

from __future__ import annotations

import numpy as np

from carom.compiling.decorators import kernel
from carom.core.laws.choice import force, stored_energy
from carom.core.wall import wall_of


@kernel
def damper_forces_all(rotor, plane, depths, rates):
    """Part of the normal force at a plane that its wall's damper bears, (M,), at depths (M,) that grow at rates (M,)."""
    wall = wall_of(rotor, plane)
    forces = np.empty_like(depths)
    for i in range(depths.shape[0]):
        forces[i] = rotor.masses[plane] * (force(depths[i], rates[i], wall) - force(depths[i], 0.0, wall))
    return forces


@kernel
def stored_energies_all(rotor, plane, depths):
    """Energy of the spring of the wall at a plane, (M,), at depths (M,)."""
    wall = wall_of(rotor, plane)
    energies = np.empty_like(depths)
    for i in range(depths.shape[0]):
        energies[i] = rotor.masses[plane] * stored_energy(depths[i], wall)
    return energies
