"""Branches of orbits along a parameter, and those of orbits with one impact a period by the equations of the closed form."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from carom.bifurcations.conditions import (
    BOUNDLESS,
    FASTEST,
    SHORTEST,
    TESTS,
    conditions_at,
    corrected,
    is_admissible,
    jacobian_at,
    margins_of,
    name_of,
    orbit_of,
    profile_at,
    relative_to_speed,
)
from carom.bifurcations.derivatives import orbit_jacobian
from carom.bifurcations.naming import meeting_at
from carom.bifurcations.points import Bifurcation
from carom.continuation import SpecialPoint, Steps, Watch, continue_branch
from carom.models import Model
from carom.models.axes import Axis, Ends, axis, interval_around
from carom.orbits.names import CountedName, OrbitName
from carom.orbits.orbit import Orbit
from carom.orbits.shooting import Start
from carom.orbits.word import Word
from carom.outcome import CaromError
from carom.parameters import Numbers
from carom.results import Result

if TYPE_CHECKING:
    from carom.bifurcations.words import WordOrbits

STEPS = Steps(first=0.02, largest=0.06, sharpest_turn=0.2, most_points=1500)
NOTHING = 1e-8
"""Radial speed that counts as zero because of rounding."""
EMERGING = 1e-4
"""Time of a maximum, in periods, below which its height is only rounding: the height grows with the cube of the time."""
SMALL = 1e-4
"""Radial speed of the orbit that represents those shrinking to a point."""
WATCHED = (
    "period-doubling",
    "neimark-sacker",
    "grazing",
    "radius-extremum",
    "non-smooth-hopf",
    "slip-stop",
    "contact-onset",
)


@dataclass(frozen=True, eq=False, repr=False)
class OrbitBranch(Result):
    """Orbits of a word along a parameter, motions of the machine and others.

    Attributes
    ----------
    axis : Axis
        The parameter.
    name : OrbitName or CountedName
        Name of the orbit from which it was followed.
    word : Word
    rotor : Model
        The rotor of that orbit.
    values : ndarray, shape (m,)
        The parameter.
    points : SingleImpactOrbits or WordOrbits
        Its orbits, by the unknowns of the equations: those of the closed form for orbits with one impact, otherwise those of
        multiple shooting.
    special : tuple of Bifurcation
        In the order of the branch.
    stops : tuple of two str
        Reason for its end at both ends: ``"radial speed without bound"``, ``"period-halving"``, or see
        :class:`~carom.continuation.Branch`.
    """

    rests_on: ClassVar[tuple[str, ...]] = ("mora2014", "keller1977", "squire1998")

    shown: ClassVar[tuple[str, ...]] = (
        "parameter",
        "name",
        "word",
        "values",
        "period",
        "radial_speed",
        "special",
        "stops",
    )

    axis: Axis
    name: OrbitName | CountedName
    word: Word
    rotor: Model
    values: np.ndarray
    points: SingleImpactOrbits | WordOrbits
    special: tuple[Bifurcation, ...]
    stops: tuple[str, str]

    def __len__(self) -> int:
        return len(self.values)

    @property
    def parameter(self) -> str:
        """Name of the parameter."""
        return self.axis.name

    @property
    def closed(self) -> SingleImpactOrbits:
        """Its orbits, with the unknowns of the closed form.

        Raises
        ------
        CaromError
            It was followed by multiple shooting.
        """
        if not isinstance(self.points, SingleImpactOrbits):
            raise CaromError(f"the branch of {self.name} was not followed by the closed form")
        return self.points

    @property
    def impacts(self) -> int:
        """Impacts per period."""
        return self.word.impacts

    @property
    def orbits(self) -> tuple[Orbit, ...]:
        """Every orbit, with its multipliers and its admissibility certified."""
        return self.points.orbits

    @property
    def names(self) -> tuple[OrbitName | CountedName, ...]:
        """Names of the orbits; those of the closed form change at folds, others do not."""
        return self.points.names

    @property
    def period(self) -> np.ndarray:
        """Periods in ``1/Ω``, shape (m,)."""
        return self.points.period

    @property
    def radial_speeds(self) -> np.ndarray:
        """``ṙ`` just before each impact in ``c_r Ω``, shape (m, n)."""
        return self.points.radial_speeds

    @property
    def radial_speed(self) -> np.ndarray:
        """``ṙ`` just before the first impact in ``c_r Ω``, shape (m,); ``nan`` without impacts."""
        first: np.ndarray = self.radial_speeds[:, 0] if self.impacts else np.full(len(self), np.nan)
        return first

    @property
    def angular_speed(self) -> np.ndarray:
        """``θ̇`` just before the first impact in ``Ω``, shape (m,)."""
        return self.points.angular_speed

    @property
    def admissible(self) -> np.ndarray:
        """Which orbits are motions of the machine, bool, shape (m,); the closed form judges by the extrema of the radius."""
        return self.points.admissible

    @property
    def multipliers(self) -> np.ndarray:
        """Non-trivial Floquet multipliers, complex, shape (m, 2N − 1)."""
        return self.points.multipliers

    @property
    def stable(self) -> np.ndarray:
        """Which orbits have all multipliers inside the unit circle, bool, shape (m,)."""
        return np.abs(self.multipliers).max(axis=1) < 1.0

    def starts_at(self, value: float) -> list[Start]:
        """Nodes and durations of its orbits at a value of the parameter, one for each time it passes there."""
        return self.points.starts_at(value)


def passing(values: np.ndarray, value: float) -> Iterator[tuple[int, float]]:
    """Steps of a branch that pass a value of the parameter: index of the first point, and share of the step before the value."""
    for i in np.flatnonzero((values[:-1] - value) * (values[1:] - value) <= 0.0).tolist():
        width = values[i + 1] - values[i]
        yield i, float((value - values[i]) / width) if width else 0.0


@dataclass(frozen=True, eq=False)
class SingleImpactOrbits:
    """Orbits with one impact a period, by their two unknowns in the closed form.

    Attributes
    ----------
    parameter : str
    values : ndarray, shape (m,)
    pair : int
        Number of the pair of periods, from 1.
    numbers : tuple of Numbers
        Parameters of each; with negative ``mu`` if the orbits slip backward.
    period, radial_speed : ndarray, shape (m,)
        ``T`` and ``ṙ`` before the impact.
    """

    parameter: str
    values: np.ndarray
    pair: int
    numbers: tuple[Numbers, ...]
    period: np.ndarray
    radial_speed: np.ndarray

    @property
    def radial_speeds(self) -> np.ndarray:
        """``ṙ`` just before the impact, shape (m, 1)."""
        return self.radial_speed[:, None]

    @cached_property
    def orbits(self) -> tuple[Orbit, ...]:
        """Every orbit, with its admissibility certified."""
        return tuple(orbit_of(numbers, self.pair, period, speed) for numbers, period, speed in self._each)

    @cached_property
    def names(self) -> tuple[OrbitName, ...]:
        """Names of the orbits; they change at folds."""
        return tuple(name_of(numbers, self.pair, period, speed) for numbers, period, speed in self._each)

    @cached_property
    def admissible(self) -> np.ndarray:
        """Which orbits are motions of the machine, judged by the extrema of their radius; bool, shape (m,)."""
        return np.array([is_admissible(*point) for point in self._each])

    @cached_property
    def multipliers(self) -> np.ndarray:
        """Non-trivial Floquet multipliers, complex, shape (m, 3)."""
        return np.linalg.eigvals(np.array([jacobian_at(*point) for point in self._each])).astype(complex)

    @cached_property
    def angular_speed(self) -> np.ndarray:
        """``θ̇`` before the impact, shape (m,)."""
        return np.array([-conditions_at(*point).turn.imag * point[2] for point in self._each])

    def at(self, value: float) -> Numbers:
        """Parameters of an orbit of this branch at a value of its parameter."""
        numbers = self.numbers[0].moved(self.parameter, value)
        return numbers._replace(mu=-abs(numbers.mu)) if self.numbers[0].mu < 0.0 else numbers

    def starts_at(self, value: float) -> list[Start]:
        """Node and duration of the orbits at a value of the parameter, one for each time the branch passes there."""
        found, numbers = [], self.at(value)
        for i, share in passing(self.values, value):
            period, speed = (
                float((1.0 - share) * each[i] + share * each[i + 1]) for each in (self.period, self.radial_speed)
            )
            orbit = orbit_of(numbers, self.pair, *corrected(numbers, period, speed))
            found.append(Start(orbit.nodes, orbit.durations))
        return found

    @property
    def _each(self) -> list[tuple[Numbers, float, float]]:
        return list(zip(self.numbers, self.period.tolist(), self.radial_speed.tolist(), strict=True))


def continue_single_impact(orbit: Orbit, parameter: str, interval: Ends, steps: Steps | None = None) -> OrbitBranch:
    """Continue an orbit with one impact a period along a parameter, through folds and where it is virtual.

    The unknowns are the period and the radial speed; the equations are ``F₁(T) = 0`` and ``|1 + q a₁₂ ṙ|² = |U*|²``
    (source paper (4.3), (4.4)).

    Parameters
    ----------
    parameter : str
        Dimensionless (``"gamma"``) or physical (``"speed"``, SI units; needs scales).
    interval : tuple of float or str
        Range of the parameter; it must contain the orbit's own value.  ``("300 N s/m", "2000 N s/m")`` has units.

    Raises
    ------
    InputError
        Unknown parameter, or an interval without the orbit.
    """
    base = Numbers.of(orbit.rotor.parameters)
    along = axis(orbit.rotor, parameter)
    present, limits = interval_around(along, along.value(orbit.rotor), interval)
    pair = orbit.name.pair

    def numbers_at(p: float) -> Numbers:
        # Backward slip with friction μ obeys the equations of forward slip with −μ.
        numbers = base.moved(along.name, p)
        return numbers if orbit.slip > 0 else numbers._replace(mu=-numbers.mu)

    def residual(u: np.ndarray, p: float) -> np.ndarray:
        if not u[0] > SHORTEST:
            return np.full(2, np.nan)
        return np.array(conditions_at(numbers_at(p), float(u[0]), float(u[1]))[:2])

    def jacobian(u: np.ndarray, p: float) -> np.ndarray:
        return orbit_jacobian(numbers_at, (p,), *u.tolist())

    def watch(kind: str) -> Watch:
        test = TESTS[kind]
        return Watch(kind, lambda u, p: test(numbers_at(p), float(u[0]), float(u[1])))

    fastest = max(FASTEST, 2.0 * abs(orbit.radial_speed))
    size = max(abs(present), 0.1 * (limits[1] - limits[0]))
    branch = continue_branch(
        residual,
        np.array([orbit.period, orbit.radial_speed]),
        present,
        limits,
        jacobian=jacobian,
        watches=[*map(watch, WATCHED), Watch(BOUNDLESS, lambda u, _: fastest - abs(u[1]), ends_branch=True)],
        steps=steps or STEPS,
        scales=np.array([1.0, 1.0, size]),
        reach=relative_to_speed,
        crossings="",
    )
    special = (_bifurcation(point, along.name, numbers_at(point.parameter), pair) for point in branch.special)
    return OrbitBranch(
        axis=along,
        name=orbit.name,
        word=orbit.word,
        rotor=orbit.rotor,
        values=branch.parameters,
        points=SingleImpactOrbits(
            along.name,
            branch.parameters,
            pair,
            tuple(numbers_at(p) for p in branch.parameters.tolist()),
            branch.unknowns[:, 0],
            branch.unknowns[:, 1],
        ),
        special=tuple(point for point in special if point is not None),
        stops=branch.stops,
    )


def _bifurcation(point: SpecialPoint, parameter: str, numbers: Numbers, pair: int) -> Bifurcation | None:
    """Special point of the continuation as a bifurcation of orbits; ``None`` if it is none.

    Two real multipliers with the product one are no Neimark–Sacker bifurcation.  The height of the radius also changes sign
    where the orbit shrinks to nothing and, without rebound, where its maximum emerges from the impact as lasting contact
    begins; neither is grazing.
    """
    at = numbers, float(point.unknowns[0]), float(point.unknowns[1])
    conditions = conditions_at(*at)
    kind = point.kind
    if kind == BOUNDLESS or (kind == "neimark-sacker" and abs(conditions.pair_sum) >= 2.0):
        return None
    if kind == "grazing" and (abs(at[2]) < NOTHING or not profile_at(*at).top > EMERGING * at[1]):
        return None
    if kind == "fold" and abs(conditions.speed_fold) < abs(conditions.period_fold):
        kind = "speed-fold"
    name = meeting_at(kind, name_of(numbers, pair, *at[1:]))[-1]
    return Bifurcation(kind, *at, name, parameter, point.parameter, _bounds_admissible(kind, *at), place=point.place)


def _bounds_admissible(kind: str, numbers: Numbers, period: float, speed: float) -> bool:
    """Whether the orbits on at least one side of a special point are motions of the machine."""
    if kind == "non-smooth-hopf":
        speed = SMALL
    slips = kind == "slip-stop" or margins_of(numbers, period, speed)["slip-stop"] > 0.0
    # At the onset of lasting contact the radius may have a maximum of zero height next to the impact.
    slack = 1e-9 if kind == "contact-onset" else 0.0
    inside = kind == "grazing" or not profile_at(numbers, period, speed).height >= slack
    return speed > 0.0 and slips and inside
