"""``carom prove``: theorems about a machine, and the check of certificates."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from carom.cli.terminal import AsJson, Settings, check_output, console, print_document, progress
from carom.outcome import InputError, shown

if TYPE_CHECKING:
    from carom.progress import Reporter
    from carom.proofs import Claim, Proof

CERTIFICATE, CELLS = "proof.json", "cells.json"
"""Names of the certificate, and of the cells of kicks found so far, in the directory given."""


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
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="Prove points and orbits along a parameter instead, --from A --to B; with --kicks-up-to which kicks come back for all its "
            "values, or for all of a box if all three are given two or three times.",
        ),
    ] = None,
    start: Annotated[
        list[str] | None,
        typer.Option("--from", metavar="A", help="First value of the parameter, dimensionless or with a unit."),
    ] = None,
    stop: Annotated[list[str] | None, typer.Option("--to", metavar="B", help="Last value of the parameter.")] = None,
    kicks_up_to: Annotated[
        str | None,
        typer.Option(metavar="SPEED", help="Prove instead which kicks out of levitation up to SPEED come back."),
    ] = None,
    states_up_to: Annotated[
        str | None,
        typer.Option(metavar="SPEED", help="Prove instead that all states inside the clearance up to SPEED come back."),
    ] = None,
    most_impacts: Annotated[
        int | None, typer.Option(metavar="N", help="Leave kicks open that may have more than N impacts; by default 12.")
    ] = None,
    time_limit: Annotated[
        str | None,
        typer.Option(metavar="T", help="End the search after T, such as '2 h'; with --kicks-up-to by default 10 min."),
    ] = None,
    out: Annotated[
        str | None, typer.Option(metavar="DIR", help=f"Write the certificate, {CERTIFICATE}, to this directory.")
    ] = None,
    check: Annotated[
        str | None, typer.Option(metavar="FILE", help="Verify a certificate instead; no machine file is needed.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Prove equilibria and all orbits with one impact a period, in ball arithmetic; or along a parameter; or what comes back.

    The numbers of the machine file are taken exactly as they are written. Each claim is proven, refuted or undecided, with the
    reason. A certificate can be verified by itself, without any search. Needs the extra carom[proof].
    """
    with progress("loading") as tell:
        from carom.proofs import check as verify
        from carom.proofs import prove as prove_machine
        from carom.proofs import prove_states

        if check is not None:
            others = (machine, longest_period, out, kicks_up_to, states_up_to, most_impacts, time_limit)
            if settings or along or start or stop or impacts != 1 or any(other is not None for other in others):
                raise InputError("--check", shown(check), "must stand alone: a certificate holds its machine")
            proof = verify(check, progress=tell)
        elif machine is None:
            raise InputError("MACHINE.toml", None, "give a machine file, or a certificate with --check")
        elif kicks_up_to is not None:
            if impacts != 1 or longest_period is not None or states_up_to is not None:
                raise InputError(
                    "--kicks-up-to", shown(kicks_up_to), "cannot be combined with options of other theorems"
                )
            box = _intervals(along, start, stop)
            proof = _prove_kicks(machine, kicks_up_to, settings or (), box, most_impacts, time_limit, out, tell)
        else:
            if most_impacts is not None or (time_limit is not None and not along):
                raise InputError(
                    "--kicks-up-to", None, "is needed by --most-impacts, and by --time-limit without --along"
                )
            box = _intervals(along, start, stop)
            check_output(out)
            if states_up_to is not None:
                if impacts != 1 or longest_period is not None or box or time_limit is not None:
                    raise InputError(
                        "--states-up-to", shown(states_up_to), "cannot be combined with options of other theorems"
                    )
                proof = prove_states(machine, states_up_to, settings or (), progress=tell)
            else:
                if len(box) > 1:
                    raise InputError("--along", shown(list(box)), "must be one parameter, but with --kicks-up-to")
                name, interval = next(iter(box.items()), (None, None))
                proof = prove_machine(
                    machine,
                    settings or (),
                    longest_period=longest_period,
                    impacts=impacts,
                    along=name,
                    interval=interval,
                    time_limit=time_limit,
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


def _intervals(along: list[str] | None, start: list[str] | None, stop: list[str] | None) -> dict[str, tuple[str, str]]:
    """Both ends of the values of each parameter that was asked for."""
    from carom.cli.starts import check_exact

    names, starts, stops = along or [], start or [], stop or []
    if not len(names) == len(starts) == len(stops):
        raise InputError("--along", shown(names or None), "needs --from and --to, and these need --along")
    if len(set(names)) < len(names):
        raise InputError("--along", shown(names), "names each parameter once")
    for name, first, last in zip(names, starts, stops, strict=True):
        for option, end in (("--from", first), ("--to", last)):
            check_exact(option, end, name)
    return {name: (first, last) for name, first, last in zip(names, starts, stops, strict=True)}


def _prove_kicks(
    machine: str,
    kicks_up_to: str,
    settings: Iterable[str],
    box: dict[str, tuple[str, str]],
    most_impacts: int | None,
    time_limit: str | None,
    out: str | None,
    tell: Reporter,
) -> Proof:
    """Prove kicks; with a directory go on from the cells in it."""
    from carom.proofs import prove_kicks

    check_output(out)
    if out is not None:
        Path(out).mkdir(parents=True, exist_ok=True)
    limits = {"most_impacts": most_impacts, "time_limit": time_limit}
    given = {name: value for name, value in limits.items() if value is not None}
    store = None if out is None else Path(out) / CELLS
    return prove_kicks(machine, kicks_up_to, settings, along=box or None, store=store, progress=tell, **given)  # type: ignore[arg-type]


def _print_proof(proof: Proof, checked: bool) -> None:
    """Print all claims, and what is not claimed."""
    from carom.cli.fitting import fitted, plain_table

    screen = console()
    table = plain_table("Claims", "of", "claim", "status", "number, or reason")
    for claim in proof:
        table.add_row(claim.about, claim.kind, claim.status, claim.reason or _number(claim))
    screen.print(fitted(screen, table))
    for claim in proof:
        if claim.about == "kicks" and claim.status == "proven":
            screen.print(claim.statement)
    how = "Verified from the certificate alone" if checked else "Proven"
    screen.print(f"{how}, with balls of {proof.bits} bits. Exactly assumed: {_assumed(proof)}.")
    screen.print("Not claimed:")
    for words in proof.not_claimed:
        screen.print(f"- {words}")


def _number(claim: Claim) -> str:
    return ", ".join(f"{name.replace('_', ' ')} {entry.short}" for name, entry in claim.enclosures.items())


def _assumed(proof: Proof) -> str:
    moved = (
        [proof.options["along"]] if "along" in proof.options else [name for name, *_ in proof.options.get("box", ())]
    )
    return ", ".join(f"{name} {'from' if name in moved else '='} {text}" for name, text in proof.assumed.items())
