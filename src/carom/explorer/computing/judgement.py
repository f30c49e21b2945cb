"""Results that take longer than a moment: the smallest lost kick, the hardest impulse, the verdict."""

from __future__ import annotations

import math

from carom.base.outcome import InputError
from carom.base.progress import Reporter, ShowProgress
from carom.base.results import record
from carom.basins import smallest_unrecovered
from carom.explorer.computing.kicked_motion import MOST_EVENTS
from carom.explorer.computing.kicks import is_slow
from carom.explorer.computing.planes import DisturbancePlane
from carom.explorer.computing.rest import rest_of
from carom.explorer.computing.walls import hardest_load, wall_at
from carom.models import Rotor
from carom.motions import simulate
from carom.parameters import Case, LoadLimits
from carom.parameters.formats import format_quantity
from carom.studies import study
from carom.studies.findings import CHANGES
from carom.studies.questions import about

SIZES, DIRECTIONS = 6, 24
FEW = 2, 12
"""Sizes and directions of the disturbances whose impacts are compared, and of a rotor whose motions take long."""
NO_LIMITS = LoadLimits()


def find_loss(
    rotor: Rotor, plane: DisturbancePlane, largest: float, progress: ShowProgress = None
) -> dict[str, object]:
    """Search for the smallest disturbance up to a size, in units of the equations, that is lost: its ``size`` in the unit that people see, 0 where none was found."""
    scales = rotor.scales
    try:
        few = dict(zip(("sizes", "directions"), FEW, strict=True)) if is_slow(rotor) else {}
        found = smallest_unrecovered(rotor, plane.by_size(rotor, largest), progress=progress, **few)
    except InputError:
        return {"size": 0.0, "value": "none comes back", "remark": "there is no stable levitation to come back to"}
    tried = f"{found.tried:,} {plane.nouns[1]} tried"
    if found.size is None:
        remark = f"up to {format_quantity(largest, plane.scale, scales)}, {tried}"
        return {"size": 0.0, "value": "none found", "remark": remark}
    below = f"; {found.fresh:,} fresh {plane.nouns[1]} below it came back" if found.fresh else ""
    size, value = plane.shown(scales)[0] * found.size, format_quantity(found.size, plane.scale, scales)
    return {"size": size, "value": value, "remark": f"smallest of {tried}{below}"}


def find_hardest(
    rotor: Rotor, plane: DisturbancePlane, largest: float, limits: LoadLimits = NO_LIMITS, progress: ShowProgress = None
) -> dict[str, object]:
    """Follow disturbances of all directions and sizes up to one in units of the equations, and note the hardest impact.

    ``peak_load`` is an impulse in ``m c_r Ω``, or a force in ``m c_r Ω²``.
    """
    rest, wall = rest_of(rotor), wall_at(rotor, 0)
    sizes, directions = FEW if is_slow(rotor) else (SIZES, DIRECTIONS)
    tell = Reporter.of(progress, "looking for the hardest impact")
    hardest, scales, count = 0.0, rotor.scales, sizes * directions
    for place in range(count):
        size = largest * (place // directions + 0.5) / sizes
        angle = math.tau * (place % directions + 0.5) / directions
        after, start, _ = plane.start(rotor, rest, size * math.cos(angle), size * math.sin(angle))
        motion = simulate(after, start, settle=True, max_events=MOST_EVENTS)
        for seen in map(motion.seen_at, range(len(after.system.planes))):
            if (peak_load := hardest_load(seen.contacts)) > hardest:
                hardest, scales = peak_load, seen.scales
        tell((place + 1) / count)
    tried = f"in {count} {plane.words_up_to(largest, rotor.scales)}{wall.beside(hardest, limits, scales)}"
    value = wall.load(hardest, scales) if hardest else f"no {wall.noun}"
    return {"peak_load": hardest, "value": value, "remark": tried}


def judge(case: Case, progress: ShowProgress = None) -> dict[str, object]:
    """Verdict of a full study, what to change, and what is survived of each kind of disturbance."""
    found = study(case, progress=progress)
    first = next((fact for fact in about(found.facts, "Recommendation") if fact.label in CHANGES), None)
    advice = f"{first.label}: {first.text}." if first else ""
    return record(found.verdict, "lead survived") | {"advice": advice}
