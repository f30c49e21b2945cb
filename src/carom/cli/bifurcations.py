"""``carom bifurcations``: where motions appear, vanish and change along a parameter."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.cli import options
from carom.cli.options import option
from carom.cli.terminal import check_output, console, hand_over, progress, read_machine, write_output

if TYPE_CHECKING:
    from carom.bifurcations import Diagram
    from carom.models import Axis

IMPACTS = option(
    "N",
    "Follow orbits with at most N impacts a period; those with several are found by search, so some may be missing.",
    default=1,
    min=1,
    max=64,
)
FROM = option("A", "First value of the parameter, dimensionless or with a unit.", "--from", default=...)
TO = option("B", "Last value of the parameter.", "--to", default=...)


def bifurcations(
    machine: str = options.MACHINE,
    along: str = options.ALONG,
    start: str = FROM,
    end: str = TO,
    settings: list[str] | None = options.SETTINGS,
    impacts: int = IMPACTS,
    out: str | None = options.OUT,
    as_json: bool = options.AS_JSON,
) -> None:
    """Find the bifurcations along one parameter.

    Follows all equilibria and all orbits with one impact a period; with --impacts N orbits with at most N impacts, those
    with several as a search finds them. Lists folds, period doublings, Neimark-Sacker points, grazing, boundary equilibria, non-smooth Hopf
    points, folds of rubs and the limit of rolling. Along the speed it is a run-up diagram: damping and stiffness stay
    fixed, their dimensionless values change with the speed.
    """
    case = read_machine(machine, settings)
    with progress("loading") as tell:
        from carom.bifurcations import find_bifurcations
        from carom.bifurcations.documents import diagram_document
        from carom.cli.starts import read_ends
        from carom.models import axis, rotor_of

        model = rotor_of(case)
        varied = axis(model, along.strip())
        interval = read_ends(start, end, varied)
        check_output(out)
        diagram = find_bifurcations(model, varied.name, interval, impacts=impacts, progress=tell)
        name = f"bifurcations-{varied.name}"
        write_output(out, case, name, lambda: diagram_document(diagram), {name: diagram.plot})
    hand_over(lambda: diagram_document(diagram), as_json, lambda: _print_diagram(diagram, varied.value(model)), out)


def _shown(varied: Axis, value: float) -> str:
    """Write a value in the unit in which people usually say it."""
    return f"{varied.field.in_usual_unit(value):.10g} {varied.field.usual_unit}".rstrip()


def _print_diagram(diagram: Diagram, present: float) -> None:
    from carom.base.results import table_of
    from carom.bifurcations.documents import POINT
    from carom.cli.screen import print_table

    screen = console()
    ends = " to ".join(_shown(diagram.axis, value) for value in diagram.interval)
    now = _shown(diagram.axis, present)
    screen.print(f"Bifurcations over {diagram.axis.field.words}, {ends}; now {now}")
    exact = diagram.model.has_closed_forms
    if diagram.points:
        styles = ["" if point.admissible else "dim" for point in diagram.points]
        print_table(screen, "", *table_of(POINT, diagram.points, diagram), styles=styles)
    else:
        screen.print("No bifurcation in this range." if exact else "No bifurcation was found in this range.")
    if not exact:
        levitates = diagram.equilibria[0].admissible & diagram.equilibria[0].stable
        share = "all" if levitates.all() else "some" if levitates.any() else "none"
        screen.print(f"Levitation is possible at {share} of the {len(levitates)} values examined.")
    for branch in diagram.orbits:
        screen.print(f"Branch {branch.names[0]} to {branch.names[-1]}, ends: {branch.stops[0]}, {branch.stops[1]}")
    for several in diagram.several:
        screen.print(f"Branch {several.name} ({several.word}), ends: {several.stops[0]}, {several.stops[1]}")
    if diagram.search is not None:
        screen.print(f"Searched at several values of the parameter; counts are totals. {diagram.search.words}")
