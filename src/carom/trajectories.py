"""Motions: a start followed through flights and impacts."""

from __future__ import annotations

import cmath
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from carom.core.advance import advance, set_on_wall
from carom.core.layout import workspace
from carom.outcome import InputError, Outcome
from carom.rotors import Rotor

if TYPE_CHECKING:
    import xarray

    from carom.parameters import Scales

__all__ = ["ContactLog", "Kick", "State", "Trajectory", "kick", "simulate"]

WALL_TOLERANCE = 1e-12
"""A start this near to ``|U| = 1`` lies on the wall."""
CHUNK = 4096
"""Impacts per kernel call; between calls progress is reported."""


@dataclass(frozen=True)
class State:
    """A state of the rotor in the co-rotating frame.

    Attributes
    ----------
    position, velocity : complex
        ``U`` in clearances and ``U̇`` in clearances times ``Ω``.
    """

    position: complex
    velocity: complex = 0j


@dataclass(frozen=True)
class Kick:
    """A velocity kick out of the contact-free equilibrium.

    Attributes
    ----------
    speed : float
        Size of the kick in clearances times ``Ω``.
    angle : float
        Direction in the co-rotating frame, in rad.
    """

    speed: float
    angle: float = 0.0

    def state(self, rotor: Rotor) -> State:
        """Return the state just after the kick."""
        return State(rotor.equilibrium, cmath.rect(self.speed, self.angle))


def kick(speed: float, angle: float = 0.0) -> Kick:
    """Velocity kick of ``speed`` (in ``c_r Ω``) in direction ``angle`` (rad) out of the contact-free equilibrium."""
    return Kick(speed, angle)


@dataclass(frozen=True, eq=False)
class ContactLog:
    """Impacts of a motion, one entry each, in the order of time.

    All arrays have shape (n,).  Lengths are in ``c_r``, times in ``1/Ω``, impulses in ``m c_r Ω``, energies in
    ``m c_r² Ω²``, in the co-rotating frame.

    Attributes
    ----------
    time, angle : ndarray
        Time and angle ``θ`` of the impact.
    radial_speed, angular_speed : ndarray
        ``ṙ`` and ``θ̇`` just before it.
    radial_speed_after, angular_speed_after : ndarray
        ``ṙ`` and ``θ̇`` just after it.
    normal_impulse, tangential_impulse : ndarray
        Impulse of the bearing on the rotor: inward, and along growing ``θ`` (against the slip).
    slip_before, slip_after : ndarray
        Slip velocity ``v = s + 1 + θ̇`` of the contact point.
    sticks : ndarray of bool
        Whether friction stopped the slip.
    contact_work : ndarray
        Work of the impulse on the contact point (mean velocity of before and after), never positive.
    drive_work : ndarray
        Work that the shaft's drive feeds in through friction: kinetic energy gained minus ``contact_work``.
    """

    time: np.ndarray
    angle: np.ndarray
    radial_speed: np.ndarray
    angular_speed: np.ndarray
    radial_speed_after: np.ndarray
    angular_speed_after: np.ndarray
    normal_impulse: np.ndarray
    tangential_impulse: np.ndarray
    slip_before: np.ndarray
    slip_after: np.ndarray
    sticks: np.ndarray
    contact_work: np.ndarray
    drive_work: np.ndarray

    def __len__(self) -> int:
        return len(self.time)

    def in_si(self, scales: Scales) -> dict[str, tuple[np.ndarray, str]]:
        """Columns with their SI units: name to (values, unit)."""
        return {
            name: (getattr(self, name) * (getattr(scales, scale) if scale else 1), unit)
            for name, (scale, unit, _) in _COLUMNS.items()
        }

    def to_dataset(self, scales: Scales | None = None) -> xarray.Dataset:
        """Table with units and long names as attributes; in SI if scales are given."""
        import xarray

        si = self.in_si(scales) if scales else {}
        columns = {}
        for name, (scale, _, words) in _COLUMNS.items():
            values, unit = si.get(name, (getattr(self, name), _DIMENSIONLESS_UNITS.get(scale, "1")))
            columns[name] = ("impact", values, {"units": unit, "long_name": words})
        return xarray.Dataset(columns)


_COLUMNS = {
    "time": ("time", "s", "time of impact"),
    "angle": ("", "rad", "angle of impact in the co-rotating frame"),
    "radial_speed": ("velocity", "m/s", "radial speed before impact"),
    "angular_speed": ("speed", "rad/s", "angular speed before impact, co-rotating frame"),
    "radial_speed_after": ("velocity", "m/s", "radial speed after impact"),
    "angular_speed_after": ("speed", "rad/s", "angular speed after impact, co-rotating frame"),
    "normal_impulse": ("impulse", "N s", "normal impulse of the bearing on the rotor"),
    "tangential_impulse": ("impulse", "N s", "friction impulse of the bearing on the rotor"),
    "slip_before": ("velocity", "m/s", "slip velocity before impact"),
    "slip_after": ("velocity", "m/s", "slip velocity after impact"),
    "sticks": ("", "1", "whether friction stopped the slip"),
    "contact_work": ("energy", "J", "work of the impact on the contact point"),
    "drive_work": ("energy", "J", "work of the shaft's drive through friction"),
}

_DIMENSIONLESS_UNITS = {
    "": "1",
    "time": "1/Omega",
    "velocity": "c_r Omega",
    "speed": "Omega",
    "impulse": "m c_r Omega",
    "energy": "m c_r^2 Omega^2",
}


@dataclass(frozen=True, eq=False)
class Trajectory:
    """A motion: exact flights joined by impacts.

    Attributes
    ----------
    rotor : Rotor
    start : State
    outcome : Outcome
        ``TIME_REACHED``, ``IMPACT_LIMIT``, ``CHATTER`` (the exact state where impacts have accumulated) or ``GRAZING``.
    time : float
        End of the motion in ``1/Ω``.
    final : State
        State at the end.
    flight_starts : ndarray, shape (n + 1,)
        Start time of each flight.
    flight_amplitudes : ndarray of complex, shape (n + 1, N)
        Mode amplitudes at the start of each flight.
    arrivals : ndarray of complex, shape (n, N)
        Mode amplitudes just before each impact.
    """

    rotor: Rotor
    start: State
    outcome: Outcome
    time: float
    final: State
    flight_starts: np.ndarray
    flight_amplitudes: np.ndarray
    arrivals: np.ndarray

    @cached_property
    def contacts(self) -> ContactLog:
        """Log of the impacts."""
        before = _polar(*self.rotor.state(self.arrivals))
        after = _polar(*self.rotor.state(self.flight_amplitudes[1:]))
        drive = float(self.rotor.arrays.drive[0])
        ratio = self.rotor.parameters.radius_ratio
        angle, radial, angular = before
        _, radial_after, angular_after = after
        normal = radial - radial_after
        tangential = angular_after - angular
        slip, slip_after = drive + angular, drive + angular_after
        stopped = self.rotor.parameters.mu * normal >= np.abs(slip)
        normal_work = -0.5 * normal * (radial + radial_after)
        return ContactLog(
            time=self.flight_starts[1:],
            angle=angle,
            radial_speed=radial,
            angular_speed=angular,
            radial_speed_after=radial_after,
            angular_speed_after=angular_after,
            normal_impulse=normal,
            tangential_impulse=tangential,
            slip_before=slip,
            slip_after=slip_after,
            sticks=stopped,
            contact_work=normal_work + 0.5 * tangential * (slip + slip_after),
            drive_work=-ratio * tangential,
        )

    def at(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """State at given times, exact; at an impact the state just after it.

        Parameters
        ----------
        times : array_like
            In ``1/Ω``, within 0 … ``time``.

        Returns
        -------
        position, velocity : ndarray of complex
            ``U`` and ``U̇`` in the co-rotating frame, of the shape of ``times``.
        """
        times = np.asarray(times, float)
        flight = np.clip(np.searchsorted(self.flight_starts, times, side="right") - 1, 0, None)
        elapsed = times - self.flight_starts[flight]
        return self.rotor.state(self.rotor.fly(self.flight_amplitudes[flight], elapsed))

    def sample(self, count: int = 2000) -> np.ndarray:
        """Times for drawing: about ``count`` even ones, every impact time, and the last instant before each."""
        impacts = self.flight_starts[1:]
        even = np.linspace(0.0, self.time, count)
        return np.unique(np.concatenate([even, impacts, np.nextafter(impacts, 0.0)]))

    def position(self, times: np.ndarray, frame: Literal["rotating", "fixed"] = "rotating") -> np.ndarray:
        """Position in clearances, ``U`` in the co-rotating or ``Z = U e^{it}`` in the fixed frame."""
        rotating, _ = self.at(times)
        return rotating if frame == "rotating" else rotating * np.exp(1j * np.asarray(times))

    def radius(self, times: np.ndarray) -> np.ndarray:
        """Distance from the bearing centre in clearances."""
        radius: np.ndarray = np.abs(self.at(times)[0])
        return radius


def _polar(position: np.ndarray, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Angle, radial and angular speed of states on the wall."""
    local = position.conj() * velocity / np.abs(position)
    return np.angle(position), local.real, local.imag / np.abs(position)


def simulate(
    rotor: Rotor,
    start: State | Kick,
    until: float,
    *,
    max_impacts: int = 1_000_000,
    progress: Callable[[float], None] | None = None,
) -> Trajectory:
    """Follow a start through flights and impacts.

    Parameters
    ----------
    rotor : Rotor
    start : State or Kick
        On the wall (``|U| = 1`` to within 1e-12) or inside it.
    until : float
        Time to follow it, in ``1/Ω``.
    max_impacts : int
        Impacts after which to give up.
    progress : callable, optional
        Called now and then with the time reached.

    Returns
    -------
    Trajectory
        Where impacts accumulate it ends early with the outcome ``CHATTER``.

    Raises
    ------
    InputError
        The start lies outside the wall, or a number is not finite.
    """
    state = start.state(rotor) if isinstance(start, Kick) else start
    amplitudes, plane = _checked_start(rotor, state)
    if not (np.isfinite(until) and until > 0):
        raise InputError("until", until, "a finite time above 0, in 1/Omega")
    if max_impacts < 1:
        raise InputError("max_impacts", max_impacts, "a whole number of at least 1")
    modes = len(amplitudes)
    work = workspace(modes)
    first = amplitudes.copy()
    times, before, after = [np.zeros(0)], [np.zeros((0, modes), complex)], [np.zeros((0, modes), complex)]
    reached, impacts, outcome = 0.0, 0, Outcome.IMPACT_LIMIT
    while outcome is Outcome.IMPACT_LIMIT and impacts < max_impacts:
        size = min(CHUNK, max_impacts - impacts)
        log = (
            np.empty(size),
            np.empty(size, np.int64),
            np.empty((size, modes), complex),
            np.empty((size, modes), complex),
        )
        code, time, count, plane = advance(rotor.arrays, rotor.table, amplitudes, until - reached, plane, *log, work)
        times.append(reached + log[0][:count])
        before.append(log[2][:count])
        after.append(log[3][:count])
        reached, impacts, outcome = reached + time, impacts + count, Outcome(code)
        if progress:
            progress(reached)
    position, velocity = rotor.state(amplitudes)
    return Trajectory(
        rotor=rotor,
        start=state,
        outcome=outcome,
        time=until if outcome is Outcome.TIME_REACHED else reached,
        final=State(complex(position), complex(velocity)),
        flight_starts=np.concatenate([np.zeros(1), *times]),
        flight_amplitudes=np.concatenate([first[None], *after]),
        arrivals=np.concatenate(before),
    )


def _checked_start(rotor: Rotor, state: State) -> tuple[np.ndarray, int]:
    """Amplitudes of a start, and the plane it touches or −1."""
    for name in ("position", "velocity"):
        if not cmath.isfinite(getattr(state, name)):
            raise InputError(f"start {name}", getattr(state, name), "finite numbers")
    radius = abs(state.position)
    if radius > 1.0 + WALL_TOLERANCE:
        raise InputError("start position", state.position, f"inside the wall, |U| <= 1 (here |U| = {radius:.12g})")
    amplitudes = rotor.amplitudes(state.position, state.velocity)
    if radius < 1.0 - WALL_TOLERANCE:
        return amplitudes, -1
    set_on_wall(rotor.arrays, 0, amplitudes)
    return amplitudes, 0
