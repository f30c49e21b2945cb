"""Branches of orbits with several impacts in a diagram."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from carom.bifurcations import Diagram, find_bifurcations
from carom.bifurcations.documents import diagram_document
from carom.bifurcations.several import lies_on
from carom.files import as_json
from carom.models import Jeffcott
from carom.orbits.orbit import orbit_near
from carom.outcome import InputError
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
    assert found[0].values.max() == pytest.approx(point.value, abs=1e-7)
    grazing = [each for each in diagram().points if each.kind == "grazing" and each.name == "P2,1"]
    more = [each for each in diagram().points if each.kind == "vanishing-impact" and each.orbit.impacts == 3]
    assert [each.value for each in grazing] == pytest.approx([0.08267431146], abs=1e-10)
    assert min(abs(each.value - grazing[0].value) for each in more) < 1e-10
    assert all(each.admissible for each in grazing)


def test_every_orbit_found_lies_on_one_branch_and_names_are_unique():
    names = [branch.name for branch in diagram().several]
    assert len(set(names)) == len(names) > 3
    for branch in diagram().several:
        middle = 0.5 * (branch.values.min() + branch.values.max())
        rotor = Jeffcott(PAPER.replace(gamma=middle))
        for start in branch.starts_at(middle):
            orbit = orbit_near(rotor, branch.word, start)
            assert orbit is not None
            passing = [other.name for other in diagram().several if lies_on(orbit, middle, other)]
            # Orbits that have half the period lie on no branch of this word.
            assert passing in ([branch.name], [])
        assert set(branch.names) == {branch.name}
        assert {orbit.name for orbit in branch.orbits} == {branch.name}
    assert any(len(branch.starts_at(0.0833)) == 1 for branch in diagram().several)


def test_points_have_a_word_and_the_number_of_impacts():
    document = diagram_document(PAPER, diagram())
    assert as_json(document)
    for point in document["points"]:
        if point["branch"].startswith("P"):
            assert point["impacts"] == int(point["branch"][1])
            assert point["word"] == " ".join(["impact+"] * point["impacts"])
        elif point["branch"].startswith("B"):
            assert (point["word"], point["impacts"]) == ("impact+", 1)
        else:
            assert (point["word"], point["impacts"]) == (None, None)
    for branch in document["several"]:
        assert np.shape(branch["radial_speeds"]) == (len(branch["values"]), branch["impacts"])
    assert "P2,1" in repr(diagram())
    figure = diagram().plot()
    assert len(figure.axes) == 3


def test_without_impacts_there_are_none():
    plain = find_bifurcations(PAPER, "gamma", (0.0824, 0.0836))
    assert plain.several == ()
    assert [point.value for point in plain.points] == [
        point.value for point in diagram().points if not point.name.startswith("P")
    ]
    with pytest.raises(InputError, match="impacts"):
        find_bifurcations(PAPER, "gamma", (0.0824, 0.0836), impacts=0)
