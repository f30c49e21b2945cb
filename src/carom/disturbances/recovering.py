"""Levitation that is regained after a drop, with what the controller does then, as stages of the rotor.

A set point ``z₀`` moves all of the levitation: what it did at a displacement ``z`` it does at ``z − z₀``.  With the stiffness ``K`` of the levitated rotor,
``K₀`` of what is left without levitation, and a translation ``t``, that is the force ``(K − K₀) t z₀`` on coordinates with mass, and ``K t z₀`` on the states
of controllers, which see displacements alone; where bearings are anisotropic, so does what acts on conjugates.  It is constant in the fixed frame.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterator

import numpy as np

from carom.base.outcome import InputError, shown
from carom.core.wall import Wall
from carom.models import Force, LinearEquations, Rotor, Stage, Trigger
from carom.models.mode_arrays import STEADY
from carom.parameters import RecoveryAction, Scales, own_time


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
    yield Stage(falling, _trigger(falling, recovery, scales), carry)
    if recovery.lasts is not None:
        lasts = own_time("lasts", recovery.lasts / scales.time, scales)
        yield Stage(_acting(rotor, falling, recovery, scales), Trigger(time=lasts))
    yield Stage(rotor)


def _trigger(falling: Rotor, recovery: RecoveryAction, scales: Scales) -> Trigger:
    """When levitation is regained."""
    if recovery.regain_after is not None:
        return Trigger(time=own_time("regain_after", recovery.regain_after / scales.time, scales))
    if recovery.regain_quiet is not None:
        slow = 0.0 if recovery.quiet_speed is None else recovery.quiet_speed / scales.velocity
        return Trigger(quiet_time=recovery.regain_quiet / scales.time, quiet_speed=slow)
    speed = float(recovery.regain_speed or 0.0)
    if falling.system.shaft is None:
        allowed = (
            "a shaft that friction slows down: a table [drive] beside [machine] with a compliant touchdown bearing"
        )
        raise InputError("regain_speed", speed, allowed)
    if speed >= scales.speed:
        raise InputError("regain_speed", speed, f"below the speed of the shaft, {scales.speed:g} rad/s")
    return Trigger(shaft_speed=speed / scales.speed)


def _acting(rotor: Rotor, falling: Rotor, recovery: RecoveryAction, scales: Scales) -> Rotor:
    """The levitated rotor while the action lasts."""
    helped, forces = _with_gains(rotor, recovery), []
    if recovery.set_point:
        at = cmath.rect(recovery.set_point / scales.length, recovery.set_point_angle)
        forces.append(Force(STEADY, _held_at(helped, falling, at)))
    if pushed := recovery.force or recovery.current:
        ahead = cmath.rect(pushed, rotor.unbalance_phase + recovery.phase)
        forces.append(Force(0.0, _pushed(rotor, recovery, ahead, scales)))
    if forces and rotor.limits:
        raise InputError(
            "recovery",
            recovery.name,
            "other gains alone: limits of magnetic bearings do not see forces, currents and set points",
        )
    if recovery.current and falling.system.shaft is not None:
        raise InputError("current", recovery.current, "a shaft at constant speed: it turns with the nominal speed")
    return helped.under(*forces) if forces else helped


def _with_gains(rotor: Rotor, recovery: RecoveryAction) -> Rotor:
    """The levitated rotor with other gains; what is no part of its levitation is refused."""
    factors = {name: rotor.value(name) * factor for name, factor in recovery.gain_factors.items()}
    if not (changes := {**recovery.gains, **factors}):
        return rotor
    helped = rotor.replace(**changes)
    before, after = rotor.system.arrays, helped.system.arrays
    bodies = [(each.equations.mass, each.equations.forcing, each.equations.planes) for each in (rotor, helped)]
    pairs = [*zip(*bodies, strict=True), *((before[name], after[name]) for name in Wall._fields)]
    if rotor.scales != helped.scales or not all(np.array_equal(*pair) for pair in pairs):
        raise InputError(
            "gains", shown(", ".join(changes)), "parameters of the levitation alone, such as damping or proportional"
        )
    return helped


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
