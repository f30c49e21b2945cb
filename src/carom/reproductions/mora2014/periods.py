"""Figure 3: the period condition, its roots along the damping, and the birth of the two small orbits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.base.results import Result
from carom.bifurcations.conditions import conditions_at
from carom.closed_forms.periods import PeriodCondition
from carom.continuation import Equations, Steps, continue_branch
from carom.models import Rotor, jeffcott
from carom.orbits.orbit import Orbit
from carom.orbits.single_impact import find_orbits
from carom.parameters import Numbers
from carom.reproductions.mora2014.propositions import hopf_side
from carom.reproductions.mora2014.source import machine_at

LONGEST_DRAWN = 30.0
"""Longest period drawn, in ``1/Ω``."""
DAMPINGS = (0.005, 0.2)
"""Range of the damping."""
AWAY = 0.01
"""Distance in damping from the birth at which the small orbits are drawn."""


@dataclass(frozen=True, eq=False, repr=False)
class PeriodFunction(Result):
    """``F₁`` over the period at one damping (figure 3a).

    Attributes
    ----------
    periods, values : ndarray, shape (n,)
    roots : ndarray
        All roots, also beyond the periods drawn.
    """

    gamma: float
    periods: np.ndarray
    values: np.ndarray
    roots: np.ndarray


@dataclass(frozen=True, eq=False, repr=False)
class PeriodPair(Result):
    """A pair of roots of ``F₁`` along the damping, from one over their fold to the other (figure 3b).

    Attributes
    ----------
    gammas, periods : ndarray, shape (m,)
    longer : ndarray of bool, shape (m,)
        Which periods are ``T_{0,n,b}``; the others are ``T_{0,n,a}``.
    fold : tuple of float
        ``γ_{F,n}`` and the period there.
    """

    gammas: np.ndarray
    periods: np.ndarray
    longer: np.ndarray
    fold: tuple[float, float]


@dataclass(frozen=True, eq=False, repr=False)
class Birth(Result):
    """The equilibrium and the two orbits that shrink into it, on one side of the non-smooth Hopf point (figure 3c).

    Attributes
    ----------
    side : {"below", "at", "above"}
        Side of ``γ*``.
    orbits : tuple of Orbit
        ``B1,a`` and ``B1,b``; none at ``γ*``, where they are a point.
    """

    side: str
    rotor: Rotor
    orbits: tuple[Orbit, ...]


def period_functions() -> tuple[PeriodFunction, ...]:
    """Compute ``F₁`` at the dampings of figure 3a."""
    periods = np.linspace(0.02, LONGEST_DRAWN, 1500)
    found = []
    for gamma in (0.1, 0.05):
        condition = PeriodCondition.planar(machine_at(gamma))
        found.append(PeriodFunction(gamma, periods, condition.value(periods), condition.roots().periods))
    return tuple(found)


def period_pairs() -> tuple[PeriodPair, ...]:
    """Follow all pairs of roots of ``F₁`` with periods up to 30/Ω from ``γ = 0.005`` to their folds and back, in ascending order."""
    gamma = DAMPINGS[0]
    shorter = PeriodCondition.planar(machine_at(gamma)).roots(LONGEST_DRAWN).periods[::2]
    return tuple(period_pair(gamma, period) for period in shorter.tolist())


def period_pair(gamma: float, period: float) -> PeriodPair:
    """Follow a pair of roots of ``F₁`` from the shorter period at a damping to their fold and back."""
    base = Numbers.of(machine_at(gamma))

    def closing(u: np.ndarray, gamma: float) -> np.ndarray:
        if u[0] <= 0.0:
            return np.array([np.nan])
        return np.array([conditions_at(base._replace(gamma=gamma), float(u[0]), 0.0).closing])

    equations = Equations(closing, None, np.array([1, 0.1]), Steps(0.005, largest=0.04))
    branch = continue_branch(equations, np.array([period]), gamma, (gamma, DAMPINGS[1]))
    (fold,) = branch.of_kind("fold")
    at = float(fold.unknowns[0])
    # The fold itself is drawn too: it is where both halves meet.
    place = int(np.ceil(fold.place))
    gammas = np.insert(branch.parameters, place, fold.parameter)
    periods = np.insert(branch.unknowns[:, 0], place, at)
    return PeriodPair(gammas, periods, periods >= at, (fold.parameter, at))


def birth() -> tuple[Birth, ...]:
    """Compute both small orbits and the equilibrium below, at and above the non-smooth Hopf point, in this order."""
    at = hopf_side(machine_at(0.1)).gamma
    stages = []
    for side, gamma in (("below", at - AWAY), ("at", at), ("above", at + AWAY)):
        rotor = jeffcott(machine_at(gamma))
        orbits = find_orbits(rotor)
        small = () if side == "at" else (orbits["B1,a"], orbits["B1,b"])
        stages.append(Birth(side, rotor, small))
    return tuple(stages)
