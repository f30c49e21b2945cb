"""What a rotor is by: named parameters, what each of them changes, and the equations of motion that follow, with their matrices."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom.base.outcome import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np

    from carom.models.forcing import Force
    from carom.models.limits import Limit
    from carom.models.linear import LinearEquations
    from carom.models.system import System
    from carom.parameters import Field, Parameters, Scales, TouchdownBearing


SINGULAR = 1e-14
"""Smallest singular value of a matrix, relative to the size of its terms, up to which it counts as singular."""


class Matrices(NamedTuple):
    """Matrices of a rotor in the fixed frame, ``M Z̈ + (D − iG) Ż + K Z = F e^{it}``.

    Attributes
    ----------
    mass, damping, gyroscopic, stiffness : ndarray of complex, shape (n, n)
        ``D`` and ``G`` are Hermitian; so is ``K`` without circulatory forces.
    forcing : ndarray of complex, shape (n,)
    """

    mass: np.ndarray
    damping: np.ndarray
    gyroscopic: np.ndarray
    stiffness: np.ndarray
    forcing: np.ndarray


def is_singular(matrix: np.ndarray, *terms: np.ndarray) -> bool:
    """Whether a matrix is singular to the rounding of these."""
    return bool(np.linalg.svd(matrix, compute_uv=False)[-1] <= SINGULAR * max(map(np.linalg.norm, terms)))


class Definition:
    """A frozen value from which a :class:`~carom.models.Rotor` is made; a maker of another kind of rotor gives it another one.

    What is not said here otherwise follows from the equations.
    """

    @property
    def equations(self) -> LinearEquations:
        """The equations of motion of the levitating rotor, without further forces and limits."""
        raise NotImplementedError

    @property
    def varied(self) -> Mapping[str, Field]:
        """Named parameters that can be varied: words, symbol, unit and range of each."""
        raise NotImplementedError

    def value(self, name: str) -> float:
        """Value of a named parameter, in the unit of its field."""
        raise NotImplementedError

    def replace(self, **changes: float | str) -> Definition:
        """Return it with other values of named parameters; what depends on them changes too."""
        raise NotImplementedError

    @property
    def words(self) -> str:
        """Its parameters in a line; empty where there are too many."""
        return ""

    @property
    def words_of_bearing(self) -> str:
        """What it has beside a rigid wall that stands still and a shaft at constant speed, in words."""
        return ""

    @property
    def system(self) -> System:
        """Modes, contact planes and contact law."""
        return self.equations.system

    @property
    def matrices(self) -> Matrices:
        """Matrices of the equations of motion in the fixed frame."""
        return self.equations.matrices

    @property
    def scales(self) -> Scales | None:
        """Mass, clearance and speed that convert results to SI units, if known."""
        return self.equations.scales

    @property
    def unbalance_phase(self) -> float:
        """Angle of the unbalance in the co-rotating frame, in rad."""
        return self.equations.unbalance_phase

    @property
    def equilibrium(self) -> complex | np.ndarray:
        """Coordinates at rest without further forces; a plain number of one coordinate."""
        return complex(self.system.rest[0]) if len(self.system.rest) == 1 else self.system.rest

    @property
    def rotating(self) -> np.ndarray | None:
        """Damping ``D_i`` that turns with the shaft, on ``ż − iΩz``, part of the damping and the stiffness of its matrices; ``None`` where it is not known."""
        return None

    @property
    def planar(self) -> Parameters | None:
        """Dimensionless parameters of the planar rotor; ``None`` of other rotors."""
        return None

    @property
    def has_closed_forms(self) -> bool:
        """Whether exact results are known, without further forces and limits."""
        return False

    @property
    def finite_elements(self) -> object:
        """The reduced flexible machine behind it; ``None`` without one."""
        return None

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Limits of the magnetic bearings that follow from its parameters; empty where these say nothing of them."""
        return ()

    @property
    def pull(self) -> tuple[Force, ...]:
        """What pulls the rotor from the centre of its touchdown bearing to the place of levitation, where these differ."""
        return ()

    def held_by_bias(self, weight: np.ndarray, limits: int) -> tuple[np.ndarray, np.ndarray]:
        """What is left of the accelerations (n,) of a weight that bias currents carry, and what these ask of each limit in the fixed frame, both complex.

        By default they act where the weight does, and what they ask is not known.
        """
        return np.zeros_like(weight), np.zeros(limits, complex)

    def pushed_by_currents(self, current: complex) -> np.ndarray:
        """Accelerations (n,) by this current, A, in all magnetic bearings, each of which pushes where it points."""
        raise InputError("current", f"{abs(current):g}", "a [rotor] with magnetic bearings; others have a force")

    def bearing_at(self, plane: int) -> TouchdownBearing | None:
        """Data in SI units of a touchdown bearing, which may state its balls; ``None`` if they are not known."""
        return self.equations.touchdowns[plane].bearing

    def without_levitation(self) -> Definition:
        """See :meth:`carom.models.Rotor.without_levitation`."""
        return self.equations.without_levitation()

    def unbalance_push(self, node: int | None = None) -> np.ndarray:
        """Force (n,) of an unbalance of one, as an eccentricity in ``c_r`` of the whole mass, that has the phase of the one before.

        It is distributed like the unbalance of the rotor; of a balanced one it is that of all masses off centre by the same.  Of a flexible
        machine it acts at a node.
        """
        return self.equations.unbalance_push(node)

    def unbalance_along(self, node: int | None = None) -> float | None:
        """Unbalance that changes, as an eccentricity in ``c_r``; ``None`` where others stay, so that no change leads to the machine of another one."""
        return self.equations.unbalance_along(node)

    def with_changed_unbalance(self, change: complex, node: int | None = None) -> tuple[Definition, float]:
        """See :meth:`carom.models.Rotor.with_changed_unbalance`."""
        return self.equations.with_changed_unbalance(change, node)
