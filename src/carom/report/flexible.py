"""The HTML page of the study of a flexible machine: self-contained, with its figures and numbers beside it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

from matplotlib.figure import Figure

from carom import plots
from carom.arguments import checked
from carom.files import staged_directory, write_json
from carom.files.directory import FIGURES, MANIFEST
from carom.motions import Trajectory
from carom.plots.sheet import drawing
from carom.progress import Reporter, ShowProgress, shows_progress
from carom.report.html import InlineFigure, inline_figure, page_template, versions
from carom.report.page import REPORT
from carom.studies import FlexibleStudy
from carom.studies.facts import about, paragraphs
from carom.studies.verdict_facts import KINDS

_MARKS = {
    "no-contact-free-motion": "var(--bad)",
    "may-not-come-back": "var(--warn)",
    "all-tried-came-back": plots.OUTCOMES["levitated"].colour,
}


@checked
@shows_progress
def write_flexible_report(study: FlexibleStudy, directory: str, *, progress: ShowProgress = None) -> Path:
    """Write ``report.html``, ``study.json`` and the figures of the study of a flexible machine, as SVG and PNG; return the path of the page.

    Parameters
    ----------
    directory : str
        Target directory, created if it does not exist.  Files of an earlier study are replaced; other files stay.

    Raises
    ------
    InputError
        The directory cannot be written; nothing has been changed then.
    """
    tell, inline, names = Reporter.of(progress, "drawing"), list[InlineFigure](), list[str]()
    wanted = list(_pictures(study))
    with staged_directory(directory, "--out") as place, drawing(), plots.heading(study.case.name):
        (place / FIGURES).mkdir()
        for done, (name, caption, draw) in enumerate(wanted):
            tell(done / len(wanted), f"figure {done + 1} of {len(wanted)}")
            paths = plots.save(draw(), place / FIGURES / name)
            names += [f"{FIGURES}/{path.name}" for path in paths]
            text = paths[0].read_text(encoding="utf-8")
            inline.append(inline_figure("study", caption, text, f"f{done + 1}-"))
        write_json(place / MANIFEST, {**study.to_dict(), "figures": names})
        page = page_template("flexible.html.jinja").render(
            study=study,
            mark=_MARKS[study.verdict.level],
            survived=about(study.facts, "Verdict"),
            topics=paragraphs(study.facts),
            machine=study.case.rows(),
            figures=inline,
            versions=versions(),
        )
        (place / REPORT).write_text(page, encoding="utf-8")
    return Path(directory) / REPORT


def _pictures(study: FlexibleStudy) -> Iterator[tuple[str, str, Callable[[], Figure]]]:
    """File name, caption and figure, in the order of the page."""
    found = study.levitation
    yield (
        "campbell",
        "Free whirls over the speed of the shaft, from all modes; unbalance excites forward whirls where they cross the line.",
        found.campbell.plot,
    )
    if found.response is not None:
        yield "unbalance", "Radii of the whirl by unbalance, levitating without contact.", found.response.plot
    if found.sensitivity is not None:
        yield "sensitivity", "Sensitivity of each loop, with the zones of ISO 14839-3.", found.sensitivity.plot
    planes = range(len(found.machine.touchdowns))
    for trial in study.trials:
        for plane in planes:
            what = KINDS[trial.kind].lower()  # type: ignore[index]
            caption = f"Orbit of the shaft at plane {plane + 1} after the {what} with the largest force, in the fixed frame, and its gap to the touchdown bearing."
            yield (
                f"{trial.kind}-{plane + 1}",
                caption,
                _orbit(trial.worst, plane, f"After the {what}, plane {plane + 1}"),
            )
    if study.fall is not None:
        for plane in planes:
            caption = f"Orbit of the shaft at plane {plane + 1} after levitation is lost, in the fixed frame, and its gap to the touchdown bearing."
            yield f"drop-{plane + 1}", caption, _orbit(study.fall, plane, f"Drop, plane {plane + 1}")


def _orbit(motion: Trajectory, plane: int, title: str) -> Callable[[], Figure]:
    return lambda: plots.drop_orbit(motion.seen_at(plane), title=title)
