"""Basins side by side share axes, legend and colours."""

import numpy as np
import pytest
from drawn_legends import fits, legend_words
from machines import PAPER, SCALES
from matplotlib.collections import QuadMesh
from matplotlib.colors import to_rgb

from carom import Grid, map_basins, plots
from carom.disturbances import KickPlane

pytestmark = pytest.mark.jit_only

MACHINE = PAPER.replace(gamma=0.15, rho=0.3, scales=SCALES)
DAMPED = MACHINE.replace(gamma=0.4)


def painted(axes):
    """Colours of the cells, in the order of the second coordinate, then of the first."""
    (mesh,) = [entry for entry in axes.collections if isinstance(entry, QuadMesh)]
    mesh.update_scalarmappable()
    return mesh.get_facecolors().reshape(-1, 4)


def test_both_have_the_same_range_and_colours():
    after = map_basins(DAMPED, Grid(KickPlane(1.0), (24, 24)))
    before = map_basins(MACHINE, Grid(KickPlane(1.0), (24, 24)))
    figure = plots.basin_pair([("now", before), ("then", after)], 0.8)
    now, then = figure.axes
    assert now.get_xlim() == then.get_xlim() == now.get_ylim()
    assert now.get_xlim()[1] == pytest.approx(1.04 * 1e3 * MACHINE.scales.velocity)
    green = to_rgb(plots.OUTCOMES["levitated"].colour)
    for axes, basin in ((now, before), (then, after)):
        exists, back = basin.exists.T.ravel(), basin.recovered.T.ravel()
        assert back.sum() > 0
        same = np.all(np.isclose(painted(axes)[:, :3], green), axis=1)
        assert np.array_equal(same[exists], back[exists])
    assert not before.recovered[before.exists].all()
    assert {"levitation", "must survive: up to 103 mm/s"} <= set(legend_words(figure))
    assert len(legend_words(figure)) == len(set(before.motions) | set(after.motions)) + 1
    assert (now.get_xlabel(), now.get_ylabel()) == ("kick outward (mm/s)", "kick in the sense of rotation (mm/s)")
    assert then.get_ylabel() == ""
    for axes in figure.axes:
        (ring,) = [line for line in axes.get_lines() if line.get_gid() == "circle"]
        assert np.hypot(*ring.get_data()) == pytest.approx(0.8e3 * MACHINE.scales.velocity)
    assert fits(figure)
