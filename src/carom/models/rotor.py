"""The rotor: one class for all of them, asked for what it has and never for its kind."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import InputError, shown
from carom.base.results import Result
from carom.models.acting import Acting, is_steady
from carom.models.definition import Definition, Matrices
from carom.models.documents import document_of
from carom.models.forcing import (
    Force,
    checked_forces,
    gravity_among,
    in_scales,
    with_forces,
)
from carom.models.limits import Limit, checked_limits, limits_by, with_bias, with_limits
from carom.models.mode_arrays import STEADY
from carom.parameters import SETTINGS, ControlLimit, Field, Gravity, Parameters, Scales, read_quantity
from carom.parameters.machine_file import GRAVITY_NAME
from carom.parameters.tables import BIAS

if TYPE_CHECKING:
    from carom.models.linear import LinearEquations
    from carom.models.stages import Stage
    from carom.models.system import System
    from carom.models.turning import Race

PLANAR_ALONE = "the planar rotor, of which alone this result is known; the functions of carom itself take any rotor"
ONE_STAGE = "a rotor of one stage, such as carom.models.rotor_of(machine)"
_GRAVITY_FIELD = dataclasses.replace(SETTINGS[GRAVITY_NAME], zero=False)
_LEVITATION = ("gamma", "omega")
"""Parameters of the levitation as a whole, with which limits given as numbers would change."""


@dataclass(frozen=True, eq=False, repr=False)
class Rotor(Result):
    """A rotor in its touchdown bearings, with what acts on it: a value with named parameters.

    Makers give it its definition: :func:`~carom.models.jeffcott`, :func:`~carom.models.from_matrices`, flexible machines
    (:mod:`carom.rotors`).  Exact results are asked for in :func:`carom.closed_forms.exact_results.exact_results`.

    Attributes
    ----------
    definition : Definition
        Its parameters, and the equations of motion that follow from them.
    forces : tuple of Force
        Further forces that change with time in its frame, such as weight, or those of a housing that is shaken.  Under them it never is at rest in
        that frame.  Its orbits are found under forces that are constant in the fixed frame.
    carried_by_bias : bool
        Whether bias currents of its magnetic bearings carry its weight: it levitates in the centre, and the weight acts where levitation is lost.
    limits : carom.parameters.ControlLimit, or tuple of Limit
        Of its magnetic bearings, beyond which these give no more and the states of controllers wind up: of the planar rotor in SI units, or
        in units of its equations.
    is_vertical : bool
        Whether its weight acts along its axis, so that nothing pulls it to a side when levitation is lost.
    stages : tuple of Stage
        Where it changes while it moves, its stages (:func:`carom.models.in_stages`): it is the rotor of the first one.

    Raises
    ------
    InputError
        Forces or limits are of another kind, stages begin with another rotor, or the touchdown bearing is off the place of levitation where the magnetic bearings have limits.
    """

    definition: Definition
    forces: tuple[Force, ...] = ()
    limits: ControlLimit | tuple[Limit, ...] = ()
    carried_by_bias: bool = False
    stages: tuple[Stage, ...] = ()
    is_vertical: bool = False

    def __post_init__(self) -> None:
        if self.forces != ():
            object.__setattr__(self, "forces", checked_forces(self.forces, self.definition.system.rest.shape))
        if self.limits != ():
            object.__setattr__(self, "limits", checked_limits(self.limits, self.definition))
        if self.stages and self._outline != self.stages[0].rotor._outline:
            raise InputError("stages", shown(self.stages[0]), "stages the first of which has this rotor")

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Rotor) or (self._outline, self.stages) != (other._outline, other.stages):
            return False
        return all(mine is theirs for mine, theirs in zip(self.forces, other.forces, strict=True))

    def __hash__(self) -> int:
        return hash(self._outline)

    @property
    def _outline(self) -> tuple[object, ...]:
        return self.definition, len(self.forces), self.limits, self.carried_by_bias, self.is_vertical

    def rows(self) -> list[tuple[str, str]]:
        """What defines it, and what acts on it."""
        fields = dataclasses.fields(self.definition)  # type: ignore[arg-type]  # all definitions are dataclasses
        values = {field.name: getattr(self.definition, field.name) for field in fields}
        values |= {
            name: value
            for name, value in vars(self).items()
            if name in ("forces", "limits", "carried_by_bias") and value
        }
        return [
            (name, self.line_of(name, value))
            for name, value in values.items()
            if value is not None and name != "scales"
        ]

    @property
    def words(self) -> str:
        """Its parameters and its limits in a line; empty where there are too many."""
        return "; ".join(filter(None, (self.definition.words, self.words_of_limits)))

    @property
    def words_of_limits(self) -> str:
        """The limits in words."""
        if isinstance(self.limits, ControlLimit):
            return self.limits.words
        return f"{len(self.limits)} limits" if self.limits else ""

    # What follows from its definition.

    @property
    def equations(self) -> LinearEquations:
        """Its equations of motion by matrices, without further forces and limits."""
        return self.definition.equations

    @property
    def matrices(self) -> Matrices:
        """Matrices of the equations of motion in the fixed frame."""
        return self.definition.matrices

    @property
    def scales(self) -> Scales | None:
        """Mass, clearance and speed that convert results to SI units, if known."""
        return self.definition.scales

    @property
    def unbalance_phase(self) -> float:
        """Angle of the unbalance in the co-rotating frame, in rad."""
        return self.definition.unbalance_phase

    @property
    def equilibrium(self) -> Any:
        """Coordinates at rest without further forces; a plain number of one coordinate.  They may lie outside the clearance."""
        return self.definition.equilibrium

    @property
    def planar(self) -> Parameters | None:
        """Dimensionless parameters of the planar rotor, whatever acts on it; ``None`` of other rotors, and of one that changes in stages."""
        return None if self.stages else self.definition.planar

    @property
    def parameters(self) -> Parameters:
        """The same of a rotor that is planar; any other one is refused."""
        if self.planar is None:
            raise InputError("machine", shown(self), PLANAR_ALONE)
        return self.planar

    @property
    def numbers(self) -> dict[str, float] | None:
        """Parameters of the planar rotor by name, without a restitution that its wall does not have; ``None`` of other rotors."""
        if self.planar is None:
            return None
        return {name: value for name, value in self.planar.as_dict().items() if name in self.varied}

    @property
    def finite_elements(self) -> Any:
        """The reduced flexible machine behind it (:class:`carom.rotors.ReducedMachine`); ``None`` of other rotors."""
        return self.definition.finite_elements

    @property
    def is_compliant(self) -> bool:
        """Whether a touchdown bearing is compliant."""
        return bool(self.definition.system.arrays["stiffness"].any())

    @property
    def in_rigid_wall(self) -> Parameters | None:
        """Parameters of the planar rotor in a rigid wall, whose load is compared with that of solid steel; ``None`` of other rotors and walls."""
        return None if self.is_compliant else self.planar

    @property
    def is_anisotropic(self) -> bool:
        """Whether its bearings are anisotropic."""
        return self.definition.system.is_anisotropic

    @property
    def races(self) -> tuple[Race | None, ...]:
        """The race at each touchdown bearing; ``None`` where it stands still."""
        return tuple(touchdown.race for touchdown in self.equations.touchdowns)

    @property
    def carried_by_housing(self) -> np.ndarray:
        """Coordinates (n,) when all that a housing carries is displaced by one against it: the rotor as a whole, and mounts."""
        carried = self.equations.carried
        return self.definition.system.translated if carried is None else carried

    # What acts on it besides.

    @cached_property
    def acting(self) -> Acting:
        """The forces that act on it while it levitates, and what bias currents carry of its weight."""
        return Acting.of(self.definition, self.forces, self.limits, self.carried_by_bias)

    @cached_property
    def system(self) -> System:
        """Modes, contact planes, contact law, limits, and a mode for each force, as arrays for the kernels."""
        if self.stages:
            return self.stages[0].rotor.system
        if "_before" in vars(self):  # modes of the rotor to which forces were added need not be found again
            rotor, more = vars(self)["_before"]
            return with_forces(rotor.system, more)
        system = self.definition.system
        limits = self.listed_limits
        if limits:
            system = with_limits(system, limits)
        asked = self.acting.asked_by_bias
        if not asked.any():
            return with_forces(system, self.acting.forces) if self.acting.forces else system
        # What limits see of the bias currents turns as weight does.
        turning = Force(STEADY, np.zeros(len(system.rest), complex)), *self.acting.forces
        return with_bias(with_forces(system, turning), limits, asked)

    @property
    def listed_limits(self) -> tuple[Limit, ...]:
        """The limits in units of the equations."""
        if isinstance(self.limits, ControlLimit):
            scales = cast("Scales", self.scales)
            return limits_by(self.limits, cast("Parameters", self.definition.planar), scales, len(self.matrices.mass))
        return self.limits

    @cached_property
    def _gravity(self) -> tuple[int, float] | None:
        """Which of the forces is weight, which pulls all masses alike, and its acceleration in m/s²; ``None`` without scales or weight."""
        return gravity_among(self.forces, self.definition.system.translated, self.scales)

    @property
    def is_time_dependent(self) -> bool:
        """Whether it matters when a motion begins: something stands in the fixed frame, past which the unbalance turns."""
        return self.system.is_time_dependent

    @property
    def depends_on_instant(self) -> bool:
        """Whether the end of a disturbance depends on the instant of the turn at which it comes: something stands in the fixed frame in any stage."""
        return any(each.rotor.is_time_dependent for each in self.stages) if self.stages else self.is_time_dependent

    def under(self, *forces: Force) -> Rotor:
        """The rotor with further forces on it.

        Raises
        ------
        InputError
            It changes in stages: forces act on the rotor of a stage.
        """
        if self.stages:
            raise InputError("rotor", shown(self), ONE_STAGE)
        more = checked_forces(forces, self.definition.system.rest.shape)
        rotor = dataclasses.replace(self, forces=(*self.forces, *more))
        if not (self.carried_by_bias and any(map(is_steady, more))):
            rotor.__dict__["_before"] = self, more
        return rotor

    def under_gravity(self, gravity: Gravity) -> Rotor:
        """The rotor with its weight: all its masses fall alike, along the translation, or would without bias currents; or along the axis, where that moves no place.

        Raises
        ------
        InputError
            Its scales are not known.
        """
        if self.scales is None:
            allowed = "a rotor with mass, clearance and speed: without them nothing is in m/s^2"
            raise InputError("gravity", gravity.words, allowed)
        if gravity.is_axial:
            return dataclasses.replace(self, is_vertical=True)
        rotor = self.under(Force(STEADY, gravity.pull(self.scales) * self.definition.system.translated))
        return dataclasses.replace(rotor, carried_by_bias=True) if gravity.carried_by == BIAS else rotor

    @property
    def unforced(self) -> Rotor:
        """The rotor without forces."""
        return dataclasses.replace(self, forces=(), carried_by_bias=False) if self.forces else self

    def without_levitation(self) -> Rotor:
        """The rotor without the stiffness and damping of its levitation, under the same forces.

        One of several coordinates is refused where it does not say what is left then, which does not follow from its shaft.
        """
        return Rotor(self.definition.without_levitation(), self.forces, is_vertical=self.is_vertical)

    # Named parameters.

    @property
    def varied(self) -> Mapping[str, Field]:
        """Named parameters that can be varied: words, symbol, unit and range of each.

        With scales ``gravity`` is one, the acceleration of a weight that acts, in its direction.  Those of the levitation are none beside limits given as numbers.
        """
        found = self.definition.varied
        if self.limits and not isinstance(self.limits, ControlLimit):
            found = {name: field for name, field in found.items() if name not in _LEVITATION}
        if self._gravity is not None and self.acting.weight is not None:
            found = {**found, GRAVITY_NAME: _GRAVITY_FIELD}
        return found

    @checked
    def value(self, name: str) -> float:
        """Value of a named parameter, in the unit of its field.

        Raises
        ------
        InputError
            No such name, or touchdown bearings with different values.
        """
        return self._gravity[1] if name == GRAVITY_NAME and self._gravity else self.definition.value(name)

    def replace(self, **changes: float | str) -> Rotor:
        """Return the rotor with other values of named parameters; what depends on them changes too.

        Forces and limits stay what they are in SI units, if scales are known; limits that follow from parameters change with these.

        Raises
        ------
        InputError
            A name is unknown or a value not allowed, or there is nothing to multiply: no damping, stiffness or unbalance.
        """
        if self.stages:
            return self._in_all_stages(lambda rotor: rotor.replace(**changes))
        forces, limits, before = list(self.forces), self.limits, self.scales
        if self._gravity is not None and GRAVITY_NAME in changes:
            place, present = self._gravity
            share = read_quantity(_GRAVITY_FIELD, changes.pop(GRAVITY_NAME)) / present
            forces[place] = Force(forces[place].exponent, forces[place].accelerations * share)
        if not isinstance(limits, ControlLimit) and limits:
            for name in changes.keys() & set(_LEVITATION) - self.varied.keys():
                raise InputError(name, shown(changes[name]), "not to be set beside limits of the controllers")
        definition = self.definition.replace(**changes) if changes else self.definition
        after = definition.scales
        if not isinstance(limits, ControlLimit) and limits:
            if definition.limits:  # what a controller asks for changes with its gains
                limits = definition.limits
            elif before is not None and after is not None and before != after:
                limits = tuple(each.at_speed(before.speed / after.speed) for each in limits)
        moved = tuple(in_scales(force, before, after) for force in forces)
        return dataclasses.replace(self, definition=definition, forces=moved, limits=limits)

    def _in_all_stages(self, change: Callable[[Rotor], Rotor]) -> Rotor:
        """The rotor with a change in all its stages."""
        stages = tuple(dataclasses.replace(each, rotor=change(each.rotor)) for each in self.stages)
        return dataclasses.replace(stages[0].rotor, stages=stages)

    @property
    def stored(self) -> tuple[str, ...]:
        """Names of the attributes from which it is made again."""
        return ("stages",) if self.stages else ("definition", "forces", "limits", "carried_by_bias", "is_vertical")

    @staticmethod
    def from_stored(stages: tuple[Stage, ...] = (), **others: Any) -> Rotor:
        """Make the rotor again."""
        return dataclasses.replace(stages[0].rotor, stages=stages) if stages else Rotor(**others)

    def attributes(self) -> dict[str, str]:
        """Texts from which :func:`~carom.models.subjects.rotor_from` makes the same rotor again, exact to the last bit."""
        numbers = self.planar if self.has_closed_forms and not self.forces and not self.is_vertical else None
        return {"rotor": json.dumps(document_of(self))} if numbers is None else numbers.attributes()

    def document(self) -> dict[str, object]:
        """What describes it in a document: the parameters of the planar rotor, the attributes of any other."""
        return {"parameters": self.numbers} if self.numbers else {"rotor": self.attributes()}

    def with_changed_unbalance(self, change: complex, node: int | None = None) -> tuple[Rotor, float]:
        """The rotor with another unbalance, and the angle by which its frame has turned, so that the phase stays what it was.

        The change is a vector, an eccentricity in ``c_r`` relative to the direction of the unbalance before: a force ``Δ p e^{iβ}`` in the frame
        that turns with the shaft.  The rotor after it is seen in a frame that has turned with the unbalance, so that many changes lead to one
        machine, which differ by where the motion starts.  A node is one of a flexible machine.
        """
        definition, turned = self.definition.with_changed_unbalance(change, node)
        if self.stages:
            return self._in_all_stages(lambda rotor: rotor.with_changed_unbalance(change, node)[0]), turned
        return dataclasses.replace(self, definition=definition), turned

    @property
    def has_closed_forms(self) -> bool:
        """Whether exact results are known: of the planar rotor in a rigid wall that stands still, without limits and forces that act."""
        return (
            self.planar is not None and self.definition.has_closed_forms and not self.acting.forces and not self.limits
        )
