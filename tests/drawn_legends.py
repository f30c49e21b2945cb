"""Legends and titles of a drawn figure: their words, and whether they fit."""

from itertools import combinations


def _above_axes(figure) -> list:
    return [axes.get_legend() for axes in figure.axes if axes.get_legend() is not None]


def legend_words(figure) -> list[str]:
    return [text.get_text() for legend in [*figure.legends, *_above_axes(figure)] for text in legend.get_texts()]


def fits(figure) -> bool:
    """Whether no legend and no title reaches beyond the figure, over the axes or over each other."""
    figure.draw_without_rendering()
    page = figure.bbox
    apart = [legend.get_window_extent() for legend in figure.legends]
    if figure.get_suptitle():
        apart.append(figure._suptitle.get_window_extent())
    outside = [*apart, *(legend.get_window_extent() for legend in _above_axes(figure))]
    around = [axes.get_tightbbox() for axes in figure.axes]  # with the legends of the axes
    return (
        all(page.x0 <= box.x0 and box.x1 <= page.x1 and page.y0 <= box.y0 and box.y1 <= page.y1 for box in outside)
        and not any(box.overlaps(other) for box in apart for other in around)
        and not any(box.overlaps(other) for box, other in combinations(apart, 2))
    )
