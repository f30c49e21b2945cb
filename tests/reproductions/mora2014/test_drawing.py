"""Figures of the source paper: what is drawn, in which look, under which words, and that nothing lies on anything."""

import numpy as np
import pytest

from carom.plots.diagrams import POINTS
from carom.reproductions import mora2014


@pytest.fixture(scope="module")
def drawn():
    found = mora2014.reproduce()
    return found, {picture.name: (picture, picture.draw()) for picture in mora2014.figures(found)}


def test_orbits_of_figure_2_strike_the_circle_that_is_drawn(drawn):
    _, figures = drawn
    axes = figures["figure-2"][1].axes[:9]
    for fixed, rotating, radius in (axes[3:6], axes[6:9]):
        for frame in (fixed, rotating):
            struck = [line.get_xydata() for line in frame.lines if line.get_gid() in ("forward", "backward")]
            assert struck
            np.testing.assert_allclose(np.hypot(*np.concatenate(struck).T), 1.0, rtol=1e-9)
        assert max(line.get_ydata().max() for line in radius.lines if len(line.get_xdata()) > 100) == pytest.approx(1.0)


def test_zeros_of_figure_3(drawn):
    found, figures = drawn
    condition, zeros = figures["figure-3"][1].axes[:2]
    points = [line for line in condition.lines if line.get_marker() == "o"]
    for line, function in zip(points, found.periods.functions, strict=True):
        np.testing.assert_allclose(line.get_xdata(), function.roots[function.roots < 30.0])
    folds = [line for line in zeros.lines if line.get_marker() == POINTS["fold"].marker]
    assert len(folds) == len(found.periods.pairs) >= 5
