"""Controllers of several magnetic bearings at once: of translation and tilt about the centre of mass, or of all sensors and magnets by matrices."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from carom.base.outcome import InputError, shown
from carom.parameters import Field
from carom.rotors.controllers import PID, Controller, Series, controller_of, gains_in, state_space_of
from carom.rotors.free_rotor import FreeRotor
from carom.rotors.magnetic_bearing import AT_REGAIN, MagneticBearing
from carom.rotors.state_spaces import StateSpace, in_series, side_by_side


class ForcePID(PID):
    """A :class:`PID` of force by displacement: N/m, N/(m s), N s/m."""

    fields: ClassVar[Mapping[str, Field]] = gains_in("N/m", "N/m/s", "N s/m", '"1e7 N/m"')


class MomentPID(PID):
    """A :class:`PID` of moment by tilt: N m/rad, N m/(rad s), N m s/rad."""

    fields: ClassVar[Mapping[str, Field]] = gains_in("N m/rad", "N m/rad/s", "N m s/rad", '"1e6 N m/rad"')


@dataclass(frozen=True, eq=False)
class SharedController:
    """One controller of several magnetic bearings, which have none of their own.

    By translation ``z`` of the centre of mass and tilt ``θ``, found from the displacements ``z + l_j θ`` at the sensors, it asks for a force ``F = C_z(s) z`` and
    a moment ``M = C_θ(s) θ``, which the magnets share so that both are met, ``Σ f_j = F`` and ``Σ l_j f_j = M``; with more than two by least squares, in displacements and
    in forces.  Or matrices make all currents, A, from all displacements at the sensors, m.

    Parameters
    ----------
    bearings : sequence of int, optional
        Numbers of the magnetic bearings, from 1; by default all.
    translation, tilt : ForcePID, MomentPID, or other controllers
        ``C_z``, N/m, and ``C_θ``, N m/rad.
    matrices : StateSpace
        In place of both.
    at_regain : {"reset", "hold", "running"}
        As of a :class:`MagneticBearing`.

    Raises
    ------
    InputError
        It is neither both of the first nor matrices.
    """

    bearings: Sequence[int] = ()
    translation: Controller | None = None
    tilt: Controller | None = None
    matrices: StateSpace | None = None
    at_regain: str = "reset"

    def __post_init__(self) -> None:
        object.__setattr__(self, "bearings", tuple(self.bearings))
        for name in self.parts:
            object.__setattr__(self, name, controller_of(getattr(self, name)))
        if self.parts not in (("translation", "tilt"), ("matrices",)):
            raise InputError(
                "shared_controller", ", ".join(self.parts) or None, "translation and tilt, or A, B, C and D"
            )
        for name, kind in (("translation", ForcePID), ("tilt", MomentPID)):
            own = getattr(self, name)
            gains = own.controller if isinstance(own, Series) else own
            if isinstance(gains, PID) and not isinstance(gains, kind):
                raise InputError(name, type(gains).__name__, f"carom.rotors.{kind.__name__}")
        if self.at_regain not in AT_REGAIN[:2]:
            raise InputError("at_regain", shown(self.at_regain), "one of reset, hold")

    @property
    def parts(self) -> tuple[str, ...]:
        """Which of its controllers are stated."""
        return tuple(name for name in ("translation", "tilt", "matrices") if getattr(self, name) is not None)

    def numbers(self, machine_bearings: Sequence[MagneticBearing]) -> tuple[int, ...]:
        """Which bearings of a machine it has, from 0 on."""
        count = len(machine_bearings)
        listed = self.bearings or tuple(range(1, count + 1))
        if len(set(listed)) < max(2, len(listed)) or not set(listed) <= set(range(1, count + 1)):
            raise InputError(
                "shared_controller: bearings",
                shown(list(listed)),
                f"two or more numbers of magnetic bearings, 1 to {count}",
            )
        return tuple(number - 1 for number in listed)

    def system(self, rotor: FreeRotor, bearings: Sequence[MagneticBearing]) -> StateSpace:
        """Currents, A, of its bearings by displacements, m, at their sensors: sensors, controller, delays and amplifiers, one after the other."""
        if self.matrices is not None:
            law = [state_space_of(self.matrices)]
            if law[0].D.shape != (len(bearings), len(bearings)):
                raise InputError(
                    "controller D",
                    f"of shape {law[0].D.shape}",
                    f"{len(bearings)} outputs and inputs, one for each bearing",
                )
        else:
            sensors = [float(np.mean([_place(rotor, node) for node in each.sensor_nodes])) for each in bearings]
            magnets = [_place(rotor, each.node) for each in bearings]
            seen, pulled = (np.stack([np.ones(len(at)), at], axis=1) for at in (sensors, magnets))
            split = np.linalg.pinv(pulled.T) / np.array([[each.ki] for each in bearings])
            both = side_by_side([state_space_of(self.translation), state_space_of(self.tilt)])
            law = [StateSpace.constant(np.linalg.pinv(seen)), both, StateSpace.constant(split)]
        before, *after = (side_by_side(each) for each in zip(*(each.stages for each in bearings), strict=True))
        return in_series([before, *law, *after]).balanced()


def _place(rotor: FreeRotor, node: int) -> float:
    """Place of a node along the shaft, m from the centre of mass."""
    return float(rotor.node_places[node]) - rotor.centre


class ControlLoop(NamedTuple):
    """A controller with what it measures and moves."""

    bearings: tuple[int, ...]
    """Numbers of the bearings from 0 on, of whose sensors it takes displacements, and whose currents it makes."""
    system: StateSpace
    at_regain: str
    across: StateSpace | None = None
    """What it makes of the conjugates of displacements, where its axes differ."""


def loops_in(
    rotor: FreeRotor, bearings: Sequence[MagneticBearing], shared: Sequence[SharedController]
) -> tuple[ControlLoop, ...]:
    """The loops of a machine: of each bearing with a controller of its own, then of each shared one."""
    own = [
        ControlLoop((number,), each.parts[0], each.at_regain, each.parts[1])
        for number, each in enumerate(bearings)
        if each.controller is not None
    ]
    found = [(each, each.numbers(bearings)) for each in shared]
    driven = [number for loop in own for number in loop.bearings] + [
        number for _, numbers in found for number in numbers
    ]
    for number in range(len(bearings)):
        if driven.count(number) != 1:
            allowed = "one controller: its own (proportional; numerator and denominator; zeros, poles and gain; sos; or A, B, C and D), or that of a [[shared_controller]]"
            raise InputError(
                f"[[magnetic_bearing]] {number + 1}: controller", "several" if driven.count(number) else None, allowed
            )
    return (
        *own,
        *(
            ControlLoop(numbers, each.system(rotor, [bearings[number] for number in numbers]), each.at_regain)
            for each, numbers in found
        ),
    )
