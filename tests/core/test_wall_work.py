"""Stored energies of walls, against the laws written out."""

import numpy as np
import pytest
from yielding_walls import free_mass

from carom.core.wall_work import stored_energies_all
from carom.models import HuntCrossley, KelvinVoigt

DEPTHS = np.array([0.0, 1e-4, 0.02, 0.3])


@pytest.mark.parametrize(
    ("law", "energy"),
    [
        (KelvinVoigt(40.0, 3.0), 20.0 * DEPTHS**2),
        (HuntCrossley(40.0, 0.6), 20.0 * DEPTHS**2),
        (HuntCrossley(40.0, 0.6, 1.5), 16.0 * DEPTHS**2.5),
    ],
)
def test_each_law(law, energy):
    arrays = free_mass(law).system.arrays
    assert stored_energies_all(arrays, 0, DEPTHS) == pytest.approx(energy, rel=1e-14)
