"""``carom orbits``: equilibria and periodic orbits."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from carom.cli.terminal import AsJson, MachineFile, Settings, console, print_document, progress

if TYPE_CHECKING:
    from carom.parameters import Case


def orbits(
    machine: MachineFile,
    settings: Settings = None,
    longest_period: Annotated[
        str | None,
        typer.Option(metavar="T", help="Search only periods up to T, in 1/Omega or with a unit; by default all."),
    ] = None,
    impacts: Annotated[
        int | None,
        typer.Option(metavar="N", min=1, help="Search orbits with N impacts a period instead, from simulated starts."),
    ] = None,
    starts: Annotated[
        int | None, typer.Option(metavar="N", min=1, help="Number of starts of that search; 100 by default.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """List equilibria and periodic orbits, stable or not.

    Lists all orbits with one impact a period, with the argument that there are no more; or, with --impacts, the orbits that a
    search finds, with the number of starts that it tried.
    """
    from carom.parameters import load

    case = load(machine, settings or ())
    if impacts is not None:
        _search(case, impacts, starts, as_json)
        return
    longest = None
    if longest_period is not None:
        from carom.cli.starts import read_time

        longest = read_time(longest_period, case.parameters.scales, "--longest-period")
    with progress("equilibria and periodic orbits (the kernels are compiled on first use)") as tell:
        from carom.closed_forms.equilibria import find_equilibria
        from carom.models import Jeffcott
        from carom.orbits.single_impact import find_orbits, orbits_within_reach
        from carom.studies import orbits_document

        tell(0.3)
        rotor = Jeffcott(case.parameters)
        steady = find_equilibria(rotor).members
        found = orbits_within_reach(rotor) if longest is None else find_orbits(rotor, longest)
    if as_json:
        print_document(orbits_document(case.parameters, steady, found, case.machine))
        return
    from carom.cli.tables import print_orbits

    print_orbits(console(), case, steady, found)


def _search(case: Case, impacts: int, starts: int | None, as_json: bool) -> None:
    """Print the orbits with a number of impacts that a search finds."""
    with progress("orbits (the kernels are compiled on first use)") as tell:
        from carom.orbits.search import STARTS
        from carom.orbits.single_impact import find_orbits
        from carom.studies import found_orbits_document

        found = find_orbits(case, impacts=impacts, starts=STARTS if starts is None else starts, progress=tell)
    if as_json:
        print_document(found_orbits_document(case.parameters, found))
        return
    from carom.cli.tables import print_found_orbits

    print_found_orbits(console(), case, found)
