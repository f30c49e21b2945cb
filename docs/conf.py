"""Sphinx configuration: `make docs`.  Every code cell is executed while the documentation is built."""

from __future__ import annotations

import importlib
import importlib.metadata
import importlib.util
import os
import sys
from pathlib import Path

from docutils import nodes
from sphinx.util.nodes import make_refnode
from sphinx.util.parallel import make_chunks

# Cells run in processes of their own, each in the folder of its page; what they share is in _cells.
_CELLS = str(Path(__file__).parent / "_cells")
os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [_CELLS, os.environ.get("PYTHONPATH")]))
sys.path.insert(0, _CELLS)
# A cell that takes long is no place for a bar that vanishes.
os.environ["CAROM_PROGRESS"] = "0"

from sidebar import share_trees  # noqa: E402

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

# ------------------------------------------------------------------------------------------------ order of the pages

_SECONDS = {
    "tutorial": 30,
    "howto/what-is-proven": 20,
    "theorems": 20,
    "misprints": 12,
    "reference/json": 7,
    "paper": 6,
    "python-tour": 6,
    "theory/attractors": 5,
    "howto/choose-gains": 5,
    "howto/uncertain-contact": 14,
    "howto/flexible-rotor": 8,
    "reference/command-line": 4,
    "sweeps": 4,
    "theory/regions": 4,
}
"""Processor time of the slowest pages.  Another page with cells takes about 3 s, most of it to start its process."""


def _spread_work(app, env, docnames) -> None:  # type: ignore[no-untyped-def]
    """Order the pages so that those that take long are shared evenly by the chunks in which Sphinx has pages read.

    In alphabetic order the last chunk holds nearly all of them, and one process reads it while the others wait.
    """
    sizes = [len(chunk) for chunk in make_chunks(docnames, app.parallel)]
    chunks: list[list[str]] = [[] for _ in sizes]
    seconds = {name: _SECONDS.get(name, 3 if _has_cells(env.doc2path(name)) else 0.05) for name in docnames}
    for name in sorted(docnames, key=lambda name: -seconds[name]):
        free = (place for place, chunk in enumerate(chunks) if len(chunk) < sizes[place])
        chunks[min(free, key=lambda place: sum(seconds[other] for other in chunks[place]))].append(name)
    docnames[:] = [name for chunk in chunks for name in chunk]


def _has_cells(path: Path) -> bool:
    return "{code-cell}" in Path(path).read_text(encoding="utf-8")


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


# ------------------------------------------------------------------------------------------------ references

# Every reference must lead somewhere or name something that exists.
nitpicky = True
_PYTHON = "https://docs.python.org/3/library/"
_ELSEWHERE = {
    "numpy.ndarray": "https://numpy.org/doc/stable/reference/generated/numpy.ndarray.html",
    "xarray.Dataset": "https://docs.xarray.dev/en/stable/generated/xarray.Dataset.html",
    "matplotlib.figure.Figure": "https://matplotlib.org/stable/api/figure_api.html#matplotlib.figure.Figure",
    "matplotlib.axes.Axes": "https://matplotlib.org/stable/api/_as_gen/matplotlib.axes.Axes.html",
    "scipy.integrate.solve_ivp": "https://docs.scipy.org/doc/scipy/reference/generated/scipy.integrate.solve_ivp.html",
    "pathlib.Path": f"{_PYTHON}pathlib.html#pathlib.Path",
    "os.PathLike": f"{_PYTHON}os.html#os.PathLike",
    "fractions.Fraction": f"{_PYTHON}fractions.html#fractions.Fraction",
    "decimal.Decimal": f"{_PYTHON}decimal.html#decimal.Decimal",
    "dataclasses.asdict": f"{_PYTHON}dataclasses.html#dataclasses.asdict",
    **{
        f"collections.abc.{name}": f"{_PYTHON}collections.abc.html#collections.abc.{name}"
        for name in ("Callable", "Collection", "Iterable", "Iterator", "Mapping", "Sequence")
    },
}
"""Addresses of what other packages document.  Their inventories would have to be downloaded for every build."""
_SHORT = {"np.ndarray": "numpy.ndarray", "Figure": "matplotlib.figure.Figure", "Axes": "matplotlib.axes.Axes"}


def _objects(path: str) -> list[object]:
    """The object of a dotted path, if there is one, and the package that has it."""
    parts = path.split(".")
    for count in range(len(parts), 0, -1):
        try:
            found = importlib.import_module(".".join(parts[:count]))
        except ImportError:
            continue
        for name in parts[count:]:
            fields = getattr(found, "__dataclass_fields__", {})
            if not hasattr(found, name) and name not in fields and name not in getattr(found, "__annotations__", {}):
                return []
            found = getattr(found, name, fields.get(name))
        return [found]
    return []


def _resolve(app, env, node, contnode):  # type: ignore[no-untyped-def]
    """Follow a reference to where its object is documented; set a name that exists and is not documented as text."""
    if node.get("refdomain") != "py":
        return None
    target = _SHORT.get(node["reftarget"], node["reftarget"])
    if target in _ELSEWHERE:
        return nodes.reference("", "", contnode, internal=False, refuri=_ELSEWHERE[target])
    module, owner = node.get("py:module") or "carom", node.get("py:class") or ""
    for path in (target, f"{module}.{target}", f"{module}.{owner}.{target}"):
        for found in _objects(path):
            for name, entry in env.get_domain("py").objects.items():
                alike = not entry.aliased and name.rpartition(".")[2] == target.rpartition(".")[2]
                if alike and any(other is found for other in _objects(name)):
                    return make_refnode(app.builder, node["refdoc"], entry.docname, entry.node_id, contnode, name)
            return contnode
    return contnode if _is_annotation(target) else None


def _is_annotation(name: str) -> bool:
    """Whether a name stands in annotations only: with brackets, a type of another package, or one imported for checking."""
    head, _, last = name.rpartition(".")
    if "[" in name or last == "Annotated":
        return True
    return head.partition(".")[0] in ("np", "numpy", "distributed") or (not head and last[:1].isupper())


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
    app.connect("missing-reference", _resolve)
    app.connect("env-before-read-docs", _spread_work)
    share_trees(app)
