"""Records that kernels take."""

import numpy as np

from carom.core import layout


def test_rotor_record():
    exponents = np.array([-0.5 - 1j, -0.2 + 0.3j, -0.1j])
    rows = np.array([[0.0, 1.0, 2.0], [1j, 0.5, 0.0]])
    arrays = layout.rotor_record(
        exponents=exponents,
        driven=np.array([False, True, False]),
        offsets=np.array([0.1, 0.2j]),
        rows=rows,
        columns=np.ones((3, 2)),
        friction=np.array([0.1, 0.2]),
        restitution=np.array([0.9, 0.8]),
        surface_speed=np.array([50.0, 20.0]),
        masses=np.array([0.4, 3.0]),
    )
    matrix = np.array([[exponents[0], 0, 0], [1, exponents[1], 0], [0, 0, exponents[2]]])
    assert np.array_equal(arrays.rate_rows, rows @ matrix)
    assert np.array_equal(arrays.acceleration_rows, rows @ matrix @ matrix)
    assert np.array_equal(arrays.gaps, [0, exponents[1] - exponents[0], 0])
    assert arrays.inverse_gaps[1] == 1.0 / (exponents[1] - exponents[0])
    assert np.array_equal(arrays.weights, [5.0, 1.25])
    assert arrays.columns.shape == (3, 2)
    assert arrays.masses.tolist() == [0.4, 3.0]


def test_largest_response_bounds_the_response():
    """``|φ(t)|`` of a pair over all later time, for pairs far apart, near and degenerate."""
    times = np.concatenate([np.linspace(0.0, 20.0, 4001), np.geomspace(20.0, 1e4, 400)])
    for lower, upper in ((-1.0, -0.2), (-0.5 - 1j, -0.5 + 1j), (-0.5, -0.5), (-0.5, -0.5 + 1e-9), (-0.3 + 5j, -0.1)):
        exponents = np.array([lower, upper], complex)
        gap = exponents[1] - exponents[0]
        bound = layout._largest_response(exponents, np.array([0.0, gap]))[1]
        lag = times if gap == 0 else -np.expm1(-gap * times) / gap
        response = np.abs(np.exp(exponents[1] * times) * lag)
        assert response.max() <= bound
        assert bound <= 4.0 * response.max()
    assert layout._largest_response(np.array([0.1, 0.2 + 0j]), np.array([0, 0.1 + 0j]))[1] == np.inf


def test_workspaces_hold_what_kernels_write():
    work = layout.workspace(3)
    assert work.products.shape == (15,)
    assert work.polynomial.shape == (layout.DEGREE,)
    rub = layout.rub_workspace(3)
    assert rub.series.shape == (layout.ORDER + 1, 3)
