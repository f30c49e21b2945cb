"""The equations of motion of any linear rotor, from its matrices."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from carom.base.outcome import InputError, shown
from carom.base.results import Result
from carom.models import linear_parameters
from carom.models.definition import Definition, Matrices, is_singular
from carom.models.forcing import complex_numbers
from carom.models.linear_system import system_of
from carom.models.rotor import Rotor
from carom.models.system import BesideModes, System
from carom.models.touchdown import Touchdown
from carom.models.turning import Shaft, ShaftModes
from carom.parameters import Field, Scales

ROUNDING = 1e-12
"""Part of an unbalance across another one, relative to it, that is rounding."""
GYROSCOPIC = 1e-12
"""Size of the gyroscopic matrix, relative to the damping in the co-rotating frame, that is rounding."""


@dataclass(frozen=True, eq=False, repr=False)
class LinearEquations(Definition, Result):
    """Rotor with ``M Ü + D U̇ + K U = F`` in the co-rotating frame and ``P`` contact planes.

    The coordinates are complex: displacements, or tilts, in two directions at a right angle.  All numbers are
    dimensionless: times in ``1/Ω``, the displacement at each plane in the clearance there.

    Coordinates whose rows and columns of ``M`` are zero have no mass: their rates follow from the state, as those of a controller do.  Their
    rates in a state are not used.

    Attributes
    ----------
    mass, damping, stiffness : array_like of complex, shape (n, n)
        ``M``, ``D`` and ``K``, with the terms of the turning frame (see :meth:`in_fixed_frame`).
    forcing : array_like of complex, shape (n,)
        ``F``, constant: unbalance.
    touchdowns : sequence of Touchdown, length P
        The contact planes.
    translation : array_like of complex, shape (n,), optional
        Coordinates when the rotor as a whole is displaced by one: the direction of kicks.  Ones by default.
    carried : array_like of complex, shape (n,), optional
        The same of all that stands in a housing, rotor and mounts of touchdown bearings: the direction of shocks of the base.  The
        translation by default.
    scales : Scales, optional
        Unit of the mass matrix, unit of length (the clearance of planes that state none of their own), and speed: they convert results to SI units.
    shaft : Shaft, optional
        Shaft whose speed changes in contact, from the nominal one on; by default the speed is constant.  Of a rotor without gyroscopic
        matrix: otherwise the modes would change with the speed.
    unlevitated : array_like of complex, shape (2, n, n), optional
        Damping and stiffness in the fixed frame that are left when levitation is lost; a drop needs it.  By default all are
        levitation for a rotor with one coordinate, and none is known for others.
    regained : array_like, shape (n,), optional
        What coordinates and rates are multiplied by when levitation is regained: 0 for states of controllers that are reset then.  Ones by default.
    magnets : array_like of complex, shape (G, n), optional
        Displacement at each magnet, in its air gap, per coordinate: motions end where one is larger than one.  By default no gap is known.
    conjugate : array_like of complex, shape (2, n, n), optional
        Damping and stiffness in the fixed frame that act on the conjugates of rates and coordinates: of bearings that act differently in two
        directions, with levitation or without it.  By default there are none.  Not with a ``shaft``.
    conjugate_unlevitated : array_like of complex, shape (2, n, n), optional
        The same when levitation is lost, where it is another one; ``conjugate`` by default.

    Raises
    ------
    InputError
        A shape is wrong, a number is not finite or out of range, a matrix is singular, or an impulse at a plane does not
        move it.
    """

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    forcing: np.ndarray
    touchdowns: Sequence[Touchdown]
    translation: np.ndarray | None = None
    carried: np.ndarray | None = None
    scales: Scales | None = None
    shaft: Shaft | None = None
    unlevitated: np.ndarray | None = None
    conjugate: np.ndarray | None = None
    conjugate_unlevitated: np.ndarray | None = None
    regained: np.ndarray | None = None
    magnets: np.ndarray | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.scales, Scales | None):
            raise InputError("scales", self.scales, "carom.parameters.Scales, or None")
        if not isinstance(self.shaft, Shaft | None):
            raise InputError("shaft", shown(self.shaft), "carom.models.Shaft, or None")
        n = _numbers("forcing", self.forcing).size
        if self.translation is None:
            object.__setattr__(self, "translation", np.ones(n))
        shapes: dict[str, tuple[int, ...]] = dict.fromkeys(("mass", "damping", "stiffness"), (n, n))
        shapes |= dict.fromkeys(("forcing", "translation", "carried", "regained"), (n,))
        shapes |= dict.fromkeys(("unlevitated", "conjugate", "conjugate_unlevitated"), (2, n, n))
        shapes["magnets"] = (len(np.atleast_1d(self.magnets)) if self.magnets is not None else 0, n)
        for name, shape in shapes.items():
            if getattr(self, name) is not None:
                values = _numbers(name, getattr(self, name), shape)
                values.flags.writeable = False
                object.__setattr__(self, name, values)
        if self.conjugate is not None and not self.conjugate.any():
            object.__setattr__(self, "conjugate", None)
        if self.has_mass.any() and self.forcing[~self.has_mass].any():
            raise InputError("forcing", self.forcing.tolist(), "0 for coordinates without mass")
        given: object = self.touchdowns
        listed = tuple(given) if isinstance(given, Iterable) else ()
        if not listed or not all(isinstance(each, Touchdown) and len(each.plane) == n for each in listed):
            allowed = f"carom.models.Touchdown, one or more, with planes of {n} coordinates"
            raise InputError("touchdowns", shown(given), allowed)
        object.__setattr__(self, "touchdowns", listed)
        if self.shaft is not None:
            self._check_shaft()

    @property
    def equations(self) -> LinearEquations:
        """They are these."""
        return self

    @cached_property
    def has_mass(self) -> np.ndarray:
        """Which coordinates have mass, shape (n,)."""
        return np.asarray(self.mass.any(axis=1) | self.mass.any(axis=0))

    def accelerations(self, forces: np.ndarray) -> np.ndarray:
        """Accelerations (n, …) of the coordinates by forces (n, …) on them; zero for those without mass."""
        found = np.zeros(forces.shape, complex)
        found[self.has_mass] = np.linalg.solve(self.mass[np.ix_(self.has_mass, self.has_mass)], forces[self.has_mass])
        return found

    def rates_by(self, forces: np.ndarray) -> np.ndarray:
        """Accelerations (n,) of the coordinates by what acts on their equations, and rates of those without mass."""
        found, none = np.zeros(len(forces), complex), ~self.has_mass
        found[none] = np.linalg.solve(self.damping[np.ix_(none, none)], forces[none])
        return found + self.accelerations(forces - self.damping[:, none] @ found[none])

    def _check_shaft(self) -> None:
        """Refuse a shaft whose speed changes where the matrices would change with it, or where it has no response to its unbalance."""
        if self.conjugate is not None:
            allowed = "None where bearings are anisotropic: its speed stays as it is"
            raise InputError("shaft", shown(self.shaft), allowed)
        in_stages = self.shaft is not None and self.shaft.in_stages
        if not in_stages and np.abs(self.matrices.gyroscopic).max() > GYROSCOPIC * np.abs(self.damping).max():
            raise InputError(
                "shaft", shown(self.shaft), "None for a rotor with a gyroscopic matrix: its modes change with the speed"
            )
        if is_singular(self.stiffness, self.mass, self.damping, self.stiffness):
            raise InputError("shaft", shown(self.shaft), "None for a rotor in undamped resonance with its unbalance")

    @cached_property
    def planes(self) -> np.ndarray:
        """Displacement at each contact plane per coordinate, shape (P, n)."""
        return np.array([each.plane for each in self.touchdowns])

    @classmethod
    def in_fixed_frame(cls, matrices: Matrices, touchdowns: Sequence[Touchdown], **others: Any) -> Self:
        """Rotor from its matrices in the fixed frame, ``M Z̈ + (D − iG) Ż + K Z = F e^{it}``, and further attributes.

        With ``Z = U e^{it}`` the matrices of the co-rotating frame are ``M``, ``D − iG + 2iM`` and
        ``K − M + i(D − iG)``.
        """
        mass, damping, gyroscopic, stiffness, forcing = matrices
        spin = damping - 1j * gyroscopic
        return cls(mass, spin + 2j * mass, stiffness - mass + 1j * spin, forcing, touchdowns, **others)

    @cached_property
    def system(self) -> System:
        """Modes, contact planes and contact law."""
        return system_of(self)

    @property
    def beside_modes(self) -> BesideModes:
        """What does not follow from its modes."""
        return BesideModes(
            translation=self.translation,
            races=tuple(each.race for each in self.touchdowns),
            shaft=None if self.shaft is None else ShaftModes(self.shaft, self.accelerations(self.forcing)),
            clearances=tuple(each.clearance for each in self.touchdowns),
            magnets=self.magnets,
        )

    @property
    def matrices(self) -> Matrices:
        """Matrices of the fixed frame; see :meth:`in_fixed_frame`."""
        spin = self.damping - 2j * self.mass
        damping, gyroscopic = 0.5 * (spin + spin.conj().T), 0.5j * (spin - spin.conj().T)
        return Matrices(self.mass, damping, gyroscopic, self.stiffness + self.mass - 1j * spin, self.forcing)

    @property
    def unbalance_phase(self) -> float:
        """Angle of the unbalance in the co-rotating frame, in rad: that of its force on the rotor as a whole."""
        return float(np.angle(np.vdot(self.translation, self.forcing)))

    def without_levitation(self) -> LinearEquations:
        """See :meth:`carom.models.Rotor.without_levitation`."""
        if len(self.mass) > 1 and self.unlevitated is None:
            allowed = "a rotor of one coordinate, or one that says by its unlevitated matrices what is left without its levitation"
            raise InputError("machine", shown(self), allowed)
        damping, stiffness = np.zeros((2, *self.mass.shape)) if self.unlevitated is None else self.unlevitated
        left = self.matrices._replace(damping=damping, stiffness=stiffness)
        kept = {name: getattr(self, name) for name in ("translation", "scales", "shaft", "magnets")}
        stays = self.conjugate if self.conjugate_unlevitated is None else self.conjugate_unlevitated
        return LinearEquations.in_fixed_frame(left, self.touchdowns, conjugate=stays, **kept)

    def unbalance_push(self, node: int | None = None) -> np.ndarray:
        """See :meth:`carom.models.Definition.unbalance_push`: all masses are off centre by the same, along the translation."""
        linear_parameters.refuse_node(node)
        return np.asarray(self.mass @ self.translation * np.exp(1j * self.unbalance_phase))

    def unbalance_along(self, node: int | None = None) -> float | None:
        """See :meth:`carom.models.Definition.unbalance_along`."""
        push = self.unbalance_push(node)
        times = float((np.vdot(push, self.forcing) / np.vdot(push, push)).real)
        apart = np.linalg.norm(self.forcing - times * push)
        return times if apart <= ROUNDING * np.linalg.norm(self.forcing) else None

    def with_changed_unbalance(self, change: complex, node: int | None = None) -> tuple[Self, float]:
        """See :meth:`carom.models.Rotor.with_changed_unbalance`."""
        push, before = self.unbalance_push(node), self.unbalance_along(node)
        if before is None:
            return dataclasses.replace(self, forcing=self.forcing + change * push), 0.0
        return dataclasses.replace(self, forcing=abs(before + change) * push), float(np.angle(before + change))

    @property
    def varied(self) -> Mapping[str, Field]:
        """Parameters that can be varied (:mod:`carom.models.linear_parameters`)."""
        return linear_parameters.fields(self)

    def value(self, name: str) -> float:
        """Value of a parameter.

        Raises
        ------
        InputError
            No such name, or planes with different values.
        """
        return linear_parameters.value_of(self, name)

    def replace(self, **changes: Any) -> LinearEquations:
        """Return the rotor with other attributes, or other values of its parameters (:attr:`varied`).

        Attributes are set first, then the speed, then the other parameters in the order given.

        Raises
        ------
        InputError
            A name is unknown or a value not allowed, or there is nothing to multiply: no damping, stiffness or unbalance.
        """
        given = {field.name for field in dataclasses.fields(self)} & set(changes)
        rotor = dataclasses.replace(self, **{name: changes[name] for name in given}) if given else self
        for name in sorted(set(changes) - given, key=lambda name: (name != "speed", list(changes).index(name))):
            rotor = linear_parameters.moved(rotor, name, changes[name])
        return rotor


def from_matrices(
    *,
    mass: ArrayLike,
    damping: ArrayLike,
    stiffness: ArrayLike,
    gyroscopic: ArrayLike | None = None,
    forcing: ArrayLike,
    touchdowns: Sequence[Touchdown],
    **others: object,
) -> Rotor:
    """Any linear rotor from its matrices in the fixed frame, ``M Z̈ + (D − iG) Ż + K Z = F e^{it}``.

    Parameters
    ----------
    mass, damping, stiffness, gyroscopic : array_like, shape (n, n)
        ``M``, ``D``, ``K`` and ``G`` (polar moments of inertia; zero by default), with ``Ω = 1``.
    forcing : array_like of complex, shape (n,)
        Unbalance ``F``.
    touchdowns : sequence of Touchdown
    **others
        Further attributes of :class:`LinearEquations`.

    Raises
    ------
    InputError
        See :class:`LinearEquations`.
    """
    unbalance = _numbers("forcing", forcing)
    shape = (unbalance.size, unbalance.size)
    spin = np.zeros(shape) if gyroscopic is None else gyroscopic
    given = {"mass": mass, "damping": damping, "gyroscopic": spin, "stiffness": stiffness}
    matrices = Matrices._make((*(_numbers(name, values, shape) for name, values in given.items()), unbalance))
    return Rotor(LinearEquations.in_fixed_frame(matrices, touchdowns, **others))


def _numbers(name: str, given: object, shape: tuple[int, ...] | None = None) -> np.ndarray:
    """Array of the given numbers, a copy; refuse what is none, and one of another shape."""
    values = complex_numbers(given)
    if values is None or not values.size or shape not in (None, values.shape):
        raise InputError(name, shown(given), f"finite numbers{f' of shape {shape}' if shape else ''}")
    return values
