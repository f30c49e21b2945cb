"""``carom response``: amplitude and phase over the speed of the shaft."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from carom.base.outcome import InputError
from carom.cli import options
from carom.cli.options import option
from carom.cli.terminal import check_output, console, hand_over, progress, read_machine, write_output

if TYPE_CHECKING:
    from carom.disturbances.single import Echo
    from carom.parameters import Case
    from carom.studies import UnbalanceResponse


Interval = tuple[float, float] | None
FROM = option(
    "SPEED", "Lowest speed, such as '500 rpm'; by default a range around the critical and the present speed.", "--from"
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
    """Show the unbalance response over speed: amplitude, phase, critical speeds, and where the rotor touches.

    Shown at each touchdown bearing, with the static sag and the speeds at which the magnetic bearings saturate, and compared with the vibration limit
    and the separation margin of API 617 and the zones of ISO 14839-2.  Where the rotor touches, the possible synchronous rubs are shown too.  Stiffness
    and damping are held constant over speed.
    """
    case = read_machine(machine, settings)
    interval, run = _read(case, start, end, operating)
    check_output(out)
    with progress("unbalance response") as tell:
        from carom.disturbances.single import echo_of_unbalance
        from carom.models import rotor_of
        from carom.studies.response import unbalance_response

        found = unbalance_response(case, interval, operating=run)
        tell(0.3, "unbalance response")
        echo = echo_of_unbalance(rotor_of(case).value("rho"), found.interval, found.scales)
        document = cache(lambda: {"disturbance": echo.document(found.scales)} | found.to_dict())
        write_output(out, case, "response", document, {"response": found.plot}, tell=tell.part(0.4, 1.0))
    hand_over(document, as_json, lambda: _print(found, echo, out), out)


def _read(case: Case, start: str | None, end: str | None, operating: str | None) -> tuple[Interval, Interval]:
    """Read both ranges, and refuse a machine without a speed."""
    from carom.cli.starts import read_ends, read_range
    from carom.models import axis

    if case.parameters.scales is None:
        allowed = "must hold a [machine] or a [rotor] table: speeds need mass and clearance in SI units"
        raise InputError("machine file", case.name, allowed)
    along = axis(case, "speed")
    if (start is None) != (end is None):
        option, given = ("--to", start) if end is None else ("--from", end)
        raise InputError(option, None, f"give both --from and --to, or neither (the other one is {given})")
    interval = None if start is None or end is None else read_ends(start, end, along)
    return interval, None if operating is None else read_range("--operating", operating, along)


def _print(found: UnbalanceResponse, echo: Echo, out: str | None) -> None:
    from carom.base.results import table_of
    from carom.cli.screen import print_table
    from carom.studies.response import BEARING, STRETCH
    from carom.studies.wording import rpm

    screen = console()
    screen.print(f"{found.case.name}: unbalance response")
    screen.print(f"{echo.words}.")
    screen.print()
    for sentence in found.words:
        screen.print(sentence)
    screen.print()
    bearings = range(len(found.now.clearances))
    print_table(screen, f"At {rpm(found.present)}", *table_of(BEARING, bearings, found))
    print_table(screen, "Steady motions over speed", *table_of(STRETCH, found.stretches, found))
    if out is None:
        screen.print("Figure and response.json: add --out DIR")
