"""Steady motions along one parameter: levitation, synchronous rubs and rolling, with their special points."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.optimize import minimize_scalar  # type: ignore[import-untyped]

from carom.base.results import Result
from carom.base.roots import bracketed_root
from carom.bifurcations.conditions import TESTS
from carom.bifurcations.points import LOST, STEADY, Bifurcation, happens_steadily
from carom.closed_forms.equilibria import find_equilibria
from carom.closed_forms.sag import levitation
from carom.closed_forms.thresholds import WALL, boundary_kind
from carom.closed_forms.whirl import rolling
from carom.models import Axis, Rotor
from carom.parameters import Numbers, Parameters

SAMPLES, FEWER, FEWEST = 201, 21, 5
"""Values of the parameter; the others for rotors of several coordinates, and of many, whose equations take seconds to set up."""
FEW = 4
"""Coordinates up to which they are several."""
LOOKED, PEAKS = 101, 12
"""Values at which levitation of a rotor of several coordinates is looked at, and values between three of these at which its worst is looked for, or its best where it is lost."""
LOSS_RTOL = 1e-9
"""Width at which the search for its loss ends, relative to the step."""
WHY = ("a vibration grows", "it reaches the wall", "magnetic bearings would exceed a limit")
"""Why it is lost."""


@dataclass(frozen=True, eq=False, repr=False)
class EquilibriumBranch(Result):
    """Equilibria of one kind along the parameter; ``nan`` where there is none.

    Attributes
    ----------
    kind : str
        ``"contact-free"``, ``"stable rub"`` or ``"saddle rub"``.
    values, radius, normal_force : ndarray, shape (m,)
        With weight the radius is the largest distance from the centre.
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
    """Rolling on the bearing in backward whirl (:mod:`carom.closed_forms.whirl`) along the parameter.

    Attributes
    ----------
    values, largest_force : ndarray, shape (m,)
        Values of the parameter, and the largest normal force over a turn in ``m c_r Ω²``.
    holds : ndarray of bool, shape (m,)
        Whether a rotor that rolls keeps rolling.  Empty arrays for other models than the planar rotor.
    """

    values: np.ndarray
    largest_force: np.ndarray
    holds: np.ndarray


def rolling_branch(rotor: Rotor, along: Axis, interval: tuple[float, float]) -> RollingBranch:
    """Rolling on an evenly spaced grid of the parameter; empty for other models than the planar rotor."""
    grid = np.linspace(*interval, SAMPLES if rotor.has_closed_forms else 0)
    found = [rolling(along.move(rotor, value)) for value in grid.tolist()]
    forces, holds = [entry.largest_force for entry in found], [entry.holds for entry in found]
    return RollingBranch(grid, np.array(forces), np.array(holds, bool))


def _lost(why: int = 0, *, below: bool) -> str:
    """On which side of a value levitation is lost, and why."""
    return f"{'below' if below else 'above'}: {WHY[why]}"


def steady_points(parameters: Parameters, along: Axis, interval: tuple[float, float]) -> list[Bifurcation]:
    """Boundary equilibria, folds of rubs, limits of rolling, and where vibrations about levitation begin to grow, on an interval."""
    base = Numbers.of(parameters)
    grid = np.linspace(*interval, SAMPLES).tolist()
    points = []
    for kind, name in STEADY.items():

        def function(value: float, kind: str = kind) -> float:
            return TESTS[kind](base.moved(along.name, value), 1.0, 0.0)

        values = np.array([function(value) for value in grid])
        for i in np.flatnonzero((values[:-1] < 0.0) != (values[1:] < 0.0)):
            root = bracketed_root(function, grid[i], grid[i + 1])
            at = base.moved(along.name, root)
            detail = boundary_kind(at) if kind == WALL else _lost(below=values[i + 1] < 0.0) if kind == LOST else ""
            real = happens_steadily(kind, at)
            points.append(Bifurcation(kind, at, math.nan, math.nan, name, along.name, root, real, detail))
    return points


def equilibrium_branches(model: Rotor, along: Axis, interval: tuple[float, float]) -> tuple[EquilibriumBranch, ...]:
    """Levitation and both rubs on an evenly spaced grid of the parameter; with weight levitation alone, as no rub is at rest.

    Of several stable rubs, or several others, the admissible one with the largest normal force.  A virtual rub counts as
    stable if it would attract sliding, so that a branch continues as the same one where its normal force changes sign.
    """
    of_several = FEWER if len(model.system.rest) <= FEW else FEWEST
    grid = np.linspace(*interval, SAMPLES if model.planar is not None else of_several)
    kinds = ("contact-free", "stable rub", "saddle rub")
    table = np.full((len(kinds), len(grid), 4), np.nan)
    for column, value in enumerate(grid.tolist()):
        rotor = along.move(model, value)
        moving = rotor.system.forced is not None or rotor.system.races is not None
        found = [] if moving else find_equilibria(rotor)
        for equilibrium in sorted(found, key=lambda at: (at.status == "admissible", at.normal_force)):
            real = equilibrium.status == "admissible"
            attracts = equilibrium.stable if real else equilibrium.eigenvalues.real.max() < 0.0
            place = 0 if equilibrium.kind == "contact-free" else 1 if attracts else 2
            table[place, column] = equilibrium.radius, equilibrium.normal_force, real, equilibrium.stable
    return tuple(
        EquilibriumBranch(kind, grid, rows[:, 0], rows[:, 1], rows[:, 2] == 1.0, rows[:, 3] == 1.0)
        for kind, rows in zip(kinds, table, strict=True)
    )


def levitation_along(
    model: Rotor, along: Axis, interval: tuple[float, float]
) -> tuple[EquilibriumBranch, list[Bifurcation]]:
    """Levitation of a machine without closed forms, and where it is lost.

    It is looked at on a grid, where between three values of it small vibrations decay least or the rotor comes nearest to the wall, or where
    it is lost by the least, and in the bisection of each step over which it is lost.
    """
    seen: dict[float, np.ndarray] = {}

    def margins(value: float) -> np.ndarray:
        """It is lost where any of these is not below zero."""
        held = levitation(along.move(model, value))
        growth = decay = float(held.eigenvalues.real.max())
        if (whole := held.rotor.finite_elements) is not None:  # All modes decide.
            growth = float(whole.machine.slowest.exponents.real.max()) / whole.machine.speed
        seen[value] = np.array([growth, held.reach - 1.0, 1.0 if decay < 0.0 and not held.stable else -1.0])
        return seen[value]

    def sought(value: float, which: int | slice) -> np.ndarray:
        """Least where it may be lost between values that hold it, by growth or reach, and where it may be held between others."""
        return np.append(-(found := margins(float(value)))[:2], found.max())[which]

    grid = np.linspace(*interval, SAMPLES if model.planar is not None else LOOKED).tolist()
    sides = np.array([sought(value, slice(None)) for value in grid])
    held = (sides[1:-1, 2] < 0.0)[:, None] == np.array([True, True, False])
    lower = (sides[1:-1] <= np.minimum(sides[:-2], sides[2:])) & (sides[1:-1] < np.maximum(sides[:-2], sides[2:]))
    for place, which in np.argwhere(held & lower).tolist():
        minimize_scalar(sought, args=(which,), bounds=(grid[place], grid[place + 2]), options={"maxiter": PEAKS})
    for low, high in pairwise(sorted(seen)):
        if (seen[low].max() < 0.0) != (seen[high].max() < 0.0):
            bracketed_root(lambda value: float(margins(value).max()), low, high, LOSS_RTOL * (high - low))
    values, rows = np.array(sorted(seen)), np.array([seen[value] for value in sorted(seen)])
    lost, points = rows.max(axis=1) >= 0.0, []
    for place in np.flatnonzero(lost[:-1] != lost[1:]).tolist():
        at = place + int(lost[place + 1])
        detail, value = _lost(rows[at].argmax(), below=lost[place]), float(values[at])
        there = along.move(model, value)
        points.append(Bifurcation(LOST, there, name="contact-free", parameter=along.name, value=value, detail=detail))
    inside, stable = rows[:, 1] < 0.0, rows[:, ::2].max(axis=1) < 0.0
    return EquilibriumBranch("contact-free", values, 1.0 + rows[:, 1], np.zeros(len(rows)), inside, stable), points
