"""Results that take longer than a moment: the smallest lost kick, the hardest impulse, the verdict."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.basins import smallest_loss
from carom.disturbances import Grid, VelocityKick
from carom.explorer.computing.kicks import Rest, rest_of
from carom.models import Jeffcott
from carom.motions import simulate
from carom.outcome import InputError
from carom.parameters import Case
from carom.progress import Reporter, ShowProgress
from carom.studies import Verdict, Wording, study

SIZES, DIRECTIONS = 6, 24
"""Kicks whose impulses are compared."""


@dataclass(frozen=True)
class Loss:
    """The smallest kick found that does not come back, in words, and what was searched."""

    size: float | None
    """In ``c_r Ω``; ``None`` where none was found."""
    value: str
    remark: str


@dataclass(frozen=True)
class Hardest:
    """The hardest impulse among a set of kicks, in words, and what was tried."""

    impulse: float
    """In ``m c_r Ω``."""
    value: str
    remark: str


def find_loss(rotor: Jeffcott, fastest: float, progress: ShowProgress = None) -> Loss:
    """Search for the smallest kick up to a size in ``c_r Ω`` that is lost."""
    say = Wording(rotor.scales)
    try:
        found = smallest_loss(rotor, VelocityKick(fastest), progress=progress)
    except InputError:
        return Loss(None, "none comes back", "there is no stable levitation to come back to")
    if found.size is None:
        return Loss(None, "none found", f"up to {say.velocity(fastest)}, {found.tried:,} kicks tried")
    below = f"; {found.fresh:,} fresh kicks below it came back" if found.fresh else ""
    return Loss(found.size, say.velocity(found.size), f"smallest of {found.tried:,} kicks tried{below}")


def find_hardest(rotor: Jeffcott, fastest: float, progress: ShowProgress = None) -> Hardest:
    """Follow kicks of all directions and sizes up to ``fastest``, in ``c_r Ω``, and note the hardest impact."""
    rest, tell = rest_of(rotor), Reporter.of(progress, "looking for the hardest impact")
    plan = Grid(VelocityKick(fastest), (SIZES, DIRECTIONS))
    kicks = [(float(speed), float(angle)) for speed in plan.values()[0] for angle in plan.values()[1]]
    hardest = 0.0
    for place, (speed, angle) in enumerate(kicks):
        hardest = max(hardest, _hardest_of(rotor, rest, speed, angle))
        tell((place + 1) / len(kicks))
    say = Wording(rotor.scales)
    tried = f"in {len(kicks)} kicks up to {say.velocity(fastest)}"
    if hardest == 0.0:
        return Hardest(0.0, "no impact", tried)
    return Hardest(hardest, say.impulse(hardest), tried)


def _hardest_of(rotor: Jeffcott, rest: Rest, speed: float, angle: float) -> float:
    motion = simulate(rotor, rest.kicked(speed * float(np.cos(angle)), speed * float(np.sin(angle))), settle=True)
    return float(motion.contacts.normal_impulse.max(initial=0.0))


def judge(case: Case, progress: ShowProgress = None) -> Verdict:
    """Verdict of a full study."""
    return study(case, progress=progress).verdict
