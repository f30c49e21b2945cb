"""Read starts, kicks, times and ranges from text: dimensionless, or with units if the machine is known.

What cannot be read raises an :class:`~carom.outcome.InputError` that names the option, the value and what is allowed.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from carom.outcome import InputError, together
from carom.parameters import Case, Requirement, Scales, read_quantity, read_size

if TYPE_CHECKING:
    from carom.disturbances import BladeLoss
    from carom.models import Axis
    from carom.motions.starts import Kick, State

_START = "must be four values RE,IM,VRE,VIM such as 0.5,0,0,0.1 or '0.3 mm,0 mm,5 mm/s,0 m/s'"
_BLADE_LOSS = "must be AFTER or AFTER,PHASE such as 0.4,0.2 or '0.1 mm,30 deg' or '5000 g mm,30 deg'"
_KICK = "must be SPEED or SPEED,ANGLE such as 0.4,0.2 or '50 mm/s,30 deg'"


def read_start(text: str, scales: Scales | None) -> State:
    """Read ``RE,IM,VRE,VIM``: position and velocity in the co-rotating frame, in ``c_r`` and ``c_r Ω`` or with units."""
    parts = _split("--start", text, (4,), _START)
    x, y = (read_size("--start", part, "length", scales).own(scales) for part in parts[:2])
    vx, vy = (read_size("--start", part, "velocity", scales).own(scales) for part in parts[2:])
    radius = math.hypot(x, y)
    if radius > 1.0 + 1e-12:
        raise InputError("--start", text, f"must lie inside the wall, |U| <= 1 (here |U| = {radius:.6g})")
    from carom.motions.starts import State

    return State(complex(x, y), complex(vx, vy))


def read_kick(text: str, scales: Scales | None) -> Kick:
    """Read ``SPEED`` or ``SPEED,ANGLE``: a velocity kick out of levitation, co-rotating frame."""
    speed, *angle = _split("--kick", text, (1, 2), _KICK)
    size = read_size("--kick", speed, "velocity", scales).own(scales)
    direction = read_size("--kick", angle[0], "angle", scales).own(scales) if angle else 0.0
    from carom.motions.starts import Kick

    return Kick(size, direction)


def read_blade_loss(text: str, scales: Scales | None) -> tuple[BladeLoss, float]:
    """Read ``AFTER`` or ``AFTER,PHASE``: the unbalance after the loss of a blade, and its phase relative to the one before."""
    after, *phase = _split("--blade-loss", text, (1, 2), _BLADE_LOSS)
    size = read_unbalance("--blade-loss", after, scales)
    turned = read_size("--blade-loss", phase[0], "angle", scales).own(scales) if phase else 0.0
    from carom.disturbances import BladeLoss

    return BladeLoss(size), turned


def with_requirement(case: Case, **given: str | None) -> Case:
    """Return the case with what ``--kick``, ``--shock`` and ``--blade-loss`` state in place of what its file states."""
    try:
        return replace(case, requirement=case.requirement.changed_by(Requirement.of(case, **given)))
    except InputError as problem:
        named = [(f"--{error.field.replace('_', '-')}", error) for error in problem.errors]
        raise together([InputError(option, error.value, error.allowed) for option, error in named]) from None


def read_time(text: str, scales: Scales | None, option: str = "--until") -> float:
    """Read a time in ``1/Ω``, or with a unit of time."""
    return read_positive(option, text, "time", scales)


def read_positive(option: str, text: str, kind: str, scales: Scales | None) -> float:
    """Read a length, velocity, acceleration or time above 0, in units of the equations."""
    size = read_size(option, text, kind, scales).own(scales)
    if not size > 0:
        article = "an" if kind[0] in "aeiou" else "a"
        raise InputError(option, text, f"must be {article} {kind} above 0")
    return size


def read_unbalance(option: str, text: str, scales: Scales | None) -> float:
    """Read an eccentricity, in ``c_r`` or with a unit of length, or an unbalance with a unit such as g mm; return it in ``c_r``."""
    try:
        return read_positive(option, text, "length", scales)
    except InputError as problem:
        if scales is None:
            raise
        try:
            size = read_size(option, text, "unbalance", scales)
        except InputError:
            raise problem from None
    if not size.in_si or not size.own(scales) > 0.0:
        raise InputError(option, text, "must be an eccentricity or an unbalance above 0, such as 0.1 mm or 5000 g mm")
    return size.own(scales)


def read_value(option: str, text: str, varied: Axis) -> float:
    """Read a value of a parameter to vary."""
    try:
        return read_quantity(varied.field, text)
    except InputError as problem:
        raise InputError(option, problem.value, f"{varied.name} {problem.allowed}") from None


def read_range(option: str, text: str, varied: Axis) -> tuple[float, float]:
    """Read ``A,B``, the ends of a range of a parameter in either order; return the smaller one first."""
    allowed = f"must be two different values of {varied.name} with a comma between them"
    first, second = (read_value(option, part, varied) for part in _split(option, text, (2,), allowed))
    if first == second:
        raise InputError(option, text, allowed)
    return min(first, second), max(first, second)


def _split(option: str, text: str, counts: tuple[int, ...], allowed: str) -> list[str]:
    parts = [part.strip() for part in text.split(",")]
    if len(parts) not in counts or not all(parts):
        raise InputError(option, text, allowed)
    return parts
