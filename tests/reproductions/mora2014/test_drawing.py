"""Figures of the source paper: what is drawn, in which look, under which words, and that nothing lies on anything."""

from __future__ import annotations

import numpy as np
import pytest

from carom.plots.diagrams import CURVES, POINTS
from carom.plots.style import LOOKS, TWO_COLUMNS
from carom.reproductions import mora2014


@pytest.fixture(scope="module")
def drawn():
    found = mora2014.reproduce()
    return found, {picture.name: (picture, picture.draw()) for picture in mora2014.figures(found)}


def words_of(figure):
    legends = [*figure.legends, *(legend for part in figure.subfigs for legend in part.legends)]
    return [text.get_text() for legend in legends for text in legend.get_texts()]


def lettered(figure):
    return "".join(
        axes.get_title(loc="left").split("(")[1][0]
        for axes in figure.axes
        if axes.get_title(loc="left").startswith("$")
    )


def test_panels_size_and_labels(drawn):
    _, figures = drawn
    for picture, figure in figures.values():
        assert figure.get_size_inches()[0] == pytest.approx(TWO_COLUMNS)
        assert "".join(sorted(lettered(figure))) == picture.panels
        assert words_of(figure)
        assert picture.caption.startswith(("(", "Periodic", "Radial", "Local"))
        for axes in figure.axes:
            if axes.get_title(loc="left"):
                assert axes.get_xlabel()
                assert axes.get_ylabel()


def test_orbits_of_figure_2_strike_the_circle_that_is_drawn(drawn):
    _, figures = drawn
    axes = figures["figure-2"][1].axes[:9]
    for fixed, rotating, radius in (axes[3:6], axes[6:9]):
        for frame in (fixed, rotating):
            struck = [line.get_xydata() for line in frame.lines if line.get_gid() in ("forward", "backward")]
            assert struck
            np.testing.assert_allclose(np.hypot(*np.concatenate(struck).T), 1.0, rtol=1e-9)
        assert max(line.get_ydata().max() for line in radius.lines if len(line.get_xdata()) > 100) == pytest.approx(1.0)


def test_legends_lie_outside_of_the_data(drawn):
    _, figures = drawn
    for _, figure in figures.values():
        legends = [*figure.legends, *(legend for part in figure.subfigs for legend in part.legends)]
        boxes = [legend.get_window_extent() for legend in legends]
        frames = [axes.get_window_extent() for axes in figure.axes]
        assert not any(box.overlaps(frame) for box in boxes for frame in frames)
        assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])
        page = figure.bbox
        assert all(box.x0 >= page.x0 - 1 and box.x1 <= page.x1 + 1 and box.y0 >= page.y0 - 1 for box in boxes)


def test_names_do_not_lie_on_each_other_or_on_lines(drawn):
    _, figures = drawn
    for _, figure in figures.values():
        for axes in figure.axes:
            names = [text for text in axes.texts if text.get_gid() == "name" and text.get_text()]
            boxes = [text.get_window_extent() for text in names]
            assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])
            for line in axes.lines:
                path = line.get_path().interpolated(4).transformed(line.get_transform())
                for text, box in zip(names, boxes, strict=True):
                    inside = (path.vertices >= box.min).all(axis=1) & (path.vertices <= box.max).all(axis=1)
                    assert not inside.any(), (text.get_text(), axes.get_title(loc="left"))


def test_levitation_and_orbits_of_figure_2(drawn):
    found, figures = drawn
    figure = figures["figure-2"][1]
    fixed, rotating, radius = figure.axes[:3]
    (circle,) = [line for line in fixed.lines if line.get_color() == LOOKS["contact-free"].colour]
    np.testing.assert_allclose(np.hypot(*circle.get_data()), found.motions[0].highest, rtol=1e-12)
    (place,) = [line for line in rotating.lines if line.get_gid() == "contact-free"]
    assert complex(*[value[0] for value in place.get_data()]) == found.motions[0].rotor.equilibrium
    assert "time" in radius.get_xlabel()
    words = words_of(figure)
    for expected in (
        "levitation",
        "impact, backward whirl",
        "impact, forward whirl",
        "orbit, admissible, unstable",
    ):
        assert expected in words


def test_zeros_of_figure_3(drawn):
    found, figures = drawn
    condition, zeros = figures["figure-3"][1].axes[:2]
    points = [line for line in condition.lines if line.get_marker() == "o"]
    for line, function in zip(points, found.periods.functions, strict=True):
        np.testing.assert_allclose(line.get_xdata(), function.roots[function.roots < 30.0])
    folds = [line for line in zeros.lines if line.get_marker() == POINTS["fold"].marker]
    assert len(folds) == len(found.periods.pairs) >= 5


def test_figure_4_has_the_local_theory_over_the_exact_branches(drawn):
    found, figures = drawn
    figure = figures["figure-4"][1]
    for axes, slopes in (
        (figure.axes[1], [cycle.radial_slope for cycle in found.pair.hopf.cycles]),
        (figure.axes[3], [cycle.angular_slope for cycle in found.pair.hopf.cycles]),
    ):
        straight = [line for line in axes.lines if line.get_linewidth() == 1.3]
        drawn_slopes = [np.ptp(line.get_ydata()) / np.ptp(line.get_xdata()) for line in straight]
        assert drawn_slopes == pytest.approx(np.abs(slopes), rel=1e-9)
    looks = {line.get_color() for line in figure.axes[0].lines}
    assert {LOOKS["stable"].colour, LOOKS["unstable"].colour, LOOKS["virtual"].colour} <= looks
    assert {"local theory", "period doubling", "grazing", "non-smooth Hopf bifurcation"} <= set(words_of(figure))


def test_stable_part_of_figure_6(drawn):
    found, figures = drawn
    stability, plane = figures["figure-6"][1].axes
    stable = [
        line for line in stability.lines if line.get_color() == LOOKS["stable"].colour and len(line.get_xdata()) > 1
    ]
    gammas = np.concatenate([line.get_xdata() for line in stable])
    assert [gammas.min(), gammas.max()] == pytest.approx([0.0833814175, 0.1780277257], abs=1e-9)
    assert all((line.get_ydata() <= 1.0 + 1e-9).all() for line in stable)
    names = {text.get_text(): text for text in plane.texts}
    assert set(names) == {region.part for region in found.plane.regions}
    for kind in ("fold", "grazing", "period-doubling", "rub-fold"):
        (line,) = [
            line for line in plane.lines if line.get_color() == CURVES[kind].colour and len(line.get_xdata()) > 2
        ]
        np.testing.assert_array_equal(np.stack(line.get_data(), axis=1), found.plane.curve(kind).points)
    listed = words_of(figures["figure-6"][1])
    assert all(any(word.startswith(f"{region.part}:") for word in listed) for region in found.plane.regions)
