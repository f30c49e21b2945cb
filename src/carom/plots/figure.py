"""A figure that carries carom's style to every file and notebook, whoever writes or shows it."""

from __future__ import annotations

import codecs
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache, lru_cache
from io import BytesIO, StringIO
from typing import Any

from matplotlib import rcParams
from matplotlib.backend_bases import RendererBase
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_mixed import MixedModeRenderer
from matplotlib.backends.backend_svg import RendererSVG
from matplotlib.cbook import file_requires_unicode, open_file_cm
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties, fontManager, get_font
from matplotlib.legend import Legend
from matplotlib.mathtext import MathTextParser
from matplotlib.text import Text
from matplotlib.textpath import TextToPath
from matplotlib.transforms import Bbox

from carom.arguments import checked
from carom.plots.sheet import ONE_COLUMN, applied, drawing

_heading: ContextVar[str] = ContextVar("_heading", default="")


@checked
@contextmanager
def heading(text: str) -> Iterator[None]:
    """Write a line above every figure made inside a ``with`` block, such as the name of the machine."""
    before = _heading.set(text)
    try:
        yield
    finally:
        _heading.reset(before)


_narrow: ContextVar[bool] = ContextVar("_narrow", default=False)
_MARGIN = 3.0
"""Least distance of a title or a legend from the left and right edge of a figure [pt]."""


@contextmanager
def one_column() -> Iterator[None]:
    """Make figures one column wide inside a ``with`` block: readable on a telephone, with panels below each other."""
    before = _narrow.set(True)
    try:
        yield
    finally:
        _narrow.reset(before)


def narrow() -> bool:
    """Whether figures are made one column wide now."""
    return _narrow.get()


POINTS = 72.0
"""Dots per inch of an SVG file: its unit is the point."""


class StyledFigure(Figure):
    """A figure that is drawn, saved and shown in carom's style, whatever the settings are at that time.

    Matplotlib reads many settings only when it draws or writes: the resolution and background of files, outlines for
    letters in SVG, the looks of ticks.  Its layout is fixed, so one drawing is enough for a file.
    """

    def __init__(self, figsize: tuple[float, float] | None = None, **kwargs: Any) -> None:
        self._narrow = _narrow.get()
        if self._narrow and figsize is not None:
            figsize = min(figsize[0], ONE_COLUMN), figsize[1]
        super().__init__(figsize, layout="constrained", **kwargs)
        _Canvas(self)
        self._heading = _heading.get()
        if self._heading:
            super().suptitle(self._wrapped(self._heading))

    @property
    def heading(self) -> str:
        """The line above the title; empty if there is none."""
        return self._heading

    def suptitle(self, t: str, **kwargs: Any) -> Text:
        """Set the title as :meth:`matplotlib.figure.Figure.suptitle` does, below the heading if there is one."""
        return super().suptitle(self._wrapped(f"{self._heading}\n{t}" if self._heading else t), **kwargs)

    def _wrapped(self, text: str) -> str:
        """Break the lines of a title that are wider than the figure: after commas, and between words if that is not enough."""
        lines: list[str] = []
        for line in text.split("\n"):
            lines += self._broken(line, ", ")
        return "\n".join(lines)

    def _broken(self, line: str, between: str) -> list[str]:
        if self._room_for(line) or between not in line:
            return [line]
        first, *rest = line.split(between)
        lines = [first]
        for part in rest:
            together = f"{lines[-1]}{between}{part}"
            lines[-1:] = [together] if self._room_for(together) else [f"{lines[-1]}{between.rstrip()}", part]
        return lines if between == " " else [piece for part in lines for piece in self._broken(part, " ")]

    def _room_for(self, line: str) -> bool:
        with applied():
            font = FontProperties(size=rcParams["figure.titlesize"])
            width = gauge().get_text_width_height_descent(line, font, "$" in line)[0]
        return width <= POINTS * self.get_figwidth() - 2.0 * _MARGIN

    def legend(self, *args: Any, **kwargs: Any) -> Legend:
        """Add a legend as :meth:`matplotlib.figure.Figure.legend` does, in as many columns as the figure has room for."""
        columns = int(kwargs.get("ncols", 1))
        if self._narrow:
            columns = 2
        while True:
            legend = super().legend(*args, **kwargs | {"ncols": columns})
            if columns == 1 or self._holds(legend):
                return legend
            legend.remove()
            columns -= 1

    def _holds(self, legend: Legend) -> bool:
        dpi, self.dpi = self.dpi, POINTS
        try:
            width = legend.get_window_extent(gauge()).width
        finally:
            self.dpi = dpi
        return bool(width <= POINTS * self.get_figwidth() - 2.0 * _MARGIN)

    def draw(self, renderer: RendererBase) -> None:
        """Draw as :meth:`matplotlib.figure.Figure.draw` does, under carom's style sheet."""
        with applied():
            super().draw(renderer)

    def get_tightbbox(self, *args: Any, **kwargs: Any) -> Bbox:
        """Measure as :meth:`matplotlib.figure.Figure.get_tightbbox` does, under carom's style sheet."""
        with applied():
            return super().get_tightbbox(*args, **kwargs)

    def savefig(self, fname: Any, **kwargs: Any) -> None:
        """Save as :meth:`matplotlib.figure.Figure.savefig` does, under carom's style sheet."""
        with drawing():
            # With an engine, matplotlib would draw twice, even with the one that does nothing.
            engine = self.get_layout_engine()
            self.set_layout_engine(None)
            try:
                super().savefig(fname, **kwargs)
            finally:
                self.set_layout_engine(engine)

    def _repr_png_(self) -> bytes:
        """The picture for notebooks, at the resolution of the screen."""
        buffer = BytesIO()
        self.savefig(buffer, format="png", dpi="figure")
        return buffer.getvalue()


class _Canvas(FigureCanvasAgg):
    """Canvas that writes SVG with texts that are measured and parsed once for all figures."""

    def print_svg(
        self, filename: Any, *, bbox_inches_restore: Any = None, metadata: dict[str, Any] | None = None, **_: Any
    ) -> None:
        """Write as :class:`matplotlib.backends.backend_svg.FigureCanvasSVG` does."""
        figure, dpi = self.figure, self.figure.dpi
        with open_file_cm(filename, "w", encoding="utf-8") as file:
            stream = file if file_requires_unicode(file) else codecs.getwriter("utf-8")(file)
            figure.dpi = POINTS
            width, height = figure.get_size_inches()
            svg = _Svg(POINTS * width, POINTS * height, stream, image_dpi=dpi, metadata=metadata)
            renderer: Any = MixedModeRenderer(  # type: ignore[no-untyped-call]
                figure, width, height, dpi, svg, bbox_inches_restore=bbox_inches_restore
            )
            figure.draw(renderer)
            renderer.finalize()


class _Svg(RendererSVG):
    """Renderer of SVG that shares its outlines of letters with all others."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)  # type: ignore[no-untyped-call]
        self._text2path = _OUTLINES

    def _get_font_height_metrics(self, prop: FontProperties) -> tuple[float, float, float]:
        """Ascent, descent and gap between lines, which matplotlib asks for each time it places a text."""
        return _OUTLINES.heights(prop.copy())


class _Outlines(TextToPath):
    """Sizes and outlines of texts; each font, size, formula and row of letters is kept."""

    def __init__(self) -> None:
        super().__init__()
        self.mathtext_parser = _Formulas("path")

    @lru_cache(1024)  # noqa: B019  (there is one object)
    def heights(self, prop: FontProperties) -> tuple[float, float, float]:
        """Ascent, descent and gap between the lines of a font at POINTS dots per inch."""
        font: Any = get_font(self._files(prop))
        scale = prop.get_size_in_points() / font.get_sfnt_table("head")["unitsPerEm"]
        table, names = font.get_sfnt_table("OS/2"), ("sTypoAscender", "sTypoDescender", "sTypoLineGap")
        if table is None:
            table, names = font.get_sfnt_table("hhea"), ("ascent", "descent", "lineGap")
        ascent, descent, gap = (table[name] * scale for name in names)
        return ascent, -descent, gap

    @lru_cache(1024)  # noqa: B019  (there is one object)
    def _files(self, prop: FontProperties) -> Any:
        return fontManager._find_fonts_by_props(prop)

    def _get_font(self, prop: FontProperties) -> Any:
        font = get_font(self._files(prop.copy()))
        font.set_size(self.FONT_SCALE, self.DPI)  # others draw with the same object
        return font

    def get_glyphs_with_font(
        self, font: Any, s: str, glyph_map: Any = None, return_new_glyphs_only: bool = False, **options: Any
    ) -> Any:
        """Letters of a text, their places, and the outlines of those that are not known."""
        if any(value is not None for value in options.values()):  # features and languages, which carom does not use
            return super().get_glyphs_with_font(font, s, glyph_map, return_new_glyphs_only, **options)
        return _unknown(self._letters(font, s), glyph_map, return_new_glyphs_only)

    @lru_cache(8192)  # noqa: B019  (there is one object)
    def _letters(self, font: Any, s: str) -> Any:
        return super().get_glyphs_with_font(font, s)

    def get_glyphs_mathtext(
        self, prop: FontProperties, s: str, glyph_map: Any = None, return_new_glyphs_only: bool = False
    ) -> Any:
        """Letters of a formula, their places, and the outlines of those that are not known."""
        return _unknown(self._symbols(prop.copy(), s), glyph_map, return_new_glyphs_only)

    @lru_cache(1024)  # noqa: B019  (there is one object)
    def _symbols(self, prop: FontProperties, s: str) -> Any:
        return super().get_glyphs_mathtext(prop, s)

    def get_text_width_height_descent(self, s: str, prop: FontProperties, ismath: Any) -> tuple[float, float, float]:
        return self._size(s, prop.copy(), ismath)

    @lru_cache(8192)  # noqa: B019  (there is one object)
    def _size(self, s: str, prop: FontProperties, ismath: Any) -> tuple[float, float, float]:
        return super().get_text_width_height_descent(s, prop, ismath)


def _unknown(row: Any, glyph_map: Any, new_only: bool) -> Any:
    """A row of letters with the outlines that a map lacks, or with the map after these have been added."""
    places, outlines, rectangles = row
    known = {} if glyph_map is None else glyph_map
    new = {name: outline for name, outline in outlines.items() if name not in known}
    if not new_only:
        known.update(new)
    return places, new if new_only else known, rectangles


class _Formulas(MathTextParser):  # type: ignore[type-arg]
    """Parser that keeps all formulas: matplotlib's keeps fifty, and a report has more."""

    def parse(self, s: str, dpi: float = POINTS, prop: FontProperties | None = None, **options: Any) -> Any:
        return self._parsed(s, dpi, None if prop is None else prop.copy(), **options)

    @lru_cache(1024)  # noqa: B019  (there is one object)
    def _parsed(self, s: str, dpi: float, prop: FontProperties | None, **options: Any) -> Any:
        return super().parse(s, dpi, prop, **options)


_OUTLINES = _Outlines()


@cache
def gauge() -> RendererBase:
    """A renderer for measuring, at 72 dots per inch; matplotlib keeps the sizes of texts by renderer."""
    return _Svg(1.0, 1.0, StringIO())
