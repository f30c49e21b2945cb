"""The scripts of the page.  Those that draw on a canvas know no page, and are used elsewhere too."""

from __future__ import annotations

import re
from functools import cache
from importlib.resources import files

PICTURES = ("common.js", "basin.js", "clearance.js")
"""Modules of the pictures, each after those that it imports."""
PAGE = (
    *PICTURES,
    "page.js",
    "controls.js",
    "address.js",
    "stage.js",
    "panels.js",
    "plots.js",
    "found.js",
    "sweep.js",
    "main.js",
)
"""All scripts of the page, in their order."""


@cache
def text_of(name: str) -> str:
    """The text of a file of the page."""
    return files("carom.explorer.page").joinpath("files", name).read_text(encoding="utf-8")


def joined(names: tuple[str, ...]) -> str:
    """Modules as a single one: they lie in one text, so that nothing is imported, and nothing exported."""
    text = re.sub(r'^import [^;]+ from "\./[\w.]+";\n', "", "\n".join(map(text_of, names)), flags=re.MULTILINE)
    return re.sub(r"^export (?=const )", "", text, flags=re.MULTILINE)
