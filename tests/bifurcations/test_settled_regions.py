"""Regions of machines whose orbits have no closed forms, by where disturbances settle."""

from pathlib import Path

import pytest

import carom as cm
from carom.bifurcations.documents import regions_document

EXAMPLE = Path("examples/keogh-cole.toml").read_text(encoding="utf-8").split("[zones]")[0]


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    path = tmp_path_factory.mktemp("regions") / "machine.toml"
    soft = EXAMPLE.replace("restitution", "# restitution")
    path.write_text(f'{soft}[touchdown]\nlaw = "kelvin-voigt"\nstiffness = 2e9\nrestitution = 0.95\n', encoding="utf-8")
    plane = cm.bifurcations.Plane("damping", "friction", (1000.0, 12000.0), (0.05, 0.15))
    return cm.map_regions(cm.load(path), plane, grid=3)


def test_every_point_of_the_grid_is_in_one_region(found):
    assert sum(region.share for region in found.regions) == pytest.approx(1.0)
    assert sum(len(region.places) for region in found.regions) == 9
    # With much damping every disturbance comes back.
    most = min(found.regions, key=lambda region: -region.places[:, 0].max())
    assert most.motions.contact_free
    assert len({region.motions for region in found.regions}) > 1


def test_regions_of_points_are_where_motions_settle(found):
    for region in found.regions:
        x, y = region.point
        rotor = found.axes[1].move(found.axes[0].move(found.model, x), y)
        assert cm.bifurcations.motions_at(rotor) == region.motions


def test_documents_and_remarks_say_how_they_were_found(found):
    document = regions_document(found)
    assert document["curves"] == []
    assert "disturbances" in document["lost"][0]
    assert {entry["words"] for entry in document["regions"]} == {region.motions.words for region in found.regions}
