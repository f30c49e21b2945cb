"""Figures of basins of drops: what they must show."""

import numpy as np
import pytest
from drawn_legends import legend_words

import carom as cm
from carom import plots

pytestmark = pytest.mark.jit_only


def mesh(axes):
    (cells,) = [each for each in axes.collections if each.get_gid() == "cells"]
    return cells


def test_both_panels_show_the_cells():
    found = cm.basins.map_drops(
        cm.load("examples/touchdown-balls.toml"),
        cm.drop(regained_after="12 ms"),
        over={"phase": 6, "speed": 4},
        until="40 ms",
    )
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
    assert "present machine and release" in legend_words(figure)
    assert figure.axes[2].get_ylabel() == "peak force (kN)"
