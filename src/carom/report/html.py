"""What the HTML pages share: their style, figures drawn into files and inside the page, formulas in text, and what has made them."""

from __future__ import annotations

import platform
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined, Template
from markupsafe import Markup
from matplotlib.figure import Figure

from carom import plots
from carom.base.files import FIGURES
from carom.base.progress import Reporter


@dataclass(frozen=True)
class InlineFigure:
    """A figure as it is embedded in the page."""

    section: str
    caption: str
    svg: Markup


def page_template(name: str, folder: Path = Path(__file__).parent) -> Template:
    """Return a template of this package or of another folder, which may include others."""
    loader = FileSystemLoader(folder)
    environment = Environment(
        loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters["formulas"] = with_subscripts
    return environment.get_template(name)


def versions() -> str:
    """What has made a page."""
    packages = ", ".join(f"{name} {version(name)}" for name in ("numpy", "numba", "matplotlib"))
    return f"carom {version('carom')}, Python {platform.python_version()}, {packages}"


_SUBSCRIPT = re.compile(r"\b([ceFik])_(max|[rcis])(?![A-Za-z0-9])|\b([BR])(\d+,[a-d])\b|\b(F)(1)\b")
_UNITS = (
    "m c_r² Ω³|m c_r² Ω²|m c_r Ω²|m c_r Ω|c_r Ω|c_r|N s/m|A s/m|N s|g mm|kg mm|%|rpm|rad|mm/s|µm/s|m/s²|m/s|mm|µm|m|ms|µs|s|kg|kN|MN|"
    "N/mm|N/m|N/A|N|A/m|A|kW|W|kJ|J|Hz|dB"
)
_QUANTITY = re.compile(rf"(?<=[0-9⁰¹²³⁴⁵⁶⁷⁸⁹]) (?:{_UNITS})(?![\w/²³])")
"""A unit behind a number: no line ends within them."""
_COMMAND = re.compile(r"`(carom \w+)`")


def with_subscripts(text: str) -> Markup:
    """Write ``c_r``, ``B1,d``, ``F1`` and ``Omega`` as formulas, commands as code, and keep numbers with their units."""

    def formula(match: re.Match[str]) -> str:
        letter, index = (part for part in match.groups() if part)
        return f"{letter}<sub>{index}</sub>"

    escaped = _COMMAND.sub(r"<code>\1</code>", str(Markup.escape(text)).replace("Omega", "Ω"))
    escaped = _QUANTITY.sub(lambda match: match[0].replace(" ", "\N{NO-BREAK SPACE}"), escaped)
    return Markup(_SUBSCRIPT.sub(formula, escaped))  # escaped above


_PROLOGUE = re.compile(r"^.*?(?=<svg)", re.DOTALL)
_METADATA = re.compile(r"<metadata>.*?</metadata>", re.DOTALL)
_SIZE = re.compile(r'<svg([^>]*?) (?:width="[\d.]+pt" height="[\d.]+pt"|height="[\d.]+pt" width="[\d.]+pt")')
_IDENTIFIER = re.compile(r' id="([^"]+)"')
_REFERENCE = re.compile(r'(xlink:href="#|url\(#)([^")]+)')


def inline_figure(section: str, caption: str, text: str, prefix: str) -> InlineFigure:
    """Prepare a figure file for a page: make it scalable, and its identifiers unique."""
    svg = _METADATA.sub("", _PROLOGUE.sub("", text))
    # Identifiers must be unique within a page, but every figure has an "axes_1".  Keep only those that are referred to.
    used = {match[2] for match in _REFERENCE.finditer(svg)}
    svg = _IDENTIFIER.sub(lambda match: f' id="{prefix}{match[1]}"' if match[1] in used else "", svg)
    svg = _REFERENCE.sub(lambda match: f"{match[1]}{prefix}{match[2]}", svg)
    label = str(Markup.escape(caption.split(". ")[0]))

    svg = _SIZE.sub(lambda match: f'<svg role="img" aria-label="{label}"{match[1]}', svg, count=1)
    return InlineFigure(section, caption, Markup(svg))  # written by carom


@dataclass(frozen=True)
class ReportPicture:
    """A figure to draw.

    Attributes
    ----------
    name : str
        File name without ending.
    section : str
        Section of the page in which it stands.
    caption : str
        What to see, in a sentence.
    draw : callable
        Returns the figure.
    """

    name: str
    section: str
    caption: str
    draw: Callable[[], Figure]


def draw_figures(wanted: Sequence[ReportPicture], place: Path, tell: Reporter) -> tuple[list[InlineFigure], list[str]]:
    """Draw figures into a directory, as SVG and PNG; return them for the page, and the names of their files."""
    (place / FIGURES).mkdir()
    inline, names = list[InlineFigure](), list[str]()
    for done, picture in enumerate(wanted):
        tell(done / len(wanted), f"figure {done + 1} of {len(wanted)}")
        paths = plots.save(picture.draw(), place / FIGURES / picture.name)
        names += [f"{FIGURES}/{path.name}" for path in paths]
        text = paths[0].read_text(encoding="utf-8")
        inline.append(inline_figure(picture.section, picture.caption, text, f"f{done + 1}-"))
    return inline, names
