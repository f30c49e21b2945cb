"""Pictures of kicks: the basin of the library, with the look of its figures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from compilation import sized
from machines import PAPER

import carom
from carom.base.outcome import Outcome
from carom.disturbances import FASTEST, BaseShock, BladeLoss, Grid, KickPlane
from carom.explorer.computing.kicks import NOWHERE, map_kicks, opening_range, telling_pair
from carom.explorer.computing.planes import Plane, planes_of
from carom.explorer.computing.rest import RestKick, rest_of
from carom.models import jeffcott
from carom.plots import OUTCOMES

EXAMPLES = Path(__file__).parents[3] / "examples"
CELLS = sized(24, 3)
ROTOR = jeffcott(PAPER.replace(gamma=0.2))
KICKS = Plane("kick", "velocity", FASTEST, FASTEST)
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
            assert ending.words == basin.motions[basin.dataset["motion"].values[radial, tangential]].words


def test_colours_are_those_of_the_figures(found):
    colours = {OUTCOMES[Outcome(code).label].colour for code in np.unique(found.outcomes[found.exists])}
    assert colours <= {ending.colour for ending in found.endings}
    assert sum(ending.share for ending in found.endings) == pytest.approx(1.0, abs=1e-12)


def test_the_smallest_lost_kick_is_lost_and_none_of_the_picture_is_smaller(found):
    sizes = found.sizes
    np.testing.assert_allclose(found.middles, KickPlane(FASTEST).coordinates[0].middles(CELLS), rtol=1e-12)
    assert not found.recovered[np.isclose(sizes, found.smallest_lost, rtol=1e-12)].all()
    assert found.recovered[sizes < found.smallest_lost * (1.0 - 1e-12)].all()
    assert (found.exists == (sizes <= FASTEST)).all()


def test_kicks_of_a_rotor_that_cannot_levitate_disturb_the_rub():
    rest = rest_of(GROUNDED)
    rub = next(one for one in carom.find_equilibria(GROUNDED) if one.kind == "rub" and one.stable)
    assert not rest.levitates
    assert rest.position == rub.position
    shown = map_kicks(GROUNDED, KICKS, sized(8, 2), FASTEST)
    assert shown.share.fraction == 0.0
    np.testing.assert_array_equal(shown.cells.T == NOWHERE, ~shown.exists)


def test_a_kick_from_the_wall_starts_there_with_its_velocity():
    kick = RestKick(1.0, 1j)
    starts = kick.starts(GROUNDED, np.array([0.5]), np.array([0.25]))
    assert starts.positions[0] == 1j
    assert starts.velocities[0] == 1j * (0.5 + 0.25j)
    assert starts.touched.all()


def test_sizes_stay_in_si_units_where_the_speed_changes():
    case = carom.load(EXAMPLES / "keogh-cole.toml")
    kicks = planes_of(case)[0]
    faster = jeffcott(case.replace(speed="3000 rpm", damping="3000 N s/m").parameters)
    shown = map_kicks(faster, kicks, sized(4, 2), kicks.usual)
    assert shown.largest * faster.scales.velocity == pytest.approx(kicks.usual, rel=1e-14)
    assert kicks.usual == pytest.approx(np.sqrt(4.0 * 9.80665 * case.parameters.scales.clearance))
    assert planes_of(carom.load(EXAMPLES / "source-paper.toml"))[0].usual == 1.0


@pytest.mark.parametrize(
    ("path", "names"),
    [("balanced-rotor.toml", ["kick", "shock", "blade-loss"]), ("source-paper.toml", ["kick", "blade-loss"])],
)
def test_kinds_are_offered_where_their_sizes_are_known(path, names):
    assert [plane.name for plane in planes_of(carom.load(EXAMPLES / path))] == names


@pytest.mark.jit_only
def test_pictures_of_shocks_and_losses_of_a_blade_are_those_of_the_library():
    case = carom.load(EXAMPLES / "balanced-rotor.toml")
    rotor, (_, shocks, losses) = jeffcott(case.parameters), planes_of(case)
    for plane in (shocks, losses):
        found = map_kicks(rotor, plane, 16, 3.0 * plane.usual)
        assert 0 < found.share.count < found.share.total
        for place in zip(*np.nonzero(found.exists), strict=True):
            size = found.sizes[place]
            angle = np.arctan2(found.middles[place[1]], found.middles[place[0]])
            if plane is losses:
                # A cell shows the unbalance after it by the nearest of few sizes, a cell apart, and phases, at most a cell apart.
                before, width = rotor.value("rho"), found.largest / 8
                left = before + size * np.exp(1j * angle)
                phases = np.ceil(2.0 * np.pi * (before + found.largest) / width)
                turned = np.rint(np.angle(left) / (2.0 * np.pi) * phases) / phases * 2.0 * np.pi
                shown = np.rint(abs(left) / width) * width * np.exp(1j * turned) - before
                assert abs(shown - size * np.exp(1j * angle)) < width
                after, start = BladeLoss(abs(shown)).apply(rotor, np.angle(shown))
            else:
                after, start = rotor, BaseShock(size, plane.lasting(rotor)).release(rotor, angle)
            if place[0] % 3 == 0:
                assert found.outcomes[place] == carom.simulate(after, start, settle=True).outcome


@pytest.mark.jit_only
def test_the_page_begins_with_a_range_in_which_something_is_lost_and_something_comes_back():
    case = carom.load(EXAMPLES / "balanced-rotor.toml")
    rotor, kicks = jeffcott(case.parameters), planes_of(case)[0]
    largest = opening_range(rotor, kicks)
    assert kicks.required == 0.1
    assert 0.2 < largest < 0.35
    found = map_kicks(rotor, kicks, 60, largest)
    assert 0.1 < found.share.fraction < 0.4
    # An arm of kicks that come back after contact, beyond a ring of which all are lost somewhere.
    assert found.recovered[found.sizes > 1.8 * found.smallest_lost].sum() > 50
    back, lost = telling_pair(found)
    rest = rest_of(rotor)
    motions = [carom.simulate(rotor, rest.kicked(*kick), settle=True) for kick in (back, lost)]
    assert motions[0].outcome is Outcome.LEVITATED
    assert len(motions[0].contacts.time) > 0
    assert motions[1].outcome is not Outcome.LEVITATED
    assert np.hypot(*back) == pytest.approx(np.hypot(*lost), rel=0.1)


def test_two_kicks_are_drawn_where_none_comes_back():
    back, lost = telling_pair(map_kicks(GROUNDED, KICKS, sized(8, 4), FASTEST))
    assert 0.0 < np.hypot(*back) <= FASTEST
    assert 0.0 < np.hypot(*lost) <= FASTEST
