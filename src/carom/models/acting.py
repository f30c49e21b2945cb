"""What acts on a rotor while it levitates: its forces, of which weight may be carried by bias currents."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from carom.models.definition import Definition
from carom.models.forcing import Force
from carom.models.limits import Limit
from carom.models.mode_arrays import EQUAL, STEADY
from carom.parameters import ControlLimit


@dataclass(frozen=True, eq=False)
class Acting:
    """The forces that act on a rotor, and what bias currents carry.

    Attributes
    ----------
    forces : tuple of Force
        Those that act: of a weight that bias currents carry, what they leave.
    whole_weight : complex array of shape (n,), optional
        Accelerations of the coordinates by forces that are constant in the fixed frame, with what bias currents carry, which acts where levitation is lost; ``None`` without any.
    asked_by_bias : complex array of shape (L,)
        What bias currents ask of each limit, constant in the fixed frame, in its unit.
    translated : complex array of shape (n,)
        Coordinates when the rotor is displaced by one.
    """

    forces: tuple[Force, ...]
    whole_weight: np.ndarray | None
    asked_by_bias: np.ndarray
    translated: np.ndarray

    @classmethod
    def of(
        cls, definition: Definition, forces: tuple[Force, ...], limits: ControlLimit | tuple[Limit, ...], by_bias: bool
    ) -> Acting:
        """What acts of some forces on a rotor with limits, whose bias currents carry the weight or do not."""
        weight, translated = steady_of(forces), definition.system.translated
        count = 1 if isinstance(limits, ControlLimit) else len(limits)
        if weight is None or not by_bias:
            return cls(forces, weight, np.zeros(count, complex), translated)
        left, asked = definition.held_by_bias(weight, count)
        others = tuple(force for force in forces if not is_steady(force))
        acting = (Force(STEADY, left), *others) if left.any() else others
        return cls(acting, weight, weight[:1] if isinstance(limits, ControlLimit) else asked, translated)

    @property
    def weight(self) -> np.ndarray | None:
        """Accelerations (n,) of the coordinates by forces that are constant in the fixed frame and act; ``None`` if none does."""
        return steady_of(self.forces)

    @property
    def direction_of_fall(self) -> float:
        """Angle of the weight in the fixed frame, in rad; that of the negative y axis without weight."""
        weight = self.whole_weight
        return -0.5 * math.pi if weight is None else cmath.phase(complex(weight @ self.translated.conj()))


def is_steady(force: Force) -> bool:
    """Whether a force is constant in the fixed frame."""
    return force.rates is None and abs(force.exponent - STEADY) <= EQUAL


def steady_of(forces: Sequence[Force]) -> np.ndarray | None:
    """Accelerations (n,) by those forces that are constant in the fixed frame; ``None`` without any."""
    steady = [force.accelerations for force in forces if is_steady(force)]
    total: np.ndarray = np.sum(steady, axis=0)
    return total if steady and total.any() else None
