"""Base class of the models of disturbances."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Self

import numpy as np

from carom.disturbances.coordinates import Coordinate, Starts
from carom.outcome import InputError
from carom.parameters import Scales

if TYPE_CHECKING:
    from carom.models import Jeffcott

__all__ = ["FASTEST", "Disturbance"]

FASTEST = 2.0
"""Default largest speed in ``c_r Ω``: twice that of a whirl that fills the clearance."""
_SIZES = ("fastest", "peak", "duration", "largest")


@dataclass(frozen=True)
class Disturbance:
    """Base class of disturbances; see :mod:`carom.disturbances` for the models."""

    kind: ClassVar[str] = ""
    measured_in: ClassVar[dict[str, str]] = {}

    def __post_init__(self) -> None:
        for name, scale in self.measured_in.items():
            value = getattr(self, name)
            if not (np.isfinite(value) and abs(value) > 0.0):
                raise InputError(name, value, f"a finite number other than 0, in the unit of {scale} of the equations")
            if name in _SIZES and value < 0.0:
                raise InputError(name, value, "a size, above 0")

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Coordinates by which the disturbance varies."""
        raise NotImplementedError

    def starts(self, rotor: Jeffcott, *values: np.ndarray) -> Starts:
        """Starts of free motion.

        Parameters
        ----------
        rotor : Jeffcott
        *values : ndarray
            One array for each coordinate, broadcast against each other.
        """
        raise NotImplementedError

    def rescaled(self, before: Scales | None, after: Scales | None) -> Self:
        """Return the disturbance that is the same in SI units for a machine with other scales."""
        if before is None or after is None or before == after:
            return self
        changes = {
            name: getattr(self, name) * (getattr(before, scale) / getattr(after, scale))
            for name, scale in self.measured_in.items()
        }
        return dataclasses.replace(self, **changes)

    def describe(self) -> dict[str, object]:
        """Kind and numbers of the disturbance."""
        return {"kind": self.kind, **dataclasses.asdict(self)}
