"""Equations of motion of a flexible rotor on magnetic bearings and supports, in SI units and in the fixed frame."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom.parameters.touchdown_bearing import Mount
from carom.rotors.attachments import TouchdownPlane
from carom.rotors.free_rotor import FreeRotor
from carom.rotors.magnetic_bearing import MagneticBearing
from carom.rotors.reduction import Basis, damping_by, damping_of_basis
from carom.rotors.shared_controller import loops_in
from carom.rotors.support import Support, turning

if TYPE_CHECKING:
    from carom.rotors.flexible_machine import FlexibleMachine


class SpeedLaw(NamedTuple):
    """Damping and stiffness that may change with the speed: those of a support, or what turns with the shaft."""

    square: np.ndarray
    """Shape (n, n)."""
    law: Callable[[float], np.ndarray]
    """Factors at a speed, 1/s, shape (2, 2): of damping and stiffness, for coordinates, then for their conjugates."""

    def at(self, speed: float) -> np.ndarray:
        """Matrices, shape (2, 2, n, n)."""
        found: np.ndarray = np.multiply.outer(self.law(speed), self.square)
        return found


class RotorEquations(NamedTuple):
    """``M z̈ + (D − iΩG) ż + K z + D′ z̄˙ + K′ z̄ = Ω² e^{iΩt} f`` of vectors with unit modal mass, mounts, and controller states, which have no mass.

    Displacements are ``basis.shapes`` times the first ``v`` coordinates, which are in m √kg.  Damping and stiffness are those of the speed of the
    machine; :meth:`at` has them at others.
    """

    mass: np.ndarray
    damping: np.ndarray
    gyroscopic: np.ndarray
    stiffness: np.ndarray
    forcing: np.ndarray
    """By the square of the speed, shape (n,)."""
    unlevitated: np.ndarray
    """Damping and stiffness without magnetic bearings, shape (2, n, n)."""
    rows: Loops
    """Where forces act and displacements are measured: of magnetic bearings relative to housings, of touchdown bearings to their mounts too."""
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
    is_anisotropic: bool
    """Whether a support or a magnetic bearing is anisotropic, at any speed."""
    speed: float = 0.0
    """For which damping and stiffness are, 1/s."""
    held: tuple[SpeedLaw, ...] = ()
    """What of these may differ at another speed."""

    def at(self, speed: float) -> RotorEquations:
        """Equations with the damping and the stiffness of another speed, 1/s, levitating and not."""
        laws = [each for each in self.held if not np.array_equal(each.law(speed), each.law(self.speed))]
        if not laws:
            return self
        (damping, stiffness), across = sum(each.at(speed) - each.at(self.speed) for each in laws)
        return self._replace(
            speed=speed,
            damping=self.damping + damping,
            stiffness=self.stiffness + stiffness,
            unlevitated=self.unlevitated + np.stack([damping, stiffness]),
            across=self.across + across,
            across_unlevitated=self.across_unlevitated + across,
        )

    def alike(self, speed: float) -> RotorEquations:
        """Equations at a speed, 1/s, in which nothing depends on the direction: of the conjugates too where supports are anisotropic."""
        found = self.at(speed)
        return found.both if self.is_anisotropic else found

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
            is_anisotropic=False,
            held=(),
        )

    def generator(self, speed: float) -> np.ndarray:
        """Matrix (N, N) of the free motion at a speed, 1/s, of coordinates and of the velocities of those with mass; of the conjugates too where supports are anisotropic."""
        held = self.alike(speed)
        has_mass = np.asarray(held.mass.any(axis=1))
        n, masses = len(has_mass), held.mass[has_mass, has_mass][:, None]
        spin = (held.damping - 1j * speed * held.gyroscopic)[np.ix_(has_mass, has_mass)]
        matrix = np.zeros((n + has_mass.sum(), n + has_mass.sum()), complex)
        matrix[np.flatnonzero(has_mass), n + np.arange(has_mass.sum())] = 1.0
        matrix[np.flatnonzero(~has_mass), :n] = -held.stiffness[~has_mass]
        matrix[n:, :n], matrix[n:, n:] = -held.stiffness[has_mass] / masses, -spin / masses
        return matrix

    def exponents(self, speed: float) -> tuple[np.ndarray, np.ndarray]:
        """Exponents (N,) of the free motion at a speed, 1/s, and the coordinates (n, N) of each; of the conjugates too where supports are anisotropic."""
        values, vectors = np.linalg.eig(self.generator(speed))
        return values, vectors[: len(self.mass) * (1 + self.is_anisotropic)]

    def response(self, speed: float) -> np.ndarray:
        """Coordinates (n,) of the whirl with which the rotor answers its unbalance, at time zero; of the conjugates too where supports are anisotropic."""
        held = self.alike(speed)
        dynamic = held.stiffness - speed**2 * held.mass + 1j * speed * (held.damping - 1j * speed * held.gyroscopic)
        answer: np.ndarray = np.linalg.solve(dynamic, speed**2 * held.forcing)
        return answer


def block(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """The matrix with these on its diagonal."""
    return np.block([[first, np.zeros_like(first)], [np.zeros_like(second), second]])


def off(matrix: np.ndarray) -> np.ndarray:
    """The matrix with this one and its conjugate beside its diagonal."""
    return np.block([[np.zeros_like(matrix), matrix], [matrix.conj(), np.zeros_like(matrix)]])


class Loops(NamedTuple):
    """Rows of coordinates."""

    bearings: np.ndarray
    """Shape (B, n)."""
    sensors: np.ndarray
    """Shape (B, n): the mean of the sensors of each."""
    touchdowns: np.ndarray
    """Shape (P, n)."""
    supports: np.ndarray
    """Shape (S, n)."""
    tilts: np.ndarray
    """Tilt at each bearing, shape (B, n), where its magnet meets it; zeros elsewhere."""


def loops_of(at: FlexibleMachine) -> Loops:
    """Where forces act and displacements are measured, by coordinates of the rotor."""
    none = np.empty((0, len(at.rotor.matrices.mass)))

    def rows(parts: Sequence[MagneticBearing | TouchdownPlane | Support]) -> np.ndarray:
        return np.array([at.rotor.row_at(each.node) for each in parts] or none)

    seen = [np.mean([at.rotor.row_at(node) for node in each.sensor_nodes], axis=0) for each in at.bearings]
    tilts = [bool(each.ks_tilt) * at.rotor.tilt_at(each.node) for each in at.bearings]
    return Loops(
        rows(at.bearings), np.array(seen or none), rows(at.touchdowns), rows(at.supports), np.array(tilts or none)
    )


def _seated(at: FlexibleMachine, basis: Basis, first: int, size: int) -> Loops:
    """The same by the coordinates of the equations (n,), relative to the housings, whose coordinates begin at the first."""
    found = [np.pad(rows @ basis.shapes, ((0, 0), (0, size - len(basis.frequencies)))) for rows in loops_of(at)]
    for place, housing in enumerate(at.housings, first):
        bearings, *others = housing.parts(at)
        for rows, seated in zip(found[:-1], (bearings, bearings, *others), strict=True):
            rows[list(seated), place] = -1.0 / np.sqrt(housing.mass)
    return Loops(*found)


def equations_of(at: FlexibleMachine, basis: Basis) -> RotorEquations:
    """Equations of a machine in a basis; its speed is also the rate with which states of controllers that will be reset fade while levitation is lost."""
    rotor, bearings, supports = at.rotor, at.bearings, at.supports
    mounts = [(plane, mount) for plane, each in enumerate(at.touchdowns) if (mount := each.bearing.mount)]
    free, seats = slice(0, len(basis.frequencies)), len(basis.frequencies) + len(mounts)
    first = seats + len(at.housings)
    controls = loops_in(rotor, bearings, at.shared_controllers)
    size = first + sum(each.system.states for each in controls)
    rows = _seated(at, basis, seats, size)
    mass, damping, stiffness, carried = _masses(at, basis, mounts, rows)
    gyroscopic = np.zeros((size, size))
    gyroscopic[free, free] = _gyroscopic(rotor, basis)
    held = _held(rotor, basis, supports, rows.supports)
    states = slice(first, size)
    damping[states, states] = np.eye(size - first)
    # By coordinates and by their conjugates: damping and stiffness; then currents by places and by rates.
    levitated = np.zeros((2, 2, size, size), complex)
    levitated[0] = damping, stiffness
    levitated += sum(each.at(at.speed) for each in held)
    left, regained = levitated.copy(), np.ones(size)
    currents = np.zeros((2, 2, len(bearings), size), complex)
    amplifiers = np.full(len(bearings), -1)
    for loop in controls:
        own, listed = slice(first, first + loop.system.states), list(loop.bearings)
        seen = rows.sensors[listed]
        for side, system in enumerate(loop.sides):
            for place, number in enumerate(listed):
                currents[side, :, number] = system.D[place] @ seen, system.rate[place] @ seen
                currents[side, 0, number, own] = system.C[place]
            levitated[side, 1, own] = -(system.B @ seen)
            levitated[side, 1, own, own] = -system.A
        if loop.at_regain == "reset":
            # What these states do meanwhile acts on nothing; they fade, so that none is mistaken for a displacement that stays.
            left[0, 1, own, own], regained[own] = at.speed * np.eye(loop.system.states), 0.0
        elif loop.at_regain == "running":
            left[:, 1, own] = levitated[:, 1, own]
        first = own.stop
        with_amplifier = [each for each in listed if any(axis.amplifier_bandwidth for axis in bearings[each].axes)]
        amplifiers[with_amplifier] = range(first - len(with_amplifier), first)
    for number, bearing in enumerate(bearings):
        pulls = rows.bearings[number]
        for side, magnet in enumerate(bearing.magnet):
            levitated[side, ::-1] += bearing.ki * (pulls[:, None] * currents[side, :, number, None])
            levitated[side, 1] += magnet * np.outer(pulls, pulls)
        levitated[0, 1] += bearing.ks_tilt * np.outer(rows.tilts[number], rows.tilts[number])
    forcing = np.zeros(size, complex)
    for each in at.unbalances:
        forcing[free] += each.size * np.exp(1j * each.angle) * (rotor.row_at(each.node) @ basis.shapes)
    (damping, stiffness), across = levitated
    return RotorEquations(
        mass,
        _real(damping),
        gyroscopic,
        _real(stiffness),
        forcing,
        _real(left[0]),
        rows,
        _real(currents[0, 0]),
        _real(currents[0, 1]),
        amplifiers,
        regained,
        carried,
        across,
        left[1],
        currents[1],
        any(len(each.sides) > 1 for each in controls)
        or any(each.magnet[1] for each in bearings)
        or any(each.is_anisotropic for each in supports),
        at.speed,
        held,
    )


def _masses(
    at: FlexibleMachine, basis: Basis, mounts: Sequence[tuple[int, Mount]], rows: Loops
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Mass, damping and stiffness of rotor, mounts and housings, and what each is displaced by when all are by 1 m; touchdown bearings on mounts get their rows."""
    vectors, seats, size = len(basis.frequencies), len(basis.frequencies) + len(mounts), rows.touchdowns.shape[1]
    free = slice(0, vectors)
    mass, damping, stiffness = np.zeros((3, size, size))
    carried = np.zeros(size)
    mass[free, free], stiffness[free, free] = np.eye(vectors), np.diag(basis.frequencies**2)
    if at.rotor.axial_stiffness is not None:
        stiffness[free, free] += basis.shapes.T @ at.rotor.axial_stiffness @ basis.shapes
    damping[free, free] = damping_of_basis(at.rotor, basis)
    carried[free], carried[vectors:seats] = at.rotor.carried(basis.shapes), 1.0
    for place, housing in enumerate(at.housings, seats):
        mass[place, place], carried[place] = 1.0, np.sqrt(housing.mass)
        damping[place, place], stiffness[place, place] = (
            housing.damping / housing.mass,
            housing.stiffness / housing.mass,
        )
    for place, (plane, mount) in enumerate(mounts, vectors):
        ring, own = np.eye(size)[place], rows.touchdowns[plane]
        stands = ring + np.where(np.arange(size) < vectors, 0.0, own)  # on a housing or on the ground
        mass[place, place] = mount.mass
        damping += mount.damping * np.outer(stands, stands)
        stiffness += mount.stiffness * np.outer(stands, stands)
        own[vectors:] = -ring[vectors:]
    return mass, damping, stiffness, carried


def _real(values: np.ndarray) -> np.ndarray:
    """The same as real numbers where they are."""
    return values if values.imag.any() else values.real.copy()


def _held(rotor: FreeRotor, basis: Basis, supports: Sequence[Support], rows: np.ndarray) -> tuple[SpeedLaw, ...]:
    """What holds the rotor with and without levitation, and the damping that turns with its shaft."""

    def padded(part: np.ndarray) -> np.ndarray:
        return np.pad(part, (0, rows.shape[1] - len(part)))

    found = []
    for each, row in zip(supports, rows, strict=True):
        found.append(SpeedLaw(np.outer(row, row), each.coefficients))
        if each.tilts:
            tilt = padded(rotor.tilt_at(each.node) @ basis.shapes)
            found.append(SpeedLaw(np.outer(tilt, tilt), each.of_tilt))
    if rotor.internal_rates is not None:
        own = damping_by(basis, rotor.by_modes(rotor.internal_rates), rotor.internal_rates)
        found.append(SpeedLaw(padded(own), turning))
    return tuple(found)


def _gyroscopic(rotor: FreeRotor, basis: Basis) -> np.ndarray:
    """Gyroscopic matrix of the vectors: none of a translation, to the last digit."""
    matrix = basis.shapes.T @ rotor.matrices.gyroscopic @ basis.shapes
    matrix[: rotor.translations], matrix[:, : rotor.translations] = 0.0, 0.0
    return 0.5 * (matrix + matrix.T)
