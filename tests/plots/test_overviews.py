"""Everything in one picture."""

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
