"""Levitation that is regained after a drop, with what the controller does then, as stages of the rotor.

A set point ``z₀`` moves all of the levitation: what it did at a displacement ``z`` it does at ``z − z₀``.  With the stiffness ``K`` of the levitated rotor,
``K₀`` of what is left without levitation, and a translation ``t``, that is the force ``(K − K₀) t z₀`` on coordinates with mass, and ``K t z₀`` on the states
of controllers, which see displacements alone; where bearings are anisotropic, so does what acts on conjugates.  It is constant in the fixed frame.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from carom.base.outcome import InputError, shown
from carom.core.wall import Wall
from carom.models import Force, LinearEquations, Rotor, Stage, Trigger
from carom.models.mode_arrays import STEADY
from carom.models.turning import Shaft
from carom.motions.descent import turning_at
from carom.motions.standstill import shaft_and_changes
from carom.parameters import RecoveryAction, Scales, own_time

UP = 0.5 * math.pi
"""Where a set point is by default: up the y axis, as an angle from the x axis."""
STEPS = 20
"""In which the speed of a shaft changes."""
HELD = 1e9
"""Inertia, in ``m c_r²``, of a shaft that is held at its speed: contact changes it by less than 1e-7, and of the energy of the rotor seven digits are left beside its own."""


def recovery_stages(
    rotor: Rotor, falling: Rotor, recovery: RecoveryAction, carry: np.ndarray | None
) -> Iterator[Stage]:
    """The fall until levitation is regained, the action while it lasts, and the rotor as it is.

    Parameters
    ----------
    carry : ndarray, shape (2n, 2n), optional
        What controllers do at the regain, as :class:`~carom.models.Stage` takes it.

    Raises
    ------
    InputError
        The rotor has no scales, or not what the recovery needs: a shaft that slows down, a parameter, magnetic bearings.
    """
    scales = rotor.scales
    if scales is None:
        raise InputError(
            "recovery", recovery.name, "a rotor with mass, clearance and speed: its entries are in SI units"
        )
    turning = _Turning.of(rotor, falling, recovery, scales)
    if recovery.regain_speed is None:
        yield Stage(falling, _trigger(recovery, scales), carry)
    else:
        for middle, edge in turning.steps_down_to(recovery.regain_speed / scales.speed):
            last = edge == turning.speed
            yield Stage(turning.at(falling, middle), Trigger(shaft_speed=edge), carry if last else None)
    if recovery.lasts is not None:
        lasts, helped = own_time("lasts", recovery.lasts / scales.time, scales), _with_gains(rotor, recovery)

        def acting(speed: float) -> Rotor:
            return _acting(turning.at(helped, speed), turning.at(falling, speed), recovery, scales)

        if recovery.slow_to is None:
            yield Stage(acting(turning.speed), Trigger(time=lasts))
        else:
            steps = turning.steps_down_to(recovery.slow_to / scales.speed, by_drive=True)
            for middle, _ in steps:
                yield Stage(acting(middle), Trigger(time=lasts / len(steps)), slowed_to=middle)
    yield Stage(turning.at(rotor, turning.speed), slowed_to=turning.speed if recovery.slow_to else math.inf)


@dataclass
class _Turning:
    """A shaft that is slowed down from the nominal speed, in ``Ω``, in steps of equal size; in each its matrices are those of the middle."""

    shaft: Shaft | None
    changes: Callable[[float], np.ndarray] | None = None
    speed: float = 1.0

    @classmethod
    def of(cls, rotor: Rotor, falling: Rotor, recovery: RecoveryAction, scales: Scales) -> _Turning:
        """The shaft of a rotor, if the recovery has to do with its speed; one whose inertia is not known is held at its speed by the drive."""
        if recovery.regain_speed is None and recovery.slow_to is None:
            return cls(None)
        for name, fastest in (("regain_speed", scales.speed), ("slow_to", recovery.regain_speed or scales.speed)):
            given = getattr(recovery, name)
            if given is not None and given >= fastest:
                raise InputError(name, given, f"below the speed before, {fastest:g} rad/s")
        if rotor.is_anisotropic:
            raise InputError(
                "supports", "anisotropic", "alike in both directions, where the speed of the shaft changes"
            )
        try:
            found = cls(*shaft_and_changes(rotor, falling, None))
        except InputError:
            if recovery.regain_speed is not None:
                raise
            found = cls(Shaft(HELD))
        if rotor.limits and (rotor.equations.shaft is None or found.changes):
            allowed = "without regain_speed and slow_to where magnetic bearings have limits (leave out current_limit, force_limit, slew_rate_limit)"
            raise InputError("recovery", recovery.name, allowed)
        return found

    def steps_down_to(self, speed: float, by_drive: bool = False) -> list[tuple[float, float]]:
        """Middle and end of each step down to a speed, which the shaft then has; friction needs one alone where nothing changes with the speed."""
        edges = np.linspace(self.speed, speed, 1 + (STEPS if by_drive or self.changes else 1))
        self.speed = speed
        return list(zip((0.5 * (edges[:-1] + edges[1:])).tolist(), [*edges[1:-1].tolist(), speed], strict=True))

    def at(self, rotor: Rotor, speed: float) -> Rotor:
        """The rotor at about a speed."""
        own = rotor.equations.shaft
        if self.shaft is None or (own is not None and self.changes is None):
            return rotor
        return turning_at(rotor, speed, self.shaft, self.changes)


def _trigger(recovery: RecoveryAction, scales: Scales) -> Trigger:
    """When levitation is regained, at whatever speed."""
    if recovery.regain_after is not None:
        return Trigger(time=own_time("regain_after", recovery.regain_after / scales.time, scales))
    if recovery.regain_quiet is not None and recovery.quiet_speed is not None:
        return Trigger(
            quiet_time=recovery.regain_quiet / scales.time, quiet_speed=recovery.quiet_speed / scales.velocity
        )
    return Trigger()


def _acting(rotor: Rotor, falling: Rotor, recovery: RecoveryAction, scales: Scales) -> Rotor:
    """The levitated rotor while the action lasts, from that with its gains."""
    forces = []
    if recovery.set_point:
        angle = UP if recovery.set_point_angle is None else recovery.set_point_angle
        at = cmath.rect(recovery.set_point / scales.length, angle)
        forces.append(Force(STEADY, _held_at(rotor, falling, at)))
    if pushed := recovery.force or recovery.current:
        ahead = cmath.rect(pushed, rotor.unbalance_phase + (recovery.phase or 0.0))
        forces.append(Force(0.0, _pushed(rotor, recovery, ahead, scales)))
    if forces and rotor.limits:
        raise InputError(
            "recovery",
            recovery.name,
            "other gains alone: limits of magnetic bearings do not see forces, currents and set points",
        )
    if pushed and rotor.system.shaft is not None:
        allowed = "left out where the speed of the shaft changes: it turns with the nominal speed"
        raise InputError("current" if recovery.current else "force", pushed, allowed)
    return rotor.under(*forces) if forces else rotor


def _with_gains(rotor: Rotor, recovery: RecoveryAction) -> Rotor:
    """The levitated rotor with other gains; what is no part of its levitation is refused."""
    if not recovery.gains:
        return rotor
    helped = rotor.replace(**recovery.gains)
    kept = all(map(np.array_equal, _besides_levitation(rotor), _besides_levitation(helped)))
    if rotor.scales != helped.scales or not kept:
        allowed = "parameters of the levitation alone, such as damping or proportional"
        raise InputError("gains", shown(", ".join(recovery.gains)), allowed)
    return helped


def _besides_levitation(rotor: Rotor) -> list[np.ndarray]:
    """Arrays of a rotor and its touchdown bearings that gains do not change."""
    body, walls = rotor.equations, rotor.system.arrays
    return [body.mass, body.forcing, body.planes, *(walls[name] for name in Wall._fields)]


def _held_at(rotor: Rotor, falling: Rotor, at: complex) -> np.ndarray:
    """Accelerations (n,), and rates of coordinates without mass, by which the levitation holds the rotor there instead of in the centre."""
    given = rotor.equations
    moved = at * np.asarray(given.translation)
    push, remains = (_answer(each.equations, moved) for each in (rotor, falling))
    push[given.has_mass] -= remains[given.has_mass]
    return given.rates_by(push)


def _answer(given: LinearEquations, moved: np.ndarray) -> np.ndarray:
    """What a displacement that stays asks of all equations, in the fixed frame."""
    found = given.matrices.stiffness @ moved
    return found if given.conjugate is None else found + given.conjugate[1] @ moved.conj()


def _pushed(rotor: Rotor, recovery: RecoveryAction, ahead: complex, scales: Scales) -> np.ndarray:
    """Accelerations (n,) by the synchronous force or current, N or A."""
    if recovery.current:
        return rotor.definition.pushed_by_currents(ahead)
    return ahead / scales.force * np.asarray(rotor.equations.translation)
