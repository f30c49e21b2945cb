"""Figures keep their places, and are drawn no more often than they are written."""

import gc
import io

import matplotlib as mpl
import matplotlib.image
import pytest
from matplotlib.figure import Figure

import carom
from carom import plots


@pytest.fixture
def drawings(monkeypatch):
    """Figures drawn, one entry for each time."""
    drawn, draw = [], Figure.draw

    def counted(figure, renderer):
        drawn.append(figure)
        return draw(figure, renderer)

    monkeypatch.setattr(Figure, "draw", counted)
    return drawn


def _places(figure):
    return [axes.get_position().extents.tolist() for axes in figure.axes]


def test_a_figure_is_drawn_once_for_each_file(damped, drawings, tmp_path):
    figure = plots.radius(damped.orbits["B1,d"])
    assert drawings == []
    plots.save(figure, tmp_path / "a", ("svg", "png", "pdf"))
    assert drawings == [figure] * 3


@pytest.mark.parametrize("settings", [{}, {"figure.constrained_layout.use": True}, {"figure.autolayout": True}])
def test_nothing_moves_when_carom_or_the_user_writes_a_figure(damped, tmp_path, settings):
    with mpl.rc_context(settings):
        for figure in (plots.radius(damped.orbits["B1,d"]), plots.orbit(damped.orbits["B1,b"])):
            before, ticks = _places(figure), _count_ticks(figure)
            plots.save(figure, tmp_path / "a", ("svg",))
            for _ in range(2):
                figure.savefig(io.BytesIO(), format="png")
            assert _places(figure) == before
            assert _count_ticks(figure) == ticks


def _count_ticks(figure):
    return [
        len(ticks)
        for axes in figure.axes
        for axis in (axes.xaxis, axes.yaxis)
        for ticks in (axis.majorTicks, axis.minorTicks)
    ]


def test_words_at_the_left_edge_are_whole_at_any_resolution():
    figure = carom.find_attractors(carom.load("examples/keogh-cole.toml"), count=2).plot()
    assert "rolling backward whirl" in {label.get_text() for label in figure.axes[0].get_yticklabels()}
    for dpi in (72, 100, 110, 150):
        picture = io.BytesIO()
        figure.savefig(picture, format="png", dpi=dpi)
        picture.seek(0)
        assert (mpl.image.imread(picture)[:, :2] == 1.0).all(), dpi


def test_a_figure_of_the_user_keeps_its_layout(damped, tmp_path):
    figure = Figure(layout="constrained")
    axes = figure.subplots()
    plots.radius(damped.orbits["B1,d"], axes=axes)
    engine = figure.get_layout_engine()
    plots.save(figure, tmp_path / "a", ("svg",))
    assert figure.get_layout_engine() is engine


def test_legends_titles_and_labels_are_within_the_page(damped):
    figure = plots.equilibria_and_orbits(damped.orbits, damped.equilibria, title="All motions")
    page = figure.bbox.extents
    for box in (figure.legends[0].get_window_extent(), *(axes.get_tightbbox() for axes in figure.axes)):
        assert (box.extents[:2] >= page[:2]).all()
        assert (box.extents[2:] <= page[2:]).all()


def test_numbers_at_second_axes_are_plain_text(damped):
    figure = plots.radius(damped.orbits["B1,a"])
    labels = [
        text.get_text()
        for axes in figure.axes[0].child_axes
        for axis in (axes.xaxis, axes.yaxis)
        for text in axis.get_ticklabels()
    ]
    assert labels
    assert not any("$" in text for text in labels)


def test_garbage_is_collected_after_drawing_as_before(damped, tmp_path):
    for wanted in (True, False):
        (gc.enable if wanted else gc.disable)()
        try:
            plots.save(plots.radius(damped.orbits["B1,d"]), tmp_path / "a", ("svg",))
            assert gc.isenabled() is wanted
        finally:
            gc.enable()
