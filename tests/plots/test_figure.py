"""Figures keep carom's style when a user writes or shows them, and their places."""

import gc
import io

import matplotlib as mpl
import matplotlib.image
import pytest
from drawn_legends import fits

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
    plain = write(plots.radius(damped.orbits["B1,d"].trajectory(3)))
    figure = plots.radius(damped.orbits["B1,d"].trajectory(3))
    with mpl.rc_context(SETTINGS):
        assert write(figure) == plain


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


def test_garbage_is_collected_after_drawing_as_before(damped, tmp_path):
    for wanted in (True, False):
        (gc.enable if wanted else gc.disable)()
        try:
            plots.save(plots.radius(damped.orbits["B1,d"].trajectory(3)), tmp_path / "a", ("svg",))
            assert gc.isenabled() is wanted
        finally:
            gc.enable()


@pytest.mark.parametrize("size", [(7.1, 3.0), (3.5, 4.0), (7.1, 5.7)])
def test_slides_are_wide_with_large_type(size):
    @styled
    def draw():
        figure = StyledFigure(figsize=size)
        axes = figure.subplots()
        axes.plot([0.0, 1.0], label="path")
        figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center")
        return figure

    page = draw()
    with plots.figures_for("slide"):
        slide = draw()
    assert tuple(page.get_size_inches()) == size
    assert slide.get_figwidth() / slide.get_figheight() == pytest.approx(16 / 9)
    assert slide.axes[0].xaxis.label.get_size() > page.axes[0].xaxis.label.get_size()
    assert fits(slide)
    pixels = matplotlib.image.imread(io.BytesIO(written(slide, "png"))).shape
    assert pixels[:2] in ((1080, 1920), (1620, 2880))
