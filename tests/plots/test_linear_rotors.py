"""Figures of results of rotors with several coordinates and planes."""

import numpy as np
import pytest
from linear_rotors import tilting

import carom
from carom.base.outcome import InputError

pytestmark = pytest.mark.jit_only


def test_equilibria_are_drawn_in_the_circle_of_each_plane():
    found = carom.find_equilibria(tilting().model)
    figure = found.plot()
    assert [panel.get_title() for panel in figure.axes] == [
        "co-rotating frame, touchdown bearing 1",
        "co-rotating frame, touchdown bearing 2",
    ]
    for plane, panel in enumerate(figure.axes):
        drawn = [line.get_xydata() for line in panel.lines if line.get_gid() != "wall"]
        assert len(drawn) == sum(abs(at.places[plane]) <= 3.0 for at in found)
        # Nothing drawn lies outside the frame.
        reach = panel.get_xlim()[1]
        assert all(abs(points).max() < reach for points in drawn)


def test_orbits_at_several_planes_are_drawn_in_the_circle_that_they_strike():
    ends = np.array([[1.0, 0.8], [1.0, -0.7]])
    found = carom.find_orbits(tilting(damping=0.02 * ends.T @ ends).model, impacts=2, guesses=120)
    second = next(orbit for orbit in found if orbit.segments == "impact+@2")
    for drawn in second.plot().axes:
        (line,) = (line for line in drawn.lines if line.get_gid() == "path")
        assert np.hypot(*line.get_xydata().T).max() == pytest.approx(1.0, abs=1e-12)
        assert "touchdown bearing 2" in drawn.get_title()
    carom.plots.radius(second.trajectory(3.0))
    both = carom.plots.equilibria_and_orbits(found, carom.find_equilibria(found.rotor), plane=1)
    assert "touchdown bearing 2" in both.axes[0].get_title()
    with pytest.raises(InputError, match="plane = 2"):
        carom.plots.equilibria_and_orbits(found, plane=2)
