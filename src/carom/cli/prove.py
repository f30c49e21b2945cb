"""``carom prove``: theorems about a machine, and the check of certificates."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from carom.cli.terminal import AsJson, Settings, check_output, console, print_document, progress
from carom.outcome import InputError, shown

if TYPE_CHECKING:
    from carom.proofs import Claim, Proof

CERTIFICATE = "proof.json"
"""Name of the certificate in the directory given."""


def prove(
    machine: Annotated[str | None, typer.Argument(metavar="[MACHINE.toml]", help="The machine file.")] = None,
    settings: Settings = None,
    longest_period: Annotated[
        str | None, typer.Option(metavar="T", help="Look only for periods up to T, in 1/Omega; by default for all.")
    ] = None,
    impacts: Annotated[
        int,
        typer.Option(
            metavar="N", help="Prove orbits with at most N impacts a period, those with several that a search finds."
        ),
    ] = 1,
    along: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Prove points and orbits along a parameter instead, --from A --to B."),
    ] = None,
    start: Annotated[
        str | None,
        typer.Option("--from", metavar="A", help="First value of the parameter, dimensionless or with a unit."),
    ] = None,
    stop: Annotated[str | None, typer.Option("--to", metavar="B", help="Last value of the parameter.")] = None,
    out: Annotated[
        str | None, typer.Option(metavar="DIR", help=f"Write the certificate, {CERTIFICATE}, to this directory.")
    ] = None,
    check: Annotated[
        str | None, typer.Option(metavar="FILE", help="Verify a certificate instead; no machine file is needed.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Prove equilibria and all orbits with one impact a period, in ball arithmetic; or along a parameter.

    The numbers of the machine file are taken exactly as they are written. Each claim is proven, refuted or undecided, with the
    reason. A certificate can be verified by itself, without any search. Needs the extra carom[proof].
    """
    with progress("loading") as tell:
        from carom.cli.starts import check_exact
        from carom.proofs import check as verify
        from carom.proofs import prove as prove_machine

        if check is not None:
            others = (machine, longest_period, out, along, start, stop)
            if settings or impacts != 1 or any(other is not None for other in others):
                raise InputError("--check", shown(check), "must stand alone: a certificate holds its machine")
            proof = verify(check, progress=tell)
        elif machine is None:
            raise InputError("MACHINE.toml", None, "give a machine file, or a certificate with --check")
        else:
            if (start is None or stop is None) and not (along is start is stop is None):
                raise InputError("--along", shown(along), "needs --from and --to, and these need --along")
            check_output(out)
            interval = None if start is None or stop is None else (start, stop)
            for option, end in zip(("--from", "--to"), interval or (), strict=False):
                check_exact(option, end, str(along))
            proof = prove_machine(
                machine,
                settings or (),
                longest_period=longest_period,
                impacts=impacts,
                along=along,
                interval=interval,
                progress=tell,
            )
    if out is not None:
        directory = Path(out)
        directory.mkdir(parents=True, exist_ok=True)
        proof.save(directory / CERTIFICATE)
    if as_json:
        print_document(proof.document())
        return
    _print_proof(proof, checked=check is not None)
    if out is not None:
        console().print(f"Certificate: {Path(out) / CERTIFICATE}", soft_wrap=True)


def _print_proof(proof: Proof, checked: bool) -> None:
    """Print all claims, and what is not claimed."""
    from carom.cli.fitting import fitted, plain_table

    screen = console()
    table = plain_table("Claims", "of", "claim", "status", "number, or reason")
    for claim in proof:
        table.add_row(claim.about, claim.kind, claim.status, claim.reason or _number(claim))
    screen.print(fitted(screen, table))
    how = "Verified from the certificate alone" if checked else "Proven"
    screen.print(f"{how}, with balls of {proof.bits} bits. Exactly assumed: {_assumed(proof)}.")
    screen.print("Not claimed:")
    for words in proof.not_claimed:
        screen.print(f"- {words}")


def _number(claim: Claim) -> str:
    return ", ".join(f"{name.replace('_', ' ')} {entry.short}" for name, entry in claim.enclosures.items())


def _assumed(proof: Proof) -> str:
    given = {**proof.hypotheses.values, **proof.hypotheses.settings}
    told = {name: f"{name} = {text}" for name, text in given.items()}
    along = proof.options.get("along")
    if along is not None:
        # Its own value in the machine file is not assumed.
        told[along] = f"{along} from {proof.options['from']} to {proof.options['to']}"
    return ", ".join(told.values())
