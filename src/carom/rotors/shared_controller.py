"""Controllers of several magnetic bearings at once: of translation and tilt about the centre of mass, or of all sensors and magnets by matrices."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from typing import ClassVar, NamedTuple

import numpy as np

from carom.base.outcome import InputError, shown
from carom.parameters import Field
from carom.rotors.controllers import PID, Controller, Series, controller_of, gains_in, state_space_of
from carom.rotors.free_rotor import FreeRotor
from carom.rotors.magnetic_bearing import AT_REGAIN, MagneticBearing
from carom.rotors.state_spaces import SINGULAR, ComplexSystem, StateSpace, in_series, side_by_side


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
    in forces.  Or matrices make all currents, A, from all displacements at the sensors, m: of one axis, taken for both, or of both axes, ``x_1, y_1, x_2, y_2, …`` along the
    axes of each bearing, so that one may act on the other.

    Parameters
    ----------
    bearings : sequence of int, optional
        Numbers of the magnetic bearings, from 1; by default all.
    translation, tilt : ForcePID, MomentPID, or other controllers
        ``C_z``, N/m, and ``C_θ``, N m/rad.
    matrices : StateSpace, or a system of SciPy or python-control
        In place of both; those of both axes may be of a single bearing.
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
        if self.at_regain not in AT_REGAIN:
            raise InputError("at_regain", shown(self.at_regain), f"one of {', '.join(AT_REGAIN)}")

    @property
    def parts(self) -> tuple[str, ...]:
        """Which of its controllers are stated."""
        return tuple(name for name in ("translation", "tilt", "matrices") if getattr(self, name) is not None)

    def numbers(self, machine_bearings: Sequence[MagneticBearing]) -> tuple[int, ...]:
        """Which bearings of a machine it has, from 0 on."""
        count = len(machine_bearings)
        listed = self.bearings or tuple(range(1, count + 1))
        least = 2 if self.matrices is None else 1
        if len(set(listed)) < max(least, len(listed)) or not set(listed) <= set(range(1, count + 1)):
            raise InputError(
                "shared_controller: bearings",
                shown(list(listed)),
                f"{'two' if least > 1 else 'one'} or more numbers of magnetic bearings, 1 to {count}",
            )
        return tuple(number - 1 for number in listed)

    def system(self, rotor: FreeRotor, bearings: Sequence[MagneticBearing]) -> StateSpace:
        """Currents, A, of its bearings by displacements, m, at their sensors: sensors, controller, delays and amplifiers, one after the other.

        Of one axis where both are alike, otherwise of both in turn, along the axes of each bearing.
        """
        count, both = len(bearings), any(each.y is not None for each in bearings)
        if self.matrices is not None:
            law = [state_space_of(self.matrices)]
            shape = law[0].D.shape
            if shape == (2 * count, 2 * count):
                return _chain(bearings, [law[0].in_pairs()], both=True)
            if shape != (count, count):
                allowed = f"{count} outputs and inputs, one for each bearing, or {2 * count}, one for each axis"
                raise InputError("controller D", f"of shape {shape}", allowed)
        else:
            sensors = [float(np.mean([_place(rotor, node) for node in each.sensor_nodes])) for each in bearings]
            magnets = [_place(rotor, each.node) for each in bearings]
            seen, pulled = (np.stack([np.ones(len(at)), at], axis=1) for at in (sensors, magnets))
            split = np.linalg.pinv(pulled.T) / np.array([[each.ki] for each in bearings])
            inner = side_by_side([state_space_of(self.translation), state_space_of(self.tilt)])
            law = [StateSpace.constant(np.linalg.pinv(seen)), inner, StateSpace.constant(split)]
        if not both:
            return _chain(bearings, law, both)
        turn = side_by_side([StateSpace.constant(_turn(each.axis_angle)) for each in bearings])
        back = StateSpace.constant(turn.D.T)
        return _chain(bearings, [turn, *(each.beside(each) for each in law), back], both)


def _chain(bearings: Sequence[MagneticBearing], law: Sequence[StateSpace], both: bool) -> StateSpace:
    """A controller behind the sensors of its bearings and before what makes their currents."""
    stages = [[axis.stages for axis in each.axes] if both else [each.stages] for each in bearings]
    # Of each bearing one stage after the other, of both axes in turn.
    each_of = [[reduce(StateSpace.beside, parts) for parts in zip(*axes, strict=True)] for axes in stages]
    before, *after = (side_by_side(each) for each in zip(*each_of, strict=True))
    return in_series([before, *law, *after]).balanced(1 + both)


def _turn(angle: float) -> np.ndarray:
    """Components in the fixed frame of what has these along axes at an angle."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def _place(rotor: FreeRotor, node: int) -> float:
    """Place of a node along the shaft, m from the centre of mass."""
    return float(rotor.node_places[node]) - rotor.centre


class ControlLoop(NamedTuple):
    """A controller with what it measures and moves."""

    bearings: tuple[int, ...]
    """Numbers of the bearings from 0 on, of whose sensors it takes displacements, and whose currents it makes."""
    system: StateSpace | ComplexSystem
    at_regain: str
    across: ComplexSystem | None = None
    """What it makes of the conjugates of displacements, where its axes differ."""

    @property
    def sides(self) -> tuple[StateSpace | ComplexSystem, ...]:
        """What it makes of displacements, and of their conjugates where its axes differ."""
        return (self.system,) if self.across is None else (self.system, self.across)

    @property
    def both(self) -> ComplexSystem:
        """The system of displacements and their conjugates."""
        none = [np.zeros(getattr(self.system, name).shape) for name in ComplexSystem._fields]
        own = [getattr(self.system, name) for name in ComplexSystem._fields]
        pairs = zip(own, self.across or none, strict=True)
        return ComplexSystem(*(np.block([[one, other], [np.conj(other), np.conj(one)]]) for one, other in pairs))

    @property
    def integrators(self) -> int:
        """Number of integrators of both axes together."""
        sizes = np.linalg.svd(self.both.A, compute_uv=False)
        return int((sizes * SINGULAR <= sizes.max(initial=0.0)).sum())

    @property
    def integrates(self) -> bool:
        """Whether each steady displacement at its sensors makes its currents grow without end."""
        return self.integrators >= 2 * len(self.bearings)


def _loop(
    bearings: Sequence[MagneticBearing], numbers: tuple[int, ...], system: StateSpace, at_regain: str
) -> ControlLoop:
    """A loop in the fixed frame, of a system of one axis or of both in turn."""
    loop = ControlLoop(numbers, system, at_regain)
    if len(system.D) > len(numbers):
        alike, across = system.complex_parts()
        differ = any(each.any() for each in across)
        angles = np.array([bearings[number].axis_angle for number in numbers])
        turns = np.exp(1j * (angles if differ else angles - angles[0]))[:, None]

        def turned(part: ComplexSystem, back: np.ndarray) -> ComplexSystem:
            A, B, C, D, rate = part
            found = (A, B * back, turns * C, turns * D * back, turns * rate * back)
            return ComplexSystem(*(each if each.imag.any() else each.real for each in found))

        own = turned(alike, turns.conj().T)
        loop = ControlLoop(numbers, own, at_regain, turned(across, turns.T) if differ else None)
    if at_regain == "running" and loop.integrators:
        allowed = "reset or hold for a controller that integrates: running, it would add up the place of a rotor that falls, which is not followed"
        raise InputError("at_regain", at_regain, allowed)
    return loop


def loops_in(
    rotor: FreeRotor, bearings: Sequence[MagneticBearing], shared: Sequence[SharedController]
) -> tuple[ControlLoop, ...]:
    """The loops of a machine: of each bearing with a controller of its own, then of each shared one."""
    own = {number: each for number, each in enumerate(bearings) if each.controller is not None}
    found = [(each, each.numbers(bearings)) for each in shared]
    driven = [*own, *(number for _, numbers in found for number in numbers)]
    for number in range(len(bearings)):
        if driven.count(number) != 1:
            allowed = "one controller: its own (proportional; numerator and denominator; zeros, poles and gain; sos; or A, B, C and D), or that of a [[shared_controller]]"
            raise InputError(
                f"[[magnetic_bearing]] {number + 1}: controller", "several" if driven.count(number) else None, allowed
            )
    systems: list[tuple[tuple[int, ...], StateSpace, str]] = [
        ((number,), each.loop if each.y is None else each.loop.beside(each.y.loop), each.at_regain)
        for number, each in own.items()
    ]
    systems += [
        (numbers, each.system(rotor, [bearings[number] for number in numbers]), each.at_regain)
        for each, numbers in found
    ]
    return tuple(_loop(bearings, *each) for each in systems)
