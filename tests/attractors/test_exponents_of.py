"""Exponents of attractors, each checked by another route."""

from dataclasses import replace

import numpy as np
import pytest

from carom.attractors import exponents_of, find_attractors
from carom.base.outcome import Outcome
from carom.models import jeffcott
from carom.orbits import orbit_exponents
from tests.compilation import sized
from tests.machines import PAPER
from tests.orbits.test_exponents import CHAOTIC, nearby_growth

pytestmark = pytest.mark.jit_only


def test_motions_of_the_machine_of_the_paper():
    machine = PAPER.replace(gamma=0.0815)
    found = {entry.name: entry for entry in find_attractors(machine, count=48)}
    known = {name: exponents_of(machine, entry) for name, entry in found.items()}
    np.testing.assert_allclose(known.pop("synchronous rub").values, [-0.19075, -0.19075, -np.inf, -np.inf], atol=1e-4)
    np.testing.assert_allclose(known.pop("levitation").values, -0.5 * 0.0815)
    assert known.pop("rolling backward whirl").values.tolist() == [0.0, -np.inf, -np.inf, -np.inf]
    assert {found[name].orbit.impacts for name in known} >= {6}
    for name, exponents in known.items():
        assert exponents.across[0] < 0.0
        np.testing.assert_array_equal(exponents.values, orbit_exponents(found[name].orbit).values)


def test_irregular_bouncing_has_an_exponent_that_nearby_motions_confirm_and_is_not_called_an_attractor():
    machine = PAPER.replace(gamma=0.081)
    entry = find_attractors(machine, count=48, patience=5000)["irregular bouncing"]
    assert entry.survival.verdict == "not seen to end"
    rate, error = nearby_growth(jeffcott(machine), entry.state, 10.0, sized(300, 1, 5000))
    assert rate > 3.0 * error
    value, uncertain = exponents_of(machine, entry, 5000).across
    assert abs(rate - value) < 5.0 * np.hypot(error, uncertain)


def test_nothing_is_known_of_motions_given_up():
    entry = next(iter(find_attractors(CHAOTIC, count=4, patience=2000)))
    given_up = replace(entry, name=replace(entry.name, outcome=Outcome.GRAZING), orbit=None)
    assert exponents_of(CHAOTIC, given_up) is None
