"""What every description of a rotor must offer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, Self, runtime_checkable

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np

    from carom.models.system import System
    from carom.parameters import Field, Scales


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


class Rates(NamedTuple):
    """Derivatives of the equations of motion in the co-rotating frame by a parameter, with masses and contact planes that stay.

    Attributes
    ----------
    accelerations : ndarray of complex, shape (n, 2n)
        Of the accelerations of the coordinates, per coordinate, then per rate of a coordinate.
    force : ndarray of complex, shape (n,)
        Of their constant part.
    friction, restitution, surface_speed : ndarray, shape (P,)
        Of the contact law of each plane.
    """

    accelerations: np.ndarray
    force: np.ndarray
    friction: np.ndarray
    restitution: np.ndarray
    surface_speed: np.ndarray


@runtime_checkable
class Model(Protocol):
    """A rotor: a value with named parameters that makes a :class:`~carom.models.system.System`.

    General code takes a model and never asks which.  What is proven for one kind of model is asked for in
    :func:`carom.closed_forms.known.known_of`.
    """

    @property
    def system(self) -> System:
        """Modes, contact planes and contact law."""

    @property
    def matrices(self) -> Matrices:
        """Matrices of the equations of motion in the fixed frame."""

    @property
    def scales(self) -> Scales | None:
        """Mass, clearance and speed that convert results to SI units, if known."""

    @property
    def unbalance_phase(self) -> float:
        """Angle of the unbalance in the co-rotating frame, in rad."""

    @property
    def varied(self) -> Mapping[str, Field]:
        """Named parameters that can be varied: words, symbol, unit and range of each."""

    def value(self, name: str) -> float:
        """Value of a named parameter, in the unit of its field."""

    def replace(self, **changes: Any) -> Self:
        """Return the rotor with other values of named parameters; what depends on them changes too."""

    def rates(self, name: str) -> Rates | None:
        """Derivatives of the equations of motion by a named parameter; ``None`` where differences have to do."""

    def attributes(self) -> dict[str, Any]:
        """Numbers and texts from which :func:`~carom.models.subjects.model_from` makes the same model again."""
