"""Periods of single-impact orbits: all roots of ``F₁(T) = 1 + Re(q a₂₂(T))``, by the kernels of :mod:`carom.core.periods`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from carom.base.arguments import Positive, Reals, Whole, checked
from carom.base.outcome import CaromError, InputError
from carom.base.results import Result
from carom.core import periods
from carom.core.friction import sliding_factor
from carom.core.planar import planar_exponents
from carom.models import System
from carom.parameters import Parameters

FIRST_WIDTH = 0.25
"""Width of the intervals at which the search begins, in ``1/Ω``."""
MOST_INTERVALS = 1_000_000
FADED = 1e-12
"""Size of ``F₁`` that is too near its rounding error for roots to be distinguished."""


@dataclass(frozen=True, eq=False, repr=False)
class PeriodRoots(Result):
    """All roots of ``F₁`` on ``0 < T ≤ longest_period``.

    Attributes
    ----------
    periods : ndarray
        The roots in ascending order, a double root twice.
    returns : ndarray of complex, shape (N, 2)
        ``q a₁₂`` and ``q a₂₂`` there.
    longest_period : float
        End of the searched range.
    proven : bool
        Whether ``F₁ > 0`` is proven beyond it, so that there is no other root at all.
    starts_below : bool
        Whether ``F₁ < 0`` next to ``T = 0``.  This requires ``d = 1`` and a root at ``T = 0``, which is not counted.
    """

    periods: np.ndarray
    returns: np.ndarray
    longest_period: float
    proven: bool
    starts_below: bool


@dataclass(frozen=True, eq=False)
class PeriodCondition:
    """``F₁`` of a rotor and its roots.

    Attributes
    ----------
    modes : ndarray of complex, shape (N, 3)
        Exponents and residues, as :mod:`carom.core.periods` takes them.
    factor : complex
        ``q = (1 + d)(1 ± iμ)``, with the sign of the slip during impacts.
    """

    modes: np.ndarray
    factor: complex

    @classmethod
    @checked
    def of(cls, system: System, slip: Literal[-1, 1] = 1, plane: Whole = 0) -> PeriodCondition:
        """Return the condition for orbits with impacts at a plane of a system and this direction of slip."""
        arrays, free = system.arrays, system.free
        row, column = arrays.rows[plane, free], arrays.columns[free, plane]
        modes = np.zeros((len(row), 3), complex)
        modes[:, 0], modes[:, 1] = system.exponents, row * column
        modes[1:, 2] = row[1:] * column[:-1] * arrays.driven[free][1:]
        return cls(modes, sliding_factor(slip * float(arrays.friction[plane]), float(arrays.restitution[plane])))

    @classmethod
    @checked
    def planar(cls, parameters: Parameters, slip: Literal[-1, 1] = 1) -> PeriodCondition:
        """Return the condition for orbits of the planar rotor; its system need not be built."""
        driving, driven = planar_exponents(parameters.gamma, parameters.omega)
        modes = np.array([[driving, 0.0, 0.0], [driven, 0.0, 1.0]])
        return cls(modes, complex(1.0 + parameters.d) * complex(1.0, slip * parameters.mu))

    @checked
    def a12(self, periods: Reals) -> np.ndarray:
        """``a₁₂(T)``, complex, of the shape of ``periods``."""
        return self._returns(periods)[..., 0]

    @checked
    def a22(self, periods: Reals) -> np.ndarray:
        """``a₂₂(T)``, complex, of the shape of ``periods``."""
        return self._returns(periods)[..., 1]

    @checked
    def value(self, periods: Reals) -> np.ndarray:
        """``F₁(T)``."""
        return 1.0 + (self.factor * self._returns(periods)[..., 1]).real

    @checked
    def slope(self, periods: Reals) -> np.ndarray:
        """``F₁'(T)``."""
        return (self.factor * self._returns(periods)[..., 2]).real

    def _returns(self, times: np.ndarray) -> np.ndarray:
        """``a₁₂``, ``a₂₂`` and ``da₂₂/dT``, one more axis than ``times``."""
        times = np.asarray(times, float)
        found = [periods.flight_return(self.modes, time)[:3] for time in times.ravel().tolist()]
        return np.array(found, complex).reshape(*times.shape, 3)

    def longest_period(self) -> float:
        """Time beyond which ``F₁ > 0``; infinite without damping."""
        return periods.longest_period(self.modes, self.factor)

    def longest_distinct(self) -> float:
        """Time beyond which ``F₁`` cannot be distinguished from zero: where all modes grow, it approaches ``1 − Re q = −d``."""
        growth = float(self.modes[:, 0].real.min())
        fades = growth > 0.0 and abs(1.0 - self.factor.real) < FADED
        return -math.log(FADED) / growth if fades else math.inf

    @checked
    def roots(self, longest_period: Positive | None = None) -> PeriodRoots:
        """All roots up to ``longest_period``; by default all roots there are.

        Parameters
        ----------
        longest_period : float, optional
            End of the search in ``1/Ω``.  Needed where damping is not positive, as ``F₁`` then has infinitely many roots.

        Raises
        ------
        InputError
            No damping and no ``longest_period``.
        CaromError
            The search would take unreasonable work (very weak damping), or ``F₁`` cannot be distinguished from zero (negative damping
            without rebound); give a shorter ``longest_period``.
        """
        bound = self.longest_period()
        if longest_period is None and not np.isfinite(bound):
            growth = -2.0 * self.modes[:, 0].real.max()
            raise InputError("gamma", growth, "above 0, or longest_period must limit the orbits searched")
        end = bound if longest_period is None else longest_period
        if end > self.longest_distinct():
            raise CaromError(
                f"periods above {self.longest_distinct():.3g}/Omega cannot be distinguished; give a shorter longest_period"
            )
        if end > MOST_INTERVALS * FIRST_WIDTH:
            raise CaromError(f"periods up to {end:.3g}/Omega are too many to search; give a shorter longest_period")
        count = int(np.ceil(end / FIRST_WIDTH))
        intervals, complete = periods.isolate(self.modes, self.factor, float(end), count, MOST_INTERVALS + 2 * count)
        if not complete:
            raise CaromError(f"periods up to {end:.3g}/Omega are too near resonance; give a shorter longest_period")
        found, values, starts_below = periods.roots_on(self.modes, self.factor, intervals)
        return PeriodRoots(found, self.factor * values, end, end >= bound, starts_below)
