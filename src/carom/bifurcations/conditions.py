"""Single-impact orbits by their closed form: solutions, names, and test functions that vanish at bifurcations, also of equilibria."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from carom.closed_forms.periods import PeriodCondition
from carom.closed_forms.thresholds import rolling_condition, rub_fold_condition, wall_condition
from carom.core import planar
from carom.models import Subject, exact_rotor_of, jeffcott
from carom.orbits.maps import Section, multipliers
from carom.orbits.names import OrbitName, Slip, in_order
from carom.orbits.orbit import Orbit
from carom.orbits.single_impact import orbit_at, orbits_of_roots
from carom.parameters import Numbers

BOUNDLESS, FASTEST = "radial speed without bound", 30.0
"""Radial speed, in ``c_r Ω``, beyond which orbits are not followed: with one impact it grows without bound where ``a₁₂`` vanishes."""

BELOW = 1e-4
"""Relative distance from a period within which a root counts as that period."""
PLACES = 5
"""Points of a curve at which the number of the pair is determined: it increases where a shorter pair appears."""

CORRECTIONS, CORRECTED = 12, 1e-10
"""Largest number of steps of Newton's method, and the last of them, relative: the error that is left is its square."""


class OrbitConditions(NamedTuple):
    """Equations and test functions of a single-impact orbit; see :func:`carom.core.planar.orbit_conditions`."""

    closing: float
    balance: float
    period_fold: float
    speed_fold: float
    boundary: float
    slip_stop: float
    period_doubling: float
    neimark_sacker: float
    pair_sum: float
    lever: complex
    turn: complex


class RadialProfile(NamedTuple):
    """The radius between the impacts; see :func:`carom.core.planar.radial_profile`."""

    height: float
    top: float
    flattest: float


def with_slip(numbers: Numbers, slip: int) -> Numbers:
    """Numbers for orbits with forward or backward slip, which obey the equations of forward slip with negative ``mu``."""
    return numbers if slip >= 0 else numbers._replace(mu=-numbers.mu)


@lru_cache(maxsize=64)
def conditions_at(numbers: Numbers, period: float, speed: float) -> OrbitConditions:
    """Conditions of an orbit with forward slip, given by its period and radial speed."""
    gamma, omega, rho, _, mu, d, radius_ratio, *_ = numbers
    return OrbitConditions(*planar.orbit_conditions(gamma, omega, rho, mu, d, radius_ratio + 1.0, period, speed))


@lru_cache(maxsize=8)
def profile_at(numbers: Numbers, period: float, speed: float) -> RadialProfile:
    """Extrema of the radius between the impacts."""
    gamma, omega, _, _, mu, d, *_ = numbers
    return RadialProfile(*planar.radial_profile(gamma, omega, mu, d, period, speed))


def grazing_equations(numbers: Numbers, period: float, speed: float, time: float) -> tuple[float, float]:
    """``Re(Ū U̇)`` and ``r² − 1`` at a time after the impact; both vanish where the orbit grazes the wall."""
    gamma, omega, _, _, mu, d, *_ = numbers
    return planar.radial_course(gamma, omega, mu, d, period, speed, time)


def jacobian_at(numbers: Numbers, period: float, speed: float) -> np.ndarray:
    """Derivative of the impact map with respect to ``(θ, ṙ, θ̇)``, shape (3, 3)."""
    gamma, omega, _, _, mu, d, *_ = numbers
    return planar.impact_jacobian(gamma, omega, mu, d, period, speed)


def spectral_radii(orbits: Sequence[tuple[Numbers, float, float]]) -> list[float]:
    """Largest modulus of the non-trivial multipliers of each orbit; it is stable where that is below 1."""
    if not orbits:
        return []
    return np.abs(np.linalg.eigvals([jacobian_at(*orbit) for orbit in orbits])).max(axis=1).tolist()


def margins_of(numbers: Numbers, period: float, speed: float) -> dict[str, float]:
    """Margins of the conditions for an orbit to be a motion of the machine: it is one if all are positive.

    Each by the kind of special point at which it vanishes: the radial speed, the slip after the impact (backward if
    ``mu`` is negative), the depth of the highest maximum of the radius below the wall (in ``r²``), and without rebound
    the pull off the wall.  Infinite where a condition does not apply.
    """
    slip, away = math.inf, math.inf
    if numbers.mu != 0.0:
        slip = math.copysign(1.0, numbers.mu) * conditions_at(numbers, period, speed).slip_stop
    if numbers.d == 0.0:
        away = -pressed_on(numbers, period, speed)
    height = profile_at(numbers, period, speed).height
    grazing = math.inf if math.isnan(height) else -height
    return {"non-smooth-hopf": speed, "slip-stop": slip, "grazing": grazing, "contact-onset": away}


def is_admissible(numbers: Numbers, period: float, speed: float) -> bool:
    """Whether the orbit stays inside the wall, judged by the extrema of its radius, and keeps its direction of slip.

    This is no proof; :attr:`carom.orbits.single_impact.Orbit.admissible` rests on a certified search.
    """
    return speed > 0.0 and min(margins_of(numbers, period, speed).values()) > 0.0


def corrected(numbers: Numbers, period: float, speed: float) -> tuple[float, float] | None:
    """Period and radial speed of the orbit at these parameters near a guess, by Newton's method; ``None`` if it does not converge."""
    for _ in range(CORRECTIONS):
        at = conditions_at(numbers, period, speed)
        if not (at.period_fold and at.speed_fold and math.isfinite(at.closing + at.balance)):
            return None
        step, change = at.closing / at.period_fold, at.balance / (2.0 * at.speed_fold)
        period, speed = max(period - step, 0.5 * period), speed - change
        if abs(step) < CORRECTED * period and abs(change) < CORRECTED * (1.0 + abs(speed)):
            return period, speed
    return None


def name_of(numbers: Numbers, pair: int, period: float, speed: float) -> OrbitName:
    """Name of an orbit whose pair is known; it has backward slip if ``mu`` is negative."""
    conditions = conditions_at(numbers, period, speed)
    return OrbitName(pair, conditions.period_fold > 0.0, conditions.speed_fold > 0.0, -1 if numbers.mu < 0.0 else 1)


def orbits_joined_at(kind: str, name: OrbitName) -> tuple[OrbitName, ...]:
    """Orbits that meet at a special point of an orbit: two at a fold, the longer or faster one last; else itself."""
    if kind == "fold":
        return replace(name, longer=False), replace(name, longer=True)
    if kind == "speed-fold":
        return replace(name, faster=False), replace(name, faster=True)
    return (name,)


def orbits_on_curve(kind: str, points: Sequence[tuple[Numbers, float, float]]) -> tuple[OrbitName, ...]:
    """Names of the orbits that bifurcate on a curve, in order, from numbers, period and radial speed along it."""
    last = max(len(points) - 1, 1)
    pairs = [_pair(*points[i][:2]) for i in np.linspace(0, len(points) - 1, PLACES).round().astype(int)]
    names: set[OrbitName] = set()
    for i, (numbers, period, speed) in enumerate(points):
        pair = pairs[round(i / last * (PLACES - 1))]
        names.update(orbits_joined_at(kind, name_of(numbers, pair, period, speed)))
    return in_order(names)


def _pair(numbers: Numbers, period: float) -> int:
    """Number of the pair of periods, counted by the shorter roots of ``F₁``."""
    shorter = PeriodCondition.planar(numbers.parameters).roots((1.0 - BELOW) * period)
    return (len(shorter.periods) + int(shorter.starts_below)) // 2 + 1


class Solution(NamedTuple):
    """A solution, without multipliers and without certified admissibility."""

    name: OrbitName
    numbers: Numbers
    """Parameters; with negative ``mu`` for backward slip."""
    period: float
    radial_speed: float
    """In ``1/Ω`` and ``c_r Ω``."""


def orbit_solutions(machine: Subject, longest_period: float | None = None, *, backward: bool = False) -> list[Solution]:
    """Solve the equations at all roots of ``F₁`` up to a longest period, in ``1/Ω``, with forward or backward slip.

    Only solutions with a positive radial speed, which meet the wall from inside; see
    :func:`carom.orbits.single_impact.find_orbits`.
    """
    rotor = exact_rotor_of(machine)
    if rotor.equilibrium == 0.0:
        return []
    slip: Slip = -1 if backward else 1
    numbers = with_slip(Numbers.of(rotor.parameters), slip)
    roots = PeriodCondition.planar(rotor.parameters, slip).roots(longest_period)
    periods: list[float] = roots.periods.tolist()
    orbits = orbits_of_roots(rotor, roots, slip)
    return [Solution(name, numbers, periods[root], speed) for name, root, speed in orbits if speed > 0.0]


def orbit_of(numbers: Numbers, pair: int, period: float, speed: float) -> Orbit:
    """Orbit with certified admissibility and its multipliers; it has backward slip if ``mu`` is negative."""
    conditions = conditions_at(numbers, period, speed)
    stiffness = complex(numbers.omega**2 - 1.0, numbers.gamma)
    angle = numbers.phi - cmath.phase(stiffness) - cmath.phase(1.0 + conditions.lever * speed)
    section = Section(math.remainder(angle, math.tau), speed, -conditions.turn.imag * speed)
    name, nontrivial = name_of(numbers, pair, period, speed), multipliers(jacobian_at(numbers, period, speed))
    rotor = jeffcott(numbers._replace(mu=abs(numbers.mu)).parameters)
    return orbit_at(rotor, name, period, section, nontrivial)


def pressed_on(numbers: Numbers, period: float, speed: float) -> float:
    """Normal force, in ``m c_r Ω²``, with which the rotor would be pressed on the wall just after the impact.

    It is ``Re(Ū Ü) + |U̇|²`` with the velocity after the impact, in the frame that has the impact at ``U = 1``.  For a
    rotor that does not rebound (``d = 0``) lasting contact begins where it grows through zero.
    """
    conditions = conditions_at(numbers, period, speed)
    damping, stiffness = complex(numbers.gamma, 2.0), complex(numbers.omega**2 - 1.0, numbers.gamma)
    factor = (1.0 + numbers.d) * complex(1.0, numbers.mu)
    velocity = speed * (complex(1.0, -conditions.turn.imag) - factor)
    return float((stiffness * conditions.lever * speed - damping * velocity).real + abs(velocity) ** 2)


RESONANCES = {"resonance-1:1": 2.0, "resonance-1:2": -2.0, "resonance-1:3": -1.0, "resonance-1:4": 0.0}
"""Sum of two multipliers of modulus one at each of their resonances."""
ENDING = ("resonance-1:1", "resonance-1:2")
"""Resonances at which curves of Neimark–Sacker bifurcations begin and end: two multipliers meet at 1, or at −1."""
TESTS: dict[str, Callable[[Numbers, float, float], float]] = {
    "fold": lambda n, period, speed: conditions_at(n, period, speed).period_fold,
    "speed-fold": lambda n, period, speed: conditions_at(n, period, speed).speed_fold,
    "period-doubling": lambda n, period, speed: conditions_at(n, period, speed).period_doubling,
    "neimark-sacker": lambda n, period, speed: conditions_at(n, period, speed).neimark_sacker,
    "grazing": lambda n, period, speed: profile_at(n, period, speed).height,
    "slip-stop": lambda n, period, speed: conditions_at(n, period, speed).slip_stop,
    "non-smooth-hopf": lambda n, period, speed: speed,
    "boundary-equilibrium": lambda n, period, speed: wall_condition(n),
    "rub-fold": lambda n, period, speed: rub_fold_condition(n),
    "rolling-limit": lambda n, period, speed: rolling_condition(n),
    "levitation-lost": lambda n, period, speed: -n.gamma,
    "contact-onset": lambda n, period, speed: pressed_on(n, period, speed) if n.d == 0.0 else math.nan,
    **{
        kind: lambda n, period, speed, total=total: conditions_at(n, period, speed).pair_sum - total  # type: ignore[misc]
        for kind, total in RESONANCES.items()
    },
}
"""Functions of the numbers, the period and the radial speed that vanish at each kind of special point."""
