"""Multipliers next to the unit circle."""

import numpy as np

from carom import plots


def _values(axes, name):
    (line,) = [line for line in axes.get_lines() if line.get_gid() == name]
    return np.sort_complex(np.asarray(line.get_xdata()) + 1j * np.asarray(line.get_ydata())), line


def test_multipliers_are_drawn_as_they_are(damped):
    orbit = damped.orbits["B1,d"]
    (axes,) = plots.multipliers([orbit]).axes
    values, _ = _values(axes, "B1,d")
    np.testing.assert_allclose(values, np.sort_complex(orbit.multipliers.values))
    (circle,) = [line for line in axes.get_lines() if line.get_gid() == "unit-circle"]
    np.testing.assert_allclose(np.hypot(*circle.get_data()), 1.0)
    assert axes.get_aspect() == 1.0
    assert axes.get_xlabel() == r"Re $\lambda$ (no unit)"
    (axes,) = plots.multipliers(damped.orbits).axes
    for each in damped.orbits:
        np.testing.assert_allclose(_values(axes, each.name)[0], np.sort_complex(each.multipliers.values))
    assert (axes.get_xscale(), axes.get_xlabel()) == ("symlog", r"Re $\lambda$ (no unit; logarithmic beyond 1)")
