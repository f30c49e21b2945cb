"""The HTML page of the study of a flexible machine: self-contained, with its figures and numbers beside it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

from matplotlib.figure import Figure

from carom import plots
from carom.arguments import checked
from carom.files import staged_directory, write_json
from carom.files.directory import MANIFEST
from carom.motions import Trajectory
from carom.parameters.told import number
from carom.plots.sheet import drawing
from carom.progress import Reporter, ShowProgress, shows_progress
from carom.report.figure_files import Picture, draw_figures
from carom.report.html import page_template, versions
from carom.report.page import REPORT
from carom.studies import FlexibleStudy
from carom.studies.facts import about, paragraphs
from carom.studies.flexible_rows import machine_rows
from carom.studies.verdict_facts import KINDS

SECTION = "study"
"""The one section of the page that has figures."""
_MARKS = {
    "no-contact-free-motion": "var(--bad)",
    "may-not-come-back": "var(--warn)",
    "not-decided": "var(--warn)",
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
    tell, wanted = Reporter.of(progress, "drawing"), list(_pictures(study))
    with staged_directory(directory, "--out") as place, drawing(), plots.heading(study.case.name):
        inline, names = draw_figures(wanted, place, tell)
        write_json(place / MANIFEST, {**study.to_dict(), "figures": names})
        page = page_template("flexible.html.jinja").render(
            study=study,
            mark=_MARKS[study.verdict.level],
            survived=about(study.facts, "Verdict"),
            topics=paragraphs(study.facts),
            machine=machine_rows(study.case, study.reduced.machine),
            whirls=_whirls(study),
            figures=inline,
            versions=versions(),
        )
        (place / REPORT).write_text(page, encoding="utf-8")
    return Path(directory) / REPORT


def _pictures(study: FlexibleStudy) -> Iterator[Picture]:
    """All figures, in the order of the page."""
    found = study.levitation
    whirls = "Free whirls over the speed of the shaft, from all modes; unbalance excites forward whirls where they cross the line."
    yield Picture("campbell", SECTION, whirls, found.campbell.plot)
    shapes = "Shapes of the slowest free whirls at the speed of the machine, from all modes, along the shaft."
    yield Picture("shapes", SECTION, shapes, lambda: plots.mode_shapes(found.machine, found.whirls))
    if found.response is not None:
        radii = "Radii of the whirl by unbalance, levitating without contact."
        yield Picture("unbalance", SECTION, radii, found.response.plot)
    if found.sensitivity is not None:
        peaks = "Sensitivity of each loop, with the zones of ISO 14839-3."
        yield Picture("sensitivity", SECTION, peaks, found.sensitivity.plot)
    planes = range(len(found.machine.touchdowns))
    for trial in study.trials:
        what = KINDS[trial.kind].lower()  # type: ignore[index]
        for plane in planes:
            largest = "largest force" if any(each.contacts for each in trial.planes) else "widest orbit"
            after = f"after the {what} with the {largest}"
            draw = _orbit(trial.worst, plane, f"After the {what}, touchdown bearing {plane + 1}")
            yield Picture(f"{trial.kind}-{plane + 1}", SECTION, _caption(plane, after), draw)
    if study.fall is not None:
        for plane in planes:
            draw = _orbit(study.fall, plane, f"Drop, touchdown bearing {plane + 1}")
            yield Picture(f"drop-{plane + 1}", SECTION, _caption(plane, "after levitation is lost"), draw)


def _whirls(study: FlexibleStudy) -> list[tuple[str, str, str]]:
    """Frequency, sense and damping ratio of the slowest whirls."""
    found = study.levitation.whirls
    return [(f"{number(each.frequency)} Hz", each.sense, number(each.damping_ratio, 3)) for each in found]


def _caption(plane: int, when: str) -> str:
    return (
        f"Orbit of the shaft at touchdown bearing {plane + 1} {when}, in the fixed frame, and its gap to the bearing."
    )


def _orbit(motion: Trajectory, plane: int, title: str) -> Callable[[], Figure]:
    return lambda: plots.drop_orbit(motion.seen_at(plane), title=title)
