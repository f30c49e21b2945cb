"""The picture of kicks of a flexible machine."""

from __future__ import annotations

import math

import numpy as np
import pytest
from flexible_pages import opened, reduced

import carom
from carom.explorer.computing import flexible_kicks as kicks
from carom.explorer.computing.flexible_kicks import KickPicture, empty_picture, fill_picture, opening_size
from carom.outcome import Outcome


@pytest.fixture(scope="module")
def rotor():
    return reduced("gravity=0").model


@pytest.fixture
def small(monkeypatch):
    monkeypatch.setattr(kicks, "CELLS", 9)


@pytest.mark.jit_only
def test_it_is_filled_in_from_coarse_to_fine_and_each_cell_is_its_kick(rotor, small, monkeypatch):
    monkeypatch.setattr(kicks, "FEWEST", 5)
    largest = 0.05 / rotor.scales.velocity  # 50 mm/s, which come back at once
    seen = list(fill_picture(rotor, empty_picture(largest), (3, 1)))
    counts = [int(each.followed.sum()) for each in seen]
    assert counts == sorted(set(counts))
    assert seen[-1].whole
    assert (seen[-1].outcomes[~_beyond(9)] == Outcome.LEVITATED).all()
    assert seen[-1].share_up_to(math.inf).total == (~_beyond(9)).sum()
    # What is not followed yet has the outcome of the middle of its square.
    first = seen[0]
    assert (first.outcomes[3:6, 3:6] == first.outcomes[4, 4]).all()


@pytest.mark.jit_only
def test_a_kick_of_a_cell_ends_as_simulated(rotor):
    middles, largest = kicks._middles(kicks.CELLS), 0.9 / rotor.scales.velocity
    right, up = largest * middles[30], largest * middles[24]
    (outcome,) = kicks._ends(rotor, np.array([right]), np.array([up]))
    motion = carom.simulate(rotor, carom.kick(math.hypot(right, up), math.atan2(up, right)), settle=True)
    assert Outcome(outcome) is motion.outcome


@pytest.mark.jit_only
def test_work_goes_on_where_it_was_left(rotor, small):
    largest = 0.05 / rotor.scales.velocity
    *_, coarse = fill_picture(rotor, empty_picture(largest), (3,))
    assert not coarse.whole
    *_, fine = fill_picture(rotor, coarse, (1,))
    assert fine.whole
    assert not list(fill_picture(rotor, fine, (3, 1)))


def _beyond(cells):
    middles = kicks._middles(cells)
    return np.hypot(middles[:, None], middles[None, :]) > 1.0


def test_shares_and_the_smallest_loss_count_what_was_followed():
    outcomes, followed = np.full((3, 3), int(Outcome.LEVITATED)), np.ones((3, 3), bool)
    outcomes[0, 0], outcomes[1, 2], followed[2, 2] = -1, int(Outcome.ROLLING), False
    found = KickPicture(3.0, outcomes, followed)
    share = found.share_up_to(math.inf)
    assert (share.count, share.total) == (6, 7)
    assert (found.share.count, found.share.total) == (7, 8)
    assert found.smallest_lost == pytest.approx(2.0, rel=1e-12)
    cells, endings = found.cells
    assert [ending.words for ending in endings] == ["levitation", "rolling backward whirl"]
    assert (cells[0, 0], cells[1, 2], cells[2, 2]) == (255, 1, 0)


@pytest.mark.jit_only
def test_the_first_range_is_one_in_which_some_are_lost(monkeypatch):
    monkeypatch.setattr(kicks, "TIMES", (1.0, 2.0))
    case = opened("gravity=0").case
    required = case.requirement.own(case.parameters.scales).kick * case.parameters.scales.velocity
    # Both come back on this rig, so it is the larger one.
    assert opening_size(case) == pytest.approx(kicks.ROOM * 2.0 * required, rel=0.05)  # two digits are told
