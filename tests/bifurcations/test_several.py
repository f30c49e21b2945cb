"""Branches of orbits with several impacts in a diagram."""

from functools import cache

import numpy as np
import pytest

from carom.bifurcations import Diagram, find_bifurcations
from carom.bifurcations.documents import diagram_document
from carom.models import jeffcott
from carom.motions import simulate
from carom.orbits import find_orbits, orbit_near
from tests.machines import PAPER

pytestmark = pytest.mark.jit_only


@cache
def diagram() -> Diagram:
    return find_bifurcations(PAPER, "gamma", (0.0824, 0.0836), impacts=3)


def test_the_branch_born_in_the_period_doubling_is_there_once():
    """From its birth down to its grazing, where it meets an unstable orbit with one impact more."""
    found = [branch for branch in diagram().several if "period-halving" in branch.stops]
    assert [branch.name for branch in found] == ["P2,1"]
    (point,) = [each for each in diagram().points if each.kind == "period-doubling" and each.name == "B1,d"]
    (end,) = [each for each in found[0].special if each.kind == "period-halving"]
    assert end.value == pytest.approx(point.value, abs=1e-14)
    assert [each.kind for each in diagram().points if abs(each.value - point.value) < 1e-5] == ["period-doubling"]
    grazing = [each for each in diagram().points if each.kind == "grazing" and each.name == "P2,1"]
    more = [each for each in diagram().points if each.kind == "vanishing-impact" and each.orbit.impacts == 3]
    assert [each.value for each in grazing] == pytest.approx([0.08267431146], abs=1e-10)
    assert min(abs(each.value - grazing[0].value) for each in more) < 1e-10
    assert all(each.admissible for each in grazing)


def test_the_family_of_three_impacts_that_is_stable_beside_that_of_one():
    """Between ends known from motions that settled on it; started at once, few do."""
    found = find_bifurcations(PAPER, "gamma", (0.0875, 0.093), impacts=3)
    (family,) = [branch for branch in found.several if branch.stable.any()]
    ends = {point.kind: point for point in found.points if point.name == family.name}
    assert {kind: point.value for kind, point in ends.items()} == pytest.approx(
        {"period-doubling": 0.0877105, "neimark-sacker": 0.0916731}, abs=5e-8
    )
    assert family.impacts == 3
    assert all(point.admissible for point in ends.values())
    within = (family.values > 0.08772) & (family.values < 0.09167)
    assert within.any()
    assert np.array_equal(family.stable, within)
    motion = simulate(
        PAPER.replace(gamma=0.09), find_orbits(PAPER.replace(gamma=0.09), impacts=3)["P3,4"].departure, settle=True
    )
    assert motion.multiplicity == 3
    document = diagram_document(found)
    assert document["search"]["on_others"] == 0
    low, high = document["search"]["share_on_listed"][1:]
    assert low < found.search.share_on_listed < high


def test_every_orbit_found_lies_on_one_branch_and_names_are_unique():
    names = [branch.name for branch in diagram().several]
    assert len(set(names)) == len(names) > 3
    for branch in diagram().several:
        middle = 0.5 * (branch.values.min() + branch.values.max())
        rotor = jeffcott(PAPER.replace(gamma=middle))
        for start in branch.starts_at(middle):
            orbit = orbit_near(rotor, branch.word, start)
            assert orbit is not None
            passing = [other.name for other in diagram().several if other.passes(orbit, middle)]
            # Orbits that have half the period lie on no branch of this word.
            assert passing in ([branch.name], [])
        assert set(branch.names) == {branch.name}
        assert {orbit.name for orbit in branch.orbits} == {branch.name}
    assert any(len(branch.starts_at(0.0833)) == 1 for branch in diagram().several)
