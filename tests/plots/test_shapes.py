"""Shapes of free whirls along the shaft: what is drawn where."""

import numpy as np
import pytest
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
