"""``carom orbits``: equilibria and periodic orbits."""

from __future__ import annotations

from typing import Annotated

import typer

from carom.cli.terminal import AsJson, MachineFile, Settings, console, print_document, progress


def orbits(
    machine: MachineFile,
    settings: Settings = None,
    longest_period: Annotated[
        str | None,
        typer.Option(metavar="T", help="Search only periods up to T, in 1/Omega or with a unit; by default all."),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """List equilibria and periodic orbits, stable or not.

    Lists all orbits with one impact a period, with the argument that there are no more.
    """
    from carom.parameters import load

    case = load(machine, settings or ())
    longest = None
    if longest_period is not None:
        from carom.cli.starts import read_time

        longest = read_time(longest_period, case.parameters.scales, "--longest-period")
    with progress("equilibria and periodic orbits (the kernels are compiled on first use)"):
        from carom.closed_forms.equilibria import find_equilibria
        from carom.models import Jeffcott
        from carom.orbits.single_impact import find_orbits, orbits_within_reach
        from carom.studies import orbits_document

        rotor = Jeffcott(case.parameters)
        steady = find_equilibria(rotor).members
        found = orbits_within_reach(rotor) if longest is None else find_orbits(rotor, longest)
    if as_json:
        print_document(orbits_document(case.parameters, steady, found, case.machine))
        return
    from carom.cli.tables import print_orbits

    print_orbits(console(), case, steady, found)
