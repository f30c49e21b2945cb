"""Pictures of kicks: the basin of the library, with the look of its figures."""

import numpy as np
import pytest
from compilation import sized
from machines import PAPER

import carom
from carom.disturbances import FASTEST, Grid, KickPlane
from carom.explorer.computing.kicks import NOWHERE, map_kicks
from carom.explorer.computing.planes import DisturbancePlane, planes_of
from carom.explorer.computing.rest import RestKick
from carom.models import jeffcott

CELLS = sized(24, 3)
ROTOR = jeffcott(PAPER.replace(gamma=0.2))
KICKS = DisturbancePlane("kick", "velocity", FASTEST, FASTEST)
GROUNDED = jeffcott(PAPER.replace(gamma=0.05))


@pytest.fixture(scope="module")
def found():
    return map_kicks(ROTOR, KICKS, CELLS, FASTEST)


def test_the_picture_is_the_basin(found):
    basin = carom.map_basins(ROTOR, Grid(KickPlane(FASTEST), (CELLS, CELLS)))
    np.testing.assert_array_equal(found.outcomes, basin.outcomes)
    assert found.share.fraction == pytest.approx(basin.share_recovered.fraction, rel=1e-12)
    assert (found.share.count, found.share.total) == (basin.share_recovered.count, basin.share_recovered.total)
    for radial in range(0, CELLS, 5):
        for tangential in range(0, CELLS, 5):
            if not basin.exists[radial, tangential]:
                assert found.cells[tangential, radial] == NOWHERE
                continue
            ending = found.endings[found.cells[tangential, radial]]
            assert ending["words"] == basin.motions[basin.dataset["motion"].values[radial, tangential]].words


def test_the_smallest_lost_kick_is_lost_and_none_of_the_picture_is_smaller(found):
    sizes = found.sizes
    np.testing.assert_allclose(found.middles, KickPlane(FASTEST).coordinates[0].middles(CELLS), rtol=1e-12)
    assert not found.recovered[np.isclose(sizes, found.smallest_lost, rtol=1e-12)].all()
    assert found.recovered[sizes < found.smallest_lost * (1.0 - 1e-12)].all()
    assert (found.exists == (sizes <= FASTEST)).all()


def test_a_kick_from_the_wall_starts_there_with_its_velocity():
    kick = RestKick(1.0, 1j)
    starts = kick.starts(GROUNDED, np.array([0.5]), np.array([0.25]))
    assert starts.positions[0] == 1j
    assert starts.velocities[0] == 1j * (0.5 + 0.25j)
    assert starts.touched.all()


def test_sizes_stay_in_si_units_where_the_speed_changes():
    case = carom.load("examples/keogh-cole.toml")
    kicks = planes_of(case)[0]
    faster = jeffcott(case.replace(speed="3000 rpm", damping="3000 N s/m").parameters)
    shown = map_kicks(faster, kicks, sized(4, 2), kicks.usual)
    assert shown.largest * faster.scales.velocity == pytest.approx(kicks.usual, rel=1e-14)
    assert kicks.usual == pytest.approx(np.sqrt(4.0 * 9.80665 * case.parameters.scales.clearance))
    assert planes_of(carom.load("examples/source-paper.toml"))[0].usual == 1.0
