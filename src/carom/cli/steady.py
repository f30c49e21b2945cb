"""Steady motions of a rotor of any number of modes, as a table and as a document: what ``carom orbits`` tells of flexible machines."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

from rich.console import Console

from carom.cli.fitting import fitted, plain_table
from carom.closed_forms.equilibria import steady_motions
from carom.closed_forms.statics import exponent_of
from carom.closed_forms.yielding_walls import slipping_whirls
from carom.models import rotor_of
from carom.outcome import STEADY_WORDS, Outcome
from carom.parameters import Scales
from carom.parameters.told import number, told
from carom.results import in_si

if TYPE_CHECKING:
    from carom.models import Rotor
    from carom.parameters import Case

WHIRL = Outcome.BACKWARD_WHIRL.words


class Steady(NamedTuple):
    """A circular motion: its words, the touchdown bearings in contact (from 1), whirl speed in the fixed frame in ``Ω``, radius, normal force, and what is known of it."""

    motion: str
    touchdown_bearings: tuple[int, ...]
    whirl_speed: float
    radius: float
    normal_force: float
    state: str


def steady_of(rotor: Rotor) -> list[Steady]:
    """Levitation; without weight the synchronous rubs; and slipping whirls at each plane whose wall gives way, of the rotor without its unbalance and weight."""
    found = [
        Steady(
            STEADY_WORDS["rub" if each.kind == "rub" else "contact-free"],
            tuple(plane + 1 for plane in each.planes),
            1.0,
            each.radius,
            each.normal_force,
            _state(each.status, each.stable),
        )
        for each in steady_motions(rotor)
    ]
    if rotor.system.forced is not None or rotor.system.races is not None:
        return found
    for plane, contact in enumerate(rotor.system.contacts):
        if not contact.wall.stiffness:
            continue
        for whirl in slipping_whirls(rotor, contact.wall.stiffness, exponent_of(contact.wall), plane=plane):
            force = whirl.normal_force * float(rotor.system.arrays.masses[plane])
            state = "stability not judged" if whirl.slips else "rolls before it gets there"
            found.append(Steady(WHIRL, (plane + 1,), -whirl.speed, whirl.radius, force, state))
    return found


def _state(status: str, stable: bool) -> str:
    return ("stable" if stable else "unstable") if status == "admissible" else f"not possible ({status})"


def steady_document(case: Case) -> dict[str, Any]:
    """Return the same as plain data."""
    rotor = rotor_of(case)
    entries = [{**each._asdict(), "touchdown_bearings": list(each.touchdown_bearings)} for each in steady_of(rotor)]
    own = [{**each, **in_si(each, rotor.scales, radius="length", normal_force="force")} for each in entries]
    return {**rotor.document(), "steady": own}


def print_steady(console: Console, case: Case) -> None:
    """Print steady motions, in SI units."""
    rotor = rotor_of(case)
    scales: Scales | None = rotor.scales
    table = plain_table(
        "Steady motions",
        "motion",
        "touchdown bearing",
        "whirl",
        "radius",
        "normal force",
        "state",
        no_wrap=("whirl", "radius", "normal force"),
    )
    for each in steady_of(rotor):
        bearings = ", ".join(map(str, each.touchdown_bearings)) or "none"
        rate = each.whirl_speed * (scales.speed if scales else 1.0) / math.tau
        whirl = f"{number(rate, 4)} Hz" if scales else f"{number(each.whirl_speed, 4)} Ω"
        sizes = told(each.radius, "length", scales, 4), told(each.normal_force, "force", scales, 4)
        table.add_row(each.motion, bearings, whirl, *sizes, each.state)
    console.print(fitted(console, table))
    console.print()
    if rotor.system.is_anisotropic:
        console.print(
            "Rubs and whirls are no steady motions where bearings act differently in two directions; attractors finds where motions end."
        )
        return
    if rotor.system.races is not None:
        console.print(
            "Rubs and whirls on a race that turns are steady only where its torques balance: they are orbits, if there are any."
        )
    elif rotor.system.forced is not None:
        console.print(
            "Under weight rubs and whirls are no steady motions: leave it out by --set gravity=0 to see them."
        )
    else:
        console.print(
            "Whirls are those of the rotor without unbalance; in each only the plane named touches, and others are not asked."
        )
    console.print("Orbits with impacts are searched by --impacts N.")
