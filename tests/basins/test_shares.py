"""How large a sample has to be."""

from __future__ import annotations

import pytest

from carom.basins.shares import Share, starts_enough


@pytest.mark.parametrize("wanted", [0.01, 0.5, 0.9, 0.95, 0.99, 0.999])
def test_fewest_starts_that_show_a_share(wanted):
    enough = starts_enough(wanted)
    assert Share.of(enough, enough, drawn=True).low >= wanted
    assert enough == 1 or Share.of(enough - 1, enough - 1, drawn=True).low < wanted


def test_no_sample_shows_that_all_come_back():
    assert starts_enough(1.0) is None
