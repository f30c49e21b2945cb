"""Legends of a drawn figure: their words, and whether they fit."""


def legend_words(figure) -> list[str]:
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def fits(figure) -> bool:
    """Whether no legend reaches beyond the figure or over its axes."""
    figure.draw_without_rendering()
    page = figure.bbox
    for legend in figure.legends:
        box = legend.get_window_extent()
        inside = page.x0 <= box.x0 and box.x1 <= page.x1 and page.y0 <= box.y0 and box.y1 <= page.y1
        if not inside or any(box.overlaps(axes.get_tightbbox()) for axes in figure.axes):
            return False
    return True
