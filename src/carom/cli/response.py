"""``carom response``: amplitude and phase over the speed of the shaft."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.base.outcome import STEADY_WORDS, InputError
from carom.cli import options
from carom.cli.options import option
from carom.cli.output import hand_over, write_output
from carom.cli.terminal import check_output, console, progress, read_machine

if TYPE_CHECKING:
    from rich.console import Console

    from carom.disturbances.echo import Echo
    from carom.parameters import Case
    from carom.studies import UnbalanceResponse


FROM = option(
    "SPEED", "Lowest speed, such as '500 rpm'; by default a range around critical and present speed.", "--from"
)
TO = option("SPEED", "Highest speed, such as '12000 rpm'.", "--to")
OPERATING = option(
    "A,B", "Lowest and highest operating speed, for the separation margin; by default the present speed."
)


def response(
    machine: str = options.MACHINE,
    settings: list[str] | None = options.SETTINGS,
    start: str | None = FROM,
    end: str | None = TO,
    operating: str | None = OPERATING,
    out: str | None = options.OUT,
    as_json: bool = options.AS_JSON,
) -> None:
    """Show the response to the unbalance over speed: amplitude, phase, critical speed, and where the rotor touches.

    Of any machine, at each touchdown bearing, with the static sag and the speeds at which the magnetic bearings saturate.  Compared with the vibration limit and the
    separation margin of API 617 and the zones of ISO 14839-2.  Where the rotor touches, the synchronous rubs that are possible are shown too.  Stiffness
    and damping are the same at every speed.
    """
    case = read_machine(machine, settings)
    interval, run = _read(case, start, end, operating)
    check_output(out)
    with progress("response over speed") as tell:
        from carom.disturbances.echo import echo_of_unbalance
        from carom.models import rotor_of
        from carom.studies.response import unbalance_response

        found = unbalance_response(case, interval, operating=run)
        tell(0.3, "response over speed")
        echo = echo_of_unbalance(rotor_of(case).value("rho"), found.interval, found.scales)
        document = {"disturbance": echo.document(found.scales)} | found.to_dict() if as_json or out is not None else {}
        write_output(out, case, "response", document, {"response": found.plot}, tell=tell.part(0.4, 1.0))
    hand_over(out, document, as_json, lambda: _print(found, echo, out))


def _read(
    case: Case, start: str | None, end: str | None, operating: str | None
) -> tuple[tuple[float, float] | None, tuple[float, float] | None]:
    """Read both ranges, and refuse a machine without a speed."""
    from carom.cli.starts import read_ends, read_range
    from carom.models import axis

    if case.parameters.scales is None:
        allowed = "must hold a [machine] or a [rotor] table: without mass and clearance in SI units no speed is known"
        raise InputError("machine file", case.name, allowed)
    along = axis(case, "speed")
    if (start is None) != (end is None):
        option, given = ("--to", start) if end is None else ("--from", end)
        raise InputError(option, None, f"give both --from and --to, or none of them (the other one is {given})")
    interval = None
    if start is not None and end is not None:
        interval = read_ends(start, end, along)
    return interval, None if operating is None else read_range("--operating", operating, along)


def _print(found: UnbalanceResponse, echo: Echo, out: str | None) -> None:
    from carom.cli.fitting import print_table
    from carom.studies.wording import rpm

    screen = console()
    screen.print(f"{found.case.name}: response to the unbalance")
    screen.print(f"{echo.words}.")
    screen.print()
    for sentence in found.words:
        screen.print(sentence)
    screen.print()
    _print_bearings(screen, found)
    columns, rows = ("from", "to", STEADY_WORDS["contact-free"], f"{STEADY_WORDS['rub']}s", STEADY_WORDS["rolling"]), []
    for stretch in found.stretches:
        steady = stretch.what
        kinds = {"stable": steady.stable_rubs, "unstable": steady.unstable_rubs}
        rubs = ", ".join(f"{count} {kind}" for kind, count in kinds.items() if count) or "none"
        rubs = "not known" if steady.stable_rubs is None else rubs
        free = "possible" if steady.contact_free else "virtual: the rotor touches"
        rolls = "not known" if steady.rolls is None else "holds" if steady.rolls else "does not hold"
        rows.append((rpm(stretch.low), rpm(stretch.high), free, rubs, rolls))
    print_table(screen, "Steady motions over speed", columns, rows)
    if out is None:
        screen.print("Figure and response.json: add --out DIR")


def _print_bearings(screen: Console, found: UnbalanceResponse) -> None:
    """Print the whirl at each touchdown bearing at the present speed."""
    import numpy as np

    from carom.cli.fitting import print_table
    from carom.parameters.formats import number
    from carom.studies.wording import micrometres, rpm

    now = found.now
    columns = ("touchdown bearing", "amplitude, 0-to-peak", "forward", "backward", "sag", "share of clearance", "lag")
    rows = []
    parts = (now.touchdowns.major, np.abs(now.touchdowns.forward), np.abs(now.touchdowns.backward))
    for place in range(len(now.clearances)):
        sizes = (micrometres(float(each[0, place])) for each in parts)
        share = f"{number(100.0 * float(now.reach[0, place]), 3)} %"
        lag = f"{number(float(np.degrees(now.lags[0, place])), 3)}°"
        rows.append((str(place + 1), *sizes, micrometres(float(now.sags[place])), share, lag))
    print_table(screen, f"At {rpm(found.present)}", columns, rows)
