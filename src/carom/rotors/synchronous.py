"""Contact-free whirl by unbalance of any linear rotor at any speed of its shaft, from its matrices.

Matrices, unbalance and weight stay the same in SI units.  In the fixed frame

    M z̈ + (D − iΩG) ż + K z + D′ z̄˙ + K′ z̄ = Ω² f e^{iΩt} + g

is solved by ``z = z₀ + a e^{iΩt} + b e^{−iΩt}``: a sag, and ellipses of which ``a`` goes forward, with the shaft, and ``b`` backward, against it.  Bearings alike in
both directions, ``D′ = K′ = 0``, have circles, ``b = 0``.  Of a flexible machine all modes are taken.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, NamedTuple

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.base.results import Result
from carom.models import Limit, Rotor, Subject, rotor_of
from carom.parameters import Zones
from carom.parameters.tables import BIAS
from carom.rotors import FlexibleMachine
from carom.rotors.bearing_limits import asked_by_currents
from carom.rotors.equations import Loops, RotorEquations, SpeedLaw
from carom.rotors.support import turning
from carom.rotors.whirls import speeds_of


class Ellipses(NamedTuple):
    """Ellipses ``forward e^{iΩt} + backward e^{−iΩt}``; both are complex and of one shape, with the angles at time zero."""

    forward: np.ndarray
    backward: np.ndarray

    @property
    def major(self) -> np.ndarray:
        """Longer half axes: amplitudes, 0-to-peak."""
        return np.asarray(np.abs(self.forward) + np.abs(self.backward))

    @property
    def minor(self) -> np.ndarray:
        """Shorter half axes; below zero where they go round against the shaft."""
        return np.asarray(np.abs(self.forward) - np.abs(self.backward))

    @property
    def direction(self) -> np.ndarray:
        """Angles of the longer half axes in the fixed frame, rad."""
        return np.asarray(0.5 * (np.angle(self.forward) + np.angle(self.backward)))


@dataclass(frozen=True, eq=False, repr=False)
class SynchronousResponse(Result):
    """Contact-free whirl by unbalance at several speeds, and the sag about which it goes.

    Attributes
    ----------
    speeds : ndarray, shape (m,)
        rad/s.
    touchdowns : Ellipses
        At the touchdown bearings, relative to their mounts, m, shape (m, P).
    sags : ndarray, shape (P,)
        Distance there of the middle of the ellipses from the centre, m.
    clearances : ndarray, shape (P,)
        Radial clearances, m.
    sensors : Ellipses
        What the sensors of each magnetic bearing of a flexible machine measure, m, shape (m, B).
    currents : Ellipses
        Currents of these, A, before a limit of the amplifier, shape (m, B).
    saturation : ndarray, shape (m, L)
        What sag and whirl ask of each limit of the magnetic bearings along the worse of its axes, as a share of it: beyond 1 it saturates, and the rotor does not
        whirl so.
    unbalance_angle : float
        Angle of the unbalance at time zero, rad, from which phases count: that of its force on the rotor as a whole.
    """

    speeds: np.ndarray
    touchdowns: Ellipses
    sags: np.ndarray
    clearances: np.ndarray
    sensors: Ellipses
    currents: Ellipses
    saturation: np.ndarray
    unbalance_angle: float

    shown: ClassVar = ("speeds", "reach", "zones")

    @property
    def reach(self) -> np.ndarray:
        """Largest distance from the centre at each touchdown bearing, in its clearance, shape (m, P): from 1 on it touches.  A bound where an ellipse sags."""
        return np.asarray((self.touchdowns.major + self.sags) / self.clearances)

    @property
    def lags(self) -> np.ndarray:
        """Angle by which the forward part at each touchdown bearing lags the unbalance, rad, −π to π, shape (m, P)."""
        return np.asarray(np.pi - (np.pi - self.unbalance_angle + np.angle(self.touchdowns.forward)) % (2.0 * np.pi))

    @property
    def zones(self) -> tuple[str, ...]:
        """Zone of ISO 14839-2 of each speed, by the largest displacement: the worst of all touchdown bearings."""
        return tuple(Zones().zone(float(each)) for each in self.reach.max(axis=1))


class Whole(NamedTuple):
    """A rotor in units of its own, in which speeds are divided by ``speed`` and displacements multiplied by ``length``."""

    equations: RotorEquations
    speed: float
    length: np.ndarray
    """m, per touchdown bearing."""
    sags: np.ndarray
    """In ``length``."""
    clearances: np.ndarray
    limits: Sequence[Limit]
    limit_unit: float
    """Coordinates per unit of the coordinates of the limits."""
    resting: np.ndarray
    """Coordinates (n,) of the sag."""
    asked: np.ndarray
    """What bias currents that carry a weight ask of each limit, constant in the fixed frame, shape (L,)."""


@checked
def synchronous_response(machine: Subject | FlexibleMachine, speeds: Sequence[float]) -> SynchronousResponse:
    """Contact-free whirl by unbalance at speeds in rad/s.

    The law of contact does not matter.  Stability of the levitation is not judged.

    Parameters
    ----------
    machine : Machine, Case, Parameters, model or FlexibleMachine
        With mass, clearance and speed.
    speeds : sequence of float
        rad/s, above 0.

    Raises
    ------
    InputError
        A rotor without scales, no speed, or one that is not above 0.

    See Also
    --------
    carom.studies.unbalance_response : with critical speeds, limits of standards and contact

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/dropped-rotor.toml")
    >>> found = cm.rotors.synchronous_response(machine, [machine.parameters.scales.speed])
    >>> print(f"{found.reach[0, 0]:.4f}")
    0.4012
    """
    listed = speeds_of(speeds)
    whole = _of_flexible(machine) if isinstance(machine, FlexibleMachine) else whole_of(rotor_of(machine))
    answers = Ellipses(*_answers(whole.equations, listed / whole.speed))

    def seen(rows: np.ndarray, by_rates: np.ndarray | float = 0.0) -> Ellipses:
        turns = 1j * listed[:, None, None]
        both = zip(answers, (rows + turns * by_rates, rows - turns * by_rates), strict=True)
        return Ellipses(*(np.einsum("mn,mkn->mk", part[:, : rows.shape[1]], each) for part, each in both))

    touchdowns = Ellipses(*(part * whole.length for part in seen(whole.equations.rows.touchdowns)))
    return SynchronousResponse(
        listed,
        touchdowns,
        whole.sags * whole.length,
        whole.clearances,
        seen(whole.equations.rows.sensors),
        _with_conjugates(
            whole.equations, seen(whole.equations.currents, whole.equations.current_rates), answers, listed
        ),
        _saturation(whole, answers, listed / whole.speed),
        float(np.angle(np.vdot(whole.equations.carried, whole.equations.forcing))),
    )


def _with_conjugates(equations: RotorEquations, alike: Ellipses, answers: Ellipses, speeds: np.ndarray) -> Ellipses:
    """Currents (m, B) with what bearings whose axes differ make of conjugates: what goes ahead of them comes from what goes behind."""
    by_place, by_rate = equations.currents_across
    if not equations.currents_across.any():
        return alike
    turns = 1j * speeds[:, None]
    more = [
        part.conj() @ by_place.T + sign * turns * (part.conj() @ by_rate.T)
        for sign, part in ((1.0, answers.backward), (-1.0, answers.forward))
    ]
    return Ellipses(alike.forward + more[0], alike.backward + more[1])


def whole_of(model: Rotor) -> Whole:
    """Equations of any rotor, of which a flexible one has all its modes."""
    reduced, scales = model.finite_elements, model.scales
    if reduced is not None:
        return _of_flexible(reduced.machine)
    if scales is None:
        allowed = "needed for a response over speed: use a file with a [machine] table, or parameters with scales"
        raise InputError("scales", None, allowed)
    system, conjugate, rotating = model.system, model.equations.conjugate, model.definition.rotating
    n, widths = len(system.rest), system.widths
    mass, damping, gyroscopic, stiffness, forcing = model.matrices
    none = np.zeros((0, n))
    return Whole(
        RotorEquations(
            mass,
            damping,
            gyroscopic,
            stiffness,
            forcing,
            unlevitated=np.zeros((2, n, n)),
            rows=Loops(none, none, system.planes, none, none),
            currents=none,
            current_rates=none,
            amplifiers=np.zeros(0, int),
            regained=np.ones(n),
            carried=mass @ system.translated,
            across=np.zeros((2, n, n)) if conjugate is None else conjugate,
            across_unlevitated=np.zeros((2, n, n)),
            currents_across=np.zeros((2, 0, n)),
            is_anisotropic=conjugate is not None,
            speed=1.0,
            held=() if rotating is None else (SpeedLaw(rotating, turning),),
        ),
        scales.speed,
        scales.length * widths,
        np.abs(system.arrays["rows"] @ system.outer),
        scales.length * widths,
        model.listed_limits,
        1.0,
        system.shapes @ system.outer,
        model.acting.asked_by_bias,
    )


def _of_flexible(machine: FlexibleMachine) -> Whole:
    whole = machine.whole
    held, gravity, scales = whole.equations, machine.gravity, whole.scales
    first, resting = np.eye(len(held.mass))[0], np.zeros(len(held.mass), complex)
    asked = np.zeros(len(whole.limits), complex)
    if gravity is not None and gravity.acceleration:
        # The translation of the whole rotor is the first vector; mounts have no weight.
        pull = gravity.pull(scales) * scales.acceleration * np.sqrt(scales.mass) * first
        if gravity.carried_by == BIAS:
            pushed, currents = whole.held_by_bias(pull)
            pull, asked = pull + pushed, asked_by_currents(held, machine.bearings, currents)
        both = held.both if held.is_anisotropic else held
        resting = np.linalg.solve(both.stiffness, np.append(pull, pull.conj())[: len(both.mass)])[: len(first)]
    return Whole(
        held,
        1.0,
        np.ones(len(machine.touchdowns)),
        np.abs(held.rows.touchdowns @ resting),
        np.array(machine.clearances),
        tuple(replace(each, velocity=each.velocity / scales.speed) for each in whole.limits),
        scales.length * np.sqrt(scales.mass),
        resting,
        asked,
    )


def _answers(equations: RotorEquations, speeds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates (m, n) of what goes with the shaft and of what goes against it, at time zero."""
    answers = np.array([_answer(equations, speed) for speed in speeds.tolist()])
    if not equations.is_anisotropic:
        return answers, np.zeros_like(answers)
    forward, backward = np.split(answers, 2, axis=1)
    return forward, backward.conj()


def _answer(equations: RotorEquations, speed: float) -> np.ndarray:
    try:
        return equations.response(speed)
    except np.linalg.LinAlgError:  # in undamped resonance to the last digit: as near to it as doubles come
        return equations.response(float(np.nextafter(speed, np.inf)))


def _saturation(whole: Whole, answers: Ellipses, speeds: np.ndarray) -> np.ndarray:
    """What is asked of each limit along the worse of its axes, as a share of it, shape (m, L)."""
    found = np.zeros((len(speeds), len(whole.limits)))
    for place, limit in enumerate(whole.limits):
        turn = np.exp(-1j * limit.angle) / whole.limit_unit
        ahead, behind = (
            ((limit.displacement + 1j * sense * speeds[:, None] * limit.velocity) * part).sum(axis=1) * turn
            for sense, part in zip((1.0, -1.0), answers, strict=True)
        )
        middle = complex(limit.displacement @ whole.resting) * turn + whole.asked[place] * np.exp(-1j * limit.angle)
        along = np.abs(ahead + behind.conj()) + abs(middle.real), np.abs(ahead - behind.conj()) + abs(middle.imag)
        found[:, place] = (along[0] if limit.one_axis else np.maximum(*along)) / limit.bound
    return found
