"""Growth of directions, against the QR decomposition of NumPy."""

from __future__ import annotations

import numpy as np

from carom.core.growth import carry_orthogonal


def test_directions_and_factors_are_those_of_the_decomposition_of_each_product():
    rng = np.random.default_rng(0)
    for n, k in ((4, 3), (6, 2), (8, 7)):
        passages = rng.normal(size=(30, n, n)) * 10.0 ** rng.uniform(-3.0, 1.0, (30, 1, n))
        directions, factors = np.linalg.qr(rng.normal(size=(n, k)))[0], np.empty((30, k))
        expected, triangles = directions.copy(), []
        carry_orthogonal(passages, directions, factors)
        for passage in passages:
            expected, triangle = np.linalg.qr(passage @ expected)
            triangles.append(np.abs(np.diag(triangle)))
        np.testing.assert_allclose(directions.T @ directions, np.eye(k), atol=1e-14)
        np.testing.assert_allclose(np.abs(directions), np.abs(expected), atol=1e-9)
        np.testing.assert_allclose(factors, triangles, rtol=1e-9)


def test_a_direction_that_is_taken_away_does_not_harm_the_others():
    directions, factors = np.eye(3), np.empty((2, 3))
    carry_orthogonal(np.array([np.diag([2.0, 3.0, 0.0])] * 2), directions, factors)
    np.testing.assert_array_equal(factors, [[2.0, 3.0, 0.0]] * 2)
    np.testing.assert_array_equal(directions, np.diag([1.0, 1.0, 0.0]))
