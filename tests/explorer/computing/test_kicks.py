"""Pictures of kicks: the basin of the library, with the look of its figures."""

from __future__ import annotations

import numpy as np
import pytest
from compilation import sized
from machines import PAPER

import carom
from carom.disturbances import FASTEST, Grid, KickPlane
from carom.explorer.computing.kicks import NOWHERE, RestKick, largest_kick, map_kicks, rest_of
from carom.models import Jeffcott
from carom.outcome import Outcome
from carom.plots import OUTCOMES

CELLS = sized(24, 3)
ROTOR = Jeffcott(PAPER.replace(gamma=0.2))
GROUNDED = Jeffcott(PAPER.replace(gamma=0.05))


@pytest.fixture(scope="module")
def found():
    return map_kicks(ROTOR, CELLS, FASTEST)


def test_the_picture_is_the_basin(found):
    basin = carom.map_basins(ROTOR, Grid(KickPlane(FASTEST), (CELLS, CELLS)))
    np.testing.assert_array_equal(found.basin.outcomes, basin.outcomes)
    assert found.share == basin.share_recovered
    for radial in range(0, CELLS, 5):
        for tangential in range(0, CELLS, 5):
            if not basin.exists[radial, tangential]:
                assert found.cells[tangential, radial] == NOWHERE
                continue
            ending = found.endings[found.cells[tangential, radial]]
            assert ending.words == basin.motions[basin.dataset["motion"].values[radial, tangential]].words


def test_colours_are_those_of_the_figures(found):
    colours = {OUTCOMES[Outcome(code).label].colour for code in np.unique(found.basin.outcomes[found.basin.exists])}
    assert colours <= {ending.colour for ending in found.endings}
    assert sum(ending.share for ending in found.endings) == pytest.approx(1.0, abs=1e-12)


def test_the_smallest_lost_kick_is_lost_and_none_of_the_picture_is_smaller(found):
    radial, tangential = (axis.middles(CELLS) for axis in found.basin.coordinates)
    sizes = np.hypot(radial[:, None], tangential[None, :])
    assert not found.basin.recovered[np.isclose(sizes, found.smallest_lost, rtol=1e-12)].all()
    assert found.basin.recovered[sizes < found.smallest_lost * (1.0 - 1e-12)].all()
    assert (found.basin.exists == (sizes <= FASTEST)).all()


def test_kicks_of_a_rotor_that_cannot_levitate_disturb_the_rub():
    rest = rest_of(GROUNDED)
    rub = next(one for one in carom.find_equilibria(GROUNDED) if one.kind == "rub" and one.stable)
    assert not rest.levitates
    assert rest.position == rub.position
    shown = map_kicks(GROUNDED, sized(8, 2), FASTEST)
    assert shown.share.fraction == 0.0
    np.testing.assert_array_equal(shown.cells.T == NOWHERE, ~shown.basin.exists)


def test_a_kick_from_the_wall_starts_there_with_its_velocity():
    kick = RestKick(1.0, 1j)
    starts = kick.starts(GROUNDED, np.array([0.5]), np.array([0.25]))
    assert starts.positions[0] == 1j
    assert starts.velocities[0] == 1j * (0.5 + 0.25j)
    assert starts.touched.all()


def test_the_largest_kick_stays_in_si_units_where_the_speed_changes():
    machine = carom.load("examples/keogh-cole.toml")
    largest = largest_kick(carom.load("examples/keogh-cole.toml"))
    faster = Jeffcott(machine.replace(speed="3000 rpm", damping="3000 N s/m").parameters)
    shown = map_kicks(faster, sized(4, 2), largest)
    assert shown.fastest * faster.scales.velocity == pytest.approx(largest, rel=1e-14)
    assert largest_kick(carom.load("examples/source-paper.toml")) == 1.0
    assert largest == pytest.approx(np.sqrt(4.0 * 9.80665 * machine.parameters.scales.clearance))
