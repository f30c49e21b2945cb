"""Bifurcation diagrams: every equilibrium and every single-impact orbit along one parameter."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from carom.bifurcations.axes import Axis, Numbers, axis, vary
from carom.bifurcations.branches import Bifurcation, OrbitBranch, continue_orbit
from carom.bifurcations.conditions import TESTS, conditions_at
from carom.equilibria import equilibria
from carom.orbits import Orbit, single_impact_orbits
from carom.outcome import InputError
from carom.parameters import Parameters
from carom.roots import bracketed_root
from carom.rotors import jeffcott

__all__ = ["Diagram", "EquilibriumBranch", "SpecialValue", "bifurcation_diagram"]

SAMPLES = 13
"""Values of the parameter at which all orbits are looked for."""
EQUILIBRIUM_SAMPLES = 201
SAME = 1e-6
"""Distance in period and radial speed below which an orbit lies on a known branch."""
LONGEST_PERIOD = 60.0
"""Periods above, in ``1/Ω``, are not searched where damping is so weak that there would be hundreds of pairs."""


@dataclass(frozen=True)
class SpecialValue:
    """A special point of a diagram.

    Attributes
    ----------
    kind : str
        That of a :class:`~carom.bifurcations.branches.Bifurcation`, ``"boundary-equilibrium"`` or ``"rub-fold"``.
    branch : str
        Orbit or equilibrium it belongs to.
    parameter : str
    value : float
        In SI units if the parameter is physical.
    period : float or None
    radial_speed : float or None
    admissible : bool
        Whether it happens to a motion of the machine, or to one that just begins or ends to be one.
    """

    kind: str
    branch: str
    parameter: str
    value: float
    period: float | None
    radial_speed: float | None
    admissible: bool


@dataclass(frozen=True, eq=False)
class EquilibriumBranch:
    """Equilibria of one kind along the parameter; ``nan`` where there is none.

    Attributes
    ----------
    kind : str
        ``"contact-free"``, ``"stable rub"`` or ``"saddle rub"``.
    values, radius, normal_force : ndarray, shape (m,)
    admissible, stable : ndarray of bool, shape (m,)
    """

    kind: str
    values: np.ndarray
    radius: np.ndarray
    normal_force: np.ndarray
    admissible: np.ndarray
    stable: np.ndarray


@dataclass(frozen=True, eq=False)
class Diagram:
    """All equilibria and single-impact orbits along one parameter.

    Attributes
    ----------
    axis : Axis
        The parameter.
    interval : tuple of float
    equilibria : tuple of EquilibriumBranch
    orbits : tuple of OrbitBranch
    points : tuple of SpecialValue
        In growing order of the parameter.
    """

    axis: Axis
    interval: tuple[float, float]
    equilibria: tuple[EquilibriumBranch, ...]
    orbits: tuple[OrbitBranch, ...]
    points: tuple[SpecialValue, ...]

    @property
    def parameter(self) -> str:
        """Name of the parameter."""
        return self.axis.name


def bifurcation_diagram(
    parameters: Parameters,
    parameter: str,
    interval: tuple[float, float],
    *,
    virtual: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Diagram:
    """Find every branch on an interval, and every special point on it.

    Single-impact orbits are all found (:func:`~carom.orbits.single_impact_orbits`) at 13 evenly spaced values, and each
    one that lies on no branch yet is continued both ways.

    Parameters
    ----------
    parameters : Parameters
    parameter : str
        Dimensionless or physical name.
    interval : tuple of float
        In SI units if the parameter is physical.
    virtual : bool
        Follow all orbits, also those of higher pairs that are virtual wherever they were looked at.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    Diagram

    Raises
    ------
    InputError
        Empty interval, unknown parameter, or one that is out of its range.
    """
    along = axis(parameters, parameter)
    if not (np.isfinite(interval).all() and interval[0] < interval[1]):
        raise InputError(parameter, f"{interval[0]:g} to {interval[1]:g}", "an interval of two growing finite values")
    branches: list[OrbitBranch] = []
    for done, value in enumerate(np.linspace(*interval, SAMPLES).tolist()):
        for orbit in _orbits(vary(parameters, parameter, value)):
            wanted = virtual or orbit.admissible or orbit.name.startswith("B1,")
            if wanted and not any(_lies_on(orbit, value, branch) for branch in branches):
                branches.append(continue_orbit(orbit, parameter, interval))
        if progress:
            progress((done + 1) / SAMPLES)
    points = [*_equilibrium_points(parameters, along, interval), *_orbit_points(branches)]
    return Diagram(
        axis=along,
        interval=interval,
        equilibria=_equilibrium_branches(parameters, along, interval),
        orbits=tuple(branches),
        points=tuple(sorted(points, key=lambda point: point.value)),
    )


def _orbits(parameters: Parameters) -> Iterator[Orbit]:
    """Orbits with forward slip; none without damping, where there are infinitely many."""
    if parameters.gamma > 0.0 and parameters.rho > 0.0:
        longest = LONGEST_PERIOD if parameters.gamma < 0.05 else None
        yield from (orbit for orbit in single_impact_orbits(jeffcott(parameters), longest) if orbit.slip > 0)


def _lies_on(orbit: Orbit, value: float, branch: OrbitBranch) -> bool:
    """Whether a branch passes through an orbit.

    Where it passes the value, its period there is found by Newton's method from both neighbours.
    """
    slack = 1e-9 * abs(branch.values.max() - branch.values.min())
    offset = branch.values - value
    first, last = np.minimum(offset[:-1], offset[1:]), np.maximum(offset[:-1], offset[1:])
    numbers = Numbers.of(orbit.rotor.parameters)
    for i in np.flatnonzero((first <= slack) & (last >= -slack)):
        for end in (i, i + 1):
            found = _corrected(numbers, float(branch.period[end]), float(branch.radial_speed[end]))
            if max(abs(found[0] - orbit.period), abs(found[1] - orbit.radial_speed)) < SAME * (1.0 + orbit.period):
                return True
    return False


def _corrected(numbers: Numbers, period: float, speed: float) -> tuple[float, float]:
    """Orbit at these parameters near a guess."""
    for _ in range(12):
        at = conditions_at(numbers, period, speed)
        step = at.closing / at.period_fold if at.period_fold else 0.0
        change = at.balance / (2.0 * at.speed_fold) if at.speed_fold else 0.0
        if abs(step) < 1e-13 and abs(change) < 1e-13:
            break
        period, speed = max(period - step, 0.5 * period), speed - change
    return period, speed


def _orbit_points(branches: list[OrbitBranch]) -> list[SpecialValue]:
    return [_special_value(point) for branch in branches for point in branch.special]


def _special_value(point: Bifurcation) -> SpecialValue:
    return SpecialValue(
        point.kind, point.name, point.parameter, point.value, point.period, point.radial_speed, point.admissible
    )


def _equilibrium_points(parameters: Parameters, along: Axis, interval: tuple[float, float]) -> list[SpecialValue]:
    base = Numbers.of(parameters)
    grid = np.linspace(*interval, EQUILIBRIUM_SAMPLES).tolist()
    points = []
    for kind, branch in (("boundary-equilibrium", "contact-free"), ("rub-fold", "rub")):

        def function(value: float, kind: str = kind) -> float:
            return TESTS[kind](along.set(base, value), 1.0, 0.0)

        values = np.array([function(value) for value in grid])
        for i in np.flatnonzero(values[:-1] * values[1:] < 0.0):
            root = bracketed_root(function, grid[i], grid[i + 1])
            real = kind == "boundary-equilibrium" or _rub_presses(along.set(base, root))
            points.append(SpecialValue(kind, branch, along.name, root, None, None, real))
    return points


def _rub_presses(numbers: Numbers) -> bool:
    """Whether the rubs that meet are pressed on the wall: ``N = ρ cos x + 1 − ω²`` with ``tan x = −1/μ`` there."""
    cosine = -numbers.mu / np.hypot(1.0, numbers.mu)
    return bool(numbers.rho * cosine + 1.0 - numbers.omega**2 > 0.0)


def _equilibrium_branches(
    parameters: Parameters, along: Axis, interval: tuple[float, float]
) -> tuple[EquilibriumBranch, ...]:
    base = Numbers.of(parameters)
    grid = np.linspace(*interval, EQUILIBRIUM_SAMPLES)
    kinds = ("contact-free", "stable rub", "saddle rub")
    table = np.full((len(kinds), len(grid), 4), np.nan)
    for column, value in enumerate(grid.tolist()):
        for equilibrium in equilibria(jeffcott(along.set(base, value).parameters)):
            place = 0 if equilibrium.kind == "contact-free" else 1 if equilibrium.stable else 2
            table[place, column] = (
                equilibrium.radius,
                equilibrium.normal_force,
                equilibrium.status == "admissible",
                equilibrium.stable,
            )
    return tuple(
        EquilibriumBranch(kind, grid, rows[:, 0], rows[:, 1], rows[:, 2] == 1.0, rows[:, 3] == 1.0)
        for kind, rows in zip(kinds, table, strict=True)
    )
