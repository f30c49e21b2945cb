"""Single-impact orbits in closed form: all of them, with admissibility and multipliers."""

from __future__ import annotations

import cmath
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import overload

import numpy as np

from carom.core.events import first_crossing
from carom.core.impact import strike
from carom.core.layout import workspace
from carom.maps import Section, section_jacobian
from carom.outcome import InputError, Outcome
from carom.periods import PeriodCondition
from carom.rotors import Rotor
from carom.stability import Multipliers, multipliers
from carom.trajectories import State, Trajectory, simulate

__all__ = ["Orbit", "OrbitSet", "period_condition", "single_impact_orbits"]

ARRIVAL_TOLERANCE = 1e-7
"""Relative difference of the certified first return and the period below which they are the same event."""


@dataclass(frozen=True, eq=False)
class Orbit:
    """A periodic motion in the co-rotating frame with one impact a period.

    Attributes
    ----------
    rotor : Rotor
    name : str
        ``"B1,d"``: pair 1; ``a``, ``c`` on its shorter period and ``b``, ``d`` on its longer; ``a``, ``b`` with the
        lower and ``c``, ``d`` with the higher radial speed.  Orbits whose slip runs backward begin with ``R``.
    period : float
        In ``1/Ω``.
    section : Section
        State just before the impact.
    multipliers : Multipliers
        The three non-trivial Floquet multipliers.
    reason : str
        Why it is not admissible; empty if it is.
    """

    rotor: Rotor
    name: str
    period: float
    section: Section
    multipliers: Multipliers
    reason: str

    @property
    def impacts(self) -> int:
        """Impacts a period."""
        return 1

    @property
    def admissible(self) -> bool:
        """Whether it is a motion of the machine: inside the wall between impacts and with one direction of slip."""
        return not self.reason

    @property
    def stable(self) -> bool:
        """Whether small disturbances die out."""
        return self.multipliers.stable

    @property
    def position(self) -> complex:
        """``U`` at the impact, on the unit circle."""
        return self.section.state.position

    @property
    def angle(self) -> float:
        """``θ`` at the impact in rad."""
        return self.section.angle

    @property
    def radial_speed(self) -> float:
        """``ṙ`` just before the impact in ``c_r Ω``."""
        return self.section.radial_speed

    @property
    def angular_speed(self) -> float:
        """``θ̇`` just before the impact in ``Ω``."""
        return self.section.angular_speed

    @property
    def departure(self) -> State:
        """State just after the impact."""
        before = self.section.state
        arrays = self.rotor.arrays
        slip = arrays.drive[0] + self.angular_speed
        grip = complex(1.0, np.copysign(arrays.friction[0], slip))
        change = -(1.0 + arrays.restitution[0]) * grip * self.radial_speed * before.position
        return State(before.position, before.velocity + change)

    def trajectory(self, periods: float = 1.0) -> Trajectory:
        """Follow an admissible orbit by simulation, from just after an impact."""
        return simulate(self.rotor, self.departure, periods * self.period)

    def path(self, times: np.ndarray) -> np.ndarray:
        """Position ``U`` at times since an impact, by the closed form; for virtual orbits too.

        Parameters
        ----------
        times : array_like
            In ``1/Ω``; the orbit repeats after each period.
        """
        departure = self.departure
        start = self.rotor.amplitudes(departure.position, departure.velocity)
        position, _ = self.rotor.state(self.rotor.fly(start, np.mod(times, self.period)))
        return position


@dataclass(frozen=True, eq=False)
class OrbitSet(Sequence[Orbit]):
    """All single-impact orbits of a rotor; look one up by place or by name, ``orbits["B1,d"]``.

    Attributes
    ----------
    rotor : Rotor
    members : tuple of Orbit
    periods : ndarray
        All roots of ``F₁``.  Each gives up to two orbits.
    longest_period : float
        End of the searched range.
    complete : bool
        Whether there is provably no other root.
    """

    rotor: Rotor
    members: tuple[Orbit, ...]
    periods: np.ndarray
    longest_period: float
    complete: bool

    @property
    def argument(self) -> str:
        """Why no orbit is missing, in one sentence."""
        count = len(self.periods)
        found = f"F1 has {count} root{'' if count == 1 else 's'} for 0 < T <= {self.longest_period:.4g}/Omega"
        search = f"{found}, isolated by a bound of its second derivative"
        if self.complete:
            return f"{search}; beyond, the decay of the free motion keeps F1 above zero."
        return f"{search}; longer periods were not searched."

    def __len__(self) -> int:
        return len(self.members)

    def __iter__(self) -> Iterator[Orbit]:
        return iter(self.members)

    @overload
    def __getitem__(self, key: int | str) -> Orbit: ...
    @overload
    def __getitem__(self, key: slice) -> tuple[Orbit, ...]: ...
    def __getitem__(self, key: int | str | slice) -> Orbit | tuple[Orbit, ...]:
        if not isinstance(key, str):
            return self.members[key]
        for orbit in self.members:
            if orbit.name == key:
                return orbit
        names = ", ".join(orbit.name for orbit in self.members) or "none, there are no orbits"
        raise InputError("orbit", key, f"one of: {names}")


def period_condition(rotor: Rotor, periods: np.ndarray) -> np.ndarray:
    """``F₁(T) = 1 + Re(q a₂₂(T))``, whose roots are the periods of single-impact orbits (source paper (4.4))."""
    return PeriodCondition(rotor).value(np.asarray(periods, float))


def single_impact_orbits(rotor: Rotor, longest_period: float | None = None) -> OrbitSet:
    """All orbits with one impact a period, synchronous with the shaft.

    With ``q = (1 + d)(1 + iμ)`` and the return of the flight to its start, ``a₁₂`` and ``a₂₂`` of
    :mod:`carom.periods`, the conditions of the source paper (4.3)–(4.5) are: the period is a root of
    ``F₁(T) = 1 + Re(q a₂₂)``; ``|1 + q a₁₂ ṙ|² = |U*|²`` gives two radial speeds; ``U₀ = U*/(1 + q a₁₂ ṙ)`` and
    ``θ̇ = −Im(q a₂₂) ṙ``.  Orbits whose slip ``s + 1 + θ̇`` is backward solve the same with ``−μ``.

    Parameters
    ----------
    rotor : Rotor
        With positive damping, or with ``longest_period``.
    longest_period : float, optional
        Search only periods up to this, in ``1/Ω``.

    Returns
    -------
    OrbitSet
        Virtual orbits included, each with its reason.

    Raises
    ------
    InputError
        Without damping there are infinitely many; give ``longest_period``.
    """
    condition = PeriodCondition(rotor)
    roots = condition.roots(longest_period)
    orbits = _orbits_at(rotor, condition, roots.periods, slip=1)
    if rotor.arrays.friction[0] > 0.0:
        backward = PeriodCondition(rotor, slip=-1)
        reversed_orbits = _orbits_at(rotor, backward, backward.roots(longest_period).periods, slip=-1)
        orbits += [orbit for orbit in reversed_orbits if _slip_at(orbit) < 0.0 < orbit.radial_speed]
    return OrbitSet(rotor, tuple(orbits), roots.periods, roots.longest_period, roots.proven)


def _orbits_at(rotor: Rotor, condition: PeriodCondition, periods: np.ndarray, slip: int) -> list[Orbit]:
    # F₁ starts positive (at (1 − d)/2) unless d = 1, when T = 0 is the shorter period of the first pair.
    first = 0 if rotor.arrays.restitution[0] < 1.0 or len(periods) % 2 == 0 else 1
    orbits = []
    for index, period in enumerate(periods, start=first):
        pair, longer = index // 2 + 1, index % 2
        for high, speed in enumerate(_radial_speeds(rotor, condition, period)):
            letter = "abcd"[longer + 2 * high]
            name = f"{'B' if slip > 0 else 'R'}{pair},{letter}"
            orbits.append(_make_orbit(rotor, condition, name, float(period), speed))
    return sorted(orbits, key=lambda orbit: orbit.name)


def _radial_speeds(rotor: Rotor, condition: PeriodCondition, period: float) -> tuple[float, ...]:
    """Both solutions of ``|1 + q a₁₂ ṙ|² = |U*|²``, the lower first; none where they have coalesced."""
    lever = condition.factor * complex(condition.a12(np.asarray(period)))
    square, half = abs(lever) ** 2, lever.real
    constant = (1.0 - abs(rotor.equilibrium)) * (1.0 + abs(rotor.equilibrium))
    discriminant = half**2 - square * constant
    if discriminant < 0.0 or rotor.equilibrium == 0:
        return ()
    larger = -(half + np.copysign(np.sqrt(discriminant), half))
    if larger == 0.0:
        return (0.0, 0.0)
    return tuple(sorted((float(larger / square), float(constant / larger))))


def _make_orbit(rotor: Rotor, condition: PeriodCondition, name: str, period: float, speed: float) -> Orbit:
    at = np.asarray(period)
    position = rotor.equilibrium / (1.0 + condition.factor * complex(condition.a12(at)) * speed)
    angular_speed = -(condition.factor * complex(condition.a22(at))).imag * speed
    section = Section(cmath.phase(position), float(speed), float(angular_speed))
    jacobian = section_jacobian(rotor, section, period)
    orbit = Orbit(rotor, name, period, section, multipliers(jacobian), "")
    reason = _why_virtual(orbit)
    return Orbit(rotor, name, period, section, orbit.multipliers, reason) if reason else orbit


def _slip_at(orbit: Orbit) -> float:
    return float(orbit.rotor.arrays.drive[0] + orbit.angular_speed)


def _why_virtual(orbit: Orbit) -> str:
    arrays = orbit.rotor.arrays
    if orbit.radial_speed <= 0.0:
        return "it would meet the wall from outside (radial speed not above 0)"
    before = orbit.section.state
    _, sticks = strike(before.position, before.velocity, arrays.friction[0], arrays.restitution[0], arrays.drive[0])
    if sticks and arrays.friction[0] > 0.0:
        return "friction would stop the slip during the impact"
    departure = orbit.departure
    start = orbit.rotor.amplitudes(departure.position, departure.velocity)
    code, time = first_crossing(arrays, orbit.rotor.table, 0, start, 1.5 * orbit.period, True, workspace(len(start)))
    if code == Outcome.GRAZING:
        return f"it grazes the wall at t = {time:.6g} after the impact"
    if code == Outcome.CONTACT and abs(time - orbit.period) > ARRIVAL_TOLERANCE * orbit.period:
        return f"it would cross the wall at t = {time:.6g}, before its period is over"
    return ""
