"""Maps of a plane: what is drawn, under which words and numbers."""

import numpy as np
import pytest
from drawn_legends import legend_words
from machines import PAPER

from carom import plots
from carom.bifurcations import motions_at
from carom.bifurcations.documents import regions_document


def test_no_curve_leaves_the_plane(corner):
    """The machine lies on an edge: a curve of grazing passes through the edge beside it."""
    points = np.concatenate([curve.points for curve in corner.curves])
    lows, highs = np.transpose([corner.plane.first_range, corner.plane.second_range])
    assert points[:, 0].max() == pytest.approx(highs[0], abs=1e-12)
    assert (points >= lows - 1e-12).all()
    assert (points <= highs + 1e-12).all()


def test_each_region_has_its_number_in_the_document(corner):
    figure = plots.region_map(corner)
    (axes,) = figure.axes
    document = regions_document(corner)
    numerals = [int(text.get_text()) for text in axes.texts if text.get_gid() == "numeral"]
    listed = [word for word in legend_words(figure) if word[0].isdigit()]
    assert [int(word.split(": ")[0]) for word in listed] == numerals == list(range(1, len(document["regions"]) + 1))
    for word in listed:
        assert "stable synchronous rub" not in word
        assert "no " not in word
    present = document["present"]
    assert present["point"] == [PAPER.gamma, PAPER.omega]
    assert document["regions"][present["region"] - 1]["words"] == present["words"] == motions_at(PAPER).words
    assert axes.get_xlim() == pytest.approx(corner.plane.first_range)
    drawn = np.concatenate([line.get_xdata() for line in axes.lines])
    assert np.abs(drawn - 0.077432506).min() < 1e-8
