"""The plane of two parameters in which bifurcations are followed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.bifurcations.axes import Axis, Numbers, axis
from carom.outcome import InputError
from carom.parameters import Parameters

__all__ = ["Plane"]

ROUNDING = 1e-9
"""Tolerance for points on the edge, in widths of the plane."""


@dataclass(frozen=True)
class Plane:
    """Two parameters and their ranges.

    Attributes
    ----------
    first, second : str
        Names, dimensionless or physical.
    first_range, second_range : tuple of float
        Physical ones in SI units.

    Raises
    ------
    InputError
        The names are the same, or a range is empty or not finite.
    """

    first: str
    second: str
    first_range: tuple[float, float]
    second_range: tuple[float, float]

    def __post_init__(self) -> None:
        if self.first == self.second:
            raise InputError("plane", f"{self.first},{self.second}", "two different parameters")
        for name, limits in ((self.first, self.first_range), (self.second, self.second_range)):
            if not (np.isfinite(limits).all() and limits[0] < limits[1]):
                raise InputError(
                    name, f"{limits[0]:g} to {limits[1]:g}", "a range of two finite values in ascending order"
                )

    @property
    def widths(self) -> np.ndarray:
        """Widths of both ranges, shape (2,)."""
        return np.ptp([self.first_range, self.second_range], axis=1)

    def place_of(self, parameters: Parameters) -> tuple[float, float]:
        """Values of both parameters, whether inside the plane or outside."""
        numbers = Numbers.of(parameters)
        return axis(parameters, self.first).get(numbers), axis(parameters, self.second).get(numbers)

    def holds(self, x: float, y: float) -> bool:
        """Whether a point lies in the plane, within rounding."""
        return all(
            low - ROUNDING * (high - low) <= value <= high + ROUNDING * (high - low)
            for value, (low, high) in ((x, self.first_range), (y, self.second_range))
        )

    def axes(self, base: Parameters) -> tuple[Axis, Axis]:
        """Both parameters, checked for whether the machine allows them and their ranges."""
        found = axis(base, self.first), axis(base, self.second)
        for end in (0, 1):
            self.at(base, self.first_range[end], self.second_range[end])
        return found

    def at(self, base: Parameters, x: float, y: float) -> Parameters:
        """Parameters at a point of the plane."""
        first, second = axis(base, self.first), axis(base, self.second)
        return second.set(first.set(Numbers.of(base), x), y).parameters
