"""``carom prove``: theorems about a machine, and the check of certificates."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from carom.base.outcome import InputError, shown
from carom.cli import options
from carom.cli.options import option
from carom.cli.terminal import check_output, console, hand_over, progress

if TYPE_CHECKING:
    from carom.base.progress import Reporter
    from carom.proofs import Proof

CERTIFICATE = "proof.json"
"""Name of the certificate in the directory given."""
DRAWN = "kicks"
"""Theorem that has a figure."""
PICTURE = "figures/proven-kicks"
_DRAWING = 0.95
"""Share of the bar after which it is drawn."""
_RANGE = ("--along", "--from", "--to")
_ALLOWED = {
    "": ("--impacts", *_RANGE, "--time-limit"),
    "--kicks-up-to": (*_RANGE, "--most-impacts", "--time-limit"),
    "--shocks-up-to": ("--most-impacts", "--time-limit"),
    "--unbalance-up-to": ("--most-impacts", "--time-limit"),
    "--states-up-to": (),
}
"""Options of theorems about what comes back, and what may stand beside each; first of those about equilibria and orbits."""

FILE = typer.Argument(None, metavar="[MACHINE.toml]", help="The machine file.")
IMPACTS = option(
    "N", "Prove orbits with at most N impacts a period (those with several only as a search finds them); 1 by default."
)
ALONG = option(
    "NAME",
    "Prove points and orbits along a parameter instead, --from A --to B; with --kicks-up-to which kicks come back for all its values, or for "
    "all of a box if all three are given two or three times.",
)
FROM = option("A", "First value of the parameter, dimensionless or with a unit.", "--from")
TO = option("B", "Last value of the parameter.", "--to")
KICKS = option("SPEED", "Prove instead which kicks of the levitating rotor up to SPEED come back.")
SHOCKS = option(
    "PEAK,TIME",
    "Prove instead which half-sine base shocks with peaks up to PEAK come back, such as '20 g, 0.5 ms'.",
)
STEPS = option(
    "CHANGE",
    "Prove instead which step changes of unbalance up to CHANGE come back, such as '20 um' or '500 g mm'.",
)
STATES = option("SPEED", "Prove instead that all states inside the clearance with speeds up to SPEED come back.")
MOST_IMPACTS = option("N", "Leave cases undecided that may take more than N impacts; 12 by default.")
TIME_LIMIT = option("T", "End the search after T, such as '2 h'; 10 min by default, unlimited with --along.")
OUT = option(
    "DIR",
    f"Write the certificate, {CERTIFICATE}, to this directory, and for kicks the figure; with --check only the figure.",
)
CHECK = option("FILE", "Verify a certificate instead; no machine file is needed.")


def prove(
    machine: str | None = FILE,
    settings: list[str] | None = options.SETTINGS,
    impacts: int | None = IMPACTS,
    along: list[str] | None = ALONG,
    start: list[str] | None = FROM,
    stop: list[str] | None = TO,
    kicks_up_to: str | None = KICKS,
    shocks_up_to: str | None = SHOCKS,
    unbalance_up_to: str | None = STEPS,
    states_up_to: str | None = STATES,
    most_impacts: int | None = MOST_IMPACTS,
    time_limit: str | None = TIME_LIMIT,
    out: str | None = OUT,
    check: str | None = CHECK,
    as_json: bool = options.AS_JSON,
) -> None:
    """Prove equilibria and orbits, at one point or along a parameter, or which disturbances come back.

    Proofs use ball arithmetic and take the numbers of the machine file exactly as written. Each claim is proven, refuted or
    undecided, with the reason. A certificate can be checked by itself, without repeating the search. Needs the extra carom[proof].
    """
    theorems = dict(zip(list(_ALLOWED)[1:], (kicks_up_to, shocks_up_to, unbalance_up_to, states_up_to), strict=True))
    sizes = {name: size for name, size in theorems.items() if size is not None}
    others = ("--impacts", *_RANGE, "--most-impacts", "--time-limit")
    values = (impacts, along, start, stop, most_impacts, time_limit)
    given = {name: value for name, value in zip(others, values, strict=True) if value not in (None, [], ())}
    with progress("loading") as tell:
        check_output(out)
        part = tell.part(0.0, _DRAWING)
        if check is not None:
            if machine is not None or settings or sizes or given:
                raise InputError("--check", shown(check), "must be given alone: a certificate contains its machine")
            from carom.proofs import check as verify

            proof = verify(check, progress=part)
            if out is not None and proof.theorem != DRAWN:
                allowed = "allowed with --check only for a proof of kicks, which has a figure"
                raise InputError("--out", shown(out), allowed)
        elif machine is None:
            raise InputError("MACHINE.toml", None, "give a machine file, or a certificate with --check")
        else:
            theorem = next(iter(sizes), "")
            for name, value in [*list(sizes.items())[1:], *given.items()]:
                if name not in _ALLOWED[theorem]:
                    beside = theorem or "theorems about equilibria and orbits"
                    raise InputError(name, shown(value), f"cannot be combined with {beside}")
            proof = _proven(machine, settings or (), theorem, sizes.get(theorem, ""), given, part)
        if out is not None:
            _write(proof, Path(out), None if check else machine, tell)
    files = [] if check else [f"Certificate: {Path(out or '') / CERTIFICATE}"]
    files += [f"Figure: {Path(out or '') / PICTURE}.svg"] * (proof.theorem == DRAWN)
    hand_over(proof.document, as_json, lambda: _print_proof(proof, checked=check is not None), out, *files)


def _proven(
    machine: str, settings: Iterable[str], theorem: str, size: str, given: dict[str, Any], tell: Reporter
) -> Proof:
    """Prove a theorem."""
    from carom import proofs

    box = _intervals(*(given.pop(name, None) for name in _RANGE))
    more = {name.removeprefix("--").replace("-", "_"): value for name, value in given.items()}
    if not theorem:
        if len(box) > 1:
            allowed = "must be one parameter; several are allowed only with --kicks-up-to"
            raise InputError("--along", shown(list(box)), allowed)
        along, interval = next(iter(box.items()), (None, None))
        return proofs.prove(machine, settings, along=along, interval=interval, progress=tell, **more)
    if box:
        more["along"] = box
    searches: dict[str, Callable[..., Proof]] = {
        "--kicks-up-to": proofs.prove_kicks,
        "--shocks-up-to": proofs.prove_shocks,
        "--unbalance-up-to": proofs.prove_unbalance_steps,
        "--states-up-to": proofs.prove_states,
    }
    proof: Proof = searches[theorem](machine, size, settings, progress=tell, **more)
    return proof


def _write(proof: Proof, directory: Path, machine: str | None, tell: Reporter) -> None:
    """Write the certificate, unless it is what was checked, and the figure of kicks."""
    directory.mkdir(parents=True, exist_ok=True)
    if machine is not None:
        proof.save(directory / CERTIFICATE)
    if proof.theorem == DRAWN:
        tell(_DRAWING, "drawing")
        _draw(proof, Path(machine or "certificate").stem, directory)


def _draw(proof: Proof, name: str, directory: Path) -> None:
    """Write the figure of a proof of kicks."""
    from carom import plots
    from carom.parameters.formats import number
    from carom.proofs import ProvenKicks

    kicks, given = ProvenKicks.of(proof), {**proof.hypotheses.values, **proof.hypotheses.settings}
    if proof.hypotheses.table == "machine":
        stated = [f"{key} {given[key].removeprefix('double ')}" for key in ("damping", "stiffness", "speed")]
    else:
        stated = [f"{key} {number(value)}" for key, value in kicks.rotor.parameters.as_dict().items()]
    with plots.heading(f"{name}: {', '.join(stated)}"):
        plots.save(kicks.plot(), directory / PICTURE)


def _intervals(along: list[str] | None, start: list[str] | None, stop: list[str] | None) -> dict[str, tuple[str, str]]:
    """Both ends of the values of each parameter that was asked for."""
    from carom.cli.starts import check_exact

    names, starts, stops = along or [], start or [], stop or []
    if not len(names) == len(starts) == len(stops):
        raise InputError("--along", shown(names or None), "needs --from and --to, and these need --along")
    if len(set(names)) < len(names):
        raise InputError("--along", shown(names), "must name each parameter once")
    for name, first, last in zip(names, starts, stops, strict=True):
        check_exact("--from", first, name)
        check_exact("--to", last, name)
    return dict(zip(names, zip(starts, stops, strict=True), strict=True))


def _print_proof(proof: Proof, checked: bool) -> None:
    """Print the theorem, all claims, and what is not claimed."""
    from carom.cli.screen import print_table
    from carom.proofs.headlines import chief_of, headline, numbers_of, scales_of
    from carom.proofs.levitation_claims import THEOREM

    screen, chief, scales = console(), chief_of(proof), scales_of(proof)
    screen.print(headline(proof), style="bold")
    screen.print()
    rows = [(claim.about, claim.kind, claim.status, claim.reason or numbers_of(claim, scales)) for claim in proof]
    print_table(screen, "Claims", ("about", "claim", "status", "value or reason"), rows)
    for claim in proof:
        if (claim.about == "kicks" or proof.theorem == THEOREM) and claim.status == "proven" and claim is not chief:
            screen.print(claim.statement)
    how = "Verified from the certificate alone" if checked else "Proven"
    screen.print(f"{how}, in {proof.bits}-bit ball arithmetic. Assumed exactly as written: {_assumed(proof)}.")
    screen.print("Not proven:")
    for words in proof.not_claimed:
        screen.print(f"- {words}")


def _assumed(proof: Proof) -> str:
    moved = [proof.options.get("along"), *(name for name, *_ in proof.options.get("box", ()))]
    return ", ".join(f"{name} {'from' if name in moved else '='} {text}" for name, text in proof.assumed.items())
