"""The HTML page of a study: self-contained, for screen and print, in light and dark colours."""

from __future__ import annotations

import platform
import re
from dataclasses import dataclass, replace
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path

from jinja2 import Environment, StrictUndefined
from markupsafe import Markup

from carom import plots
from carom.arguments import checked
from carom.files import staged_directory, write_json
from carom.files.directory import FIGURES, MANIFEST
from carom.plots.sheet import drawing
from carom.progress import Reporter, ShowProgress, shows_progress
from carom.report.basins import drawable
from carom.report.figures import Picture, pictures
from carom.studies import Study
from carom.studies.advice_facts import BEYOND, CHANGES
from carom.studies.facts import Fact, about, paragraphs
from carom.studies.summaries import (
    MotionRow,
    dimensionless_rows,
    machine_rows,
    motion_rows,
    range_rows,
    share_rows,
    survived_rows,
)
from carom.studies.verdict import not_covered
from carom.studies.wording import machine_heading

REPORT = "report.html"
AT_ONCE = ("Margin", "Then")
"""Labels of what the first screen says of a change; the rest stands below."""


@dataclass(frozen=True)
class InlineFigure:
    """A figure as it is embedded in the page."""

    section: str
    caption: str
    svg: Markup


@checked
@shows_progress
def write_report(study: Study, directory: str, *, progress: ShowProgress = None) -> Path:
    """Write ``report.html``, ``study.json`` and the figures of a study, as SVG and PNG; return the path of the page.

    Parameters
    ----------
    directory : str
        Target directory, created if it does not exist.  Files of an earlier study are replaced; other files stay.

    Raises
    ------
    InputError
        The directory cannot be written; nothing has been changed then.
    """
    tell = Reporter.of(progress, "drawing")
    wanted = pictures(study)
    named = plots.heading(machine_heading(study.case))
    with staged_directory(directory, "--out") as place, drawing(), named, plots.one_column():
        (place / FIGURES).mkdir()
        inline, names = [], []
        for done, picture in enumerate(wanted):
            tell(done / len(wanted), f"figure {done + 1} of {len(wanted)}")
            paths = plots.save(picture.draw(), place / FIGURES / picture.name)
            names += [f"{FIGURES}/{path.name}" for path in paths]
            inline.append(_inline(picture, paths[0].read_text(encoding="utf-8"), f"f{done + 1}-"))
        document = {**study.to_dict(), "figures": names}
        write_json(place / MANIFEST, document)
        (place / REPORT).write_text(report_page(study, inline), encoding="utf-8")
    return Path(directory) / REPORT


@checked
def report_page(study: Study, figures: list[InlineFigure]) -> str:
    """Return the page as self-contained HTML."""
    environment = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    environment.filters["formulas"] = _with_subscripts
    template = environment.from_string(files("carom.report").joinpath("report.html.jinja").read_text(encoding="utf-8"))
    changes, about_all = _advice(study)
    return template.render(
        study=study,
        verdict=study.verdict,
        mark=_mark(study),
        drawable=drawable(study),
        facts={fact.label: fact.told for fact in about(study.facts, "Verdict")},
        shares=share_rows(study),
        survived=survived_rows(study),
        can_change=CHANGES,
        changes=changes,
        advice=about_all,
        at_once=AT_ONCE,
        findings=[
            entry for entry in paragraphs(study.facts) if entry[0] not in ("What would change it", "Not covered")
        ],
        machine=machine_rows(study.case),
        dimensionless=dimensionless_rows(study.case),
        motions=motion_rows(study),
        holding=_holding(study),
        left_out=sum(not orbit.admissible for orbit in study.orbits),
        ranges=range_rows(study),
        own=[
            (study.wording.name(name), study.wording.value(name, study.case.parameters.value(name)))
            for name in (found.along.name for found in study.recoveries)
        ],
        searched=[entry for entry in study.ranges if entry.motion == "single-impact"],
        figures=figures,
        not_covered=not_covered(study),
        versions=_versions(),
    )


def _holding(study: Study) -> list[MotionRow]:
    """Rows of the motions with which the rotor may go on for long, by the names that people use."""
    words = {f"orbit {orbit.name}": orbit.name.words for orbit in study.orbits}
    rows = [row for row in motion_rows(study) if row.state not in ("unstable", "not possible")]
    return [replace(row, name=words.get(row.name, row.name)) for row in rows]


def _mark(study: Study) -> str:
    """Colour of the headline: that of levitation only where nothing is lost and nothing is asked that cannot be given."""
    if study.verdict.level == "no-contact-free-motion":
        return "var(--bad)"
    doubtful = study.bearing_demand is not None and study.bearing_demand.doubtful
    good = study.recommendation.kind == "no-change-needed" and not doubtful
    return plots.OUTCOMES["levitated"].colour if good else "var(--warn)"


@dataclass(frozen=True)
class Advice:
    """A line of the recommendation with its details."""

    fact: Fact
    details: tuple[Fact, ...]


def _advice(study: Study) -> tuple[list[Advice], dict[str, str]]:
    """The lines that say what to change, and what is said of all of them, by label."""
    lines: list[Advice] = []
    for fact in about(study.facts, "Recommendation"):
        if fact.detail:
            lines[-1] = Advice(lines[-1].fact, (*lines[-1].details, fact))
        else:
            lines.append(Advice(fact, ()))
    changes = [line for line in lines if line.fact.label in (*CHANGES, BEYOND)]
    return changes, {line.fact.label: line.fact.told for line in lines if line not in changes}


def _versions() -> str:
    packages = ", ".join(f"{name} {version(name)}" for name in ("numpy", "numba", "matplotlib"))
    return f"carom {version('carom')}, Python {platform.python_version()}, {packages}"


_SUBSCRIPT = re.compile(r"\b([ceFik])_(max|[rcis])(?![A-Za-z0-9])|\b([BR])(\d+,[a-d])\b|\b(F)(1)\b")
_UNITS = (
    "m c_r² Ω³|m c_r² Ω²|m c_r Ω²|m c_r Ω|c_r Ω|c_r|N s/m|A s/m|N s|g mm|kg mm|%|rpm|rad|mm/s|µm/s|m/s|mm|µm|m|ms|µs|s|kg|kN|MN|"
    "N/mm|N/m|N/A|N|A/m|A|kW|W|kJ|J"
)
_QUANTITY = re.compile(rf"(?<=[0-9⁰¹²³⁴⁵⁶⁷⁸⁹]) (?:{_UNITS})(?![\w/²³])")
"""A unit behind a number: no line ends within them."""
_COMMAND = re.compile(r"`(carom \w+)`")


def _with_subscripts(text: str) -> Markup:
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


def _inline(picture: Picture, text: str, prefix: str) -> InlineFigure:
    """Prepare a figure file for the page: make it scalable, and its identifiers unique."""
    svg = _METADATA.sub("", _PROLOGUE.sub("", text))
    # Identifiers must be unique within a page, but every figure has an "axes_1".  Keep only those that are referred to.
    used = {match[2] for match in _REFERENCE.finditer(svg)}
    svg = _IDENTIFIER.sub(lambda match: f' id="{prefix}{match[1]}"' if match[1] in used else "", svg)
    svg = _REFERENCE.sub(lambda match: f"{match[1]}{prefix}{match[2]}", svg)
    label = str(Markup.escape(picture.caption.split(". ")[0]))

    svg = _SIZE.sub(lambda match: f'<svg role="img" aria-label="{label}"{match[1]}', svg, count=1)
    return InlineFigure(picture.section, picture.caption, Markup(svg))  # written by carom
