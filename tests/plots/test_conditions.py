"""F1 over the period."""

from itertools import pairwise

import numpy as np
import pytest

import carom
from carom import plots


def _drawn(case, longest=None):
    periods = np.linspace(1e-3, longest or case.orbits.longest_period, 3000)
    return plots.period_condition(case.orbits, periods, carom.orbits.period_condition(case.rotor, periods))


def _names(axes):
    return [text.get_text().split("\n")[0] for text in axes.texts]


def test_roots_lie_on_the_zero_line_and_are_named(damped, read):
    (axes,) = _drawn(damped).axes
    (roots,) = read.lines(axes, "root")
    np.testing.assert_allclose(roots.get_xdata(), damped.ms * np.array(damped.orbits.periods))
    assert np.all(np.asarray(roots.get_ydata()) == 0.0)
    assert len(read.lines(axes, "zero")) == 1
    assert _names(axes) == [r"$B_{\mathrm{1,a/c}}$", r"$B_{\mathrm{1,b/d}}$"]
    (curve,) = read.lines(axes, "condition")
    crossings = np.flatnonzero(np.diff(np.sign(curve.get_ydata())))
    periods, drawn = damped.ms * np.array(damped.orbits.periods), curve.get_xdata()
    assert (drawn[crossings] <= periods).all()
    assert (periods <= drawn[crossings + 1]).all()


def test_roots_with_virtual_orbits_only_are_hollow(weak, read):
    figure = _drawn(weak)
    (axes,) = figure.axes
    filled, hollow = read.lines(axes, "root")
    assert filled.get_xdata() == pytest.approx([weak.ms * weak.orbits["B1,c"].period])
    assert hollow.get_markerfacecolor() == "white"
    assert len(hollow.get_xdata()) == 3
    assert _names(axes) == [r"$B_{\mathrm{1,c}}$"], "virtual orbits are not named"
    assert "root with virtual orbits only" in read.legend(figure)


def test_bound_is_marked(damped, read):
    figure = _drawn(damped)
    (bound,) = [patch for patch in figure.axes[0].patches if patch.get_gid() == "bound"]
    assert bound.get_x() == pytest.approx(damped.ms * damped.orbits.longest_period)
    assert any(words == r"no root beyond $T_\mathrm{max}$ = 140 ms" for words in read.legend(figure))
    (axes,) = _drawn(damped, longest=5.0).axes
    assert axes.get_xlim()[1] < damped.ms * damped.orbits.longest_period


def test_no_claim_beyond_an_unfinished_search(damped, read):
    orbits = carom.find_orbits(damped.rotor, longest_period=5.0)
    periods = np.linspace(1e-3, 5.0, 500)
    figure = plots.period_condition(orbits, periods, carom.orbits.period_condition(damped.rotor, periods))
    words = read.legend(figure)
    assert any(text.startswith("not searched beyond") for text in words)
    assert not any(text.startswith("no root") for text in words)


def test_no_roots(quiet, read):
    figure = _drawn(quiet)
    assert read.lines(figure.axes[0], "root") == []
    assert "no root: no orbit with one impact a period" in read.legend(figure)


def test_names_do_not_overlap(damped, read):
    boxes = read.boxes(_drawn(damped).axes[0])
    assert len(boxes) == 2
    for left, right in pairwise(boxes):
        assert left.x1 < right.x0
