"""Figures keep carom's style when a user writes or shows them, and their places."""

import gc
import io

import matplotlib as mpl
import matplotlib.image
import numpy as np
import pytest
from drawn_legends import fits
from machines import PAPER
from matplotlib.backends.backend_agg import FigureCanvasAgg

import carom
from carom import plots
from carom.plots.figure import StyledFigure
from carom.plots.style import styled

SETTINGS = {
    "font.size": 23.0,
    "mathtext.fontset": "cm",
    "xtick.major.size": 12.0,
    "svg.fonttype": "none",
    "savefig.dpi": 40,
    "savefig.facecolor": "red",
    "savefig.bbox": "tight",
    "figure.constrained_layout.use": True,
    "path.simplify_threshold": 1.0,
}


def written(figure, name):
    buffer = io.BytesIO()
    figure.savefig(buffer, format=name, metadata={"Software": None} if name == "png" else {"Date": None})
    return buffer.getvalue()


def shown_inline(figure):
    """What the inline backend of notebooks sends."""
    buffer = io.BytesIO()
    figure.canvas.print_figure(buffer, format="png", bbox_inches="tight", dpi="figure", facecolor="white")
    return buffer.getvalue()


@pytest.mark.parametrize(
    "write", [lambda figure: written(figure, "png"), lambda figure: written(figure, "svg"), shown_inline]
)
def test_settings_of_the_user_do_not_show_when_the_user_writes(damped, write):
    plain = write(plots.radius(damped.orbits["B1,d"]))
    figure = plots.radius(damped.orbits["B1,d"])
    with mpl.rc_context(SETTINGS):
        assert write(figure) == plain


def test_the_user_writes_what_carom_writes(damped, tmp_path):
    figure = plots.radius(damped.orbits["B1,d"])
    (path,) = plots.save(figure, tmp_path / "a", ("png",))
    assert np.array_equal(mpl.image.imread(io.BytesIO(written(figure, "png"))), mpl.image.imread(path))


def test_a_canvas_of_the_user_draws_the_same(damped):
    def pixels():
        canvas = FigureCanvasAgg(plots.multipliers(damped.orbits))
        canvas.draw()
        return bytes(canvas.buffer_rgba())

    plain = pixels()
    with mpl.rc_context(SETTINGS):
        assert pixels() == plain


@pytest.mark.parametrize("size", [(2.5, 2.5), (7.0, 3.0)])
def test_long_titles_and_legends_fit(size):
    """Titles are broken, legends lose columns; what has room stays as it is wanted."""
    with plots.heading("a machine with a long name for a small page: damping 1,400 N s/m, stiffness 980,000 N/m"):
        figure = _with_legend(size, "synchronous rub, saddle: normal force", 4)
    assert fits(figure)
    assert _columns(_with_legend(size, "rub", 2)) == 2
    short = _with_legend(size, "rub", 1)
    short.suptitle("a machine, and more")
    assert short.get_suptitle() == "a machine, and more"


@styled
def _with_legend(size, words, columns):
    figure = StyledFigure(figsize=size)
    axes = figure.subplots()
    for number in range(4):
        axes.plot([0.0, 1.0], label=f"{words} {number}")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=columns)
    return figure


def _columns(figure):
    figure.draw_without_rendering()
    return len({round(text.get_window_extent().x0) for text in figure.legends[0].get_texts()})


def test_figures_of_one_column(read):
    """Panels below each other, one or two columns of the legend, titles broken after commas."""
    motion = carom.simulate(PAPER, carom.kick(0.35), 20.0)
    wide = plots.motion(motion)
    with plots.one_column(), plots.heading("a machine: damping 1,400 N s/m, stiffness 980,000 N/m, speed 1,759 rpm"):
        narrow = plots.motion(motion, title="a motion")
    assert wide.get_size_inches()[0] == pytest.approx(plots.TWO_COLUMNS)
    assert narrow.get_size_inches()[0] == pytest.approx(plots.ONE_COLUMN)
    upper, lower = (axes.get_position() for axes in narrow.axes[:2])
    assert upper.y0 > lower.y1
    narrow.canvas.draw()
    renderer = narrow.canvas.get_renderer()
    box = narrow.legends[0].get_window_extent(renderer)
    assert box.x0 >= 0.0
    assert box.x1 <= narrow.bbox.x1
    assert plots.motion(motion).get_suptitle() == wide.get_suptitle()


def _places(figure):
    return [axes.get_position().extents.tolist() for axes in figure.axes]


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


def test_garbage_is_collected_after_drawing_as_before(damped, tmp_path):
    for wanted in (True, False):
        (gc.enable if wanted else gc.disable)()
        try:
            plots.save(plots.radius(damped.orbits["B1,d"]), tmp_path / "a", ("svg",))
            assert gc.isenabled() is wanted
        finally:
            gc.enable()
