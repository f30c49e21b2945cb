"""Damper forces and stored energies of walls, against the laws written out."""

from __future__ import annotations

import numpy as np
import pytest
from yielding_walls import free_mass

from carom.core.wall_work import damper_forces_all, stored_energies_all
from carom.models import HuntCrossley, KelvinVoigt

DEPTHS, RATES = np.array([0.0, 1e-4, 0.02, 0.3]), np.array([0.5, 0.7, -0.2, 0.0])


@pytest.mark.parametrize(
    ("law", "damper", "energy"),
    [
        (KelvinVoigt(40.0, 3.0), 3.0 * RATES, 20.0 * DEPTHS**2),
        (HuntCrossley(40.0, 0.6), 24.0 * DEPTHS * RATES, 20.0 * DEPTHS**2),
        (HuntCrossley(40.0, 0.6, 1.5), 24.0 * DEPTHS**1.5 * RATES, 16.0 * DEPTHS**2.5),
    ],
)
def test_each_law(law, damper, energy):
    arrays = free_mass(law).system.arrays
    # The parabola below 1e-9 clearances is far below these depths; the force is a difference, known to rounding of its size.
    assert damper_forces_all(arrays, 0, DEPTHS, RATES) == pytest.approx(damper, rel=1e-12, abs=1e-14)
    assert stored_energies_all(arrays, 0, DEPTHS) == pytest.approx(energy, rel=1e-14)
