"""Planes at their walls."""

import numpy as np
import pytest
from flights import plain_record
from hypothesis import given
from hypothesis import strategies as st

from carom.core.wall import local_velocity, set_on_wall, unit

EPSILON = 2.0**-52


@given(st.complex_numbers(min_magnitude=1e-100, max_magnitude=1e100, allow_nan=False, allow_infinity=False))
def test_unit(z):
    assert abs(unit(z) - z / abs(z)) <= 4 * EPSILON


def test_set_on_wall_is_the_smallest_change():
    random = np.random.default_rng(3)
    row = random.normal(size=3) + 1j * random.normal(size=3)
    arrays = plain_record(
        exponents=np.array([-0.1 + 1j, -0.2, -1j]),
        driven=np.zeros(3, bool),
        offsets=np.array([0.3 - 0.2j]),
        rows=row[None],
    )
    start = random.normal(size=3) + 1j * random.normal(size=3)
    amplitudes = start.copy()
    set_on_wall(arrays, 0, amplitudes)
    before, after = arrays.offsets[0] + row @ start, arrays.offsets[0] + row @ amplitudes
    size = abs(arrays.offsets[0]) + np.abs(row * start).sum()
    assert abs(after) == pytest.approx(1.0, abs=4 * EPSILON * size)
    assert abs(after - before / abs(before)) <= 8 * EPSILON * size
    # The smallest change that moves the plane by this much is along the conjugate of its row.
    expected, *_ = np.linalg.lstsq(row[None], np.array([after - before]), rcond=None)
    assert np.allclose(amplitudes - start, expected, rtol=0, atol=1e-14)


def test_local_velocity_is_radial_and_along_the_wall():
    arrays = plain_record(
        exponents=np.array([-0.1 + 1j]),
        driven=np.zeros(1, bool),
        offsets=np.array([0.0j]),
        rows=np.array([[2.0 + 0j]]),
    )
    # y = 2c turns once per unit of time while it shrinks by a tenth.
    assert local_velocity(arrays, 0, np.array([0.3j])) == pytest.approx(0.6 * (-0.1 + 1j), rel=1e-14)
