"""Figures of basins and gain maps show what the results hold, in words and with units."""

import numpy as np
import pytest
from drawn_legends import fits, legend_words
from machines import PAPER, SCALES
from matplotlib.collections import QuadMesh
from matplotlib.colors import to_rgb

import carom
from carom import plots
from carom.base.outcome import InputError, Outcome
from carom.basins import map_basins, map_gains, smallest_unrecovered
from carom.disturbances import AnyState, Grid, KickPlane, VelocityKick

pytestmark = pytest.mark.jit_only

MACHINE = PAPER.replace(gamma=0.15, rho=0.3, scales=SCALES)


@pytest.fixture(scope="module")
def rotor():
    return carom.models.jeffcott(MACHINE)


def painted(figure):
    """Colours of the cells, one for each cell, of the first axes."""
    (mesh,) = [entry for entry in figure.axes[0].collections if isinstance(entry, QuadMesh)]
    mesh.update_scalarmappable()
    return mesh.get_facecolors()[:, :3].reshape(-1, 3)


def test_the_worse_an_outcome_the_darker_it_is_in_even_steps():
    # Rest on the bearing, which only weight brings about, is beside this order.
    settled = [outcome.label for outcome in Outcome if outcome.settled and outcome is not Outcome.AT_REST]
    order = [*settled[:2], "irregular", *settled[2:]]
    assert order[0] == "levitated"
    steps = -np.diff([255.0 * printed(plots.OUTCOMES[label].colour) for label in order])
    # Twenty of 255 shades of grey are seen at a glance; what comes back stands out most.
    assert min(steps) >= 19.5
    assert max(steps) == steps[0]
    assert max(steps) < 1.7 * min(steps)


def printed(colour):
    """Grey of a print without colour, as in ITU-R BT.601."""
    return float(np.dot(to_rgb(colour), (0.299, 0.587, 0.114)))


def test_kicks_by_size_and_direction(rotor):
    basin = map_basins(rotor, Grid(VelocityKick(1.0), (12, 16)))
    smallest = smallest_unrecovered(rotor, VelocityKick(1.0))
    figure = plots.basin(basin, smallest)
    green = np.array(to_rgb(plots.OUTCOMES["levitated"].colour))
    shown = np.isclose(painted(figure), green).all(axis=1)
    parts = len(shown) // basin.starts
    assert 16 * parts >= 120
    assert shown.sum() == parts * basin.recovered.sum()
    round_, beside = figure.axes
    (mark,) = [line for line in round_.get_lines() if line.get_gid() == "smallest"]
    place = 1e3 * smallest.size * SCALES.velocity * np.exp(1j * smallest.angle)
    assert complex(mark.get_xdata()[0], mark.get_ydata()[0]) == pytest.approx(place)
    assert "(mm/s)" in round_.get_xlabel()
    assert beside.get_xlabel() == "size of the kick (mm/s)"
    assert any(text.startswith("levitation, ") for text in legend_words(figure))
    assert "smallest kick found that does not come back" in legend_words(figure)


def test_cells_are_where_their_start_is(rotor):
    basin = map_basins(rotor, Grid(KickPlane(1.0), (10, 14)))
    (mesh,) = [entry for entry in plots.basin(basin).axes[0].collections if isinstance(entry, QuadMesh)]
    x, y = basin.dataset["radial_speed_si"].values, basin.dataset["tangential_speed_si"].values
    corners = mesh.get_coordinates()
    middles = 0.25 * (corners[1:, 1:] + corners[1:, :-1] + corners[:-1, 1:] + corners[:-1, :-1])
    np.testing.assert_allclose(middles[0, :, 0], 1e3 * x)
    np.testing.assert_allclose(middles[:, 0, 1], 1e3 * y)
    np.testing.assert_array_equal(
        np.isclose(np.asarray(mesh.get_array()), 0.0), basin.recovered.T
    )  # the first in the order of outcomes is levitation


def test_a_grid_of_states_has_no_picture(rotor):
    with pytest.raises(InputError, match="sample"):
        plots.basin(map_basins(rotor, Grid(AnyState(1.0), (2, 2, 2, 2))))


def test_gain_map(rotor):
    plan = Grid(VelocityKick.of(MACHINE, "80 mm/s"), (8, 8))
    found = map_gains(MACHINE, plan, {"stiffness": (7e5, 1.6e6, 6), "damping": (200.0, 4000.0, 7)})
    figure = plots.gain_map(found)
    assert fits(figure)
    axes, bar = figure.axes
    assert axes.get_xlabel() == "P gain: stiffness of the levitation $k$ (N/m)"
    assert axes.get_ylabel() == "D gain: damping of the levitation $c$ (N s/m)"
    assert "come back" in bar.get_ylabel()
    figure.draw_without_rendering()
    assert bar.get_yticklabels()[-1].get_text() == "100 %"
    (star,) = [line for line in axes.get_lines() if line.get_gid() == "present"]
    assert (star.get_xdata()[0], star.get_ydata()[0]) == pytest.approx(found.present)
    said = legend_words(figure)
    assert any(text.startswith("present machine: ") for text in said)
    assert "no levitation" in said
    levitates = found.dataset["levitates"].values.T > 0.0
    shares = next(entry for entry in axes.collections if isinstance(entry, QuadMesh)).get_array()
    np.testing.assert_array_equal(np.ma.getmaskarray(shares), ~levitates)
    np.testing.assert_array_equal(shares[levitates], found.dataset["recovered"].values.T[levitates])
