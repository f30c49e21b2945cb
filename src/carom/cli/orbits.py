"""``carom orbits``: equilibria and periodic orbits."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from carom.cli.terminal import AsJson, MachineFile, Settings, console, print_document, progress
from carom.outcome import InputError

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
        typer.Option(
            metavar="N",
            min=1,
            help="List orbits with at most N impacts a period, with lasting contact too; those with several are searched.",
        ),
    ] = None,
    guesses: Annotated[
        int | None,
        typer.Option(
            metavar="N",
            min=1,
            help="Guesses of that search for each number of impacts; 1500 by default, fewer for a rotor of many states.",
        ),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """List equilibria and periodic orbits, stable or not.

    Lists all orbits with one impact a period, with the argument that there are no more, of a flexible machine the steady motions; or, with --impacts N, the
    orbits with at most N impacts that are known or that a search finds, with what it tried.
    """
    from carom.loading import load
    from carom.models import rotor_of

    case = load(machine, settings or ())
    if impacts is not None:
        _search(case, impacts, guesses, as_json)
        return
    model = rotor_of(case)
    model.system.refuse_non_stationary()
    if not model.has_closed_forms:
        _print_steady(case, longest_period, as_json)
        return
    longest = None
    if longest_period is not None:
        from carom.cli.starts import read_time

        longest = read_time(longest_period, case.parameters.scales, "--longest-period")
    with progress("equilibria and periodic orbits (the kernels are compiled on first use)") as tell:
        from carom.closed_forms.equilibria import find_equilibria
        from carom.models import jeffcott
        from carom.orbits.single_impact import find_orbits, orbits_within_reach
        from carom.studies import orbits_document

        tell(0.3)
        rotor = jeffcott(case.parameters)
        steady = find_equilibria(rotor).members
        found = orbits_within_reach(rotor) if longest is None else find_orbits(rotor, longest)
    if as_json:
        print_document(orbits_document(case.parameters, steady, found, case.machine))
        return
    from carom.cli.tables import print_orbits

    print_orbits(console(), case, steady, found)


def _print_steady(case: Case, longest_period: str | None, as_json: bool) -> None:
    """Print the steady motions of a flexible machine."""
    from carom.cli.steady import print_steady, steady_document

    if longest_period is not None:
        raise InputError(
            "--longest-period",
            longest_period,
            "allowed only where all orbits with one impact a period have closed forms: a planar rotor on a rigid wall, without weight or limits",
        )
    if as_json:
        print_document(steady_document(case))
        return
    print_steady(console(), case)


def _search(case: Case, impacts: int, guesses: int | None, as_json: bool) -> None:
    """Print the orbits with at most a number of impacts."""
    with progress("orbits (the kernels are compiled on first use)") as tell:
        from carom.orbits.single_impact import find_orbits
        from carom.studies import found_orbits_document

        found = find_orbits(case, impacts=impacts, guesses=guesses, progress=tell)
    if as_json:
        print_document(found_orbits_document(case.parameters, found))
        return
    from carom.cli.tables import print_found_orbits

    print_found_orbits(console(), case, found)
