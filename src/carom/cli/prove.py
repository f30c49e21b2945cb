"""``carom prove``: theorems about a machine, and the check of certificates."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from carom.cli.proof_options import (
    CELLS,
    CERTIFICATE,
    Along,
    Check,
    File,
    From,
    Impacts,
    KicksUpTo,
    LongestPeriod,
    MostImpacts,
    Out,
    ShocksUpTo,
    StatesUpTo,
    TimeLimit,
    To,
    UnbalanceUpTo,
)
from carom.cli.terminal import AsJson, Settings, check_output, console, print_document, progress
from carom.outcome import InputError, shown

if TYPE_CHECKING:
    from carom.progress import Reporter
    from carom.proofs import Claim, Proof

KICKS, SHOCKS, STEPS, STATES = "--kicks-up-to", "--shocks-up-to", "--unbalance-up-to", "--states-up-to"
"""Options of theorems about what comes back."""
DRAWN = "kicks"
"""Theorem that has a figure."""
PICTURE, SAMPLED = "proven-kicks", (160, 160)
"""Name of the figure of kicks, and in how many of them the basin below it is sampled."""
_DRAWING = 0.95
"""Share of the bar after which it is drawn."""


def prove(
    machine: File = None,
    settings: Settings = None,
    longest_period: LongestPeriod = None,
    impacts: Impacts = 1,
    along: Along = None,
    start: From = None,
    stop: To = None,
    kicks_up_to: KicksUpTo = None,
    shocks_up_to: ShocksUpTo = None,
    unbalance_up_to: UnbalanceUpTo = None,
    states_up_to: StatesUpTo = None,
    most_impacts: MostImpacts = None,
    time_limit: TimeLimit = None,
    out: Out = None,
    check: Check = None,
    as_json: AsJson = False,
) -> None:
    """Prove equilibria and all orbits with one impact a period, in ball arithmetic; or along a parameter; or what comes back.

    The numbers of the machine file are taken exactly as they are written. Each claim is proven, refuted or undecided, with the
    reason. A certificate can be verified by itself, without any search. Needs the extra carom[proof].
    """
    sizes = {KICKS: kicks_up_to, SHOCKS: shocks_up_to, STEPS: unbalance_up_to, STATES: states_up_to}
    limits = {"most_impacts": most_impacts, "time_limit": time_limit}
    ranges = {
        "--longest-period": longest_period,
        "--along": along or None,
        "--from": start or None,
        "--to": stop or None,
    }
    with progress("loading") as tell:
        check_output(out)
        part = tell.part(0.0, _DRAWING)
        if check is not None:
            others = (machine, *sizes.values(), *limits.values(), *ranges.values())
            if settings or impacts != 1 or any(other is not None for other in others):
                raise InputError("--check", shown(check), "must stand alone: a certificate holds its machine")
            proof = _checked(check, out, part)
        elif machine is None:
            raise InputError("MACHINE.toml", None, "give a machine file, or a certificate with --check")
        elif asked := [option for option, size in sizes.items() if size is not None]:
            refused = [longest_period] if asked == [KICKS] else [*ranges.values()]
            if len(asked) > 1 or impacts != 1 or any(other is not None for other in refused):
                raise InputError(asked[0], shown(sizes[asked[0]]), "cannot be combined with options of other theorems")
            box = _intervals(along, start, stop)
            proof = _prove_return(machine, asked[0], sizes[asked[0]] or "", settings or (), limits, box, out, part)
        else:
            box = _intervals(along, start, stop)
            _refuse_limits({**limits, "time_limit": None})
            if len(box) > 1:
                raise InputError("--along", shown(list(box)), "must be one parameter, but with --kicks-up-to")
            proof = _prove_motions(machine, settings or (), longest_period, impacts, box, time_limit, part)
        if out is not None:
            _write(proof, Path(out), None if check else machine, tell)
    if as_json:
        print_document(proof.document())
        return
    _print_proof(proof, checked=check is not None)
    if check is None and out is not None:
        console().print(f"Certificate: {Path(out) / CERTIFICATE}", soft_wrap=True)
    if out is not None and proof.theorem == DRAWN:
        console().print(f"Figure: {_picture(Path(out))}.svg", soft_wrap=True)


def _checked(check: str, out: str | None, tell: Reporter) -> Proof:
    """Verify a certificate; only of kicks there is something to write."""
    from carom.proofs import check as verify

    proof = verify(check, progress=tell)
    if out is not None and proof.theorem != DRAWN:
        raise InputError("--out", shown(out), "allowed with --check only for a proof of kicks, which has a figure")
    return proof


def _refuse_limits(limits: dict[str, Any]) -> None:
    """Refuse limits of a search through cells where there is none."""
    if any(limit is not None for limit in limits.values()):
        told = f"or {SHOCKS} or {STEPS} is needed by --most-impacts"
        raise InputError(KICKS, None, told)


def _prove_motions(
    machine: str,
    settings: Iterable[str],
    longest_period: str | None,
    impacts: int,
    box: dict[str, tuple[str, str]],
    time_limit: str | None,
    tell: Reporter,
) -> Proof:
    """Prove equilibria and orbits, of one machine or along a parameter."""
    from carom.proofs import prove as prove_machine

    along, interval = next(iter(box.items()), (None, None))
    return prove_machine(
        machine,
        settings,
        longest_period=longest_period,
        impacts=impacts,
        along=along,
        interval=interval,
        time_limit=time_limit,
        progress=tell,
    )


def _prove_return(
    machine: str,
    option: str,
    largest: str,
    settings: Iterable[str],
    limits: dict[str, Any],
    box: dict[str, tuple[str, str]],
    out: str | None,
    tell: Reporter,
) -> Proof:
    """Prove what returns to levitation, of kicks for all machines of a box; of cells, with a directory go on from those in it."""
    from carom.proofs import prove_kicks, prove_shocks, prove_states, prove_unbalance_steps

    if option == STATES:
        _refuse_limits(limits)
        return prove_states(machine, largest, settings, progress=tell)
    store = None if out is None else Path(out) / CELLS
    if out is not None:
        Path(out).mkdir(parents=True, exist_ok=True)
    given: dict[str, Any] = {name: value for name, value in limits.items() if value is not None}
    given |= {"along": box} if box else {}
    search: Any = {KICKS: prove_kicks, SHOCKS: prove_shocks, STEPS: prove_unbalance_steps}[option]
    return search(machine, largest, settings, store=store, progress=tell, **given)


def _write(proof: Proof, directory: Path, machine: str | None, tell: Reporter) -> None:
    """Write the certificate, unless it is what was checked, and the figure of kicks."""
    directory.mkdir(parents=True, exist_ok=True)
    if machine is not None:
        proof.save(directory / CERTIFICATE)
    if proof.theorem == DRAWN:
        tell(_DRAWING, "drawing")
        _draw(proof, Path(machine or "certificate").stem, directory)


def _picture(directory: Path) -> Path:
    """The figure of kicks, without its endings."""
    from carom.files.directory import FIGURES

    return directory / FIGURES / PICTURE


def _draw(proof: Proof, name: str, directory: Path) -> None:
    """Write the figure of a proof of kicks, over the basin that simulation finds."""
    from carom import plots
    from carom.basins import map_cells
    from carom.disturbances import Grid, KickPlane
    from carom.parameters.told import number
    from carom.proofs import ProvenKicks

    kicks, given = ProvenKicks.of(proof), {**proof.hypotheses.values, **proof.hypotheses.settings}
    if proof.hypotheses.table == "machine":
        told = [f"{key} {given[key].removeprefix('double ')}" for key in ("damping", "stiffness", "speed")]
    else:
        told = [f"{key} {number(value)}" for key, value in kicks.rotor.parameters.as_dict().items()]
    basin = map_cells(kicks.rotor, Grid(KickPlane(kicks.largest), SAMPLED))
    with plots.heading(f"{name}: {', '.join(told)}"):
        plots.save(kicks.plot(basin), _picture(directory))


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


def _print_proof(proof: Proof, checked: bool) -> None:
    """Print all claims, and what is not claimed."""
    from carom.cli.fitting import fitted, plain_table
    from carom.proofs.levitation_claims import THEOREM

    screen = console()
    table = plain_table("Claims", "of", "claim", "status", "number, or reason")
    for claim in proof:
        table.add_row(claim.about, claim.kind, claim.status, claim.reason or _number(claim))
    screen.print(fitted(screen, table))
    for claim in proof:
        if (claim.about == "kicks" or proof.theorem == THEOREM) and claim.status == "proven":
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
