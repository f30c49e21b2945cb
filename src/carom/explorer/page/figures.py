"""The figures with axes, which the browser fills.

They are distance and contact force at each touchdown bearing over time, the section of impacts, the response to unbalance over the speed,
and the diagram along a slider.  A machine has those of its questions.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeAlias

from bokeh.core.types import ID
from bokeh.model import Model
from bokeh.models import ColumnDataSource, HoverTool, Range1d
from bokeh.models.annotations import Span
from bokeh.plotting import figure

from carom.plots.style import LOOKS, REGIMES

HEIGHT = 270
Parts: TypeAlias = dict[str, Any]
"""Sources, marks and ranges of figures, by their names."""


def make_figures(names: Sequence[str]) -> tuple[dict[str, Model], Parts]:
    """Make figures by their names, empty, and what the browser changes in them: nothing of it is sent back to the server."""
    parts: Parts = {}
    plots: dict[str, Model] = {name: FIGURES[name](parts) for name in names}
    for name, plot in plots.items():
        plot._id = ID(name)  # type: ignore[attr-defined]  # Bokeh has no public way to name an object; the text of the page refers to these
        for model in plot.references():
            model.syncable = False
    return plots, parts


def _source(parts: Parts, name: str, *columns: str) -> ColumnDataSource:
    source = ColumnDataSource({column: [] for column in columns})
    parts[name] = source
    return source


def _plot(name: str, x_range: Range1d, y_range: Range1d) -> figure:
    """Plot without any ink of its own: labels and colours come with the page, and differ between light and dark."""
    plot = figure(
        name=name,
        height=HEIGHT,
        sizing_mode="stretch_width",
        x_range=x_range,
        y_range=y_range,
        tools="",
        toolbar_location=None,
        min_border_left=54,
        min_border_right=14,
        output_backend="canvas",
    )
    plot.background_fill_alpha = 0.0
    plot.border_fill_alpha = 0.0
    plot.outline_line_alpha = 0.0
    return plot


def _range(parts: Parts, name: str, low: float, high: float) -> Range1d:
    parts[name] = Range1d(start=low, end=high)
    return parts[name]


def _moving_line(**look: Any) -> Span:
    """Upright line that moves many times a second: drawn above the figure, which stays as it is."""
    return Span(location=0.0, dimension="height", level="overlay", **look)


def _distances(parts: Parts) -> figure:
    """Distance from the centre over time at each touchdown bearing, with its lasting contact shaded and impacts as marks on the wall, which is at one."""
    plot = _plot("distances", _range(parts, "distances_x", 0, 1), _range(parts, "distances_y", 0, 1.06))
    plot.add_layout(Span(location=1.0, dimension="width", line_color=LOOKS["wall"].colour, line_width=1.5, name="wall"))
    spans = _source(parts, "spans", "left", "right", "bottom", "top", "colour")
    plot.quad("left", "right", "top", "bottom", source=spans, fill_color="colour", fill_alpha=0.35, line_alpha=0.0)
    _curves(plot, parts, "distances")
    impacts = _source(parts, "impacts", "t", "r", "colour", "marker")
    plot.scatter("t", "r", source=impacts, marker="marker", size=6, color="colour", name="impacts")
    parts["now"] = _moving_line(line_color=LOOKS["virtual"].colour, line_dash="dashed")
    plot.add_layout(parts["now"])
    return plot


def _section(parts: Parts) -> figure:
    """Section at the impacts: angle and radial speed just before each."""
    plot = _plot("section", _range(parts, "section_x", -180, 180), _range(parts, "section_y", 0, 1))
    plot.xaxis.ticker = [-180, -90, 0, 90, 180]
    source = _source(parts, "section", "angle", "speed", "colour", "marker")
    plot.scatter("angle", "speed", source=source, marker="marker", size=7, color="colour", fill_alpha=0.75)
    return plot


def _diagram(parts: Parts) -> figure:
    """Impact speeds of all single-impact orbits along the slider moved last."""
    plot = _plot("diagram", _range(parts, "diagram_x", 0, 1), _range(parts, "diagram_y", -0.1, 1))
    bars = _source(parts, "bars", "left", "right", "bottom", "top", "colour", "words")
    drawn = plot.quad(
        "left", "right", "top", "bottom", source=bars, fill_color="colour", line_alpha=0.0, fill_alpha=0.85
    )
    for kind, dash, width, alpha in (
        ("virtual", "solid", 0.8, 0.5),
        ("unstable", "dashed", 1.6, 1.0),
        ("stable", "solid", 2.4, 1.0),
    ):
        lines = _source(parts, f"lines_{kind}", "xs", "ys")
        colour = LOOKS[kind].colour
        plot.multi_line("xs", "ys", source=lines, line_color=colour, line_dash=dash, line_width=width, line_alpha=alpha)
    points = _source(parts, "points", "x", "y", "words", "colour", "fill")
    special = plot.scatter(
        "x", "y", source=points, marker="diamond", size=11, line_color="colour", fill_color="colour", fill_alpha="fill"
    )
    parts["cursor"] = _moving_line(line_width=1.6, line_color="#808080")
    plot.add_layout(parts["cursor"])
    plot.add_tools(HoverTool(renderers=[special], tooltips="@words at @x{0.[0000]}"))
    plot.add_tools(HoverTool(renderers=[drawn], tooltips="@words: stable from @left{0.[00]} to @right{0.[00]}"))
    return plot


def _curves(plot: figure, parts: Parts, name: str, **look: Any) -> None:
    """Several lines, each with a colour of its own."""
    source = _source(parts, name, "xs", "ys", "colour")
    plot.multi_line("xs", "ys", source=source, line_color="colour", line_width=1.6, name=name, **look)


def _response(parts: Parts) -> figure:
    """Radius of the whirl by unbalance over the speed: at the touchdown bearings, dashed at the sensors; clearances, and the present speed."""
    plot = _plot("response", _range(parts, "response_x", 0, 1), _range(parts, "response_y", 0, 1))
    _curves(plot, parts, "sensors", line_dash="dashed")
    _curves(plot, parts, "planes")
    walls = _source(parts, "walls", "xs", "ys")
    plot.multi_line("xs", "ys", source=walls, line_color=LOOKS["wall"].colour, line_width=1.5, name="wall")
    parts["speed"] = _moving_line(line_width=1.6, line_color="#808080")
    plot.add_layout(parts["speed"])
    return plot


def _forces(parts: Parts) -> figure:
    """Normal force over time in each touchdown bearing."""
    plot = _plot("forces", _range(parts, "forces_x", 0, 1), _range(parts, "forces_y", 0, 1))
    _curves(plot, parts, "forces", line_alpha=0.85)
    parts["now_too"] = _moving_line(line_color=LOOKS["virtual"].colour, line_dash="dashed")
    plot.add_layout(parts["now_too"])
    return plot


FIGURES: Mapping[str, Callable[[Parts], figure]] = {
    "distances": _distances,
    "section": _section,
    "diagram": _diagram,
    "response": _response,
    "forces": _forces,
}


def looks() -> dict[str, str]:
    """Colours by their meaning, for what the browser draws itself."""
    named = {name: look.colour for name, look in LOOKS.items()}
    return named | {f"regime_{place}": look.colour for place, look in enumerate(REGIMES)}
