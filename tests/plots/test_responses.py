"""The figure of the response over speed: what is drawn, and in which look."""

import math

import numpy as np
from drawn_legends import fits, legend_words

import carom as cm
from carom import plots
from carom.plots import levitation
from carom.studies import unbalance_response

RPM = math.pi / 30.0


def lines_in(axes, look):
    return [line for line in axes.lines if line.get_color() == look.colour and line.get_linestyle() == look.line]


def test_levitation_is_solid_only_where_it_is_possible():
    real = unbalance_response(cm.load("examples/keogh-cole.toml"), ("500 rpm", "4000 rpm"))
    figure = plots.unbalance_response(real)
    upper, lower = figure.axes
    for axes in (upper, lower):
        (free,) = [line for line in lines_in(axes, levitation._FREE) if len(line.get_xdata()) > 100]
        drawn = np.asarray(free.get_xdata())[np.isfinite(free.get_ydata())] * RPM
        np.testing.assert_allclose(drawn, real.speeds[real.amplitude <= 1.0], rtol=1e-15)
    (curve,) = [line for line in lines_in(upper, levitation._FREE) if len(line.get_xdata()) > 100]
    # In the diameter of the clearance, 1,400 um, up to the last speed at which the rotor levitates.
    assert 1390.0 < np.nanmax(curve.get_ydata()) <= 1400.0
    (rub,) = lines_in(lower, levitation._RUB)
    np.testing.assert_allclose(rub.get_ydata(), np.degrees(real.rubs.lags[0]))
    words = legend_words(figure)
    assert all(any(said in entry for entry in words) for said in ("rub, stable", "API 617", "critical speed"))
    assert fits(figure)
