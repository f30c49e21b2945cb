"""Everything in one picture, and multipliers next to the unit circle."""

import numpy as np

from carom import plots


def test_every_equilibrium_is_at_its_place(damped, read):
    figure = plots.equilibria_and_orbits(damped.orbits, damped.equilibria)
    whole = figure.axes[0]
    for kind in ("contact-free", "rub"):
        drawn = [complex(line.get_xdata()[0], line.get_ydata()[0]) for line in read.lines(whole, kind)]
        wanted = [damped.mm * point.position for point in damped.equilibria if point.kind == kind]
        np.testing.assert_allclose(sorted(drawn, key=abs), sorted(wanted, key=abs))
    saddle, stable = sorted(read.lines(whole, "rub"), key=lambda line: line.get_xdata()[0])
    assert saddle.get_markerfacecolor() == "white"
    assert stable.get_markerfacecolor() == plots.LOOKS["rub"].colour


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
