"""The HTML page of a drop: self-contained, with its figures and numbers beside it."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from carom import plots
from carom.base.arguments import checked
from carom.base.files import staged_directory, write_json
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.motions import Trajectory
from carom.motions.courses import shown_until
from carom.report.film import Film, film_of, film_script
from carom.report.html import ReportPicture, draw_figures, page_template, versions
from carom.studies.drops import DropStudy
from carom.studies.wording import Wording, machine_heading

DROP_PAGE, DROP_NUMBERS = "drop.html", "drop.json"
_ORBIT = (
    "The orbit of the rotor centre in the fixed frame, and close to the wall: its gap over the angle from the direction of gravity. "
    "The arrow shows the weight."
)
_SOFT = "Distance from the centre, forces of the contact, its slip and the speed of the surface of the race."
_RIGID = "Distance from the centre, forces of lasting contact with the impulse of each impact, and slip of the contact."
_WALLS = {
    True: "The pressure of balls, if it is stated, is that of Hertz under the peak force, of which the most loaded ball bears 5/Z (Stribeck).",
    False: "The wall is rigid: an impact has an impulse and no duration, so no peak force can be stated.",
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
    for plane in planes:
        seen, mark = motion.seen_at(plane.plane), f"-{plane.plane + 1}" if len(planes) > 1 else ""
        which = (f" Touchdown bearing {plane.plane + 1}." if mark else "") + cut
        films.append((f"film{plane.plane}-", film_of(seen)))
        loads = partial(plots.touchdown, seen, until=shown_until(seen))
        wanted.append(ReportPicture(f"drop-orbit{mark}", "drop", _ORBIT + which, partial(plots.drop_orbit, seen)))
        wanted.append(
            ReportPicture(f"drop-loads{mark}", "drop", (_SOFT if plane.is_compliant else _RIGID) + which, loads)
        )
    with staged_directory(directory, "--out") as place, plots.heading(machine_heading(found.case)):
        inline, names = draw_figures(wanted, place, Reporter.of(progress, "drawing"))
        write_json(place / DROP_NUMBERS, {**found.document(), "figures": names})
        page = page_template("drop.html.jinja").render(
            found=found,
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
