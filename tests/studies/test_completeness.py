"""What a study says of the completeness of its orbits."""

from types import SimpleNamespace

import pytest

import carom
from carom.studies.findings import _bouncing


@pytest.mark.parametrize(
    ("radius_ratio", "longest", "words"),
    [
        (400 / 7, None, "bounds exclude any other"),
        (0.5, None, "but for impacts that stop the slip"),
        (400 / 7, 5.0, "there may be more"),
    ],
)
def test_completeness_is_claimed_only_where_it_is_proven(radius_ratio, longest, words):
    parameters = carom.parameters.Parameters(
        gamma=0.3, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=radius_ratio
    )
    orbits = carom.find_orbits(carom.models.jeffcott(parameters), longest)
    study = SimpleNamespace(
        orbits=orbits, rotor=orbits.rotor, stable_orbits=(), wording=SimpleNamespace(time=lambda time: f"{time}")
    )
    assert words in _bouncing(study)
