"""Which statements of the source paper hold."""

import numpy as np
import pytest
from machines import PAPER

from carom import find_equilibria, find_orbits
from carom.models import jeffcott


def test_fixed_points_of_longer_pairs_are_virtual():
    """As the text says below proposition 4.3; there are longer pairs up to a fold at about γ = 0.022."""
    pairs = set()
    for gamma in np.geomspace(0.006, 0.02, 8):
        for orbit in find_orbits(jeffcott(PAPER.replace(gamma=float(gamma)))):
            pairs.add(orbit.name.pair)
            assert orbit.name.pair == 1 or not orbit.admissible
    assert len(pairs) > 3


@pytest.mark.parametrize(("gamma", "rubs"), [(0.27, True), (0.395, False)])
def test_rub_of_the_third_region(gamma, rubs):
    """On both sides of the fold of the rubs, at the figure's own stiffness."""
    rotor = jeffcott(PAPER.replace(gamma=gamma))
    contact_free, *others = find_equilibria(rotor)
    assert contact_free.status == "admissible"
    assert any(rub.stable and rub.status == "admissible" for rub in others) == rubs
