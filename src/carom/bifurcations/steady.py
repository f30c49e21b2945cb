"""Steady motions along one parameter: levitation, synchronous rubs and rolling, with their special points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.bifurcations.axes import Axis, Numbers
from carom.bifurcations.conditions import TESTS
from carom.closed_forms.equilibria import find_equilibria
from carom.closed_forms.whirl import rolling
from carom.continuation.roots import bracketed_root
from carom.models import Jeffcott
from carom.parameters import Parameters
from carom.results import Result

__all__ = [
    "EquilibriumBranch",
    "RollingBranch",
    "SpecialValue",
    "equilibrium_branches",
    "happens_to_rubs",
    "rolling_branch",
    "steady_points",
]

SAMPLES = 201


@dataclass(frozen=True)
class SpecialValue:
    """A special point of a diagram.

    Attributes
    ----------
    kind : str
        That of a :class:`~carom.bifurcations.branches.Bifurcation`, ``"boundary-equilibrium"``, ``"rub-fold"`` or
        ``"rolling-limit"`` (rolling in backward whirl begins or ceases to hold at every angle).
    branch : str
        Orbit or steady motion it belongs to.
    parameter : str
    value : float
        In SI units if the parameter is physical.
    period : float or None
    radial_speed : float or None
    admissible : bool
        Whether it happens to a motion of the machine, or to one that just begins or ends to be one.
    detail : str
        Of a boundary equilibrium ``"persistence"`` (levitation goes over into rub: a rub begins) or ``"non-smooth fold"``
        (levitation and an unstable rub vanish together).
    """

    kind: str
    branch: str
    parameter: str
    value: float
    period: float | None
    radial_speed: float | None
    admissible: bool
    detail: str = ""


@dataclass(frozen=True, eq=False, repr=False)
class EquilibriumBranch(Result):
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


@dataclass(frozen=True, eq=False, repr=False)
class RollingBranch(Result):
    """Rolling round the bearing in backward whirl (:mod:`carom.closed_forms.whirl`) along the parameter.

    Attributes
    ----------
    values, largest_force : ndarray, shape (m,)
        The normal force, largest in a turn, is in ``m c_r Ω²``.
    holds : ndarray of bool, shape (m,)
        Whether a rotor that rolls goes on rolling.
    """

    values: np.ndarray
    largest_force: np.ndarray
    holds: np.ndarray


def rolling_branch(parameters: Parameters, along: Axis, interval: tuple[float, float]) -> RollingBranch:
    """Where the rotor can roll, on an even grid."""
    base = Numbers.of(parameters)
    grid = np.linspace(*interval, SAMPLES)
    found = [rolling(Jeffcott(along.set(base, value).parameters)) for value in grid.tolist()]
    return RollingBranch(
        grid, np.array([entry.largest_force for entry in found]), np.array([entry.holds for entry in found])
    )


def steady_points(parameters: Parameters, along: Axis, interval: tuple[float, float]) -> list[SpecialValue]:
    """Boundary equilibria, folds of rubs and limits of rolling on an interval."""
    base = Numbers.of(parameters)
    grid = np.linspace(*interval, SAMPLES).tolist()
    points = []
    kinds = (("boundary-equilibrium", "contact-free"), ("rub-fold", "rub"), ("rolling-limit", "rolling"))
    for kind, branch in kinds:

        def function(value: float, kind: str = kind) -> float:
            return TESTS[kind](along.set(base, value), 1.0, 0.0)

        values = np.array([function(value) for value in grid])
        for i in np.flatnonzero(values[:-1] * values[1:] < 0.0):
            root = bracketed_root(function, grid[i], grid[i + 1])
            at = along.set(base, root)
            real = {"rub-fold": happens_to_rubs, "rolling-limit": _rolling_presses}.get(kind, lambda _: True)(at)
            detail = _what_becomes_of_levitation(at) if kind == "boundary-equilibrium" else ""
            points.append(SpecialValue(kind, branch, along.name, root, None, None, real, detail))
    return points


def _what_becomes_of_levitation(numbers: Numbers) -> str:
    """Persistence where the synchronous rub lives on the other side, ``1 − ω² < μγ`` (:mod:`carom.bifurcations.boundary`)."""
    return "persistence" if 1.0 - numbers.omega**2 < numbers.mu * numbers.gamma else "non-smooth fold"


def _rolling_presses(numbers: Numbers) -> bool:
    """Whether the rotor stays on the wall at every angle while it rolls: ``s² − ω² > ρ``."""
    return numbers.radius_ratio**2 - numbers.omega**2 > numbers.rho


def happens_to_rubs(numbers: Numbers) -> bool:
    """Whether, at a fold of rubs, the rubs that meet are pressed on the wall: ``N = ρ cos x + 1 − ω²`` with ``tan x = −1/μ`` there."""
    cosine = -numbers.mu / np.hypot(1.0, numbers.mu)
    return bool(numbers.rho * cosine + 1.0 - numbers.omega**2 > 0.0)


def equilibrium_branches(
    parameters: Parameters, along: Axis, interval: tuple[float, float]
) -> tuple[EquilibriumBranch, ...]:
    """Levitation and both rubs on an even grid."""
    base = Numbers.of(parameters)
    grid = np.linspace(*interval, SAMPLES)
    kinds = ("contact-free", "stable rub", "saddle rub")
    table = np.full((len(kinds), len(grid), 4), np.nan)
    for column, value in enumerate(grid.tolist()):
        for equilibrium in find_equilibria(Jeffcott(along.set(base, value).parameters)):
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
