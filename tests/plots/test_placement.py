"""Labels keep their distance and go no farther than needed."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from carom.plots.overviews import spread, spread_angles

places = st.lists(st.floats(-100.0, 100.0), min_size=1, max_size=12)


@given(places, st.floats(0.1, 5.0))
def test_labels_keep_their_distance_and_order(wanted, gap):
    placed = spread(wanted, gap)
    order = np.argsort(wanted, kind="stable")
    assert np.all(np.diff(placed[order]) >= gap * (1.0 - 1e-9))


@given(places, st.floats(0.1, 5.0))
def test_labels_move_least(wanted, gap):
    """No single shift of all labels from any one on brings them nearer to where they belong."""
    placed = spread(wanted, gap)
    order = np.argsort(wanted, kind="stable")
    moved = placed[order] - np.asarray(wanted)[order]
    free = np.diff(placed[order]) > gap * (1.0 + 1e-9)
    blocks = np.split(moved, np.flatnonzero(free) + 1)
    for block in blocks:
        assert block.mean() == pytest.approx(0.0, abs=1e-8)


@given(st.lists(st.floats(-np.pi, np.pi), min_size=2, max_size=8))
def test_labels_keep_their_distance_around_a_circle(wanted):
    gap = 0.2
    turned = np.sort(np.mod(spread_angles(wanted, gap), 2.0 * np.pi))
    spaces = np.diff(np.append(turned, turned[0] + 2.0 * np.pi))
    assert np.all(spaces >= gap * (1.0 - 1e-9))
