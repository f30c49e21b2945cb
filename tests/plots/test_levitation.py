"""Figures of levitating flexible rotors: what is drawn where."""

import math

import numpy as np
import pytest
from drawn_legends import fits, legend_words
from flexible_machines import munich

from carom import plots
from carom.rotors import campbell, sensitivity

MACHINE = munich(0.06)
RPM = math.pi / 30.0


def lines(axes):
    return {line.get_gid(): line for line in axes.lines if line.get_gid()}


def test_forward_and_backward_whirls_have_their_markers():
    found = campbell(MACHINE, [100.0, 500.0], count=6)
    figure = plots.campbell(found)
    axes, below = figure.axes
    assert below.get_ylabel() == "damping ratio"
    drawn = lines(axes)
    for name, goes in (("forward whirl", found.frequencies > 0.0), ("backward whirl", found.frequencies < 0.0)):
        heights = np.concatenate([line.get_ydata() for line in axes.lines if line.get_gid() == name])
        assert np.sort(heights[~np.isnan(heights)]) == pytest.approx(np.sort(np.abs(found.frequencies[goes])))
    speeds, turns = drawn["synchronous"].get_data()
    assert speeds[-1] * RPM == pytest.approx(500.0)
    assert turns[-1] == pytest.approx(500.0 / 2.0 / math.pi)
    assert "speed of the shaft" in legend_words(figure)
    assert fits(figure)


def test_sensitivity_has_its_peaks_and_zones():
    found = sensitivity(MACHINE)
    figure = plots.sensitivity(found)
    (axes,) = figure.axes
    for bearing in (0, 1):
        assert np.array_equal(lines(axes)[f"bearing-{bearing}"].get_ydata(), np.abs(found.values[:, bearing]))
    assert [text.get_text() for text in axes.texts] == list("ABCD")
    assert axes.get_ylim()[1] > max(found.peaks.max(), 5.0)
    assert any(words.startswith("bearing 1: 2.4") for words in legend_words(figure))
    assert fits(figure)
