"""What a study says of the completeness of its orbits."""

from types import SimpleNamespace

import pytest
from machines import PAPER

import carom
from carom.studies.findings import _bouncing


@pytest.mark.parametrize(
    ("radius_ratio", "longest", "words"),
    [
        (400 / 7, None, "with one impact a period were found."),
        (0.5, None, "except orbits with impacts that stop the slip"),
        (400 / 7, 5.0, "there may be others"),
    ],
)
def test_completeness_is_claimed_only_where_it_is_proven(radius_ratio, longest, words):
    orbits = carom.find_orbits(PAPER.replace(gamma=0.3, radius_ratio=radius_ratio), longest)
    study = SimpleNamespace(
        orbits=orbits, rotor=orbits.rotor, stable_orbits=(), wording=SimpleNamespace(time=lambda time: f"{time}")
    )
    assert words in _bouncing(study)
