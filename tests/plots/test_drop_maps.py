"""Figures of basins of drops: what they must show."""

import numpy as np
import pytest
from matplotlib.path import Path

import carom as cm
from carom import plots

pytestmark = pytest.mark.jit_only


@pytest.fixture(scope="module")
def found():
    return cm.basins.map_drops(
        cm.load("examples/touchdown-balls.toml"), cm.drop(regained_after="12 ms"), shape=(6, 4), until="40 ms"
    )


def words(figure):
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def mesh(axes):
    (cells,) = [each for each in axes.collections if each.get_gid() == "cells"]
    return cells


def test_both_panels_show_the_cells(found):
    figure = plots.drop_map(found)
    left, right = figure.axes[:2]
    shown = np.ma.filled(mesh(right).get_array(), np.nan).reshape(4, 6)
    assert shown == pytest.approx(1e-3 * found.dataset["force"].values.T)
    painted = mesh(left).get_array()
    names = [str(found.motions[place]) for place in found.dataset["motion"].values.ravel()]
    assert len(np.unique(painted)) == len(set(names))
    # Cells of the phase fill a turn; the present machine is marked in both.
    assert left.get_xlim() == pytest.approx((0.0, 360.0))
    for axes in (left, right):
        (star,) = [each for each in axes.lines if each.get_gid() == "present"]
        assert (star.get_xdata()[0], star.get_ydata()[0]) == pytest.approx((90.0, 9000.0))
    assert "present machine and release" in words(figure)
    assert figure.axes[2].get_ylabel() == "peak force (kN)"


def test_what_exceeds_a_limit_is_outlined(found):
    limited = cm.basins.DropMap(found.dataset.assign_attrs(load_limits='{"force": 1300.0}'))
    over = limited.exceeding("force")
    assert 0 < over.sum() < over.size
    figure = plots.drop_map(limited)
    assert "above the limit 1.3 kN" in words(figure)
    (patch,) = [each for each in figure.axes[1].patches if each.get_gid() == "beyond"]
    corners = mesh(figure.axes[1]).get_coordinates()
    middles = 0.25 * (corners[1:, 1:] + corners[1:, :-1] + corners[:-1, 1:] + corners[:-1, :-1])
    hatched = [any(part.contains_point(place) for part in _rectangles(patch)) for place in middles.reshape(-1, 2)]
    assert np.array_equal(np.reshape(hatched, over.T.shape), over.T)


def _rectangles(patch):
    """The rectangles of a compound path, which is inside where one of them is."""
    return [Path(corners) for corners in patch.get_path().vertices.reshape(-1, 5, 2)]
