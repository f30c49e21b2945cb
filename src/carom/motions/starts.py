"""Where motions start: states, and levitation."""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from typing import Annotated, Any, Protocol, cast, runtime_checkable

import numpy as np

from carom.base.arguments import ArgumentKind, checked, kind_of_numbers
from carom.base.outcome import InputError
from carom.core.layout import rub_workspace
from carom.core.phases import AWAY, FLIGHT
from carom.core.rub import phase_in_wall
from carom.core.wall import set_on_wall
from carom.models import Rotor, Subject, System
from carom.models.forcing import complex_numbers


@runtime_checkable
class Beginning(Protocol):
    """What a motion begins with: a kick, a drop, or any single disturbance."""

    def stages(self, machine: Subject) -> tuple[Rotor, State]:
        """Return what moves, perhaps in stages or another machine than before, and the state in which it starts."""


LARGEST_SPEED = 1e12
"""Largest speed of a start: far larger ones cross the clearance in less than a double tells apart from no time."""
FARTHEST = 1e12
"""Farthest place and largest time of a start: of larger ones no digits are left, of the wall or of a turn."""
_REALS = "iuf"
"""Kinds of real numbers of NumPy."""
WALL_TOLERANCE = 1e-12
"""Distance from ``|U| = 1`` within which a start counts as on the wall."""
_TIME = "a finite time above 0, in 1/Omega or with a unit, such as '2 s'"
Until = Annotated[float | str, ArgumentKind(lambda until: isinstance(until, str) or until > 0.0, _TIME)]
"""Time to follow a motion: a number above 0, or text with a unit."""


@dataclass(frozen=True)
class State:
    """A state of the rotor in the co-rotating frame.

    Attributes
    ----------
    position, velocity : complex, or ndarray of complex, shape (n,)
        ``U`` in clearances and ``U̇`` in clearances times ``Ω``; arrays for a rotor of ``n > 1`` coordinates.  Those of many starts, for
        :func:`carom.settle`, are arrays of any shape, then with a last axis of coordinates; so is their time.
    races : tuple of float
        Speeds of the surfaces of the races that turn, in the order of their planes, in ``c_r Ω`` in the fixed frame; by default
        those that the rotor begins with.
    shaft : tuple of float
        Of a shaft whose speed changes: its speed in ``Ω``, and the angle in rad by which it is ahead of the frame, which turns at the
        nominal speed.  By default ``(1.0, 0.0)``.
    time : float
        Time at which it is taken, in ``1/Ω``: under forces that change with time, such as weight, it says where these point.

    See Also
    --------
    carom.kick : velocity kick out of levitation

    Examples
    --------
    >>> import carom as cm
    >>> cm.State(0.5 + 0.2j, velocity=-1j)
    State(position=(0.5+0.2j), velocity=(-0-1j))
    """

    position: Any
    velocity: Any = 0j
    races: tuple[float, ...] = ()
    shaft: tuple[float, ...] = ()
    time: Any = 0.0

    def __repr__(self) -> str:
        turning = [f", {name}={getattr(self, name)}" for name in ("races", "shaft", "time") if getattr(self, name)]
        return f"State(position={self.position}, velocity={self.velocity}{''.join(turning)})"

    @classmethod
    @checked
    def of(
        cls,
        position: np.ndarray | complex,
        velocity: np.ndarray | complex,
        races: tuple[float, ...] = (),
        shaft: tuple[float, ...] = (),
        time: float = 0.0,
    ) -> State:
        """State of plain numbers, or of arrays if there are several coordinates."""
        if np.size(position) > 1 or np.size(velocity) > 1:
            return cls(position, velocity, races, shaft, time)
        return cls(complex(np.squeeze(position)), complex(np.squeeze(velocity)), races, shaft, time)


def state_at(system: System, amplitudes: np.ndarray, time: float) -> State:
    """State of amplitudes (N,), with the speeds of races and of the shaft."""
    return State.of(*system.state(amplitudes), system.race_speeds(amplitudes), system.shaft_turn(amplitudes), time)


def levitating(rotor: Rotor, push: complex = 0j, instant: float = 0.0) -> State:
    """Levitation with its velocity changed by a push, at an instant of the turn where that matters; the rotor moves as a whole.

    Raises
    ------
    InputError
        The rotor sags to the wall.
    """
    if rotor.acting.weight is not None:
        rotor.system.require_levitation()
    begun = instant if rotor.depends_on_instant else 0.0
    return State.of(*rotor.system.kicked(push, begun), time=begun)


def arrays_of(start: State) -> tuple[np.ndarray, np.ndarray]:
    """Position and velocity of one start or of many as arrays; refuse what are no finite numbers."""
    parts = complex_numbers(start.position), complex_numbers(start.velocity)
    for name, values in zip(("position", "velocity"), parts, strict=True):
        if values is None:
            raise InputError(f"start {name}", getattr(start, name), "finite numbers")
    return cast("tuple[np.ndarray, np.ndarray]", parts)


def amplitudes_of(rotor: Rotor, state: State) -> tuple[np.ndarray, np.ndarray]:
    """Amplitudes of a start, and its state of contact at each plane (see :func:`carom.core.advance.advance`)."""
    system = rotor.system
    coordinates = () if len(system.rest) == 1 else system.rest.shape
    for name, values in zip(("position", "velocity"), arrays_of(state), strict=True):
        if values.shape != coordinates:
            raise InputError(f"start {name}", getattr(state, name), f"{len(system.rest)} coordinate(s)")
    if np.abs(state.velocity).max() > LARGEST_SPEED:
        raise InputError("start velocity", state.velocity, f"a speed up to {LARGEST_SPEED:g}")
    if np.abs(state.position).max() > FARTHEST:
        raise InputError("start position", state.position, f"a place up to {FARTHEST:g} clearances from the centre")
    if np.ndim(state.time) or kind_of_numbers(state.time) not in _REALS or abs(state.time) > FARTHEST:
        raise InputError("start time", state.time, f"a real number, up to {FARTHEST:g} in 1/Omega")
    amplitudes = system.amplitudes(state.position, state.velocity, state.time)
    if state.races:
        places = system.race_modes
        _check_speeds("races", state.races, len(places), "one for each race that turns")
        amplitudes[places] = state.races
    if state.shaft:
        _check_speeds(
            "shaft", state.shaft, 0 if system.shaft is None else 2, "speed and angle of a shaft whose speed changes"
        )
        place = system.arrays["shaft"][0]
        amplitudes[place], amplitudes[place + 1] = cmath.rect(1.0, state.shaft[1]), state.shaft[0]
    contact = np.full(len(system.arrays["rows"]), AWAY)
    for plane in range(len(contact)):
        # The given position of the planar rotor is used, free of the rounding of the amplitudes.
        radius = abs(state.position if system.is_planar else system.at_plane(amplitudes, plane)[0])
        if radius > 1.0 + WALL_TOLERANCE and system.arrays["stiffness"][plane] > 0.0:
            contact[plane] = phase_in_wall(
                system.arrays,
                contact,
                plane,
                amplitudes,
                rub_workspace(system.modes, len(contact), system.limits),
            )
        elif radius > 1.0 + WALL_TOLERANCE:
            where = "" if len(contact) == 1 else f" at touchdown bearing {plane + 1}"
            raise InputError(
                "start position", state.position, f"inside the wall, |U| <= 1 (here |U| = {radius:.12g}{where})"
            )
        elif radius >= 1.0 - WALL_TOLERANCE:
            set_on_wall(system.arrays, plane, amplitudes)
            contact[plane] = FLIGHT
    return amplitudes, contact


def _check_speeds(name: str, given: tuple[float, ...], count: int, words: str) -> None:
    if np.shape(given) != (count,) or kind_of_numbers(given) not in _REALS:
        raise InputError(f"start {name}", given, f"{count} finite number(s): {words}")
