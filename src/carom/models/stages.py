"""A rotor that changes while it moves: stages that a trigger ends, such as contact that persists."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from carom.arguments import Infinity, NotNegative, Positive, checked
from carom.models.forces import complex_numbers
from carom.models.forcing import Force
from carom.models.rotor import Rotor
from carom.models.system import System
from carom.outcome import InputError, shown


def _check_one_stage(rotor: Any) -> None:
    """Refuse what is no rotor of one stage."""
    if isinstance(rotor, Staged) or not isinstance(rotor, Rotor):
        raise InputError("rotor", shown(rotor), "a rotor of one stage, such as carom.models.rotor_of(machine)")


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
    rotor : Rotor
    trigger : Trigger
        What ends it; by default nothing.
    carry : array_like, shape (2n, 2n), optional
        Coordinates and rates in the next stage per coordinate and rate at the end of this one; by default they are the same.
    """

    rotor: Rotor
    trigger: Trigger = NEVER
    carry: np.ndarray | None = None

    def __post_init__(self) -> None:
        _check_one_stage(self.rotor)
        if not isinstance(self.trigger, Trigger):
            raise InputError("trigger", shown(self.trigger), "carom.models.Trigger")
        if self.carry is not None:
            size = 2 * len(self.rotor.system.rest)
            carry = complex_numbers(self.carry)
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


@dataclass(frozen=True, eq=False, repr=False, init=False)
class Staged(Rotor):
    """A rotor that moves in stages: when the trigger of one ends it, the motion goes on in the next.

    Its parameters, kicks, equilibria and orbits are those of the rotor of the first stage.

    Attributes
    ----------
    stages : tuple of Stage

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.models.rotor_of(cm.load("examples/keogh-cole.toml"))
    >>> on_contact = cm.models.Trigger(contact_time=5.0, contact_gap=2.0)
    >>> helped = cm.models.Staged((cm.models.Stage(machine, on_contact), cm.models.Stage(machine.replace(gamma=0.8))))
    >>> motion = cm.simulate(helped, cm.kick("100 mm/s"))
    >>> [part.outcome.label for part in motion.parts]
    ['triggered', 'levitated']
    """

    stages: tuple[Stage, ...] = ()

    def __init__(self, stages: Sequence[Stage]) -> None:
        given: Any = stages
        listed = tuple(given) if isinstance(given, Sequence) else ()
        if not listed or not all(isinstance(each, Stage) for each in listed):
            raise InputError("stages", shown(given), "carom.models.Stage, one or more")
        counts = {len(each.rotor.system.rest) for each in listed}
        if len(counts) > 1:
            raise InputError("stages", f"rotors of {sorted(counts)} coordinates", "rotors of equally many coordinates")
        first = listed[0].rotor
        named = {"definition": first.definition, "forces": first.forces, "limits": first.limits, "stages": listed}
        for name, value in named.items():
            object.__setattr__(self, name, value)

    @property
    def rotor(self) -> Rotor:
        """Rotor of the first stage."""
        return self.stages[0].rotor

    @property
    def system(self) -> System:
        """Modes, contact planes and contact law of the first stage."""
        return self.rotor.system

    __eq__ = object.__eq__
    __hash__ = object.__hash__

    def under(self, *forces: Force) -> Rotor:
        """Refused: forces act on the rotor of a stage."""
        _check_one_stage(self)
        return self

    def rates(self, name: str) -> None:
        """No derivatives: differences of the equations of motion have to do."""

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
def depends_on_instant(model: Rotor) -> bool:
    """Whether the end of a disturbance depends on the instant of the turn at which it comes: on where the unbalance then points.

    So it does where something stands in the fixed frame in any stage: weight or another force, bearings that act differently in two
    directions, limits of magnetic bearings along their axes.
    """
    return any(stage.rotor.system.timed for stage in stages_of(model))


def stages_of(model: Rotor) -> tuple[Stage, ...]:
    """Stages in which a model moves; of most there is one without an end."""
    return model.stages if isinstance(model, Staged) else (Stage(model),)
