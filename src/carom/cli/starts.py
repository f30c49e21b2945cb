"""Starts, kicks and times from text: dimensionless, or with units where the machine is known."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

from carom.outcome import InputError
from carom.parameters import Field, Scales, read_quantity

if TYPE_CHECKING:
    from carom.trajectories import Kick, State

__all__ = ["read_kick", "read_size", "read_start", "read_time"]

_HUGE = 1e12
_START = "must be four values RE,IM,VRE,VIM such as 0.5,0,0,0.1 or '0.3 mm,0 mm,5 mm/s,0 m/s'"
_KICK = "must be SPEED or SPEED,ANGLE such as 0.4,0.2 or '50 mm/s,30 deg'"


def read_start(text: str, scales: Scales | None) -> State:
    """Read ``RE,IM,VRE,VIM``: position and velocity in the co-rotating frame.

    Parameters
    ----------
    text : str
        Each value is a number, in ``c_r`` or ``c_r Ω``, or has a unit of length or velocity.
    scales : Scales or None
        Needed for values with units.

    Returns
    -------
    State

    Raises
    ------
    InputError
        Naming ``--start``, the value and what is allowed.
    """
    parts = _split("--start", text, (4,), _START)
    x, y = (_number("--start", part, "length", scales) for part in parts[:2])
    vx, vy = (_number("--start", part, "velocity", scales) for part in parts[2:])
    radius = math.hypot(x, y)
    if radius > 1.0 + 1e-12:
        raise InputError("--start", text, f"must lie inside the wall, |U| <= 1 (here |U| = {radius:.6g})")
    from carom.trajectories import State

    return State(complex(x, y), complex(vx, vy))


def read_kick(text: str, scales: Scales | None) -> Kick:
    """Read ``SPEED`` or ``SPEED,ANGLE``: a velocity kick out of levitation, co-rotating frame.

    Raises
    ------
    InputError
        Naming ``--kick``.
    """
    speed, *angle = _split("--kick", text, (1, 2), _KICK)
    size = _number("--kick", speed, "velocity", scales)
    direction = _number("--kick", angle[0], "angle", scales) if angle else 0.0
    from carom.trajectories import Kick

    return Kick(size, direction)


def read_time(text: str, scales: Scales | None, option: str = "--until") -> float:
    """Read a time in ``1/Ω``, or with a unit of time.

    Raises
    ------
    InputError
        Naming the option.
    """
    time = _number(option, text, "time", scales)
    if not time > 0:
        raise InputError(option, text, "must be a time above 0, such as 500 or '2 s'")
    return time


def read_size(option: str, text: str, kind: str, scales: Scales | None) -> float:
    """Read a length, velocity, acceleration or time above 0, dimensionless or with a unit; ``20 g`` are gravities.

    Raises
    ------
    InputError
        Naming the option.
    """
    size = _number(option, text, kind, scales)
    if not size > 0:
        article = "an" if kind[0] in "aeiou" else "a"
        raise InputError(option, text, f"must be {article} {kind} above 0, such as {_UNITS[kind][1]!r}")
    return size


def _split(option: str, text: str, counts: tuple[int, ...], allowed: str) -> list[str]:
    parts = [part.strip() for part in text.split(",")]
    if len(parts) not in counts or not all(parts):
        raise InputError(option, text, allowed)
    return parts


_UNITS = {
    "length": ("m", "0.3 mm"),
    "velocity": ("m/s", "5 mm/s"),
    "acceleration": ("m/s^2", "20 g"),
    "time": ("s", "2 s"),
    "angle": ("rad", "30 deg"),
}
_GRAVITIES = re.compile(r"(.*[0-9.])\s*g\s*")
"""As engineers write shocks; in tables of units g is the gram."""


def _number(option: str, text: str, kind: str, scales: Scales | None) -> float:
    """A plain number as it is; one with a unit in units of the equations."""
    unit, example = _UNITS[kind]
    article = f"an {kind}" if kind[0] == "a" else f"a {kind}"
    try:
        float(text)
    except ValueError:
        pass
    else:
        own = {
            "length": " in c_r",
            "velocity": " in c_r Omega",
            "acceleration": " in c_r Omega^2",
            "time": " in 1/Omega",
        }
        field = Field(option, "", "", article + own.get(kind, ""), "", -_HUGE, _HUGE, f"0.5 or '{example}'")
        return read_quantity(field, text, bare=True)
    field = Field(option, "", "", article, unit, -_HUGE, _HUGE, f"'{example}'")
    gravities = _GRAVITIES.fullmatch(text) if kind == "acceleration" else None
    number = read_quantity(field, f"{gravities[1]} standard_gravity" if gravities else text)
    if kind == "angle":
        return number
    if scales is None:
        raise InputError(option, text, "must be without units: the file is dimensionless and has no scales")
    return number / float(getattr(scales, kind))
