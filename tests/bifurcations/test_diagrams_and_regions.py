"""Whole diagrams and maps of a plane."""

import numpy as np
import pytest
from compilation import sized
from machines import PAPER, random_parameters

from carom import find_equilibria, find_orbits
from carom.bifurcations import Plane, find_bifurcations, map_regions, motions_at
from carom.models import jeffcott


@pytest.fixture(scope="module")
def diagram():
    return find_bifurcations(PAPER, "gamma", (0.05, 0.4))


def test_every_branch_is_followed_once(diagram):
    assert len(diagram.orbits) == 2
    for value in (0.0501, 0.09, 0.16):
        orbits = [orbit for orbit in find_orbits(jeffcott(PAPER.replace(gamma=value))) if orbit.admissible]
        for orbit in orbits:
            passing = [
                branch
                for branch in diagram.orbits
                if np.abs(branch.period - orbit.period).min() < 0.1 and value <= branch.values.max()
            ]
            assert passing


def test_equilibrium_branches(diagram):
    kinds = {branch.kind: branch for branch in diagram.equilibria}
    levitation, stable, saddle = kinds["contact-free"], kinds["stable rub"], kinds["saddle rub"]
    assert (levitation.admissible == (levitation.values > 0.0724686787)).all()
    assert np.isnan(stable.radius[stable.values > 0.3701]).all()
    assert stable.stable[stable.values < 0.3699].all()
    assert not saddle.stable.any()
    for index in (10, 100):
        at = find_equilibria(jeffcott(PAPER.replace(gamma=levitation.values[index])))
        assert levitation.radius[index] == pytest.approx(at[0].radius)
        assert stable.normal_force[index] == pytest.approx(at[1].normal_force)


def test_motions_agree_with_certified_orbits():
    random = np.random.default_rng(9)
    for _ in range(sized(20, 20, 40)):
        parameters = PAPER.replace(gamma=random.uniform(0.02, 0.3), omega=random.uniform(0.6, 1.0))
        orbits = [orbit for orbit in find_orbits(jeffcott(parameters), 60.0) if orbit.admissible]
        motions = motions_at(parameters)
        assert motions.orbits == len(orbits)
        assert motions.stable_orbits == sum(orbit.stable for orbit in orbits)
        assert motions.stable_names == tuple(sorted(orbit.name for orbit in orbits if orbit.stable))
        assert motions.unstable_names == tuple(sorted(orbit.name for orbit in orbits if not orbit.stable))


def test_steady_motions_are_those_of_the_equilibria():
    """The limit of the rub in closed form, against the equilibria with their eigenvalues."""
    random = np.random.default_rng(31)
    rubs = 0
    for _ in range(sized(150, 5)):
        parameters = random_parameters(random, gamma=float(10 ** random.uniform(-1.3, 0.5)))
        contact_free, *others = find_equilibria(jeffcott(parameters))
        motions = motions_at(parameters)
        assert motions.contact_free is (contact_free.status == "admissible")
        assert motions.rub is any(rub.stable and rub.status == "admissible" for rub in others)
        rubs += motions.rub
    assert rubs > sized(20, 0)


def test_map_of_the_source_papers_plane():
    found = map_regions(PAPER, Plane("gamma", "omega", (0.02, 0.4), (0.6, 1.0)), grid=10)
    assert found.lost == ()
    kinds = [curve.kind for curve in found.curves]
    expected = ["boundary-equilibrium", "fold", "grazing", "non-smooth-hopf", "period-doubling", "rub-fold"]
    assert sorted(set(kinds)) == expected
    for kind in ("grazing", "period-doubling", "boundary-equilibrium", "non-smooth-hopf", "rub-fold"):
        assert kinds.count(kind) == 1
    values = {point.kind: point.value for point in found.codimension2}
    assert values["fold + boundary-equilibrium"] == pytest.approx((0.1779723, 0.7811076), abs=5e-8)
    assert sum(region.share for region in found.regions) == pytest.approx(1.0)
    assert {region.motions.source_region for region in found.regions} == {"R1", "R2", "R3", "R4"}
    for region in found.regions:
        gamma, omega = region.point
        assert motions_at(PAPER.replace(gamma=gamma, omega=omega)) == region.motions
