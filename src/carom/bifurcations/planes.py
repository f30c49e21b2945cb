"""The plane of two parameters in which bifurcations are followed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import overload

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.continuation import Watch
from carom.models import Rotor
from carom.models.axes import Axis, Ends, axis, read_interval
from carom.parameters import Numbers, Parameters
from carom.parameters.formats import format_along

EDGE = "edge of the plane"
"""Why curves end that leave the plane."""
ROUNDING = 1e-9
"""Tolerance for points on the edge, in widths of the plane."""


@checked
@dataclass(frozen=True, init=False)
class Plane:
    """Two parameters and their ranges.

    Attributes
    ----------
    first, second : str
        Names, dimensionless or physical.
    first_range, second_range : tuple of float
        Physical ones in SI units; they may be given as text with units, ``("300 N s/m", "2000 N s/m")``.

    Raises
    ------
    InputError
        The names are the same, or a range is empty or not finite.
    """

    first: str
    second: str
    first_range: tuple[float, float]
    second_range: tuple[float, float]

    def __init__(self, first: str, second: str, first_range: Ends, second_range: Ends) -> None:
        if first == second:
            raise InputError("plane", f"{first},{second}", "two different parameters")
        ranges = read_interval(first, first_range), read_interval(second, second_range)
        for name, value in zip(self.__dataclass_fields__, (first, second, *ranges), strict=True):
            object.__setattr__(self, name, value)

    @property
    def words(self) -> str:
        """Both parameters with their ranges: ``damping 500 to 2,000 N s/m, speed 1,700 to 1,850 rpm``."""
        ranges = ((self.first, self.first_range), (self.second, self.second_range))
        return ", ".join(format_along(name, ends) for name, ends in ranges)

    @property
    def widths(self) -> np.ndarray:
        """Widths of both ranges, shape (2,)."""
        return np.ptp([self.first_range, self.second_range], axis=1)

    @property
    def edge(self) -> Watch:
        """Limit of a curve whose last unknown is the first parameter: the edges of its range, in widths of the plane."""
        low, high = self.first_range
        return Watch(EDGE, lambda u, _: min(u[-1] - low, high - u[-1]) / (high - low), at_zero="limit")

    @checked
    def place_of(self, at: Rotor | Parameters | Numbers) -> tuple[float, float]:
        """Values of both parameters, whether inside the plane or outside."""
        return at.value(self.first), at.value(self.second)

    @checked
    def start_at(self, at: Rotor | Numbers) -> tuple[np.ndarray, np.ndarray]:
        """Place of a point from which a curve is followed, and typical sizes of both parameters there, shape (2,).

        Raises
        ------
        InputError
            It lies outside the plane.
        """
        start, (lows, highs) = np.array(self.place_of(at)), np.transpose([self.first_range, self.second_range])
        if not ((lows <= start) & (start <= highs)).all():
            raise InputError("parameters", tuple(start.tolist()), "a point of the plane")
        return start, np.maximum(np.abs(start), 0.1 * (highs - lows))

    @checked
    def holds(self, x: float, y: float) -> bool:
        """Whether a point lies in the plane, within rounding."""
        return all(
            low - ROUNDING * (high - low) <= value <= high + ROUNDING * (high - low)
            for value, (low, high) in ((x, self.first_range), (y, self.second_range))
        )

    def axes(self, base: Parameters | Rotor) -> tuple[Axis, Axis]:
        """Both parameters, checked for whether the machine allows them and their ranges."""
        found = axis(base, self.first), axis(base, self.second)
        for end in (0, 1):
            self.at(base, self.first_range[end], self.second_range[end])
        return found

    @overload
    def at(self, base: Parameters, x: float, y: float) -> Parameters: ...

    @overload
    def at(self, base: Rotor, x: float, y: float) -> Rotor: ...

    @checked
    def at(self, base: Parameters | Rotor, x: float, y: float) -> Parameters | Rotor:
        """Parameters, or the rotor, at a point of the plane."""
        if isinstance(base, Parameters):
            return self.numbers_at(Numbers.of(base), x, y).parameters
        return base.replace(**{self.first: x}).replace(**{self.second: y})

    def move(self, base: Rotor, place: tuple[float, float]) -> Rotor:
        """The rotor at a point of the plane."""
        return self.at(base, *place)

    def numbers_at(self, base: Numbers, x: float, y: float) -> Numbers:
        """Plain numbers at a point of the plane."""
        return base.moved(self.first, x).moved(self.second, y)
