"""``carom orbits``: equilibria and periodic orbits."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from carom.cli import options
from carom.cli.options import option
from carom.cli.terminal import console, hand_over, progress, read_machine

if TYPE_CHECKING:
    from carom.closed_forms.compliant_walls import SlippingWhirl
    from carom.models import Rotor

LONGEST_PERIOD = option("T", "Search only periods up to T, in 1/Omega or with a unit; by default all.")
IMPACTS = option(
    "N",
    "List orbits with at most N impacts a period, with lasting contact too; those with several are searched.",
    min=1,
)
GUESSES = option(
    "N",
    "Initial guesses of that search for each number of impacts; 1500 by default, fewer for a rotor with many states.",
    min=1,
)


def orbits(
    machine: str = options.MACHINE,
    settings: list[str] | None = options.SETTINGS,
    longest_period: str | None = LONGEST_PERIOD,
    impacts: int | None = IMPACTS,
    guesses: int | None = GUESSES,
    as_json: bool = options.AS_JSON,
) -> None:
    """List equilibria and periodic orbits, stable and unstable.

    For a planar rotor in a rigid bearing: all orbits with one impact a period, with the argument that there are no more. For any other machine: those
    that a search finds. With --impacts N: the orbits with at most N impacts a period that are known or found by search, and what was tried.
    """
    from carom.cli.starts import read_time
    from carom.models import rotor_of

    case = read_machine(machine, settings)
    model, exact = rotor_of(case), False
    if impacts is None:
        model.system.refuse_non_stationary()
        exact = model.has_closed_forms
    longest = read_time(longest_period, case.parameters.scales, "--longest-period")
    with progress("equilibria and periodic orbits (the kernels are compiled on first use)") as tell:
        from carom.closed_forms.equilibria import steady_motions
        from carom.orbits.single_impact import find_orbits, orbits_within_reach

        if impacts is not None:
            found = find_orbits(case, impacts=impacts, guesses=guesses, progress=tell)
        else:
            tell(0.3)
            steady, whirls = steady_motions(model), [] if exact else _whirls(model)
            if exact:
                found = orbits_within_reach(model) if longest is None else find_orbits(model, longest)
            else:
                found = find_orbits(case, longest, guesses=guesses, progress=tell.part(0.3, 1.0))

    def document() -> dict[str, Any]:
        from carom.base.results import record
        from carom.studies import found_orbits_document, orbits_document

        if impacts is not None:
            return found_orbits_document(found)
        entries = orbits_document(model, steady, found, case)
        for entry, each in zip(entries["equilibria"], steady, strict=True):
            entry["touchdown_bearings"] = [place + 1 for place in each.planes]
        columns = "speed radius: normal_force: slips"
        said = [{"touchdown_bearing": place + 1, **record(each, columns, model.scales)} for place, each in whirls]
        return entries | {"whirls": said}

    def show() -> None:
        from carom.cli.tables import print_found_orbits, print_orbits

        if impacts is not None:
            print_found_orbits(console(), case, found)
        else:
            print_orbits(console(), case, steady, found, whirls)

    hand_over(document, as_json, show, None)


def _whirls(rotor: Rotor) -> list[tuple[int, SlippingWhirl]]:
    """Slipping backward whirls at each compliant touchdown bearing, of the rotor without its unbalance, with its force in ``m c_r Ω²``; none under weight or on races that turn."""
    from carom.closed_forms.compliant_walls import slipping_whirls
    from carom.closed_forms.statics import exponent_of

    if rotor.system.forced is not None or rotor.system.races is not None:
        return []
    return [
        (place, replace(whirl, normal_force=whirl.normal_force * float(rotor.system.arrays.masses[place])))
        for place, contact in enumerate(rotor.system.contacts)
        if contact.wall.stiffness
        for whirl in slipping_whirls(rotor, contact.wall.stiffness, exponent_of(contact.wall), plane=place)
    ]
