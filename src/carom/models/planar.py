"""The planar rigid rotor, in a touchdown bearing of any kind: parameters, and the equations that follow from them."""

from __future__ import annotations

import cmath
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import cast

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import InputError, shown
from carom.core.laws.hunt_crossley import HuntCrossley
from carom.core.laws.kelvin_voigt import KelvinVoigt
from carom.core.laws.rigid import Rigid
from carom.core.planar import planar_exponents
from carom.core.wall import Wall
from carom.models.definition import Definition, Matrices
from carom.models.forcing import Force, with_forces
from carom.models.from_modes import second_order_system
from carom.models.linear import LinearEquations
from carom.models.linear_parameters import refuse_node
from carom.models.rotor import Rotor
from carom.models.system import System
from carom.models.touchdown import Touchdown
from carom.models.turning import Race, Shaft
from carom.parameters import TOUCHDOWN_FIELDS, Drive, Field, Parameters, Scales, TouchdownBearing
from carom.parameters.formats import number
from carom.parameters.restitution import damping_ratio_of, dissipation_of
from carom.parameters.touchdown_bearing import PREFIX

RESTITUTION = ("restitution", "d")
"""Names of the restitution of a rigid wall."""
RIGID = TouchdownBearing()
"""A rigid wall that stands still, and has no data of its own."""


@dataclass(frozen=True)
class Planar(Definition):
    """Rigid rotor on a linear isotropic bearing inside a circular clearance (Föppl–Jeffcott rotor).

    In the co-rotating frame ``Ü + (γ + 2i)U̇ + (ω² − 1 + iγ)U = ρe^{iφ}`` [1]_ (2.13), with the exponents
    ``λ± = (−γ − 2i ± √(γ² − 4ω²))/2``.  Its coordinates are the position of the rotor and, on a mount, that of the mount.

    Attributes
    ----------
    parameters : Parameters
        In a bearing that is compliant their coefficient of restitution means nothing.
    bearing : TouchdownBearing, optional
        In SI units; by default a rigid wall that stands still.
    levitates : bool
        Whether stiffness and damping of the levitation act.
    drive : Drive, optional
        In SI units; without one the speed of the shaft never changes.
    air_gap : float, optional
        Of the magnets, m: where the rotor reaches them a motion ends.
    internal_damping : float, optional
        Damping that turns with the shaft, N s/m: it acts on ``ż − iΩz``, as long as the rotor levitates.

    Raises
    ------
    InputError
        ``parameters`` is not an instance of :class:`~carom.parameters.Parameters`; or there is a bearing or a drive and no scales are known, or
        nothing that a rigid wall and a shaft at constant speed have not.

    References
    ----------
    .. [1] Mora, Budd, Glendinning, Keogh, "Non-smooth Hopf-type bifurcations arising from impact–friction contact
       events in rotating machinery", Proc. R. Soc. A 470 (2014).
    """

    parameters: Parameters
    bearing: TouchdownBearing | None = None
    levitates: bool = True
    drive: Drive | None = None
    air_gap: float | None = None
    internal_damping: float = 0.0

    def __post_init__(self) -> None:
        if not isinstance(self.parameters, Parameters):
            raise InputError("parameters", shown(self.parameters), "must be carom.parameters.Parameters")
        if self.bearing is None:
            return
        if self.parameters.scales is None:
            raise InputError("rotor", shown(self.parameters), "a planar rotor with mass, clearance and speed")
        if self.bearing.is_plain and self.drive is None and not self.internal_damping:
            allowed = "a compliant bearing, has a race, a mount or an offset; a rigid wall needs no data of its own"
            raise InputError("bearing", self.bearing.words, allowed)
        if self.internal_damping and self.drive and self.drive.polar_inertia:
            allowed = "0 where the speed of the shaft changes, and its force with it"
            raise InputError("internal_damping", self.internal_damping, allowed)
        if self.air_gap is not None and self.bearing.centre:
            allowed = "0 where the air gap is known, which counts from the place of levitation"
            raise InputError("touchdown_offset", self.bearing.offset, allowed)

    @property
    def planar(self) -> Parameters:
        """Its parameters."""
        return self.parameters

    @property
    def has_closed_forms(self) -> bool:
        """Whether its wall is rigid and stands still, and its speed constant."""
        return self.bearing is None

    @property
    def scales(self) -> Scales | None:
        """Mass, clearance and speed that convert results to SI units, if known."""
        return self.parameters.scales

    @property
    def unbalance_phase(self) -> float:
        """Angle of the unbalance in the co-rotating frame, in rad."""
        return self.parameters.phi

    @cached_property
    def equilibrium(self) -> complex:
        """Contact-free equilibrium position ``U*``; it may lie outside the clearance."""
        at = self.parameters
        # Adding zero turns a negative zero, the quotient for a balanced rotor, into zero.
        return cmath.rect(at.rho, at.phi) / complex(at.omega**2 - 1.0, at.gamma) + 0j

    @cached_property
    def system(self) -> System:
        """Modes, contact plane and contact law, with exact exponents where the wall is rigid and stands still.

        Seen from the centre of a bearing off the place of levitation, that pulls with a constant force in the fixed frame (:attr:`pull`).
        """
        at = self.parameters
        if self.bearing is None:
            return second_order_system(
                exponents=planar_exponents(at.gamma, at.omega),
                equilibrium=self.equilibrium,
                wall=Wall(at.mu, at.d, at.radius_ratio + 1.0),
            )
        return with_forces(self.equations.system, self.pull) if self.pull else self.equations.system

    @property
    def _row(self) -> Matrices:
        """``z̈ + γż + ω²z = ρe^{iφ}e^{it}`` as matrices of one row."""
        at = self.parameters
        mass, damping, gyroscopic, stiffness = np.reshape((1.0 + 0j, at.gamma, 0.0, at.omega**2), (4, 1, 1))
        return Matrices(mass, damping, gyroscopic, stiffness, np.array([cmath.rect(at.rho, at.phi)]))

    @property
    def matrices(self) -> Matrices:
        """Matrices of the equations of motion in the fixed frame."""
        return self._row if self.bearing is None else self.equations.matrices

    @cached_property
    def equations(self) -> LinearEquations:
        """The same by matrices."""
        scales = cast("Scales", self.scales)
        matrices, plane, none = self._row, [1.0], np.zeros((1, 1), complex)
        if not self.levitates:
            matrices = matrices._replace(damping=none, stiffness=none)
        elif self.internal_damping:
            turning = self.internal_damping / scales.damping
            matrices = matrices._replace(
                damping=matrices.damping + turning, stiffness=matrices.stiffness - 1j * turning
            )
        given, at = self.bearing or RIGID, self.parameters
        if mount := given.mount:
            plane = [1.0, -1.0]
            own = mount.mass / scales.mass, mount.damping / scales.damping, 0.0, mount.stiffness / scales.stiffness
            pairs = (np.diag([matrix[0, 0], of_mount]) for matrix, of_mount in zip(matrices, own, strict=False))
            matrices = Matrices._make((*pairs, np.append(matrices.forcing, 0.0)))
        touchdown = Touchdown(
            plane, law_of(given, scales, at.d), at.mu, at.radius_ratio + 1.0, race_of(given, at.radius_ratio, scales)
        )
        return LinearEquations.in_fixed_frame(
            matrices,
            [touchdown],
            translation=np.eye(len(plane))[0],
            carried=np.ones(len(plane)),
            shaft=shaft_of(self.drive, scales),
            magnets=None if self.air_gap is None else np.eye(1, len(plane)) * scales.length / self.air_gap,
            scales=scales,
        )

    @property
    def pull(self) -> tuple[Force, ...]:
        """What pulls the rotor from the centre of the bearing to the place of levitation, where these differ."""
        centre = self.bearing.centre if self.bearing else 0.0
        if not centre or not self.levitates:
            return ()
        scales = cast("Scales", self.scales)
        pull, row = np.zeros(len(self.equations.mass), complex), self._row
        pull[0] = -(row.stiffness[0, 0] / row.mass[0, 0]) * (centre / scales.length)
        return (Force(-1j, pull),)

    def bearing_at(self, plane: int) -> TouchdownBearing | None:
        """Its data."""
        return self.bearing

    @property
    def words(self) -> str:
        """Its parameters in a line."""
        if self.bearing is None:
            return self.parameters.words
        names = ("gamma", "omega", "rho", "phi", "mu", *([] if self.bearing.is_compliant else ["d"]), "radius_ratio")
        own = (f"{name} = {self.parameters.value(name):g}" for name in names)
        return f"{', '.join(own)}; {self.words_of_bearing}"

    @property
    def words_of_bearing(self) -> str:
        """What is more than a rigid wall that stands still and a shaft at constant speed."""
        bearing = self.bearing.words if self.bearing and not self.bearing.is_plain else ""
        internal = f"internal damping {number(self.internal_damping)} N s/m" if self.internal_damping else ""
        return "; ".join(filter(None, (bearing, self.drive.words if self.drive else "", internal)))

    @property
    def rotating(self) -> np.ndarray:
        """See :attr:`carom.models.Definition.rotating`."""
        found = np.zeros_like(self.equations.mass)
        found[0, 0] = self.internal_damping and self.internal_damping / cast("Scales", self.scales).damping
        return found

    @property
    def _left_out(self) -> tuple[str, ...]:
        """Parameters of the planar rotor in a rigid wall that it does not have."""
        return RESTITUTION if self.bearing and self.bearing.is_compliant else ()

    @property
    def varied(self) -> Mapping[str, Field]:
        """Named parameters that can be varied."""
        if self.bearing is None:
            return self.parameters.varied
        own = {name: field for name, field in self.parameters.varied.items() if name not in self._left_out}
        bearing = {
            PREFIX + name: replace(TOUCHDOWN_FIELDS[name], name=PREFIX + name)
            for name in self.bearing.given
            if name in self.bearing.of_motion
        }
        return {**own, **bearing}

    def value(self, name: str) -> float:
        """Value of a named parameter, in the unit of its field."""
        if name in self._left_out:
            raise InputError(name, None, "a compliant touchdown bearing has no such number for all speeds")
        if self.bearing and name.startswith(PREFIX) and name in self.varied:
            return float(getattr(self.bearing, name.removeprefix(PREFIX)))
        return self.parameters.value(name)

    def replace(self, **changes: float | str) -> Planar:
        """Return it with other values of its parameters; those of the bearing stay what they are in SI units."""
        if self.bearing is None:
            return Planar(self.parameters.replace(**changes))
        for name in self._left_out:
            if name in changes:
                raise InputError(
                    name, changes[name], "a compliant touchdown bearing has its own entries in [touchdown]"
                )
        of_bearing = {name: changes.pop(name) for name in list(changes) if name.startswith(PREFIX)}
        bearing = self.bearing.replace(**{name.removeprefix(PREFIX): value for name, value in of_bearing.items()})
        parameters = self.parameters.replace(**changes) if changes else self.parameters
        return replace(self, parameters=parameters, bearing=bearing)

    def without_levitation(self) -> Definition:
        """See :meth:`carom.models.Rotor.without_levitation`."""
        return super().without_levitation() if self.bearing is None else replace(self, levitates=False)

    def unbalance_push(self, node: int | None = None) -> np.ndarray:
        """See :meth:`carom.models.Definition.unbalance_push`; a mount is not pushed."""
        refuse_node(node)
        push = np.array([cmath.rect(1.0, self.unbalance_phase)])
        return push if self.bearing is None else np.append(push, np.zeros(len(self.equations.mass) - 1))

    def unbalance_along(self, node: int | None = None) -> float:
        """See :meth:`carom.models.Definition.unbalance_along`."""
        return self.parameters.rho

    def with_changed_unbalance(self, change: complex, node: int | None = None) -> tuple[Planar, float]:
        """See :meth:`carom.models.Rotor.with_changed_unbalance`."""
        refuse_node(node)
        after = self.parameters.rho + change
        return replace(self, parameters=self.parameters.replace(rho=abs(after))), cmath.phase(after) if after else 0.0


@checked
def jeffcott(
    parameters: Parameters,
    bearing: TouchdownBearing | None = None,
    *,
    levitates: bool = True,
    drive: Drive | None = None,
    air_gap: float | None = None,
    internal_damping: float = 0.0,
) -> Rotor:
    """The planar rigid rotor, in a rigid wall that stands still or in a touchdown bearing of its own; see :class:`Planar`.

    Examples
    --------
    >>> import carom as cm
    >>> rotor = cm.models.jeffcott(cm.load("examples/keogh-cole.toml").parameters)
    >>> rotor.has_closed_forms, rotor.is_compliant
    (True, False)
    """
    return Rotor(Planar(parameters, bearing, levitates, drive, air_gap, internal_damping))


def shaft_of(drive: Drive | None, scales: Scales, inertia: float | None = None) -> Shaft | None:
    """What turns with the shaft in the units of a rotor's equations; ``None`` of one whose speed never changes, as it has no inertia, not even this one."""
    drive = drive or Drive()
    if (inertia := drive.polar_inertia or inertia) is None:
        return None
    unit = scales.mass * scales.length**2
    torque, brake = drive.torque / (unit * scales.speed**2), drive.brake / (unit * scales.speed**2)
    return Shaft(inertia / unit, torque, brake, drive.drag / (unit * scales.speed), drive.windage / unit)


def law_of(bearing: TouchdownBearing, scales: Scales, restitution: float = 0.0) -> Rigid | KelvinVoigt | HuntCrossley:
    """Law of a bearing in the units of a rotor's equations; the restitution is that of a rigid wall."""
    if not bearing.is_compliant:
        return Rigid(restitution)
    stated, exponent = bearing.spring
    stiffness = stated * scales.length ** (exponent - 1.0) / scales.stiffness
    if bearing.law == "kelvin-voigt":
        if bearing.restitution is not None:
            return KelvinVoigt(stiffness, 2.0 * damping_ratio_of(bearing.restitution) * stiffness**0.5)
        return KelvinVoigt(stiffness, (bearing.damping or 0.0) / scales.damping)
    dissipation = bearing.dissipation
    if dissipation is None:
        dissipation = dissipation_of(bearing.restitution or 1.0, bearing.restitution_speed or 1.0)
    return HuntCrossley(stiffness, dissipation * scales.velocity, exponent)


def race_of(bearing: TouchdownBearing, radius_ratio: float, scales: Scales) -> Race | None:
    """Race of a bearing in the units of a rotor's equations; ``None`` if it stands still."""
    race = bearing.race
    if race is None:
        return None
    unit = scales.mass * scales.length**2
    return Race(race.inertia / unit, radius_ratio + 1.0, race.drag / (unit * scales.speed))
