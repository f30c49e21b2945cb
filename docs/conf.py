"""Sphinx configuration: `make docs`.  Every code cell is executed while the documentation is built."""

from __future__ import annotations

import importlib.metadata
import importlib.util
import os
import sys
from pathlib import Path

# Cells run in processes of their own, each in the folder of its page; what they share is in _cells.
_CELLS = str(Path(__file__).parent / "_cells")
os.environ["PYTHONPATH"] = _CELLS
sys.path.insert(0, _CELLS)

project = "carom"
author = "The carom developers"
copyright = "2026, The carom developers"
release = importlib.metadata.version("carom")
version = release

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.mathjax",
    "numpydoc",
    "sphinx_gallery.gen_gallery",
]
exclude_patterns = [
    "_templates",
    "_cells",
    "gallery/*.py",
    "gallery/*.ipynb",
    "gallery/*.md5",
    "gallery/*.json",
    "gallery/*.zip",
]
templates_path = ["_templates"]
# The pages of the API are generated with the first of these.
source_suffix = {".rst": "restructuredtext", ".md": "myst-nb"}
suppress_warnings = [
    # Pages link to files of the repository that are no pages.
    "myst.xref_missing",
]

# ------------------------------------------------------------------------------------------------ pages and cells

myst_enable_extensions = ["amsmath", "attrs_inline", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
myst_dmath_double_inline = True
nb_execution_mode = "force"
nb_execution_show_tb = True
nb_execution_timeout = 300
nb_output_stderr = "error"
nb_merge_streams = True
nb_render_markdown_format = "myst"

# ------------------------------------------------------------------------------------------------ gallery


sphinx_gallery_conf = {
    "examples_dirs": "../examples/gallery",
    "gallery_dirs": "gallery",
    "within_subsection_order": "FileNameSortKey",
    "filename_pattern": r"/\d\d_",
    "image_scrapers": ("gallery_figures.named_figures",),
    "capture_repr": (),
    "reset_modules": (),
    "write_computation_times": False,
    "download_all_examples": False,
    "show_signature": False,
    "min_reported_time": 60,
    "thumbnail_size": (400, 280),
}

# ------------------------------------------------------------------------------------------------ API

autosummary_generate = True
# Names that differ in case only, for file systems that do not tell them apart.
autosummary_filename_map = {
    "carom.closed_forms.Rolling": "carom.closed_forms.Rolling-class",
    "carom.models.Axis": "carom.models.Axis-class",
}
# Types stand in the signatures; a docstring repeats only those that say more than the signature, such as shapes.
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_member_order = "bysource"
autodoc_preserve_defaults = True
# Attributes stand in the docstrings; properties and methods are listed by the template.
numpydoc_show_class_members = False
numpydoc_xref_param_type = False

# ------------------------------------------------------------------------------------------------ HTML


def _mathjax() -> str:
    """One file with all that typesets the formulas, so that the pages need no network."""
    found = importlib.util.find_spec("sphinx-mathjax-offline")
    if found is None or found.origin is None:
        raise RuntimeError("sphinx-mathjax-offline is not installed: make docs installs requirements/docs.txt")
    return str(Path(found.origin).parent / "static" / "mathjax" / "tex-svg.js")


html_theme = "furo"
html_title = f"carom {release}"
html_static_path = ["_static", _mathjax()]
html_css_files = ["carom.css"]
html_copy_source = False
html_show_sourcelink = False
mathjax_path = "tex-svg.js"
mathjax3_config = {
    "tex": {
        "macros": {
            "ee": r"\mathrm{e}",
            "ii": r"\mathrm{i}",
            "dd": r"\mathrm{d}",
            "Re": r"\operatorname{Re}",
            "Im": r"\operatorname{Im}",
            "sgn": r"\operatorname{sgn}",
        }
    },
    "options": {"enableMenu": False},
}


def _keep_formulas(app, what, name, obj, options, lines) -> None:  # type: ignore[no-untyped-def]
    """Show the indented formulas of module texts as they are: their bars and stars are no markup."""
    if what != "module":
        return
    text, inside = [], False
    for place, line in enumerate(lines):
        indented = line.startswith("    ")
        if indented and not inside and place and not lines[place - 1].strip():
            text += ["::", ""]
        inside = indented or (inside and not line.strip())
        text.append(line)
    lines[:] = text


def setup(app) -> None:  # type: ignore[no-untyped-def]
    """Register what this file adds."""
    app.connect("autodoc-process-docstring", _keep_formulas, priority=100)
