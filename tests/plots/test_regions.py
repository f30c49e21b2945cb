"""Maps of a plane: what is drawn, under which words and numbers."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_legends import fits, legend_words
from machines import PAPER

import carom
from carom import plots
from carom.bifurcations import UnexplainedChange, motions_at
from carom.bifurcations.documents import regions_document
from carom.parameters import Scales
from carom.plots.diagrams import FAINT

SCALES = Scales(50.0, 0.7e-3, 184.2)


@pytest.fixture(scope="module")
def figure(corner):
    return plots.region_map(corner)


def test_words_of_the_legend(corner, figure):
    words = legend_words(figure)
    for expected in (
        r"grazing: $B_{\mathrm{1,d}}$, $B_{\mathrm{2,b}}$, $B_{\mathrm{3,b}}$",
        r"period doubling: $B_{\mathrm{1,d}}$",
        r"Neimark–Sacker bifurcation: $B_{\mathrm{1,d}}$",
        "two at once",
        "resonance of the multipliers",
        "the machine as it is",
    ):
        assert expected in words


def test_no_curve_leaves_the_plane(corner):
    """The machine lies on an edge: a curve of grazing passes through the edge beside it."""
    points = np.concatenate([curve.points for curve in corner.curves])
    lows, highs = np.transpose([corner.plane.first_range, corner.plane.second_range])
    assert points[:, 0].max() == pytest.approx(highs[0], abs=1e-12)
    assert (points >= lows - 1e-12).all()
    assert (points <= highs + 1e-12).all()


def test_each_region_has_its_number_in_the_document(corner, figure):
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


def test_axes_of_a_machine_are_in_its_units(corner):
    known = type(corner)(**{**vars(corner), "model": carom.models.jeffcott(PAPER.replace(scales=SCALES))})
    (axes,) = plots.region_map(known).axes
    below, left = axes.child_axes
    assert (below.get_xlabel(), left.get_ylabel()) == (
        "damping of the levitation $c$ (N s/m)",
        "stiffness of the levitation $k$ (N/m)",
    )
    assert below.get_xlim() == pytest.approx(np.array(axes.get_xlim()) * SCALES.damping)
    assert left.get_ylim() == pytest.approx(np.array(axes.get_ylim()) ** 2 * SCALES.stiffness)
    assert axes.get_xaxis().get_label_position() == "top"
    assert "1,000,000" in [text.get_text() for text in left.get_yticklabels()], (
        "a power of ten would overlap the top axis"
    )
    assert fits(plots.region_map(known))


def test_curves_of_virtual_motions_are_hidden_unless_asked_for(corner, figure):
    virtual = np.concatenate([curve.points[~curve.admissible] for curve in corner.curves])
    assert len(virtual)

    def faint(drawn):
        return [line for line in drawn.axes[0].lines if line.get_alpha() == FAINT]

    asked = plots.region_map(corner, virtual=True)
    assert faint(figure) == []
    assert faint(asked)
    assert "faint: virtual motions only" in set(legend_words(asked)) - set(legend_words(figure))


def test_resonances_the_machine_and_changes_without_a_curve_are_marked(corner):
    change = UnexplainedChange((0.05, 0.5), motions_at(PAPER), motions_at(PAPER.replace(gamma=0.2)), "for this test")
    marked = type(corner)(**{**vars(corner), "unexplained": (change,)})
    figure = plots.region_map(marked, virtual=True)
    (axes,) = figure.axes
    places = {line.get_gid(): (line.get_xdata()[0], line.get_ydata()[0]) for line in axes.lines if line.get_gid()}
    assert places["the machine as it is"] == (PAPER.gamma, PAPER.omega)
    assert places["change of motions on no curve found"] == (0.05, 0.5)
    ratios = {text.get_text() for text in axes.texts if text.get_gid() == "resonance"}
    assert ratios == {"1:2", "1:3"}
    assert regions_document(marked)["unexplained"][0]["point"] == [0.05, 0.5]


def test_legends_and_title_fit(corner, figure):
    assert fits(figure)
    with plots.heading("keogh-cole: damping 1,400 N s/m, stiffness 980,000 N/m, speed 1,759 rpm"):
        assert fits(plots.region_map(corner))
