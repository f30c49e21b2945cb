"""Diagrams of bifurcations: what is drawn, in which look, and under which words."""

import numpy as np
import pytest
from drawn_legends import legend_words
from machines import PAPER

from carom import bifurcations, plots
from carom.plots.style import LOOKS


def test_looks_change_at_the_special_points():
    found = bifurcations.find_bifurcations(PAPER, "gamma", (0.03, 0.4))
    figure = plots.bifurcation_diagram(found)
    upper, lower = figure.axes
    stable = [line for line in upper.lines if line.get_color() == LOOKS["stable"].colour and len(line.get_xdata()) > 2]
    ends = sorted(end for line in stable for end in (line.get_xdata()[0], line.get_xdata()[-1]))
    assert ends == pytest.approx([0.0833814175, 0.1780277257], abs=1e-9)
    assert all(line.get_linestyle() == "-" for line in stable)
    words = legend_words(figure)
    assert {"stable orbit", "period doubling", "fold of synchronous rubs"} <= set(words)
    assert "Neimark–Sacker bifurcation" not in words
    assert "virtual" not in words
    assert lower.get_xlabel() == r"scaled damping $\gamma$"
    assert lower.get_xlim() == pytest.approx((0.03, 0.4))


@pytest.mark.jit_only
def test_bars_say_what_exists_where():
    found = bifurcations.find_bifurcations(PAPER, "gamma", (0.03, 0.4))
    below = plots.bifurcation_diagram(found).axes[-1]
    rows = {text.get_text(): height for text, height in zip(below.get_yticklabels(), below.get_yticks(), strict=True)}
    assert list(rows)[:3] == ["levitation", "synchronous rub", "bouncing"]
    assert "rolling backward whirl" in rows

    def bars(row, width):
        return sorted(
            tuple(line.get_xdata())
            for line in below.lines
            if line.get_linewidth() == pytest.approx(width) and line.get_ydata()[0] == rows[row]
        )

    assert np.ravel(bars("levitation", 4.5)) == pytest.approx([0.0724686787, 0.4], abs=1e-9)
    assert np.ravel(bars("synchronous rub", 4.5)) == pytest.approx([0.03, 0.3700060375], abs=1e-9)
    assert np.ravel(bars("bouncing", 4.5)) == pytest.approx([0.0833814175, 0.1780277257], abs=1e-9)
    assert np.ravel(bars("rolling backward whirl", 4.5)) == pytest.approx([0.03, 0.4])
