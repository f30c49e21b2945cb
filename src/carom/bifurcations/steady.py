"""Steady motions along one parameter: levitation, synchronous rubs and rolling, with their special points."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from carom.base.results import Result
from carom.base.roots import bracketed_root
from carom.bifurcations.conditions import TESTS
from carom.bifurcations.points import STEADY, Bifurcation
from carom.closed_forms.equilibria import find_equilibria
from carom.closed_forms.sag import levitation
from carom.closed_forms.thresholds import boundary_kind, happens_to_rubs
from carom.closed_forms.whirl import rolling
from carom.models import Axis, Rotor
from carom.parameters import Numbers, Parameters

SAMPLES, FEWER, FEWEST = 201, 21, 3
"""Values of the parameter; the others for rotors of several coordinates, and of many, whose equations take seconds to set up."""
FEW = 4
"""Coordinates up to which they are several."""
HALVINGS = 10
"""Halvings of the step between two of these values, for the value at which levitation is lost."""


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


def steady_points(parameters: Parameters, along: Axis, interval: tuple[float, float]) -> list[Bifurcation]:
    """Boundary equilibria, folds of rubs and limits of rolling on an interval."""
    base = Numbers.of(parameters)
    grid = np.linspace(*interval, SAMPLES).tolist()
    points = []
    for kind, name in STEADY.items():

        def function(value: float, kind: str = kind) -> float:
            return TESTS[kind](base.moved(along.name, value), 1.0, 0.0)

        values = np.array([function(value) for value in grid])
        for i in np.flatnonzero(values[:-1] * values[1:] < 0.0):
            root = bracketed_root(function, grid[i], grid[i + 1])
            at = base.moved(along.name, root)
            real = kind != "rub-fold" or happens_to_rubs(at)
            detail = boundary_kind(at) if kind == "boundary-equilibrium" else ""
            points.append(Bifurcation(kind, at, math.nan, math.nan, name, along.name, root, real, detail))
    return points


def _count(model: Rotor) -> int:
    """Number of values at which levitation and rubs are computed."""
    if model.planar is not None:
        return SAMPLES
    return FEWER if len(model.system.rest) <= FEW else FEWEST


def equilibrium_branches(model: Rotor, along: Axis, interval: tuple[float, float]) -> tuple[EquilibriumBranch, ...]:
    """Levitation and both rubs on an evenly spaced grid of the parameter; with weight levitation alone, as no rub is at rest.

    Of several stable rubs, or several others, the admissible one with the largest normal force.  A virtual rub counts as
    stable if it would attract sliding, so that a branch continues as the same one where its normal force changes sign.
    """
    grid = np.linspace(*interval, _count(model))
    kinds = ("contact-free", "stable rub", "saddle rub")
    table = np.full((len(kinds), len(grid), 4), np.nan)
    for column, value in enumerate(grid.tolist()):
        rotor = along.move(model, value)
        if rotor.system.forced is not None or rotor.system.races is not None:
            held = levitation(rotor)
            table[0, column] = held.reach, 0.0, held.inside, held.stable
            continue
        found = find_equilibria(rotor)
        for equilibrium in sorted(found, key=lambda at: (at.status == "admissible", at.normal_force)):
            real = equilibrium.status == "admissible"
            attracts = equilibrium.stable if real else equilibrium.eigenvalues.real.max() < 0.0
            place = 0 if equilibrium.kind == "contact-free" else 1 if attracts else 2
            table[place, column] = equilibrium.radius, equilibrium.normal_force, real, equilibrium.stable
    return tuple(
        EquilibriumBranch(kind, grid, rows[:, 0], rows[:, 1], rows[:, 2] == 1.0, rows[:, 3] == 1.0)
        for kind, rows in zip(kinds, table, strict=True)
    )


def levitation_words(model: Rotor, along: Axis, branch: EquilibriumBranch) -> list[str]:
    """Where a machine without closed forms levitates, one line for each value at which that changes; ``branch`` is its levitation."""
    good = branch.admissible & branch.stable
    changes = np.flatnonzero(good[:-1] != good[1:])
    if not len(changes):
        where = "stable and clear of the wall at all" if good[0] else "possible at none"
        return [f"Levitation is {where} of the {len(good)} values looked at."]
    values = branch.values.tolist()
    return [_lost(model, along, values[at], values[at + 1], bool(good[at])) for at in changes.tolist()]


def _lost(model: Rotor, along: Axis, low: float, high: float, below: bool) -> str:
    """Say between which values, and why, levitation is lost; ``below``: it is possible at the lower one."""
    inner, outer = (low, high) if below else (high, low)
    fails = levitation(along.move(model, outer))
    for _ in range(HALVINGS):
        middle = 0.5 * (inner + outer)
        held = levitation(along.move(model, middle))
        if held.inside and held.stable:
            inner = middle
        else:
            outer, fails = middle, held
    unstable = fails.eigenvalues.real.max() >= 0.0
    why = (
        "a vibration grows"
        if unstable
        else "limits of the magnetic bearings"
        if fails.inside
        else "it reaches the wall"
    )
    field = along.field
    shown = f"{field.in_usual_unit(inner):.4g} {field.usual_unit}".rstrip()
    return f"Levitation is lost {'above' if below else 'below'} about {shown}: {why}."
