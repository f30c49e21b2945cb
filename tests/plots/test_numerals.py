"""Numerals of regions: none lies on a curve, and slivers have theirs beside, with a leader into them."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure

from carom.plots.numerals import name_regions


def line(*points):
    return SimpleNamespace(points=np.array(points, dtype=float), admissible=np.ones(len(points), bool))


def region(*places):
    return SimpleNamespace(point=places[0], places=np.array(places, dtype=float))


def numbered(found, names=None):
    """Axes with the names of a plane over the unit square, 100 x 100 points large; by default numerals only."""
    figure = Figure(figsize=(100 / 72, 100 / 72), dpi=144)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(0, 1), ylim=(0, 1))
    for curve in found.curves:
        axes.plot(*curve.points.T)
    every = range(1, len(found.regions) + 1)
    axes.without = name_regions(axes, found, np.ones(2), names or [""] * len(every), () if names else every)
    figure.draw_without_rendering()
    return axes


def boxes(axes):
    """Extent of each written numeral in units of the axes."""
    extents = {text.get_text(): super(type(text), text).get_window_extent() for text in axes.texts}
    inverse = axes.transData.inverted()
    return {name: inverse.transform(box.get_points()) for name, box in extents.items()}


def feet(axes):
    return [tuple(mark.get_xydata()[0]) for mark in axes.lines if mark.get_gid() == "foot"]


def plane(*regions, curves=(), meetings=(), present=None):
    points = tuple(SimpleNamespace(value=value) for value in meetings)
    return SimpleNamespace(curves=tuple(curves), codimension2=points, regions=regions, unexplained=(), present=present)


def test_a_region_with_room_has_its_numeral_at_its_point():
    axes = numbered(plane(region((0.5, 0.75)), curves=[line((0, 0.5), (1, 0.5))]))
    assert boxes(axes)["1"].mean(axis=0) == pytest.approx([0.5, 0.75], abs=0.02)
    assert not feet(axes)


def test_a_roomier_grid_point_is_taken():
    axes = numbered(plane(region((0.5, 0.55), (0.5, 0.8)), curves=[line((0, 0.5), (1, 0.5))]))
    assert boxes(axes)["1"].mean(axis=0) == pytest.approx([0.5, 0.8], abs=0.02)


def test_a_numeral_moves_away_from_a_curve_within_its_region():
    axes = numbered(plane(region((0.5, 0.53)), curves=[line((0, 0.5), (1, 0.5))]))
    low, high = boxes(axes)["1"]
    assert low[1] > 0.5
    assert high[1] < 0.75
    assert not feet(axes)


@pytest.mark.parametrize("middle", [0.04, 0.5, 0.96])
def test_a_sliver_has_its_numeral_beside_with_a_leader(middle):
    curves = [line((0, middle + shift), (1, middle + shift)) for shift in (-0.03, 0.03)]
    axes = numbered(plane(region((0.5, 0.25)), region((0.5, middle)), curves=curves))
    low, high = boxes(axes)["2"]
    for curve in curves:
        height = curve.points[0, 1]
        assert not low[1] <= height <= high[1]
    assert (low > 0).all()
    assert (high < 1).all()
    assert feet(axes) == [(0.5, middle)]
    first = boxes(axes)["1"]
    assert (high < first[0]).any() or (first[1] < low).any()


@pytest.mark.parametrize("marked", [{"meetings": [(0.5, 0.5)]}, {"present": (0.5, 0.5)}])
def test_numerals_keep_clear_of_points_where_curves_meet_and_of_the_machine(marked):
    axes = numbered(plane(region((0.5, 0.5)), **marked))
    low, high = boxes(axes)["1"]
    assert not ((low <= 0.5) & (high >= 0.5)).all()


def test_a_region_with_room_has_its_name_and_a_thin_one_its_numeral():
    curves = [line((0, height), (1, height)) for height in (0.5, 0.56)]
    found = plane(region((0.5, 0.25)), region((0.5, 0.53)), curves=curves)
    axes = numbered(found, ["levitation\nsynchronous rub", "levitation"])
    written = boxes(axes)
    assert set(written) == {"levitation\nsynchronous rub", "2"}
    assert axes.without == {2}
    low, high = written["levitation\nsynchronous rub"]
    assert 0 < low[1] < high[1] < 0.5
    assert 0 < low[0] < high[0] < 1


def test_a_name_is_one_line_where_its_region_is_low():
    found = plane(region((0.5, 0.08)), curves=[line((0, 0.16), (1, 0.16))])
    assert set(boxes(numbered(found, ["rest\nrub"]))) == {"rest, rub"}


def test_a_virtual_curve_that_is_hidden_takes_no_room():
    hidden = line((0, 0.5), (1, 0.5))
    hidden.admissible[:] = False
    assert set(boxes(numbered(plane(region((0.5, 0.5)), curves=[hidden]), ["levitation"]))) == {"levitation"}
