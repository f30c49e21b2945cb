"""What parameters and models have in common: numbers by name that can be varied."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol, Self, runtime_checkable

from carom.base.outcome import InputError
from carom.parameters.fields import DIMENSIONLESS_FIELDS, Field
from carom.parameters.scaling import Scales


@runtime_checkable
class Named(Protocol):
    """Numbers by name: those of the planar rotor, or of any model."""

    @property
    def scales(self) -> Scales | None:
        """Mass, clearance and speed that convert results to SI units, if known."""

    @property
    def varied(self) -> Mapping[str, Field]:
        """Parameters that can be varied."""

    def value(self, name: str) -> float:
        """Value of a parameter."""

    def replace(self, **changes: Any) -> Self:
        """Return the same with other values."""


def own_numbers(numbers: Named) -> dict[str, float]:
    """Return the dimensionless numbers by name; those that differ between the planes of a rotor for each plane."""
    found: dict[str, float] = {}
    for name in DIMENSIONLESS_FIELDS:
        try:
            found[name] = numbers.value(name)
        except InputError:
            at_planes = [each for each in numbers.varied if each.startswith(f"{name}_")]
            found |= {each: numbers.value(each) for each in at_planes}
    return found
