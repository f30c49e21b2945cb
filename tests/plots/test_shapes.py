"""Shapes of free whirls along the shaft: what is drawn where."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_legends import fits, legend_words
from flexible_machines import munich

from carom import plots
from carom.rotors import find_whirls

MACHINE = munich(0.06)
WHIRLS = find_whirls(MACHINE, count=5)
FIGURE = plots.mode_shapes(MACHINE, WHIRLS)


def lines(axes):
    return {line.get_gid(): line for line in axes.lines if line.get_gid()}


@pytest.mark.parametrize("place", range(5))
def test_both_directions_together_are_the_shape(place):
    """Rotated to any plane the distance from the axis stays; along is the widest of all planes."""
    drawn, whirl = lines(FIGURE.axes[place]), WHIRLS[place]
    along = drawn["along"].get_ydata()
    across = drawn["across"].get_ydata() if "across" in drawn else 0.0
    assert np.hypot(along, across) == pytest.approx(np.abs(whirl.shape), abs=1e-12 if "across" in drawn else 0.06)
    widths = [
        np.linalg.norm((whirl.shape * np.exp(1j * angle)).real)
        for angle in np.linspace(0.0, np.pi, 400, endpoint=False)
    ]
    assert np.linalg.norm(along) == pytest.approx(max(widths), rel=1e-4)
    assert drawn["along"].get_xdata() == pytest.approx(1e3 * MACHINE.rotor.places)


def test_bearings_and_sensors_are_marked_at_their_nodes():
    drawn, nodes = lines(FIGURE.axes[0]), 1e3 * MACHINE.rotor.node_places
    assert drawn["magnet"].get_xdata() == pytest.approx(nodes[[each.node for each in MACHINE.bearings]])
    sensors = [node for each in MACHINE.bearings for node in each.sensor_nodes]
    assert drawn["sensor"].get_xdata() == pytest.approx(nodes[sensors])
    assert drawn["touchdown"].get_xdata() == pytest.approx(nodes[[each.node for each in MACHINE.touchdowns]])


def test_titles_tell_the_whirls_and_the_legend_all_marks():
    for axes, whirl in zip(FIGURE.axes, WHIRLS, strict=False):
        assert whirl.sense in axes.get_title()
        assert f"{whirl.damping_ratio:.1g}"[:3] in axes.get_title()
    assert {"magnet", "sensor", "touchdown bearing"} <= set(legend_words(FIGURE))
    assert len(FIGURE.axes) == 5
    assert fits(FIGURE)
