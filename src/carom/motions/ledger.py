"""Energy ledger of a motion: stored energies, the works of all forces, and the error of the balance."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from carom.arguments import checked
from carom.models import Matrices
from carom.models.stages import forces_of
from carom.motions.contacts import Table, column
from carom.motions.trajectories import Trajectory
from carom.outcome import InputError, Phase
from carom.parameters import Scales

NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)
"""Gauss rule for a piece, on −1 … 1."""
LONGEST_PIECE = 1.5
"""Longest stretch, in ``1/max|λ|``, over which one Gauss rule is used; its error is below rounding."""
HERMITIAN = 1e-12
"""Largest skew part of a matrix, relative to its largest element, that counts as rounding."""


@dataclass(frozen=True, eq=False, repr=False)
class EnergyLedger(Table):
    """Energies of a motion over time in the fixed frame.

    All arrays have shape (k,): values at ``times``, which begin at zero and contain the ends of all segments.  Works
    are cumulative from the start; a positive work supplies energy to the rotor.  Gyroscopic forces do no work.  The
    energy of all masses is ``ŻᴴMŻ/2``, that of the springs ``ZᴴKZ/2`` with the Hermitian part of ``K``; the rest of
    ``K``, such as cross-coupled stiffness, does the circulatory work.  Contact works at all planes.
    """

    figure: ClassVar[str] = "energies"

    times: np.ndarray = field(metadata=column("time", "time"))
    kinetic: np.ndarray = field(metadata=column("energy", "kinetic energy of all masses"))
    spring: np.ndarray = field(metadata=column("energy", "energy of the springs"))
    unbalance: np.ndarray = field(metadata=column("energy", "work of the unbalance since the start"))
    damping: np.ndarray = field(metadata=column("energy", "work of damping since the start"))
    circulatory: np.ndarray = field(metadata=column("energy", "work of circulatory forces since the start"))
    forces: np.ndarray = field(metadata=column("energy", "work of weight and other outer forces since the start"))
    impacts: np.ndarray = field(metadata=column("energy", "work at the contact point in impacts since the start"))
    friction: np.ndarray = field(metadata=column("energy", "work of friction in lasting contact since the start"))
    drive: np.ndarray = field(metadata=column("energy", "work of the shaft's drive through friction since the start"))
    scales: Scales | None = None

    dimension: ClassVar[str] = "times"

    @property
    def energy(self) -> np.ndarray:
        """Kinetic and spring energy."""
        return self.kinetic + self.spring

    @property
    def works(self) -> tuple[np.ndarray, ...]:
        """All works since the start."""
        others = self.circulatory, self.forces, self.impacts, self.friction, self.drive
        return self.unbalance, self.damping, *others

    @property
    def supplied(self) -> np.ndarray:
        """Sum of all works since the start."""
        total: np.ndarray = np.sum(self.works, axis=0)
        return total

    @property
    def imbalance(self) -> float:
        """Largest error of the balance, relative to the largest energy or work that occurs; 0 at rest."""
        missing = np.abs(self.energy - self.energy[0] - self.supplied).max()
        passed = max(self.energy.max(), *(np.abs(work).max() for work in self.works))
        return float(missing / passed) if passed > 0.0 else 0.0


@checked
def energy_ledger(trajectory: Trajectory) -> EnergyLedger:
    """Compute the energy ledger of a motion of any linear rotor.

    With ``w = U̇ + iU`` (velocities in the fixed frame, seen in the co-rotating one) and ``K = K₀ + K₁``, Hermitian and
    skew-Hermitian, the energy ``(wᴴMw + UᴴK₀U)/2`` changes by the power ``Re(wᴴF)`` of the unbalance, ``−wᴴDw`` of the
    damping, ``−Re(wᴴK₁U)`` of the circulatory forces, ``Re(wᴴMa(t))`` of forces that accelerate the coordinates by ``a(t)``, such
    as weight, and that of the contact forces.  A friction force ``F`` does the
    work ``F v`` on the contact point, which slips with ``v = s + 1 + θ̇``, and the rest ``−F s`` comes from the drive.

    Raises
    ------
    InputError
        The mass matrix is not Hermitian, so there is no kinetic energy.

    See Also
    --------
    carom.plots.energies, carom.plots.touchdown : draw it
    carom.motions.full_spectrum : the motion as a sum of whirls

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> ledger = cm.motions.energy_ledger(cm.simulate(machine, cm.kick("60 mm/s"), 40.0))
    >>> ledger.imbalance < 1e-12
    True
    """
    matrices = trajectory.rotor.matrices
    edges, counts = pieces(trajectory)
    if np.abs(matrices.mass - matrices.mass.conj().T).max() > HERMITIAN * np.abs(matrices.mass).max():
        raise InputError("mass", matrices.mass.tolist(), "a Hermitian matrix: otherwise there is no kinetic energy")
    half = 0.5 * np.diff(edges)
    times = (edges[:-1] + half)[:, None] + half[:, None] * NODES
    position, fixed = _in_fixed_frame(*trajectory.at(times), len(matrices.mass))
    ends = np.concatenate([[0], np.cumsum(counts)])

    def work(power: np.ndarray) -> np.ndarray:
        running: np.ndarray = np.concatenate([[0.0], np.cumsum(half * (power @ WEIGHTS))])
        return running[ends]

    def at_events(events: np.ndarray, values: np.ndarray) -> np.ndarray:
        shares = np.zeros(len(ends))
        np.add.at(shares, events + 1, values)
        return np.cumsum(shares)

    powers = [contact_power(trajectory.seen_at(plane), times) for plane in range(trajectory.segment_phases.shape[1])]
    slides, drives = np.sum(powers, axis=0)
    skew = 0.5 * (matrices.stiffness - matrices.stiffness.conj().T)
    if np.abs(skew).max() <= HERMITIAN * np.abs(matrices.stiffness).max():
        skew = np.zeros_like(skew)
    kinetic, spring = _stored(trajectory, matrices)
    impact, landing = (trajectory.blows(each).events for each in (trajectory.is_impact, trajectory.is_landing))
    impacts, landings = trajectory.log_of(trajectory.is_impact), trajectory.log_of(trajectory.is_landing)
    return EnergyLedger(
        times=edges[ends],
        kinetic=kinetic,
        spring=spring,
        unbalance=work((fixed.conj() @ matrices.forcing).real),
        damping=work(-_form(fixed, matrices.damping, fixed)),
        circulatory=work(-_form(fixed, skew, position)),
        forces=work(_power_of_forces(trajectory, times, fixed)),
        impacts=at_events(impact, impacts.contact_work),
        # A landing stands for the last bounces of a chatter; its work is a correction to their friction.
        friction=work(slides) + at_events(landing, landings.contact_work),
        drive=work(drives) + at_events(impact, impacts.drive_work) + at_events(landing, landings.drive_work),
        scales=trajectory.rotor.scales,
    )


def _power_of_forces(trajectory: Trajectory, times: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Power of the forces that change with time in the frame of the rotor, weight among them; velocities (..., n) in the fixed frame."""
    power, since = np.zeros(times.shape), trajectory.begins + times
    for force in forces_of(trajectory.rotor):
        push = trajectory.rotor.matrices.mass @ force.accelerations
        power += ((velocity.conj() @ push) * np.exp(force.exponent * since)).real
    return power


def _form(left: np.ndarray, matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """``Re(aᴴAb)`` of vectors along the last axis."""
    form: np.ndarray = np.einsum("...i,ij,...j->...", left.conj(), matrix, right, optimize=True).real
    return form


def _in_fixed_frame(position: np.ndarray, velocity: np.ndarray, coordinates: int) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates along a last axis, and their velocities in the fixed frame."""
    if coordinates == 1:
        position, velocity = position[..., None], velocity[..., None]
    return position, velocity + 1j * position


def contact_power(motion: Trajectory, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Powers of friction on the contact point of a plane and of the drive."""
    position, velocity = motion.at_plane(times)
    surface_speed = float(motion.rotor.system.arrays.surface_speed[motion.plane])
    _, grip = motion.forces(times)
    return grip * (surface_speed + (position.conj() * velocity).imag), -(surface_speed - 1.0) * grip


def pieces(trajectory: Trajectory) -> tuple[np.ndarray, np.ndarray]:
    """Edges of the stretches to integrate, and the number of stretches in each segment."""
    bounds = np.append(trajectory.segment_starts, trajectory.time)
    lengths = np.diff(bounds)
    fastest = np.abs(trajectory.rotor.system.arrays["exponents"]).max()
    flying = (trajectory.segment_phases == Phase.FLIGHT).all(axis=1)
    counts = np.where(flying, np.ceil(lengths * fastest / LONGEST_PIECE), 1).astype(int)
    counts = np.maximum(counts, 1)
    owner = np.repeat(np.arange(len(counts)), counts)
    place = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
    return np.append(bounds[owner] + lengths[owner] * place / counts[owner], trajectory.time), counts


def _stored(trajectory: Trajectory, matrices: Matrices) -> tuple[np.ndarray, np.ndarray]:
    """Kinetic and spring energy at the start of each segment and at the end."""
    position, velocity = trajectory.rotor.system.state(trajectory.segment_amplitudes)
    position = np.concatenate([position, np.asarray(trajectory.final.position)[None]])
    velocity = np.concatenate([velocity, np.asarray(trajectory.final.velocity)[None]])
    position, fixed = _in_fixed_frame(position, velocity, len(matrices.mass))
    return 0.5 * _form(fixed, matrices.mass, fixed), 0.5 * _form(position, matrices.stiffness, position)
