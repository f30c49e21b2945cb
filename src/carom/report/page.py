"""The HTML pages of a study and of a drop: self-contained, for screen and print, in light and dark colours, with figures and numbers beside them."""

from __future__ import annotations

from contextlib import AbstractContextManager
from dataclasses import replace
from functools import partial
from pathlib import Path

from carom import plots
from carom.base.arguments import checked
from carom.base.files import MANIFEST, staged_directory, write_json
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.models import rotor_of
from carom.motions import Trajectory
from carom.motions.courses import shown_until
from carom.parameters.formats import format_entry, number
from carom.plots.figure import drawing, made_for
from carom.report.figures import drawable, pictures
from carom.report.film import Film, film_of, film_script
from carom.report.html import InlineFigure, ReportPicture, draw_figures, page_template, versions
from carom.studies import Study
from carom.studies.drops import DropStudy
from carom.studies.findings import CHANGES, not_covered
from carom.studies.landing import Accepted, bearing_words, load_columns
from carom.studies.levitating import Levitating, frequency_words
from carom.studies.questions import Fact, about, paragraphs
from carom.studies.summaries import MOTION_COLUMNS, MotionRow, motion_rows, survived_rows
from carom.studies.wording import Wording, machine_heading

REPORT = "report.html"
AT_ONCE = ("Margin", "Then")
"""Labels of what the first screen says of a change; the rest stands below."""


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
    with staged_directory(directory, "--out") as place, drawing(), named, _in_columns():
        inline, names = draw_figures(wanted, place, tell)
        document = {**study.to_dict(), "figures": names}
        write_json(place / MANIFEST, document)
        (place / REPORT).write_text(report_page(study, inline), encoding="utf-8")
    return Path(directory) / REPORT


def _in_columns() -> AbstractContextManager[None]:
    """Figures of one column, which can be read on a telephone too, unless slides are asked for."""
    return plots.figures_for("slide" if made_for.get() == "slide" else "column")


@checked
def report_page(study: Study, figures: list[InlineFigure]) -> str:
    """Return the page as self-contained HTML."""
    template = page_template("report.html.jinja")
    changes, about_all = _advice(study)
    return template.render(
        study=study,
        verdict=study.verdict,
        mark=_mark(study),
        drawable=drawable(study),
        facts={fact.label: fact.sentence for fact in about(study.facts, "Verdict")},
        survived=survived_rows(study),
        can_change=CHANGES,
        changes=changes,
        advice=about_all,
        at_once=AT_ONCE,
        findings=[entry for entry in paragraphs(study.facts) if entry[0] != "Not covered"],
        machine=study.case.rows(),
        whirls=_whirls(study.levitating),
        motion_columns=MOTION_COLUMNS,
        motions=motion_rows(study),
        holding=_holding(study),
        left_out=sum(not orbit.admissible for orbit in study.orbits),
        searched=[entry for entry in study.ranges if entry.motion == "single-impact"],
        figures=figures,
        not_covered=not_covered(study),
        versions=versions(),
    )


def _holding(study: Study) -> list[MotionRow]:
    """Rows of the motions with which the rotor may go on for long, by the names that people use."""
    words = {f"orbit {orbit.name}": orbit.name.words for orbit in study.orbits}
    rows = [row for row in motion_rows(study) if row.state not in ("unstable", "not possible")]
    return [replace(row, name=words.get(row.name, row.name)) for row in rows]


def _whirls(found: Levitating) -> list[tuple[str, str, str]]:
    """Frequency, sense and damping ratio of the slowest whirls."""
    return [
        (frequency_words(each, dimensionless=found.dimensionless), each.sense, number(each.damping_ratio, 3))
        for each in found.whirls
    ]


def _mark(study: Study) -> str:
    """Colour of the headline: that of levitation only where everything comes back."""
    if study.verdict.level == "no-contact-free-motion":
        return "var(--bad)"
    good = study.recommendation.kind == "no-change-needed"
    return plots.OUTCOMES["levitated"].colour if good else "var(--warn)"


def _advice(study: Study) -> tuple[list[tuple[Fact, list[Fact]]], dict[str, str]]:
    """The lines that say what to change with their details, and what is said of all of them, by label."""
    lines: list[tuple[Fact, list[Fact]]] = []
    for fact in about(study.facts, "Recommendation"):
        if fact.detail:
            lines[-1][1].append(fact)
        else:
            lines.append((fact, []))
    changes = [line for line in lines if line[0].label in CHANGES]
    return changes, {fact.label: fact.sentence for fact, _ in lines if fact.label not in CHANGES}


DROP_PAGE, DROP_NUMBERS = "drop.html", "drop.json"
_ORBIT = (
    "Orbit of the rotor centre in the fixed frame, coloured by time, and its gap to the wall over the angle. "
    "An arrow shows the weight, unless levitation is regained."
)
_STANDSTILL = "Speed of the shaft until it stands, with the critical speeds of the free rotor, and the widest whirl in each step of speed (0-to-peak)."
_LANDING = (
    "Contact force at each touchdown bearing over time, how fast the shaft and its race turn, where one of them changes, and temperatures, where the "
    "mass of the race is stated."
)
_SOFT = "Distance from the centre, contact forces, slip velocity and surface speed of the race."
_RIGID = "Distance from the centre, forces in lasting contact, the impulse of each impact, and slip velocity."
_WALLS = {
    True: "Ball pressure, where stated, is the Hertz pressure of the most loaded ball at the peak force, by the sum over all balls.",
    False: "The wall is rigid: an impact has an impulse but no duration, so no peak force can be stated.",
}


@checked
@shows_progress
def write_drop_report(found: DropStudy, motion: Trajectory, directory: str, *, progress: ShowProgress = None) -> Path:
    """Write ``drop.html``, ``drop.json`` and the figures of a drop, as SVG and PNG; return the path of the page.

    Parameters
    ----------
    motion : Trajectory
        The same drop as far as it is to be drawn.
    directory : str
        Target directory, created if it does not exist.  Files of an earlier drop are replaced; other files stay.

    Raises
    ------
    InputError
        The directory cannot be written; nothing has been changed then.
    """
    films, wanted = list[tuple[str, Film]](), list[ReportPicture]()
    planes, drawn, cut = found.loads.planes, motion.begins + motion.time, ""
    if drawn < found.loads.time and not motion.outcome.settled:
        say = Wording(found.case.parameters.scales)
        cut = f" Drawn: the first {say.time(drawn)} of {say.time(found.loads.time)}."
    if found.spin_down is not None:
        wanted.append(ReportPicture("drop-standstill", "drop", _STANDSTILL, found.spin_down.plot))
    over_time = partial(plots.landing, motion)
    wanted.append(ReportPicture("drop-landing", "drop", _LANDING + cut, over_time))
    for plane in planes:
        seen, mark = motion.seen_at(plane.plane), f"-{plane.plane + 1}" if len(planes) > 1 else ""
        which = (f" Touchdown bearing {plane.plane + 1}." if mark else "") + cut
        films.append((f"film{plane.plane}-", film_of(seen)))
        title = f"Touchdown bearing {plane.plane + 1}" if mark else None
        loads = partial(plots.touchdown, seen, title=title, until=shown_until(seen))
        orbit = partial(plots.drop_orbit, seen, title=title)
        wanted.append(ReportPicture(f"drop-orbit{mark}", "drop", _ORBIT + which, orbit))
        wanted.append(
            ReportPicture(f"drop-loads{mark}", "drop", (_SOFT if plane.is_compliant else _RIGID) + which, loads)
        )
    with staged_directory(directory, "--out") as place, plots.heading(machine_heading(found.case)), _in_columns():
        inline, names = draw_figures(wanted, place, Reporter.of(progress, "drawing"))
        write_json(place / DROP_NUMBERS, {**found.document(), "figures": names})
        page = page_template("drop.html.jinja").render(
            found=found,
            say=Wording(found.loads.scales),
            rotor=(rotor := rotor_of(found.case)),
            elements=rotor.finite_elements,
            mass=format_entry("mass", found.case.parameters.scales.mass),
            columns=load_columns(found),
            acceptance=[Accepted.of(check) for check in found.checks],
            bearings=bearing_words(found),
            heading=machine_heading(found.case),
            machine=found.case.rows(),
            mark="var(--warn)" if any(check.exceeded for check in found.checks) else "var(--rule)",
            films=films,
            script=film_script(),
            figures=inline,
            wall=_WALLS[planes[0].is_compliant],
            versions=versions(),
        )
        (place / DROP_PAGE).write_text(page, encoding="utf-8")
    return Path(directory) / DROP_PAGE
