"""The planar rotor in a touchdown bearing that gives way, turns, sits on a mount or off the centre, or with a shaft that is braked."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from carom.core.laws.hunt_crossley import HuntCrossley
from carom.core.laws.kelvin_voigt import KelvinVoigt
from carom.core.laws.rigid import Rigid
from carom.models.forcing import Force, with_forces
from carom.models.jeffcott import Jeffcott
from carom.models.linear import LinearRotor
from carom.models.model import Matrices
from carom.models.race import Race
from carom.models.shaft import Shaft
from carom.models.stages import Around
from carom.models.system import System
from carom.models.touchdown import Touchdown
from carom.outcome import InputError, shown
from carom.parameters import TOUCHDOWN_FIELDS, Drive, Field, Parameters, Scales, TouchdownBearing
from carom.parameters.restitution import damping_ratio_of, dissipation_of
from carom.parameters.touchdown_bearing import BALL_FIELDS, PREFIX

RESTITUTION = ("restitution", "d")
"""Names of the restitution of a rigid wall."""


@dataclass(frozen=True)
class InBearing(Around):
    """Rigid rotor inside a touchdown bearing that gives way, or one whose race, mount, place or shaft is more than a rigid wall's.

    Its coordinates are the position of the rotor and, on a mount, that of the mount.

    Attributes
    ----------
    rotor : Jeffcott
        In a bearing that gives way its own coefficient of restitution means nothing.
    bearing : TouchdownBearing
        In SI units.
    levitates : bool
        Whether stiffness and damping of the levitation act.
    drive : Drive, optional
        In SI units; without one the speed of the shaft never changes.
    air_gap : float, optional
        Of the magnets, m: where the rotor strikes them a motion ends.

    Raises
    ------
    InputError
        The rotor is no planar rotor with scales, or there is nothing here that :class:`~carom.models.Jeffcott` has not.
    """

    rotor: Jeffcott
    bearing: TouchdownBearing
    levitates: bool = True
    drive: Drive | None = None
    air_gap: float | None = None

    def __post_init__(self) -> None:
        rotor: Any = self.rotor
        if not isinstance(rotor, Jeffcott) or rotor.scales is None:
            raise InputError("rotor", shown(rotor), "a planar rotor with mass, clearance and speed")
        if self.bearing.is_plain and self.drive is None:
            allowed = (
                "a bearing that gives way, has a race, a mount or an offset; a rigid wall needs no model of its own"
            )
            raise InputError("bearing", self.bearing.words, allowed)
        if self.air_gap is not None and self.bearing.centre:
            allowed = "0 where the air gap is known, which counts from the place of levitation"
            raise InputError("touchdown_offset", self.bearing.offset, allowed)

    @property
    def parameters(self) -> Parameters:
        """Parameters of the rotor."""
        return self.rotor.parameters

    @property
    def races(self) -> tuple[Race | None, ...]:
        """The race of the bearing, if it turns."""
        return self.linear.races

    def bearing_at(self, plane: int) -> TouchdownBearing:
        """Its data."""
        return self.bearing

    @property
    def is_on_mount(self) -> bool:
        """Whether the touchdown bearing stands on a mount, whose place then is the second coordinate."""
        return self.bearing.mount_mass is not None

    @property
    def carried_by_housing(self) -> np.ndarray:
        """Rotor and mount."""
        return self.linear.carried_by_housing

    def without_levitation(self) -> InBearing:
        """See :meth:`~carom.models.Model.without_levitation`."""
        return replace(self, levitates=False)

    @cached_property
    def linear(self) -> LinearRotor:
        """The same as a linear rotor."""
        scales: Any = self.rotor.scales
        mass, damping, _, stiffness, forcing = self.rotor.matrices
        if not self.levitates:
            damping, stiffness = np.zeros_like(damping), np.zeros_like(stiffness)
        plane, matrices = [1.0], {"mass": mass, "damping": damping, "stiffness": stiffness}
        given = self.bearing
        if given.mount_mass is not None and given.mount_stiffness is not None:
            mount = given.mount_mass / scales.mass, (given.mount_damping or 0.0) / scales.damping
            plane = [1.0, -1.0]
            held = zip(matrices.items(), (*mount, given.mount_stiffness / scales.stiffness), strict=True)
            matrices = {name: np.diag([matrix[0, 0], value]) for (name, matrix), value in held}
            forcing = np.append(forcing, 0.0)
        at = self.rotor.parameters
        touchdown = Touchdown(
            plane, law_of(given, scales, at.d), at.mu, at.radius_ratio + 1.0, race_of(given, at.radius_ratio, scales)
        )
        return LinearRotor.in_fixed_frame(
            **matrices,
            forcing=forcing,
            touchdowns=[touchdown],
            translation=np.eye(len(plane))[0],
            carried=np.ones(len(plane)),
            shaft=shaft_of(self.drive, scales),
            magnets=None if self.air_gap is None else np.eye(1, len(plane)) * scales.length / self.air_gap,
            scales=scales,
        )

    @cached_property
    def system(self) -> System:
        """Modes, contact plane and contact law.

        Seen from the centre of a bearing off the place of levitation, that pulls with a constant force in the fixed frame (:attr:`pull`).
        """
        return with_forces(self.linear.system, self.pull) if self.pull else self.linear.system

    @property
    def pull(self) -> tuple[Force, ...]:
        """What pulls the rotor from the centre of the bearing to the place of levitation, where these differ."""
        scales: Any = self.rotor.scales
        centre = self.bearing.centre / scales.length
        if not centre or not self.levitates:
            return ()
        pull = np.zeros(len(self.linear.mass), complex)
        pull[0] = -(self.rotor.matrices.stiffness[0, 0] / self.rotor.matrices.mass[0, 0]) * centre
        return (Force(-1j, pull),)

    @property
    def matrices(self) -> Matrices:
        """Matrices of the equations of motion in the fixed frame."""
        return self.linear.matrices

    @property
    def words(self) -> str:
        """Its parameters in a line."""
        names = ("gamma", "omega", "rho", "phi", "mu", *([] if self.bearing.yields else ["d"]), "radius_ratio")
        own = (f"{name} = {self.rotor.value(name):g}" for name in names)
        return f"{', '.join(own)}; {self.words_of_bearing}"

    @property
    def words_of_bearing(self) -> str:
        """What is more than a rigid wall that stands still and a shaft at constant speed."""
        parts = [] if self.bearing.is_plain else [self.bearing.words]
        return "; ".join([*parts, *([self.drive.words] if self.drive else [])])

    @property
    def _left_out(self) -> tuple[str, ...]:
        """Parameters of the planar rotor in a rigid wall that it does not have."""
        return RESTITUTION if self.bearing.yields else ()

    @property
    def varied(self) -> Mapping[str, Field]:
        """Named parameters that can be varied."""
        own = {name: field for name, field in self.rotor.varied.items() if name not in self._left_out}
        bearing = {
            PREFIX + name: replace(TOUCHDOWN_FIELDS[name], name=PREFIX + name)
            for name in self.bearing.given
            if name not in BALL_FIELDS
        }
        return {**own, **bearing}

    def value(self, name: str) -> float:
        """Value of a named parameter, in the unit of its field."""
        if name in self.varied and name.startswith(PREFIX):
            return float(getattr(self.bearing, name.removeprefix(PREFIX)))
        if name in self._left_out:
            raise InputError(name, None, "a touchdown bearing that gives way has no such number for all speeds")
        return self.rotor.value(name)

    def replace(self, **changes: Any) -> InBearing:
        """Return the rotor with other values of its parameters; those of the bearing stay what they are in SI units."""
        for name in self._left_out:
            if name in changes:
                raise InputError(
                    name, changes[name], "a touchdown bearing that gives way has its own entries in [touchdown]"
                )
        of_bearing = {name: changes.pop(name) for name in list(changes) if name.startswith(PREFIX)}
        bearing = self.bearing.replace(**{name.removeprefix(PREFIX): value for name, value in of_bearing.items()})
        rotor = self.rotor.replace(**changes) if changes else self.rotor
        return replace(self, rotor=rotor, bearing=bearing)

    def attributes(self) -> dict[str, Any]:
        """Return the numbers as attributes of a dataset, exact to the last bit."""
        drive = asdict(self.drive) if self.drive else None
        bearing = {**asdict(self.bearing), "levitates": self.levitates, "drive": drive, "air_gap": self.air_gap}
        return {"touchdown_bearing": json.dumps(bearing), "rotor": json.dumps(self.rotor.attributes())}


def shaft_of(drive: Drive | None, scales: Scales) -> Shaft | None:
    """What turns with the shaft in the units of a rotor's equations; ``None`` of one whose speed never changes."""
    if drive is None or drive.polar_inertia is None:
        return None
    unit = scales.mass * scales.length**2
    return Shaft(drive.polar_inertia / unit, drive.torque / (unit * scales.speed**2))


def law_of(bearing: TouchdownBearing, scales: Scales, restitution: float = 0.0) -> Rigid | KelvinVoigt | HuntCrossley:
    """Law of a bearing in the units of a rotor's equations; the restitution is that of a rigid wall."""
    if not bearing.yields:
        return Rigid(restitution)
    exponent = bearing.exponent
    stiffness = (bearing.stiffness or 0.0) * scales.length ** (exponent - 1.0) / scales.stiffness
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
    if bearing.race_inertia is None:
        return None
    unit = scales.mass * scales.length**2
    drag = (bearing.race_drag or 0.0) / (unit * scales.speed)
    return Race(bearing.race_inertia / unit, radius_ratio + 1.0, drag)
