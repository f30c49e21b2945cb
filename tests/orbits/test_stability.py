"""Multipliers: order, kind and what is made of them."""

import numpy as np
import pytest

from carom.orbits import multipliers


def matrix_with(values: list[complex], seed: int = 0) -> np.ndarray:
    """Real matrix with these eigenvalues (complex ones in conjugate pairs, upper first), in a random basis."""
    blocks = np.zeros((len(values), len(values)))
    place = 0
    while place < len(values):
        value = complex(values[place])
        if value.imag:
            blocks[place : place + 2, place : place + 2] = [[value.real, value.imag], [-value.imag, value.real]]
            place += 2
        else:
            blocks[place, place] = value.real
            place += 1
    basis = np.random.default_rng(seed).normal(size=blocks.shape) + 2.0 * np.eye(len(values))
    return basis @ blocks @ np.linalg.inv(basis)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize(
    "values",
    [
        [0.9, 0.5, -0.1],
        [-1.3, 1.2, 0.1],
        [0.6 + 0.7j, 0.6 - 0.7j, 0.5],
        [1.4, -0.2 + 0.8j, -0.2 - 0.8j],
        [3.0, 1.0, 0.0],
        [0.84, -0.488 + 0.606j, -0.488 - 0.606j],
    ],
    ids=str,
)
def test_largest_first_and_upper_of_a_pair_first(values, seed):
    found = multipliers(matrix_with(values, seed))
    np.testing.assert_allclose(found.values, values, atol=1e-11)
    assert found.values.dtype == complex
    assert found.spectral_radius == pytest.approx(abs(values[0]), abs=1e-11)
    assert found.stable == (abs(values[0]) < 1.0)


def test_a_defective_matrix():
    found = multipliers(np.array([[0.5, 1.0, 0.0], [0.0, 0.5, 1.0], [0.0, 0.0, 0.5]]))
    np.testing.assert_allclose(found.values, 0.5, atol=1e-4)
    assert found.stable
