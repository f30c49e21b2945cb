"""Which statements of the source paper hold."""

from __future__ import annotations

import pytest
from machines import PAPER

from carom import equilibria, jeffcott


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
    assert "0 of 56 are admissible" in found.claims[4].found
    assert found.claims[5].found.endswith("B1,d")
    assert found.claims[6].found.endswith("R3.1")


@pytest.mark.parametrize(("gamma", "rubs"), [(0.27, True), (0.395, False)])
def test_rub_of_the_third_region(gamma, rubs):
    """On both sides of the fold of the rubs, at the figure's own stiffness."""
    rotor = jeffcott(PAPER.replace(gamma=gamma))
    contact_free, *others = equilibria(rotor)
    assert contact_free.status == "admissible"
    assert any(rub.stable and rub.status == "admissible" for rub in others) == rubs
