"""The options of ``carom prove``."""

from __future__ import annotations

from typing import Annotated

import typer

CERTIFICATE, CELLS = "proof.json", "cells.json"
"""Names of the certificate, and of the cells of kicks found so far, in the directory given."""

File = Annotated[str | None, typer.Argument(metavar="[MACHINE.toml]", help="The machine file.")]
LongestPeriod = Annotated[
    str | None, typer.Option(metavar="T", help="Look only for periods up to T, in 1/Omega; by default for all.")
]
Impacts = Annotated[
    int,
    typer.Option(
        metavar="N", help="Prove orbits with at most N impacts a period, those with several that a search finds."
    ),
]
Along = Annotated[
    list[str] | None,
    typer.Option(
        metavar="NAME",
        help="Prove points and orbits along a parameter instead, --from A --to B; with --kicks-up-to which kicks come back for all its "
        "values, or for all of a box if all three are given two or three times.",
    ),
]
From = Annotated[
    list[str] | None,
    typer.Option("--from", metavar="A", help="First value of the parameter, dimensionless or with a unit."),
]
To = Annotated[list[str] | None, typer.Option("--to", metavar="B", help="Last value of the parameter.")]
KicksUpTo = Annotated[
    str | None,
    typer.Option(metavar="SPEED", help="Prove instead which kicks out of levitation up to SPEED come back."),
]
ShocksUpTo = Annotated[
    str | None,
    typer.Option(
        metavar="PEAK,TIME",
        help="The same of half-sine shocks of the base with peaks up to PEAK, such as '20 g, 0.5 ms'.",
    ),
]
UnbalanceUpTo = Annotated[
    str | None,
    typer.Option(
        metavar="CHANGE",
        help="The same of steps to the unbalance of the machine, by changes up to CHANGE, such as '20 um' or '500 g mm'.",
    ),
]
StatesUpTo = Annotated[
    str | None,
    typer.Option(metavar="SPEED", help="Prove instead that all states inside the clearance up to SPEED come back."),
]
MostImpacts = Annotated[
    int | None, typer.Option(metavar="N", help="Leave open what may have more than N impacts; by default 12.")
]
TimeLimit = Annotated[
    str | None,
    typer.Option(
        metavar="T", help="End the search after T, such as '2 h'; by default 10 min, along a parameter never."
    ),
]
Out = Annotated[
    str | None,
    typer.Option(
        metavar="DIR",
        help=f"Write the certificate, {CERTIFICATE}, to this directory, and of kicks the figure; with --check the figure alone.",
    ),
]
Check = Annotated[
    str | None, typer.Option(metavar="FILE", help="Verify a certificate instead; no machine file is needed.")
]
