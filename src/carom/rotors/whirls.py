"""Free whirls of a levitating flexible rotor, and how they change with the speed of the shaft."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, NamedTuple

import numpy as np
from scipy.optimize import linear_sum_assignment  # type: ignore[import-untyped]

from carom.base.arguments import Count, Positive, checked
from carom.base.outcome import InputError, shown
from carom.base.results import Result
from carom.rotors.equations import RotorEquations
from carom.rotors.flexible_machine import FlexibleMachine
from carom.rotors.free_motions import STRAIGHT, StabilityLimit, growing, motions_at, stability_limits

LEAST_LIKENESS = 0.7
"""Least likeness of a motion at two speeds for it to count as the same; below, the speed between both is looked at too."""
HALVINGS = 6
"""Times that a step of the speed is halved at most; then the most alike motions are taken for the same."""


class MotionBranches(NamedTuple):
    """Free motions at one speed."""

    exponents: np.ndarray
    """1/s, shape (N,)."""
    states: np.ndarray
    """Coordinates, then velocities of those with mass, of each, shape (N, N)."""
    duals: np.ndarray
    """Rows that give the share of each motion in a state, shape (N, N)."""


def followed(equations: RotorEquations, speeds: np.ndarray) -> np.ndarray:
    """Exponents of all free motions at each of the speeds, 1/s, shape (m, N); each column is one motion, as far as it can be stated.

    Two motions are alike by ``|a b|``, where ``a`` is the share of the first in the second and ``b`` that of the second in the first: 1 of the
    same motion, whatever its size.  Where two whirls come near each other their shapes mix, and a whirl keeps its shape rather than its
    place.  Where supports are anisotropic, the exponent of each motion is that with the sense that prevails in it.
    """
    here = _at(equations, float(speeds[0]))
    rows = [here]
    for before, after in zip(speeds[:-1].tolist(), speeds[1:].tolist(), strict=True):
        here = _step(equations, here, before, after, HALVINGS)
        rows.append(here)
    if not equations.is_anisotropic:
        return np.array([each.exponents for each in rows])
    once = rows[0].exponents.imag > 0.0  # the others are their conjugates
    return np.array([_with_sense(each, len(equations.mass))[once] for each in rows])


def _with_sense(motions: MotionBranches, coordinates: int) -> np.ndarray:
    """Exponents whose imaginary parts are above zero where a motion goes forward more than backward."""
    both = motions.states[: 2 * coordinates]
    ahead, behind = (np.linalg.norm(each, axis=0) for each in np.split(both, 2))
    forward = (ahead >= behind) == (motions.exponents.imag > 0.0)
    return motions.exponents.real + 1j * np.abs(motions.exponents.imag) * np.where(forward, 1.0, -1.0)


def _at(equations: RotorEquations, speed: float) -> MotionBranches:
    exponents, coordinates = equations.exponents(speed)
    has_mass = np.tile(equations.mass.any(axis=1), 1 + equations.is_anisotropic)
    states = np.concatenate([coordinates, exponents * coordinates[has_mass]])
    # Motions of a free rotor that stay where they are may be one and the same: no inverse.
    return MotionBranches(exponents, states, np.linalg.pinv(states))


def _step(
    equations: RotorEquations, here: MotionBranches, before: float, after: float, halvings: int
) -> MotionBranches:
    """The motions at the speed after, in the order of those here."""
    there = _at(equations, after)
    alike = np.abs((here.duals @ there.states) * (there.duals @ here.states).T)
    _, order = linear_sum_assignment(-np.minimum(alike, 1.0))
    if halvings and alike[np.arange(len(order)), order].min() < LEAST_LIKENESS:
        middle = 0.5 * (before + after)
        return _step(equations, _step(equations, here, before, middle, halvings - 1), middle, after, halvings - 1)
    return MotionBranches(there.exponents[order], there.states[:, order], there.duals[order])


SLOW = 12
"""Whirls that are listed by default."""
STANDING = 0.1
"""Frequency over the size of an exponent up to which a motion has faded before it goes round: a damping ratio of 0.995."""


@dataclass(frozen=True, eq=False, repr=False)
class WhirlMode(Result):
    """A free whirl at one speed of the shaft, in the fixed frame: ``z(s, t) = shape(s) e^{λt} + opposite(s) e^{λ̄t}``.

    Attributes
    ----------
    exponent : complex
        ``λ``, 1/s.
    shape : ndarray of complex, shape (N,)
        Displacement at all places of the rotor (:attr:`FlexibleRotor.places`: the ends of all elements), of which the largest is 1; the angle is where the rotor is at time zero.
    opposite : ndarray of complex, shape (N,)
        What goes round the other way, where supports are anisotropic: each place of the rotor follows an ellipse, with the axes
        ``|shape| ± |opposite|``.  Zeros otherwise.
    """

    exponent: complex
    shape: np.ndarray
    opposite: np.ndarray

    shown: ClassVar = ("frequency", "sense", "damping_ratio")

    @property
    def frequency(self) -> float:
        """Turns per second, Hz."""
        return abs(self.exponent.imag) / (2.0 * math.pi)

    @property
    def sense(self) -> str:
        """``"forward"``, ``"backward"``, ``"straight"`` of one to and fro along lines, or ``"none"`` of a motion that fades before it goes round.

        Of ellipses it is the sense of most of the rotor: of the sum of what their areas are.
        """
        if not turns(np.array(self.exponent)):
            return "none"
        ahead, behind = np.sum(np.abs(self.shape) ** 2), np.sum(np.abs(self.opposite) ** 2)
        if abs(ahead - behind) <= STRAIGHT * (ahead + behind):
            return "straight"
        return "forward" if self.exponent.imag > 0.0 else "backward"

    @property
    def widest(self) -> np.ndarray:
        """Displacement at all places at an instant at which the largest of them is farthest out, shape (N,); of circles any instant."""
        place = (np.abs(self.shape) + np.abs(self.opposite)).argmax()
        if not self.opposite[place]:
            return self.shape
        turn = np.exp(0.5j * np.angle(self.opposite[place] / self.shape[place])) if self.shape[place] else 1.0
        displaced: np.ndarray = self.shape * turn + self.opposite / turn
        return displaced

    @property
    def damping_ratio(self) -> float:
        """``−Re λ/|λ|``; negative of a whirl that grows."""
        return -self.exponent.real / abs(self.exponent) if self.exponent else 0.0


@checked
def find_whirls(flexible: FlexibleMachine, speed: Positive | None = None, count: Count = SLOW) -> tuple[WhirlMode, ...]:
    """Find the slowest free whirls of a flexible machine, from all its modes.

    Parameters
    ----------
    flexible : FlexibleMachine
    speed : float, optional
        Speed of the shaft, rad/s; by default that of the machine.
    count : int
        How many, from the one with the lowest frequency on; whirls that grow follow, however fast they go round.  Motions without a sense, such
        as those of integrators and filters, are left out.

    See Also
    --------
    carom.rotors.campbell : over the speed
    """
    at = flexible.speed if speed is None else speed
    whole = flexible.whole
    found = motions_at(whole.equations, at)
    shown_at = flexible.rotor.displacements(whole.basis.shapes)
    shapes, opposite = (shown_at @ each[: whole.vectors] for each in (found.ahead, found.behind))
    sizes = (np.abs(shapes) + np.abs(opposite)).max(axis=0)
    shapes, opposite = (each / np.where(sizes, sizes, 1.0) for each in (shapes, opposite))
    grow = growing(found.exponents)
    order = [place for place in np.argsort(np.abs(found.exponents.imag)) if turns(found.exponents[place])]
    return tuple(
        WhirlMode(complex(found.exponents[place]), shapes[:, place], opposite[:, place])
        for rank, place in enumerate(order)
        if rank < count or grow[place]
    )


@dataclass(frozen=True, eq=False, repr=False)
class Campbell(Result):
    """Exponents of the slowest free whirls over the speed of the shaft, each whirl followed over all speeds.

    Attributes
    ----------
    speeds : ndarray, shape (m,)
        rad/s.
    exponents : ndarray of complex, shape (m, k)
        1/s; a column is a whirl (:mod:`carom.rotors.whirls`), in the order of the imaginary parts at the first speed, so backward whirls come
        first.  NaN where it fades before it goes round.  Where supports are anisotropic the sign of the imaginary part says
        which sense prevails, and may change along a column.
    machine : FlexibleMachine
    levitates : ndarray of bool, shape (m,)
        Whether no free motion grows at this speed, listed or not.
    """

    speeds: np.ndarray
    exponents: np.ndarray
    machine: FlexibleMachine
    levitates: np.ndarray

    figure: ClassVar[str] = "campbell"
    shown: ClassVar = ("speeds", "frequencies", "damping_ratios", "levitates")

    @cached_property
    def limits(self) -> tuple[StabilityLimit, ...]:
        """Speeds between these at which levitation begins or ceases to be stable, to rounding."""
        speeds = np.sort(self.speeds).tolist()
        return () if self.levitates.all() else stability_limits(self.machine.whole.equations, speeds)

    @property
    def frequencies(self) -> np.ndarray:
        """Frequencies, Hz, shape (m, k); negative ones are backward."""
        return np.asarray(self.exponents.imag / (2.0 * math.pi))

    @property
    def damping_ratios(self) -> np.ndarray:
        """Damping ratios, shape (m, k)."""
        return np.asarray(-self.exponents.real / np.abs(self.exponents))


@checked
def campbell(flexible: FlexibleMachine, speeds: Sequence[float], count: Count = SLOW) -> Campbell:
    """Follow the slowest free whirls over the speed of the shaft.

    Parameters
    ----------
    flexible : FlexibleMachine
    speeds : sequence of float
        rad/s, above 0.
    count : int
        How many whirls: those that are among so many slowest ones at any of the speeds, and those that grow at one, so the list may be longer.

    Raises
    ------
    InputError
        There is no speed, or one is not above 0.

    See Also
    --------
    carom.rotors.find_whirls : their shapes at one speed
    """
    listed = speeds_of(speeds)
    order = np.argsort(listed, kind="stable")
    rows = followed(flexible.whole.equations, listed[order])
    found = np.empty_like(rows)
    found[order] = rows
    grow = growing(found)
    found[~turns(found)] = np.nan
    slow = np.argsort(np.where(np.isnan(found), np.inf, np.abs(found.imag)), axis=1)[:, :count]
    drawn = np.isin(np.arange(found.shape[1]), slow) | (grow & ~np.isnan(found)).any(axis=0)
    chosen = np.flatnonzero(drawn & ~np.isnan(found).all(axis=0))
    chosen = chosen[np.argsort(found[order[0], chosen].imag)]
    return Campbell(listed, found[:, chosen], flexible, np.asarray(~grow.any(axis=1)))


def turns(exponents: np.ndarray) -> np.ndarray:
    """Which motions go round before they fade."""
    return np.asarray(np.abs(exponents.imag) > STANDING * np.abs(exponents))


def speeds_of(given: Sequence[float]) -> np.ndarray:
    """Speeds, rad/s; refuse none, and those not above 0."""
    listed = np.array(given, float)
    if listed.ndim != 1 or not listed.size or not (np.isfinite(listed) & (listed > 0.0)).all():
        raise InputError("speeds", shown(given), "one or more numbers above 0, in rad/s")
    return listed
