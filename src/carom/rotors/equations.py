"""Equations of motion of a flexible rotor on magnetic bearings and supports, in SI units and in the fixed frame, and its free motions."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from carom.rotors.attachments import TouchdownPlane, Unbalance
from carom.rotors.free_rotor import FreeRotor
from carom.rotors.magnetic_bearing import MagneticBearing
from carom.rotors.reduction import Basis
from carom.rotors.shared_controller import ControlLoop, SharedController, loops_in
from carom.rotors.support import Support


class RotorEquations(NamedTuple):
    """``M z̈ + (D − iΩG) ż + K z + D′ z̄˙ + K′ z̄ = Ω² e^{iΩt} f`` of vectors with unit modal mass, mounts, and controller states, which have no mass.

    Displacements are ``basis.shapes`` times the first ``v`` coordinates, which are in m √kg.
    """

    mass: np.ndarray
    damping: np.ndarray
    gyroscopic: np.ndarray
    stiffness: np.ndarray
    forcing: np.ndarray
    """By the square of the speed, shape (n,)."""
    unlevitated: np.ndarray
    """Damping and stiffness without magnetic bearings, shape (2, n, n)."""
    planes: np.ndarray
    """Displacement at each touchdown bearing, relative to its mount, shape (P, n)."""
    currents: np.ndarray
    """Current of each bearing, A, per coordinate, shape (B, n)."""
    current_rates: np.ndarray
    """The same per rate of a coordinate: of ideal derivatives."""
    amplifiers: np.ndarray
    """Coordinate of the state of the amplifier of each bearing, shape (B,); -1 without one."""
    regained: np.ndarray
    """What coordinates are multiplied by when levitation is regained, shape (n,): 0 for states of controllers that are reset."""
    carried: np.ndarray
    """Coordinates, shape (n,), when rotor and mounts are displaced by 1 m."""
    across: np.ndarray
    """``D′`` and ``K′``, shape (2, n, n): of anisotropic supports and magnetic bearings."""
    across_unlevitated: np.ndarray
    """The same of supports alone."""
    currents_across: np.ndarray
    """Current of each bearing, A, per conjugate of a coordinate, then per its rate, shape (2, B, n)."""

    @property
    def is_anisotropic(self) -> bool:
        """Whether a support is anisotropic."""
        return bool(self.across.any())

    @property
    def both(self) -> RotorEquations:
        """Equations of the coordinates and their conjugates ``(z, z̄)``, in which nothing depends on the direction.

        Their response has as its second half the conjugate of what goes round with ``e^{−iΩt}``.
        """
        stored = (block(each, each.conj()) for each in (self.mass, self.damping, self.stiffness))
        mass, damping, stiffness = stored
        damping, stiffness = damping + off(self.across[0]), stiffness + off(self.across[1])
        none = np.zeros_like
        return self._replace(
            mass=mass,
            damping=damping,
            gyroscopic=block(self.gyroscopic, -self.gyroscopic),
            stiffness=stiffness,
            forcing=np.append(self.forcing, none(self.forcing)),
            across=none(np.stack([damping, stiffness])),
        )

    def generator(self, speed: float) -> np.ndarray:
        """Matrix (N, N) of the free motion at a speed, 1/s, of coordinates and of the velocities of those with mass, where nothing depends on the direction."""
        has_mass = np.asarray(self.mass.any(axis=1))
        n, masses = len(has_mass), self.mass[has_mass, has_mass][:, None]
        spin = (self.damping - 1j * speed * self.gyroscopic)[np.ix_(has_mass, has_mass)]
        matrix = np.zeros((n + has_mass.sum(), n + has_mass.sum()), complex)
        matrix[np.flatnonzero(has_mass), n + np.arange(has_mass.sum())] = 1.0
        matrix[np.flatnonzero(~has_mass), :n] = -self.stiffness[~has_mass]
        matrix[n:, :n], matrix[n:, n:] = -self.stiffness[has_mass] / masses, -spin / masses
        return matrix

    def exponents(self, speed: float) -> tuple[np.ndarray, np.ndarray]:
        """Exponents (N,) of the free motion at a speed, 1/s, and the coordinates (n, N) of each, where nothing depends on the direction."""
        values, vectors = np.linalg.eig(self.generator(speed))
        return values, vectors[: len(self.mass)]

    def response(self, speed: float) -> np.ndarray:
        """Coordinates (n,) of the whirl with which the rotor answers its unbalance, at time zero, where nothing depends on the direction."""
        dynamic = self.stiffness - speed**2 * self.mass + 1j * speed * (self.damping - 1j * speed * self.gyroscopic)
        answer: np.ndarray = np.linalg.solve(dynamic, speed**2 * self.forcing)
        return answer


def block(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """The matrix with these on its diagonal."""
    return np.block([[first, np.zeros_like(first)], [np.zeros_like(second), second]])


def off(matrix: np.ndarray) -> np.ndarray:
    """The matrix with this one and its conjugate beside its diagonal."""
    return np.block([[np.zeros_like(matrix), matrix], [matrix.conj(), np.zeros_like(matrix)]])


class Loops(NamedTuple):
    """Rows of coordinates of the rotor."""

    bearings: np.ndarray
    """Shape (B, n)."""
    sensors: np.ndarray
    """Shape (B, n): the mean of the sensors of each."""
    touchdowns: np.ndarray
    """Shape (P, n)."""


def loops_of(rotor: FreeRotor, bearings: Sequence[MagneticBearing], planes: Sequence[TouchdownPlane]) -> Loops:
    """Where forces act and displacements are measured."""
    none = np.empty((0, len(rotor.matrices.mass)))
    return Loops(
        bearings=np.array([rotor.row_at(each.node) for each in bearings] or none),
        sensors=np.array(
            [np.mean([rotor.row_at(node) for node in each.sensor_nodes], axis=0) for each in bearings] or none
        ),
        touchdowns=np.array([rotor.row_at(each.node) for each in planes] or none),
    )


def equations_of(
    rotor: FreeRotor,
    basis: Basis,
    bearings: Sequence[MagneticBearing],
    touchdowns: Sequence[TouchdownPlane],
    unbalances: Sequence[Unbalance],
    supports: Sequence[Support],
    shared: Sequence[SharedController],
    restart: float,
) -> RotorEquations:
    """Equations of a machine in a basis.

    Parameters
    ----------
    restart : float
        Rate, 1/s, with which states of controllers that will be reset fade while levitation is lost.
    """
    loops = loops_of(rotor, bearings, touchdowns)
    mounts = [(plane, mount) for plane, each in enumerate(touchdowns) if (mount := each.bearing.mount)]
    vectors, first = len(basis.frequencies), len(basis.frequencies) + len(mounts)
    controls = loops_in(rotor, bearings, shared)
    size = first + sum(each.system.states for each in controls)
    mass, damping, gyroscopic, stiffness = np.zeros((4, size, size))
    free = slice(0, vectors)
    mass[free, free], stiffness[free, free] = np.eye(vectors), np.diag(basis.frequencies**2)
    damping[free, free] = _damping(rotor, basis)
    gyroscopic[free, free] = _gyroscopic(rotor, basis)
    carried = np.zeros(size)
    carried[free], carried[vectors:first] = rotor.carried(basis.shapes), 1.0
    planes = np.concatenate([loops.touchdowns @ basis.shapes, np.zeros((len(touchdowns), size - vectors))], axis=1)
    for place, (plane, mount) in enumerate(mounts, vectors):
        mass[place, place], damping[place, place], stiffness[place, place] = mount
        planes[plane, place] = -1.0
    held = _supported(rotor, basis, supports, size)
    damping, stiffness = damping + held.alike[0], stiffness + held.alike[1]
    states = slice(first, size)
    damping[states, states] = np.eye(size - first)
    left = np.stack([damping, stiffness])
    regained = np.ones(size)
    currents, current_rates = np.zeros((2, len(bearings), size))
    amplifiers = np.full(len(bearings), -1)
    for loop in controls:
        system, own, listed = loop.system, slice(first, first + loop.system.states), list(loop.bearings)
        seen = loops.sensors[listed] @ basis.shapes
        for place, number in enumerate(listed):
            bearing, pulls = bearings[number], loops.bearings[number] @ basis.shapes
            currents[number, free], currents[number, own] = system.D[place] @ seen, system.C[place]
            current_rates[number, free] = system.rate[place] @ seen
            stiffness[free] += bearing.ki * np.outer(pulls, currents[number])
            damping[free] += bearing.ki * np.outer(pulls, current_rates[number])
            stiffness[free, free] += bearing.magnet[0] * np.outer(pulls, pulls)
        stiffness[own, free], stiffness[own, own] = -(system.B @ seen), -system.A
        if loop.at_regain == "reset":
            # What these states do meanwhile acts on nothing; they fade, so that none is mistaken for a displacement that stays.
            left[1, own, own], regained[own] = restart * np.eye(system.states), 0.0
        elif loop.at_regain == "running":
            left[1, own] = stiffness[own]
        first = own.stop
        with_amplifier = [number for number in listed if bearings[number].amplifier_bandwidth is not None]
        amplifiers[with_amplifier] = range(first - len(with_amplifier), first)
    levitated = _on_conjugates(bearings, loops, basis, controls, size)
    forcing = np.zeros(size, complex)
    for each in unbalances:
        forcing[free] += each.size * np.exp(1j * each.angle) * (rotor.row_at(each.node) @ basis.shapes)
    return RotorEquations(
        mass,
        damping,
        gyroscopic,
        stiffness,
        forcing,
        left,
        planes,
        currents,
        current_rates,
        amplifiers,
        regained,
        carried,
        held.across + levitated.matrices if levitated.matrices.any() else held.across,
        held.across,
        levitated.currents,
    )


class _OnConjugates(NamedTuple):
    """What magnetic bearings make of conjugates, where their axes differ."""

    matrices: np.ndarray
    """Damping and stiffness, shape (2, n, n)."""
    currents: np.ndarray
    """Current by conjugates of coordinates, then of rates, shape (2, B, n)."""


def _on_conjugates(
    bearings: Sequence[MagneticBearing], loops: Loops, basis: Basis, controls: Sequence[ControlLoop], size: int
) -> _OnConjugates:
    free, first = slice(0, len(basis.frequencies)), size - sum(each.system.states for each in controls)
    matrices, currents = np.zeros((2, size, size), complex), np.zeros((2, len(bearings), size), complex)
    for loop in controls:
        own, number = slice(first, first + loop.system.states), loop.bearings[0]
        first = own.stop
        if loop.across is None:
            continue
        bearing, pulls = bearings[number], loops.bearings[number] @ basis.shapes
        seen, across = loops.sensors[[number]] @ basis.shapes, loop.across
        currents[0, number, free], currents[0, number, own] = across.D[0] @ seen, across.C[0]
        currents[1, number, free] = across.rate[0] @ seen
        currents[:, number] *= bearing.turn
        matrices[::-1, free] += bearing.ki * pulls[:, None] * currents[:, number][:, None]
        matrices[1, free, free] += bearing.magnet[1] * np.outer(pulls, pulls)
        matrices[1, own, free] = -bearing.turn * (across.B @ seen)
        matrices[1, own, own] = -bearing.turn * across.A
    return _OnConjugates(matrices, currents)


class _Supported(NamedTuple):
    """Damping and stiffness of all supports, both of shape (2, n, n)."""

    alike: np.ndarray
    """By velocities and displacements; real without cross-coupling."""
    across: np.ndarray
    """By their conjugates."""


def _supported(rotor: FreeRotor, basis: Basis, supports: Sequence[Support], size: int) -> _Supported:
    both = np.zeros((2, 2, size, size), complex)
    for each in supports:
        pull = rotor.row_at(each.node) @ basis.shapes
        square = np.zeros((size, size))
        square[: len(pull), : len(pull)] = np.outer(pull, pull)
        for place, numbers in enumerate((each.damping, each.stiffness)):
            both[:, place] += np.multiply.outer(np.array(numbers), square)
    alike: Any = both[0]
    return _Supported(alike if alike.imag.any() else alike.real, both[1])


def _damping(rotor: FreeRotor, basis: Basis) -> np.ndarray:
    """Damping of the vectors: of each mode its own, which couples it with nothing, unless a matrix of damping is given."""
    matrix = basis.shapes.T @ rotor.damping_matrix @ basis.shapes
    if rotor.damping_rates is not None:
        matrix[: basis.modes], matrix[:, : basis.modes] = 0.0, 0.0
        matrix[range(basis.modes), range(basis.modes)] = rotor.damping_rates[: basis.modes]
    beside = range(basis.modes, len(basis.frequencies))
    matrix[beside, beside] += 2.0 * basis.damping_ratio * basis.frequencies[basis.modes :]
    return 0.5 * (matrix + matrix.T)


def _gyroscopic(rotor: FreeRotor, basis: Basis) -> np.ndarray:
    """Gyroscopic matrix of the vectors: none of a translation, to the last digit."""
    matrix = basis.shapes.T @ rotor.matrices.gyroscopic @ basis.shapes
    matrix[: rotor.translations], matrix[:, : rotor.translations] = 0.0, 0.0
    return 0.5 * (matrix + matrix.T)


STRAIGHT = 1e-9
"""Sense up to which a whirl counts as going to and fro along lines."""
ROUNDING = 1e-13
"""Growth over the size of the largest exponent that is rounding: of rotors without damping it is up to 2e-15."""
KEPT = 8
"""Machines whose exponents are kept: unbalance, weight and walls, which are changed often, change none of them."""


class FreeMotions(NamedTuple):
    """Free motions of a machine, each once: ``ahead e^{λt} + behind e^{λ̄t}``."""

    exponents: np.ndarray
    """1/s, shape (N,)."""
    ahead: np.ndarray
    """Coordinates, shape (n, N)."""
    behind: np.ndarray


def motions_at(equations: RotorEquations, speed: float) -> FreeMotions:
    """Free motions at a speed, 1/s; of two conjugate exponents that stand for one motion the one whose sense prevails."""
    if not equations.is_anisotropic:
        exponents, coordinates = equations.exponents(speed)
        return FreeMotions(exponents, coordinates, np.zeros_like(coordinates))
    exponents, coordinates = equations.both.exponents(speed)
    ahead, behind = np.split(coordinates, 2)
    has_mass = equations.mass.any(axis=1)
    prevails = np.linalg.norm(ahead[has_mass], axis=0) - np.linalg.norm(behind[has_mass], axis=0)
    # Of one to and fro along lines neither does.
    level = STRAIGHT * np.linalg.norm(coordinates, axis=0)
    chosen = (prevails > level) | ((np.abs(prevails) <= level) & (exponents.imag > 0.0)) | (exponents.imag == 0.0)
    return FreeMotions(exponents[chosen], ahead[:, chosen], behind[:, chosen].conj())


def growing(exponents: np.ndarray) -> np.ndarray:
    """Which of all exponents of a machine, shape (..., N), are those of motions that grow by more than rounding."""
    rounding = ROUNDING * np.abs(exponents).max(axis=-1, keepdims=True, initial=0.0)
    return np.asarray(exponents.real > rounding)


class Slowest(NamedTuple):
    """What decides whether a machine levitates."""

    exponents: np.ndarray
    """Those of motions that grow, 1/s, the fastest first; where none does, the one that comes back last."""
    grows: bool
    rounding: float
    """Growth, 1/s, that is rounding."""


def slowest_of(equations: RotorEquations, speed: float) -> Slowest:
    """What decides whether a machine levitates, from all its exponents; where supports are not alike in both directions without the sense of whirls."""
    matrix = (equations.both if equations.is_anisotropic else equations).generator(speed)
    exponents = _exponents(matrix.tobytes(), len(matrix))
    rounding = ROUNDING * float(np.abs(exponents).max(initial=0.0))
    if equations.is_anisotropic:  # each motion has two conjugate exponents
        exponents = exponents[exponents.imag >= -rounding]
    grows = exponents.real > rounding
    return Slowest(exponents[grows] if grows.any() else exponents[:1], bool(grows.any()), rounding)


@lru_cache(KEPT)
def _exponents(matrix: bytes, size: int) -> np.ndarray:
    """Exponents of a matrix, the one with the largest real part first."""
    exponents = np.linalg.eigvals(np.frombuffer(matrix, complex).reshape(size, size))
    return np.asarray(exponents[np.argsort(-exponents.real, kind="stable")])
