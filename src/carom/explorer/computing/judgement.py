"""Results that take longer than a moment: the smallest lost kick, the hardest impulse, the verdict."""

from __future__ import annotations

import math
from dataclasses import dataclass

from carom.base.outcome import InputError
from carom.base.progress import Reporter, ShowProgress
from carom.basins import smallest_unrecovered
from carom.explorer.computing.kicked_motion import MOST_EVENTS
from carom.explorer.computing.kicks import is_slow
from carom.explorer.computing.planes import DisturbancePlane
from carom.explorer.computing.rest import rest_of
from carom.explorer.computing.walls import contact_peaks, wall_at
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


@dataclass(frozen=True)
class Judgement:
    """What a study says first: its verdict, what to change, and what is survived of each kind of disturbance."""

    lead: str
    advice: str
    survived: tuple[str, ...]


@dataclass(frozen=True)
class Loss:
    """The smallest disturbance found that does not come back, in words, and what was searched."""

    size: float | None
    """In units of the equations; ``None`` where none was found."""
    value: str
    remark: str


@dataclass(frozen=True)
class Hardest:
    """The hardest impact among a set of disturbances, in words, and what was tried."""

    peak_load: float
    """An impulse in ``m c_r Ω``, or a force in ``m c_r Ω²``."""
    value: str
    remark: str


def find_loss(rotor: Rotor, plane: DisturbancePlane, largest: float, progress: ShowProgress = None) -> Loss:
    """Search for the smallest disturbance up to a size, in units of the equations, that is lost."""
    scales = rotor.scales
    try:
        few = dict(zip(("sizes", "directions"), FEW, strict=True)) if is_slow(rotor) else {}
        found = smallest_unrecovered(rotor, plane.by_size(rotor, largest), progress=progress, **few)
    except InputError:
        return Loss(None, "none comes back", "there is no stable levitation to come back to")
    if found.size is None:
        return Loss(
            None,
            "none found",
            f"up to {format_quantity(largest, plane.scale, scales)}, {found.tried:,} {plane.nouns[1]} tried",
        )
    below = f"; {found.fresh:,} fresh {plane.nouns[1]} below it came back" if found.fresh else ""
    return Loss(
        found.size,
        format_quantity(found.size, plane.scale, scales),
        f"smallest of {found.tried:,} {plane.nouns[1]} tried{below}",
    )


def find_hardest(
    rotor: Rotor, plane: DisturbancePlane, largest: float, limits: LoadLimits = NO_LIMITS, progress: ShowProgress = None
) -> Hardest:
    """Follow disturbances of all directions and sizes up to one in units of the equations, and note the hardest impact."""
    rest, wall = rest_of(rotor), wall_at(rotor, 0)
    sizes, directions = FEW if is_slow(rotor) else (SIZES, DIRECTIONS)
    tell = Reporter.of(progress, wall.searching)
    hardest, scales, count = 0.0, rotor.scales, sizes * directions
    for place in range(count):
        size = largest * (place // directions + 0.5) / sizes
        angle = math.tau * (place % directions + 0.5) / directions
        after, start, _ = plane.start(rotor, rest, size * math.cos(angle), size * math.sin(angle))
        motion = simulate(after, start, settle=True, max_events=MOST_EVENTS)
        for seen in map(motion.seen_at, range(len(after.system.planes))):
            if (peak_load := contact_peaks(seen).hardest) > hardest:
                hardest, scales = peak_load, seen.scales
        tell((place + 1) / count)
    tried = f"in {count} {plane.words_up_to(largest, rotor.scales)}{wall.beside(hardest, limits, scales)}"
    return Hardest(hardest, wall.load(hardest, scales) if hardest else f"no {wall.noun}", tried)


def judge(case: Case, progress: ShowProgress = None) -> Judgement:
    """Verdict and advice of a full study."""
    found = study(case, progress=progress)
    first = next((fact for fact in about(found.facts, "Recommendation") if fact.label in CHANGES), None)
    advice = f"{first.label}: {first.text}." if first else ""
    return Judgement(found.verdict.lead, advice, found.verdict.survived)
