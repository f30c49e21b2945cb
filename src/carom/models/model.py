"""What every description of a rotor must offer."""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom.models.mode_arrays import EQUAL, STEADY
from carom.outcome import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from carom.models.forcing import Force
    from carom.models.limited import Limit
    from carom.models.race import Race
    from carom.models.system import System
    from carom.parameters import ControlLimit, Field, Parameters, Scales, TouchdownBearing

_WITHOUT = (
    "needs a rotor without gravity or other forces that change with time in its frame; under these carom.simulate, carom.settle, "
    "carom.drop, carom.study, carom.find_attractors, carom.find_orbits with impacts, carom.continue_orbit, and carom.map_basins of kicks, shocks, "
    "losses of a blade, steps of the unbalance, releases and states work; a setting gravity=0 leaves weight out"
)


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


class Model:
    """A rotor: a value with named parameters that makes a :class:`~carom.models.system.System`.

    General code asks it and never its class.  Exact results are asked for in :func:`carom.closed_forms.known.exact_results`.
    """

    @property
    def system(self) -> System:
        """Modes, contact planes and contact law."""
        raise NotImplementedError

    @property
    def matrices(self) -> Matrices:
        """Matrices of the equations of motion in the fixed frame."""
        raise NotImplementedError

    @property
    def scales(self) -> Scales | None:
        """Mass, clearance and speed that convert results to SI units, if known."""
        raise NotImplementedError

    @property
    def unbalance_phase(self) -> float:
        """Angle of the unbalance in the co-rotating frame, in rad."""
        raise NotImplementedError

    @property
    def varied(self) -> Mapping[str, Field]:
        """Named parameters that can be varied: words, symbol, unit and range of each."""
        raise NotImplementedError

    def value(self, name: str) -> float:
        """Value of a named parameter, in the unit of its field."""
        raise NotImplementedError

    def replace(self, **changes: Any) -> Any:
        """Return the rotor with other values of named parameters; what depends on them changes too."""
        raise NotImplementedError

    def rates(self, name: str) -> Rates | None:
        """Derivatives of the equations of motion by a named parameter; ``None`` where differences have to do."""
        raise NotImplementedError

    def attributes(self) -> dict[str, Any]:
        """Numbers and texts from which :func:`~carom.models.subjects.model_from` makes the same model again."""
        raise NotImplementedError

    @property
    def planar(self) -> Parameters | None:
        """Dimensionless parameters of the planar rotor, whatever acts on it; ``None`` of other rotors, whose numbers are matrices."""
        return None

    @property
    def has_closed_forms(self) -> bool:
        """Whether exact results are known: of the planar rotor in a rigid wall that stands still, without forces and limits."""
        return False

    @property
    def limits(self) -> ControlLimit | tuple[Limit, ...]:
        """Limits of the magnetic bearings, as they are stated; empty without any."""
        return ()

    @property
    def listed_limits(self) -> tuple[Limit, ...]:
        """The limits in units of the equations."""
        return ()

    @property
    def acting_forces(self) -> tuple[Force, ...]:
        """Forces that change with time in the frame of the rotor: those stated, and the pull of an offset."""
        return (*self.stated_forces, *self.pull)

    @property
    def pull(self) -> tuple[Force, ...]:
        """What pulls the rotor from the centre of its touchdown bearing to the place of levitation, where these differ."""
        return ()

    @property
    def unforced(self) -> Model:
        """The rotor without stated forces."""
        return self

    @property
    def stated_forces(self) -> tuple[Force, ...]:
        """The forces that are stated."""
        return ()

    @property
    def weight(self) -> np.ndarray | None:
        """Accelerations (n,) of the coordinates by stated forces that are constant in the fixed frame; ``None`` if none acts."""
        steady = [force.accelerations for force in self.stated_forces if abs(force.exponent - STEADY) <= EQUAL]
        total: np.ndarray = np.sum(steady, axis=0)
        return total if steady and total.any() else None

    @property
    def direction_of_fall(self) -> float:
        """Angle of the weight in the fixed frame, in rad; that of the negative y axis if none acts."""
        weight = self.weight
        return -0.5 * math.pi if weight is None else cmath.phase(complex(weight @ self.system.translated.conj()))

    @property
    def is_compliant(self) -> bool:
        """Whether a touchdown bearing gives way."""
        return bool(self.system.arrays["stiffness"].any())

    @property
    def races(self) -> tuple[Race | None, ...]:
        """The race at each touchdown bearing; ``None`` where it stands still."""
        return (None,) * len(self.system.contacts)

    def bearing_at(self, plane: int) -> TouchdownBearing | None:
        """Data in SI units of a touchdown bearing, which may state its balls; ``None`` if they are not known."""
        return None

    @property
    def is_on_mount(self) -> bool:
        """Whether the touchdown bearing stands on a mount, whose place then is the second coordinate."""
        return False

    @property
    def carried_by_housing(self) -> np.ndarray:
        """Coordinates (n,) when all that a housing carries is displaced by one against it: the rotor as a whole, and mounts."""
        return self.system.translated

    @property
    def acting_on_conjugates(self) -> np.ndarray | None:
        """Damping and stiffness (2, n, n) in the fixed frame that act on conjugates; ``None`` of isotropic bearings."""
        return None

    @property
    def finite_elements(self) -> Any:
        """The reduced flexible machine behind the rotor (:class:`carom.rotors.ReducedMachine`); ``None`` of other rotors."""
        return None

    @property
    def carry_at_regain(self) -> np.ndarray | None:
        """Coordinates and rates with which levitation begins again per those at the end of the fall, shape (2n, 2n); ``None`` if they stay."""
        return None

    def without_levitation(self) -> Model:
        """The rotor without the stiffness and damping of its levitation, under the same forces.

        Raises
        ------
        InputError
            It has several coordinates, and does not say what is left without levitation, which cannot be told from its shaft.
        """
        raise NotImplementedError

    def unbalance_push(self, node: int | None = None) -> np.ndarray:
        """Force (n,) of an unbalance of one, as an eccentricity in ``c_r`` of the whole mass, that has the phase of the one before.

        It is distributed like the unbalance of the rotor; of a balanced one it is that of all masses off centre by the same.  Of a flexible
        machine it acts at a node.
        """
        raise NotImplementedError

    def unbalance_along(self, node: int | None = None) -> float | None:
        """Unbalance that changes, as an eccentricity in ``c_r``; ``None`` where others stay, so that no change leads to the machine of another one."""
        raise NotImplementedError

    def with_changed_unbalance(self, change: complex, node: int | None = None) -> tuple[Any, float]:
        """The rotor with another unbalance, and the angle by which its frame has turned, so that the phase stays what it was.

        The change is a vector, an eccentricity in ``c_r`` relative to the direction of the unbalance before: a force ``Δ p e^{iβ}`` in the frame
        that turns with the shaft.  The rotor after it is seen in a frame that has turned with the unbalance, so that many changes lead to one
        machine, which differ by where the motion starts.

        Parameters
        ----------
        change : complex
        node : int, optional
            Of a flexible machine.
        """
        raise NotImplementedError

    def refuse_forces(self) -> None:
        """Refuse a rotor on which forces act that change with time in its frame: it never is at rest there."""
        if self.system.shaft is not None or self.system.mirrored is not None:
            self.system.refuse_forces()
        if self.system.outer.any():
            acting = "forces that change with time" if self.weight is None else "gravity"
            raise InputError("machine", f"a rotor under {acting}", _WITHOUT)

    @property
    def numbers(self) -> dict[str, float] | None:
        """Parameters of the planar rotor by name, without a restitution that its wall does not have; ``None`` of other rotors."""
        if self.planar is None:
            return None
        return {name: value for name, value in self.planar.as_dict().items() if name in self.varied}

    @property
    def in_rigid_wall(self) -> Parameters | None:
        """Parameters of the planar rotor in a rigid wall, whose load is compared with that of solid steel; ``None`` of other rotors and walls."""
        return None if self.is_compliant else self.planar

    def document(self) -> dict[str, Any]:
        """What describes it in a document: the parameters of the planar rotor, the attributes of any other."""
        return {"parameters": self.numbers} if self.numbers else {"rotor": self.attributes()}
