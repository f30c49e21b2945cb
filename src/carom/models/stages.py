"""A rotor that changes while it moves: forces on it, and stages that a trigger ends, such as contact that persists."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.arguments import Infinity, NotNegative, Positive, checked
from carom.models.forcing import Force, with_forces
from carom.models.mode_arrays import EQUAL, STEADY
from carom.models.model import Matrices, Model
from carom.models.race import Race
from carom.models.system import System
from carom.outcome import InputError, shown
from carom.parameters import (
    SETTINGS,
    ControlLimit,
    Field,
    Parameters,
    Scales,
    TouchdownBearing,
    read_quantity,
)
from carom.parameters.settings import GRAVITY_NAME

if TYPE_CHECKING:
    from carom.models.limited import Limit


class Around(Model):
    """A model that takes its parameters, scales and matrices from another one, its ``rotor``."""

    rotor: Model

    @property
    def matrices(self) -> Matrices:
        """Matrices of the equations of motion in the fixed frame."""
        return self.rotor.matrices

    @property
    def scales(self) -> Scales | None:
        """Mass, clearance and speed that convert results to SI units, if known."""
        return self.rotor.scales

    @property
    def unbalance_phase(self) -> float:
        """Angle of the unbalance in the co-rotating frame, in rad."""
        return self.rotor.unbalance_phase

    @property
    def varied(self) -> Mapping[str, Field]:
        """Named parameters that can be varied."""
        return self.rotor.varied

    def value(self, name: str) -> float:
        """Value of a named parameter."""
        return self.rotor.value(name)

    def rates(self, name: str) -> None:
        """No derivatives: differences of the equations of motion have to do."""

    @property
    def planar(self) -> Parameters | None:
        """Those of the rotor."""
        return self.rotor.planar

    @property
    def limits(self) -> ControlLimit | tuple[Limit, ...]:
        """Those of the rotor."""
        return self.rotor.limits

    @property
    def listed_limits(self) -> tuple[Limit, ...]:
        """Those of the rotor."""
        return self.rotor.listed_limits

    @property
    def pull(self) -> tuple[Force, ...]:
        """That of the rotor."""
        return self.rotor.pull

    @property
    def stated_forces(self) -> tuple[Force, ...]:
        """Those of the rotor."""
        return self.rotor.stated_forces

    @property
    def races(self) -> tuple[Race | None, ...]:
        """Those of the rotor."""
        return self.rotor.races

    def bearing_at(self, plane: int) -> TouchdownBearing | None:
        """That of the rotor."""
        return self.rotor.bearing_at(plane)

    @property
    def is_on_mount(self) -> bool:
        """Whether that of the rotor does."""
        return self.rotor.is_on_mount

    @property
    def carried_by_housing(self) -> np.ndarray:
        """Those of the rotor."""
        return self.rotor.carried_by_housing

    @property
    def acting_on_conjugates(self) -> np.ndarray | None:
        """Those of the rotor."""
        return self.rotor.acting_on_conjugates

    @property
    def finite_elements(self) -> Any:
        """Those behind the rotor."""
        return self.rotor.finite_elements

    @property
    def carry_at_regain(self) -> np.ndarray | None:
        """That of the rotor."""
        return self.rotor.carry_at_regain

    def unbalance_push(self, node: int | None = None) -> np.ndarray:
        """That of the rotor: coordinates of what stands around it, such as a mount, are not pushed."""
        push = self.rotor.unbalance_push(node)
        return np.append(push, np.zeros(len(self.matrices.mass) - len(push)))

    def unbalance_along(self, node: int | None = None) -> float | None:
        """That of the rotor."""
        return self.rotor.unbalance_along(node)

    def with_changed_unbalance(self, change: complex, node: int | None = None) -> tuple[Any, float]:
        """The same around the changed rotor."""
        rotor, turned = self.rotor.with_changed_unbalance(change, node)
        return replace(self, rotor=rotor), turned  # type: ignore[type-var]  # all that is around a rotor is a dataclass


@dataclass(frozen=True, eq=False)
class Forced(Around):
    """A rotor with further forces on it that change with time in its frame, for example in a housing that is shaken.

    It never is at rest in that frame: what needs an equilibrium there is not found for it.  Its orbits are, under forces that are
    constant in the fixed frame, such as weight.

    Attributes
    ----------
    rotor : Model
        Without these forces; its matrices are those of the model.
    forces : tuple of Force
    """

    rotor: Model
    forces: tuple[Force, ...]

    @property
    def stated_forces(self) -> tuple[Force, ...]:
        """Those of the rotor, and further ones."""
        return (*self.rotor.stated_forces, *self.forces)

    @property
    def unforced(self) -> Model:
        """The rotor without stated forces."""
        return self.rotor.unforced

    def without_levitation(self) -> Forced:
        """See :meth:`~carom.models.Model.without_levitation`."""
        return Forced(self.rotor.without_levitation(), self.forces)

    def __post_init__(self) -> None:
        _check_one_stage(self.rotor)
        given: Any = self.forces
        listed = tuple(given) if isinstance(given, Sequence) else ()
        if not listed or not all(isinstance(each, Force) for each in listed):
            raise InputError("forces", shown(given), "carom.models.Force, one or more")
        object.__setattr__(self, "forces", tuple(_checked_force(each, self.rotor.system.rest.shape) for each in listed))

    @cached_property
    def system(self) -> System:
        """Modes, contact planes and contact law, with a mode for each force."""
        return with_forces(self.rotor.system, self.forces)

    @cached_property
    def _gravity(self) -> tuple[int, float] | None:
        """Which of the forces is weight, which pulls all masses alike, and its acceleration in m/s²; ``None`` without scales or weight."""
        along = self.rotor.system.translated
        for place, force in enumerate(self.forces):
            pull = np.vdot(along, force.accelerations) / np.vdot(along, along)
            alike = np.abs(force.accelerations - pull * along).max() <= EQUAL * abs(pull)
            if self.scales is not None and pull and alike and abs(force.exponent - STEADY) <= EQUAL:
                return place, float(abs(pull)) * self.scales.acceleration
        return None

    @property
    def varied(self) -> Mapping[str, Field]:
        """Named parameters that can be varied; with scales also ``gravity``, the acceleration of a weight, in its direction."""
        if self._gravity is None:
            return self.rotor.varied
        return {**self.rotor.varied, GRAVITY_NAME: replace(SETTINGS[GRAVITY_NAME], zero=False)}

    def value(self, name: str) -> float:
        """Value of a named parameter."""
        return self._gravity[1] if name == GRAVITY_NAME and self._gravity else self.rotor.value(name)

    def replace(self, **changes: Any) -> Forced:
        """Return the rotor with other values of its parameters, and the same forces: in SI units, if its scales are known."""
        forces = list(self.forces)
        if self._gravity is not None and GRAVITY_NAME in changes:
            place, present = self._gravity
            share = read_quantity(self.varied[GRAVITY_NAME], changes.pop(GRAVITY_NAME)) / present
            forces[place] = Force(forces[place].exponent, forces[place].accelerations * share)
        rotor = self.rotor.replace(**changes) if changes else self.rotor
        return Forced(rotor, tuple(_in_scales(force, self.scales, rotor.scales) for force in forces))

    def attributes(self) -> dict[str, Any]:
        """Return the rotor and the forces as attributes of a dataset, exact to the last bit."""
        forces = [[force.exponent, *force.accelerations] for force in self.forces]
        texts = [[(complex(each).real, complex(each).imag) for each in force] for force in forces]
        return {"forces": json.dumps(texts), "rotor": json.dumps(self.rotor.attributes())}


def _in_scales(force: Force, before: Scales | None, after: Scales | None) -> Force:
    """The same force, seen from the fixed frame, in other units of the equations."""
    if before is None or after is None or before == after:
        return force
    exponent = (force.exponent + 1j) * (before.speed / after.speed) - 1j
    return Force(exponent, force.accelerations * (before.acceleration / after.acceleration))


def _check_one_stage(rotor: Any) -> None:
    """Refuse what is no model of one stage."""
    # Whether an object follows the whole protocol takes longer to find out than a short simulation may.
    if isinstance(rotor, Staged) or not (hasattr(type(rotor), "system") and hasattr(type(rotor), "rates")):
        raise InputError(
            "rotor", shown(rotor), "a model of one stage, such as carom.models.model_of(machine) or Forced"
        )


def _checked_force(force: Force, shape: tuple[int, ...]) -> Force:
    """The force as complex numbers; refuse those that are none, or not as many as there are coordinates."""
    exponent, accelerations = _complex_numbers(force.exponent), _complex_numbers(force.accelerations)
    if exponent is None or exponent.shape:
        raise InputError("exponent", shown(force.exponent), "a finite number")
    if accelerations is None or accelerations.shape != shape:
        raise InputError("accelerations", shown(force.accelerations), f"finite numbers of shape {shape}")
    return Force(complex(exponent), accelerations)


def _complex_numbers(given: Any) -> np.ndarray | None:
    """Array of finite numbers, a copy; ``None`` if they are no such numbers."""
    try:
        values = np.array(given)
    except (TypeError, ValueError, OverflowError):
        return None
    return values.astype(complex) if values.dtype.kind in "iufc" and np.isfinite(values).all() else None


@checked
@dataclass(frozen=True)
class Trigger:
    """What ends a stage: whichever happens first.  Times are in ``1/Ω``, speeds in ``c_r Ω``.

    Attributes
    ----------
    time : float
        Time since the beginning of the stage.
    contact_time : float
        Time for which contact has persisted, at any plane: lasting contact, or bounces.
    contact_gap : float
        Longest flight between two bounces of contact that persists; in a flight it counts as persisting until that time is over.
    impact_speed : float
        Radial speed of an impact at any plane.
    """

    time: Positive | Infinity = np.inf
    contact_time: Positive | Infinity = np.inf
    contact_gap: NotNegative = 0.0
    impact_speed: Positive | Infinity = np.inf

    @property
    def watches_contact(self) -> bool:
        """Whether contact can end the stage."""
        return min(self.contact_time, self.impact_speed) < np.inf


NEVER = Trigger()
"""The trigger of a stage without an end."""


@dataclass(frozen=True, eq=False)
class Stage:
    """A part of a motion.

    Attributes
    ----------
    rotor : Model
    trigger : Trigger
        What ends it; by default nothing.
    carry : array_like, shape (2n, 2n), optional
        Coordinates and rates in the next stage per coordinate and rate at the end of this one; by default they are the same.
    """

    rotor: Model
    trigger: Trigger = NEVER
    carry: np.ndarray | None = None

    def __post_init__(self) -> None:
        _check_one_stage(self.rotor)
        if not isinstance(self.trigger, Trigger):
            raise InputError("trigger", shown(self.trigger), "carom.models.Trigger")
        if self.carry is not None:
            size = 2 * len(self.rotor.system.rest)
            carry = _complex_numbers(self.carry)
            if carry is None or carry.shape != (size, size):
                raise InputError("carry", shown(self.carry), f"finite numbers of shape {(size, size)}")
            object.__setattr__(self, "carry", carry)

    def carried(self, position: np.ndarray, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Positions and velocities with which the next stage begins, of the shapes of those at the end of this one."""
        if self.carry is None:
            return position, velocity
        n = len(self.carry) // 2
        states = np.concatenate([np.reshape(part, (-1, n)) for part in (position, velocity)], axis=1) @ self.carry.T
        return states[:, :n].reshape(np.shape(position)), states[:, n:].reshape(np.shape(velocity))


@dataclass(frozen=True, eq=False)
class Staged(Around):
    """A rotor that moves in stages: when the trigger of one ends it, the motion goes on in the next.

    Its parameters, kicks, equilibria and orbits are those of the rotor of the first stage.

    Attributes
    ----------
    stages : tuple of Stage

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.models.model_of(cm.load("examples/keogh-cole.toml"))
    >>> on_contact = cm.models.Trigger(contact_time=5.0, contact_gap=2.0)
    >>> helped = cm.models.Staged((cm.models.Stage(machine, on_contact), cm.models.Stage(machine.replace(gamma=0.8))))
    >>> motion = cm.simulate(helped, cm.kick("100 mm/s"))
    >>> [part.outcome.label for part in motion.parts]
    ['triggered', 'levitated']
    """

    stages: tuple[Stage, ...]

    def __post_init__(self) -> None:
        given: Any = self.stages
        listed = tuple(given) if isinstance(given, Sequence) else ()
        if not listed or not all(isinstance(each, Stage) for each in listed):
            raise InputError("stages", shown(given), "carom.models.Stage, one or more")
        counts = {len(each.rotor.system.rest) for each in listed}
        if len(counts) > 1:
            raise InputError("stages", f"rotors of {sorted(counts)} coordinates", "rotors of equally many coordinates")
        object.__setattr__(self, "stages", listed)

    @property
    def rotor(self) -> Model:  # type: ignore[override]
        """Rotor of the first stage."""
        return self.stages[0].rotor

    @property
    def system(self) -> System:
        """Modes, contact planes and contact law of the first stage."""
        return self.rotor.system

    @property
    def planar(self) -> None:
        """None: its stages may have different ones."""

    def replace(self, **changes: Any) -> Staged:
        """Return the rotor with other values of parameters in all stages."""
        return Staged(tuple(replace(each, rotor=each.rotor.replace(**changes)) for each in self.stages))

    def with_changed_unbalance(self, change: complex, node: int | None = None) -> tuple[Staged, float]:
        """The same in all stages."""
        moved = [each.rotor.with_changed_unbalance(change, node) for each in self.stages]
        return Staged(
            tuple(replace(each, rotor=rotor) for each, (rotor, _) in zip(self.stages, moved, strict=True))
        ), moved[0][1]

    def attributes(self) -> dict[str, Any]:
        """Return the stages as attributes of a dataset, exact to the last bit."""
        stages = [
            {
                "rotor": each.rotor.attributes(),
                "trigger": asdict(each.trigger),
                "carry": None if each.carry is None else [each.carry.real.tolist(), each.carry.imag.tolist()],
            }
            for each in self.stages
        ]
        return {"stages": json.dumps(stages)}


@checked
def depends_on_instant(model: Model) -> bool:
    """Whether the end of a disturbance depends on the instant of the turn at which it comes: on where the unbalance then points.

    So it does where something stands in the fixed frame in any stage: weight or another force, bearings that act differently in two
    directions, limits of magnetic bearings along their axes.
    """
    return any(stage.rotor.system.timed for stage in stages_of(model))


def stages_of(model: Model) -> tuple[Stage, ...]:
    """Stages in which a model moves; of most there is one without an end."""
    return model.stages if isinstance(model, Staged) else (Stage(model),)
