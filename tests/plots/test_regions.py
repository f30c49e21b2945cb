"""Maps of a plane: what is drawn, under which words and numbers."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_legends import fits, legend_words
from machines import PAPER

from carom import plots
from carom.bifurcations import UnexplainedChange, motions_at
from carom.bifurcations.documents import regions_document


@pytest.fixture(scope="module")
def figure(corner):
    return plots.region_map(corner)


def test_words_of_the_legend(corner, figure):
    words = legend_words(figure)
    for expected in (
        "grazing: B1,d, B2,b, B3,b",
        "period doubling: B1,d",
        "Neimark–Sacker bifurcation: B1,d",
        "two at once",
        "resonance of the multipliers",
        f"the machine as it is: region {corner.present_region}",
    ):
        assert expected in words


def test_no_curve_leaves_the_plane(corner):
    """The machine lies on an edge: a curve of grazing passes through the edge beside it."""
    points = np.concatenate([curve.points for curve in corner.curves])
    lows, highs = np.transpose([corner.plane.first_range, corner.plane.second_range])
    assert points[:, 0].max() == pytest.approx(highs[0], abs=1e-12)
    assert (points >= lows - 1e-12).all()
    assert (points <= highs + 1e-12).all()


def test_figure_and_document_number_the_same_regions(corner, figure):
    (axes,) = figure.axes
    document = regions_document(PAPER, corner)
    listed = [word.split(": ")[0] for word in legend_words(figure) if word[0].isdigit()]
    numerals = sorted(int(text.get_text()) for text in axes.texts if text.get_gid() == "numeral")
    numbers = [region["number"] for region in document["regions"]]
    assert numbers == list(range(1, len(numbers) + 1)) == numerals
    assert listed == [str(number) for number in numbers]
    present = document["present"]
    assert present["point"] == [PAPER.gamma, PAPER.omega]
    assert document["regions"][present["region"] - 1]["words"] == present["words"] == motions_at(PAPER).words
    assert axes.get_xlim() == pytest.approx(corner.plane.first_range)
    drawn = np.concatenate([line.get_xdata() for line in axes.lines])
    assert np.abs(drawn - 0.077432506).min() < 1e-8


def test_resonances_the_machine_and_changes_without_a_curve_are_marked(corner):
    change = UnexplainedChange((0.05, 0.5), motions_at(PAPER), motions_at(PAPER.replace(gamma=0.2)), "for this test")
    marked = type(corner)(**{**vars(corner), "unexplained": (change,)})
    figure = plots.region_map(marked)
    (axes,) = figure.axes
    places = {line.get_gid(): (line.get_xdata()[0], line.get_ydata()[0]) for line in axes.lines if line.get_gid()}
    assert places[f"the machine as it is: region {corner.present_region}"] == (PAPER.gamma, PAPER.omega)
    assert places["change of motions on no curve found"] == (0.05, 0.5)
    ratios = {text.get_text() for text in axes.texts if text.get_gid() == "resonance"}
    assert ratios == {"1:2", "1:3"}
    assert regions_document(PAPER, marked)["unexplained"][0]["point"] == [0.05, 0.5]


def test_legends_and_title_fit(corner, figure):
    assert fits(figure)
    with plots.heading("keogh-cole: damping 1,400 N s/m, stiffness 980,000 N/m, speed 1,759 rpm"):
        assert fits(plots.region_map(corner))
