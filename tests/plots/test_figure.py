"""Figures keep carom's style when a user writes or shows them, and measure and parse no more than they need."""

import io

import matplotlib as mpl
import pytest
from drawn_legends import fits
from machines import PAPER
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.mathtext import MathTextParser
from matplotlib.textpath import TextToPath

import carom
from carom import plots
from carom.plots import arrangement
from carom.plots import figure as figure_module
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
    assert written(figure, "png") == path.read_bytes()


def test_wishes_of_the_user_are_kept(damped):
    figure = plots.radius(damped.orbits["B1,d"])
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=50)
    wide = int.from_bytes(buffer.getvalue()[16:20], "big")
    assert wide == pytest.approx(50 * plots.TWO_COLUMNS, abs=1.0)  # whole pixels


def test_notebooks_show_a_figure(damped):
    picture = plots.radius(damped.orbits["B1,d"])._repr_png_()
    assert picture.startswith(b"\x89PNG")
    assert int.from_bytes(picture[16:20], "big") == pytest.approx(150 * plots.TWO_COLUMNS, abs=1.0)  # whole pixels


def test_a_canvas_of_the_user_draws_the_same(damped):
    def pixels():
        canvas = FigureCanvasAgg(plots.multipliers(damped.orbits))
        canvas.draw()
        return bytes(canvas.buffer_rgba())

    plain = pixels()
    with mpl.rc_context(SETTINGS):
        assert pixels() == plain


def test_each_axes_is_measured_once(damped, monkeypatch):
    measured, measure = [], Axes.get_tightbbox
    monkeypatch.setattr(Axes, "get_tightbbox", lambda axes, *a, **k: (measured.append(axes), measure(axes, *a, **k))[1])
    figure = plots.orbit(damped.orbits["B1,d"])
    assert set(measured) == set(figure.axes)
    assert len(measured) == len(set(measured))


def test_each_formula_is_parsed_once(damped, monkeypatch, tmp_path):
    parsed, parse = [], MathTextParser.parse

    def counted(parser, text, dpi=72, prop=None, **options):
        parsed.append((text, None if prop is None else hash(prop)))
        return parse(parser, text, dpi, prop, **options)

    monkeypatch.setattr(MathTextParser, "parse", counted)
    for periods in (2, 3, 2):
        plots.save(plots.radius(damped.orbits["B1,c"], periods=periods), tmp_path / "a", ("svg",))
    assert len(parsed) == len(set(parsed))


def test_texts_are_those_that_matplotlib_writes(damped, monkeypatch):
    """The same file, byte for byte, without anything kept from one text to the next."""

    def figures():
        return plots.radius(damped.orbits["B1,c"], periods=3), plots.multipliers(damped.orbits)

    kept = [written(figure, "svg") for figure in figures()]
    monkeypatch.setattr(figure_module, "_OUTLINES", TextToPath())
    monkeypatch.delattr(figure_module._Svg, "_get_font_height_metrics")
    monkeypatch.setattr(figure_module, "gauge", lambda: figure_module._Svg(1.0, 1.0, io.StringIO()))
    monkeypatch.setattr(arrangement, "gauge", figure_module.gauge)
    assert [written(figure, "svg") for figure in figures()] == kept


def test_each_row_of_letters_is_placed_once(damped, monkeypatch):
    placed, place = [], TextToPath.get_glyphs_with_font

    def counted(outlines, font, text, *arguments, **options):
        placed.append((font.fname, text))
        return place(outlines, font, text, *arguments, **options)

    figures = [plots.radius(damped.orbits["B1,c"], periods=periods) for periods in (5, 4, 5)]
    monkeypatch.setattr(TextToPath, "get_glyphs_with_font", counted)
    for figure in figures:
        written(figure, "svg")
    assert len(placed) == len(set(placed))


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
    assert narrow.get_suptitle().split("\n") == [
        "a machine: damping 1,400 N s/m, stiffness 980,000 N/m,",
        "speed 1,759 rpm",
        "a motion",
    ]
    narrow.canvas.draw()
    renderer = narrow.canvas.get_renderer()
    box = narrow.legends[0].get_window_extent(renderer)
    assert box.x0 >= 0.0
    assert box.x1 <= narrow.bbox.x1
    assert plots.motion(motion).get_suptitle() == wide.get_suptitle()
