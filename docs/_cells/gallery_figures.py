"""Pictures for the pages of the gallery: the figures that an example makes and names."""

from __future__ import annotations

from textwrap import indent
from typing import Any

from matplotlib.figure import Figure
from sphinx_gallery.scrapers import figure_rst

__all__ = ["named_figures"]


def named_figures(block: object, block_vars: dict[str, Any], gallery_conf: dict[str, Any]) -> str:
    """Pictures of the figures that a block of an example has made, in the order of their names."""
    found = []
    for figure in block_vars["example_globals"].values():
        if isinstance(figure, Figure) and not getattr(figure, "in_gallery", False):
            figure.in_gallery = True  # type: ignore[attr-defined]
            found.append(next(block_vars["image_path_iterator"]))
            figure.savefig(found[-1], dpi=150)
    if not found:
        return ""
    pictures = indent(figure_rst(found, gallery_conf["src_dir"]).strip("\n"), "   ")
    return f"\n.. container:: wide-figure\n\n{pictures}\n\n"
