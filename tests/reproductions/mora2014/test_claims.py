"""Which statements of the source paper hold."""

from __future__ import annotations

import re

import numpy as np
import pytest
from machines import PAPER

from carom import find_equilibria, find_orbits
from carom.models import jeffcott


def test_which_hold(found):
    assert [(claim.place, claim.holds) for claim in found.claims] == [
        ("Proposition 4.1", True),
        ("Proposition 4.1", False),
        ("Proposition 4.2", True),
        ("Proposition 4.3", True),
        ("section 4, below Proposition 4.3", True),
        ("section 4a", True),
        ("section 4b, region R3", False),
    ]
    assert "admissible: none" in found.claims[4].found
    assert found.claims[5].found.endswith("B1,d")
    assert found.claims[6].found.endswith("R3.1")


def test_longer_pairs_are_looked_at_along_the_damping(found):
    """Up to a fold beyond which only the first pair is left, and with a distance from the wall that no step jumps over."""
    text = found.claims[4].found
    last = float(re.search(r"γ = (0\.\d+)", text)[1])
    periods = [len(find_orbits(jeffcott(PAPER.replace(gamma=last + step))).periods) for step in (-1e-8, 1e-8)]
    assert periods == [4, 2]
    assert float(re.search(r"at least (0\.\d+) clearances", text)[1]) > 0.02
    # Dampings between those of the claim.
    for gamma in np.random.default_rng(3).uniform(0.008, last, 8):
        orbits = find_orbits(jeffcott(PAPER.replace(gamma=float(gamma))))
        assert not any(orbit.admissible for orbit in orbits if not orbit.name.startswith("B1,"))


@pytest.mark.parametrize(("gamma", "rubs"), [(0.27, True), (0.395, False)])
def test_rub_of_the_third_region(gamma, rubs):
    """On both sides of the fold of the rubs, at the figure's own stiffness."""
    rotor = jeffcott(PAPER.replace(gamma=gamma))
    contact_free, *others = find_equilibria(rotor)
    assert contact_free.status == "admissible"
    assert any(rub.stable and rub.status == "admissible" for rub in others) == rubs
