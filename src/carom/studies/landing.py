"""A landing for its report: loads of all touchdown bearings beside each other, how far they are from their limits, and the touchdown bearings themselves."""

from __future__ import annotations

from typing import NamedTuple

from carom.models import rotor_of
from carom.parameters import LIMIT_FIELDS, LoadLimits
from carom.parameters.formats import number
from carom.studies.drops import NONE_LEFT, DropStudy, LoadCheck
from carom.studies.wording import Wording

COLUMN = (
    ("peak force", "{force}"),
    ("load of a ball", "{catalogue.ball_load:newton}"),
    ("ball pressure", "{pressure:pressure}"),
    ("of the static rating", "{catalogue.static_share:percent}"),
    ("of the life L10", "{catalogue.life_share:percent}"),
    ("such landings left", "{landings}"),
    ("hardest impulse", "{impulse}"),
    ("deepest", "{depth}"),
    ("contacts", "{contacts}"),
    ("heat of slip", "{heat}"),
    ("largest friction power", "{power}"),
    ("fastest race", "{fastest_race:speed}"),
    ("highest temperature", "{temperatures.warmest}"),
)
"""Loads of a touchdown bearing in a table in which each has a column."""


def load_columns(found: DropStudy) -> list[tuple[str, list[str]]]:
    """Labels, and what each touchdown bearing has of that load; what none of them has is left out."""
    columns = [
        dict(Wording(plane.scales).rows(COLUMN, plane) + ([NONE_LEFT] if plane.landings == 0.0 else []))
        for plane in found.loads.planes
    ]
    labels = [label for label in dict(COLUMN) if any(label in column for column in columns)]
    return [(label, [column.get(label, "\N{EM DASH}") for column in columns]) for label in labels]


class Accepted(NamedTuple):
    """A limit, and how far a load is from it, in words."""

    name: str
    load: str
    limit: str
    margin: str
    verdict: str

    @classmethod
    def of(cls, check: LoadCheck) -> Accepted:
        """A load against its limit."""
        where = "" if check.touchdown_bearing is None else f", bearing {check.touchdown_bearing}"
        load, limit = (LoadLimits.format(check.name, each) for each in (check.value, check.limit))
        margin, over = f"{number(100.0 * abs(check.margin), 3)} %", check.value > check.limit
        room = f"{margin} above" if over else "none in time" if check.endless else margin
        kept = "kept" if check.settled and not check.still_growing else "kept so far"
        verdict = "exceeded" if check.exceeded else kept
        return cls(f"{LIMIT_FIELDS[check.name].words}{where}", load, limit, room, verdict)


def bearing_words(found: DropStudy) -> list[str]:
    """Clearance, friction, law, race and mount of each touchdown bearing, in a line."""
    rotor, elements, lines = found.loads.rotor, rotor_of(found.case).finite_elements, list[str]()
    for plane in found.loads.planes:
        touchdown, bearing = rotor.equations.touchdowns[plane.plane], rotor.definition.bearing_at(plane.plane)
        if elements is not None:
            bearing = elements.machine.touchdowns[plane.plane].bearing
        law = bearing.words if bearing else "compliant" if plane.is_compliant else "rigid wall"
        race = "the race turns" if touchdown.race else "the race stands still"
        mount = "on a mount of its own" if bearing and bearing.mount else "fixed to the base"
        room = Wording(plane.scales).length(1.0)
        lines.append(f"radial clearance {room}, friction {number(touchdown.friction)}; {law}; {race}; {mount}")
    return lines
