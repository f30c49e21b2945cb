"""Restitution of walls that give way: what formulas in use promise, and what a wall made by them gives back."""

import pytest

from carom.parameters.restitution import damping_ratio_of, dissipation_of, restitution_of_dissipation

SPEED = 0.3
"""No matter which."""


@pytest.mark.parametrize(
    ("promised", "dissipation", "given_back"),
    [
        # Hunt and Crossley 1975: χv = 3(1 − e)/2.
        (0.76, lambda e: 1.5 * (1.0 - e), 0.80573),
        # Lankarani and Nikravesh 1990: χv = 3(1 − e²)/4.
        (0.5, lambda e: 0.75 * (1.0 - e * e), 0.7252),
    ],
)
def test_walls_made_by_approximations_give_back_more_than_promised(promised, dissipation, given_back):
    digits = len(str(given_back)) - 2

    assert round(restitution_of_dissipation(dissipation(promised) / SPEED, SPEED), digits) == given_back
    exact = dissipation_of(promised, SPEED)
    assert restitution_of_dissipation(exact, SPEED) == pytest.approx(promised, rel=1e-14)


def test_damping_of_the_source_paper_s_restitution():
    assert round(damping_ratio_of(0.95), 7) == 0.0164982
