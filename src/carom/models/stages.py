"""A rotor that changes while it moves: stages that a trigger ends, such as contact that persists."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from carom.base.arguments import Infinity, NotNegative, Positive, checked
from carom.base.outcome import InputError, shown
from carom.models.forcing import complex_numbers
from carom.models.rotor import ONE_STAGE, Rotor


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
    shaft_speed : float
        Speed of a shaft that slows down, in ``Ω``, seen at an impact or after a step of contact.
    quiet_time : float
        Time for which the rotor was not faster than ``quiet_speed``, in the fixed frame, at any touchdown bearing.  The speed is looked at at events,
        and when the time is over.
    quiet_speed : float
    """

    time: Positive | Infinity = np.inf
    contact_time: Positive | Infinity = np.inf
    contact_gap: NotNegative = 0.0
    impact_speed: Positive | Infinity = np.inf
    shaft_speed: float | Infinity = -np.inf
    quiet_time: Positive | Infinity = np.inf
    quiet_speed: NotNegative = 0.0

    @property
    def is_certain(self) -> bool:
        """Whether it may end a motion that has settled."""
        return self.time < np.inf or self.quiet_time < np.inf or self.shaft_speed > -np.inf


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
    slowed_to : float
        Speed of a shaft to which the drive has slowed it down where the stage begins, in ``Ω``.
    """

    rotor: Rotor
    trigger: Trigger = NEVER
    carry: np.ndarray | None = None
    slowed_to: float = np.inf

    def __post_init__(self) -> None:
        rotor: object = self.rotor
        if not isinstance(rotor, Rotor) or rotor.stages:
            raise InputError("rotor", shown(rotor), ONE_STAGE)
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


def in_stages(stages: Sequence[Stage]) -> Rotor:
    """The rotor of the first stage, moving in stages: when the trigger of one ends it, the motion goes on in the next.

    Its parameters, kicks, equilibria and orbits are those of the rotor of the first stage; other values of parameters are set in all stages.

    Raises
    ------
    InputError
        They are no stages, or their rotors have different numbers of coordinates.

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.models.rotor_of(cm.load("examples/keogh-cole.toml"))
    >>> on_contact = cm.models.Trigger(contact_time=5.0, contact_gap=2.0)
    >>> helped = cm.models.in_stages((cm.models.Stage(machine, on_contact), cm.models.Stage(machine.replace(gamma=0.8))))
    >>> motion = cm.simulate(helped, cm.kick("100 mm/s"))
    >>> [part.outcome.label for part in motion.parts]
    ['triggered', 'levitated']
    """
    given: object = stages
    listed = tuple(given) if isinstance(given, Sequence) else ()
    if not listed or not all(isinstance(each, Stage) for each in listed):
        raise InputError("stages", shown(given), "carom.models.Stage, one or more")
    counts = {len(each.rotor.system.rest) for each in listed}
    if len(counts) > 1:
        raise InputError("stages", f"rotors of {sorted(counts)} coordinates", "rotors of equally many coordinates")
    return replace(listed[0].rotor, stages=listed)


def stages_of(rotor: Rotor) -> tuple[Stage, ...]:
    """Stages in which a rotor moves; of most there is one without an end."""
    return rotor.stages or (Stage(rotor),)
