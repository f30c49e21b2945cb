"""What acts on a rotor: forces, of which weight may be carried by bias currents while it levitates."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from carom.base.outcome import InputError
from carom.models.definition import Definition
from carom.models.forcing import ISOTROPIC_ALONE, WITHOUT_FORCES, Force
from carom.models.limits import Limit
from carom.models.mode_arrays import EQUAL, STEADY
from carom.parameters import ControlLimit

if TYPE_CHECKING:
    from carom.models.system import System


class Weighed:
    """The part of a :class:`~carom.models.Rotor` that says which of its forces act."""

    definition: Definition
    forces: tuple[Force, ...]
    limits: ControlLimit | tuple[Limit, ...]
    carried_by_bias: bool

    @property
    def listed_limits(self) -> tuple[Limit, ...]:
        """The limits in units of the equations."""
        raise NotImplementedError

    @property
    def system(self) -> System:
        """Its arrays for the kernels."""
        raise NotImplementedError

    @cached_property
    def _bias(self) -> tuple[np.ndarray, np.ndarray] | None:
        """What bias currents leave of the weight that they carry, and what they ask of each limit; ``None`` where they carry none."""
        weight = self.whole_weight if self.carried_by_bias else None
        if weight is None:
            return None
        left, asked = self.definition.held_by_bias(weight, len(self.listed_limits))
        return left, weight[:1] if isinstance(self.limits, ControlLimit) else asked

    @property
    def asked_by_bias(self) -> np.ndarray:
        """What bias currents that carry its weight ask of each limit, constant in the fixed frame, in its unit; complex, shape (L,)."""
        return np.zeros(len(self.listed_limits), complex) if self._bias is None else self._bias[1]

    @cached_property
    def acting(self) -> tuple[Force, ...]:
        """The forces that act on it: of a weight that bias currents carry, what is left."""
        if self._bias is None:
            return self.forces
        left = Force(STEADY, self._bias[0])
        others = tuple(force for force in self.forces if not is_steady(force))
        return (left, *others) if left.accelerations.any() else others

    @property
    def weight(self) -> np.ndarray | None:
        """Accelerations (n,) of the coordinates by forces that are constant in the fixed frame and act; ``None`` if none does."""
        return steady_of(self.acting)

    @property
    def whole_weight(self) -> np.ndarray | None:
        """The same with what bias currents carry, which acts where levitation is lost."""
        return steady_of(self.forces)

    @property
    def direction_of_fall(self) -> float:
        """Angle of the weight in the fixed frame, in rad; that of the negative y axis if none acts."""
        weight = self.whole_weight
        return -0.5 * math.pi if weight is None else cmath.phase(complex(weight @ self.system.translated.conj()))

    def refuse_forces(self) -> None:
        """Refuse a rotor on which forces act that change with time in its frame: it never is at rest there."""
        if self.system.shaft is not None:
            self.system.refuse_non_stationary()
        if self.system.is_anisotropic:
            raise InputError("machine", "anisotropic bearings", ISOTROPIC_ALONE)
        if self.system.outer.any():
            acting = "forces that change with time" if self.weight is None else "gravity"
            raise InputError("machine", f"a rotor under {acting}", WITHOUT_FORCES)


def is_steady(force: Force) -> bool:
    """Whether a force is constant in the fixed frame."""
    return force.rates is None and abs(force.exponent - STEADY) <= EQUAL


def steady_of(forces: Sequence[Force]) -> np.ndarray | None:
    """Accelerations (n,) by those forces that are constant in the fixed frame; ``None`` without any."""
    steady = [force.accelerations for force in forces if is_steady(force)]
    total: np.ndarray = np.sum(steady, axis=0)
    return total if steady and total.any() else None
