"""Energy ledger of a motion: stored energies, the works of all forces, and the error of the balance."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from carom.models import jeffcott_of
from carom.motions.contacts import Table
from carom.motions.trajectories import Trajectory
from carom.outcome import Phase
from carom.parameters import Scales

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
LONGEST_PIECE = 1.5
"""Longest stretch, in ``1/max|λ|``, over which one Gauss rule is used; its error is below rounding."""


@dataclass(frozen=True, eq=False, repr=False)
class EnergyLedger(Table):
    """Energies of a motion over time in the fixed frame, in ``m c_r² Ω²``.

    All arrays have shape (k,): values at ``times``, which begin at zero and contain the ends of all segments.  Works
    are cumulative from the start; a positive work supplies energy to the rotor.

    Attributes
    ----------
    times : ndarray
        In ``1/Ω``.
    kinetic, spring : ndarray
        Energy of the rotor centre ``|ż|²/2`` and of the bearing's stiffness ``ω²|z|²/2``.
    unbalance, damping : ndarray
        Work of the unbalance force and of the bearing's damping.
    impacts, friction : ndarray
        Work at the contact point: in impacts, and by friction in lasting contact.
    drive : ndarray
        Work that the shaft's drive supplies through friction, in impacts and in lasting contact.
    """

    figure: ClassVar[str] = "energies"

    times: np.ndarray
    kinetic: np.ndarray
    spring: np.ndarray
    unbalance: np.ndarray
    damping: np.ndarray
    impacts: np.ndarray
    friction: np.ndarray
    drive: np.ndarray
    scales: Scales | None = None

    dimension: ClassVar[str] = "times"
    columns: ClassVar[dict[str, tuple[str, str, str]]] = {
        "times": ("time", "s", "time"),
        "kinetic": ("energy", "J", "kinetic energy of the rotor centre"),
        "spring": ("energy", "J", "energy of the bearing's stiffness"),
        "unbalance": ("energy", "J", "work of the unbalance since the start"),
        "damping": ("energy", "J", "work of the bearing's damping since the start"),
        "impacts": ("energy", "J", "work at the contact point in impacts since the start"),
        "friction": ("energy", "J", "work of friction in lasting contact since the start"),
        "drive": ("energy", "J", "work of the shaft's drive through friction since the start"),
    }

    @property
    def energy(self) -> np.ndarray:
        """Kinetic and spring energy."""
        return self.kinetic + self.spring

    @property
    def supplied(self) -> np.ndarray:
        """Sum of all works since the start."""
        return self.unbalance + self.damping + self.impacts + self.friction + self.drive

    @property
    def imbalance(self) -> float:
        """Largest error of the balance, relative to the largest energy or work that occurs; 0 at rest."""
        missing = np.abs(self.energy - self.energy[0] - self.supplied).max()
        works = (self.unbalance, self.damping, self.impacts, self.friction, self.drive)
        passed = max(self.energy.max(), *(np.abs(work).max() for work in works))
        return float(missing / passed) if passed > 0.0 else 0.0


def energy_ledger(trajectory: Trajectory) -> EnergyLedger:
    """Compute the energy ledger of a motion.

    With ``w = U̇ + iU`` (velocity in the fixed frame, seen in the co-rotating one) the energy
    ``(|w|² + ω²|U|²)/2`` changes by the power ``Re(w̄ρe^{iφ})`` of the unbalance, ``−γ|w|²`` of the damping and that of
    the contact force.  A friction force ``F`` does the work ``F v`` on the contact point, which slips with
    ``v = s + 1 + θ̇``, and the rest ``−F s`` comes from the drive.

    Raises
    ------
    InputError
        The motion is that of another model than the planar rotor.
    """
    parameters = jeffcott_of(trajectory.rotor).parameters
    edges, counts = _pieces(trajectory)
    half = 0.5 * np.diff(edges)
    times = (edges[:-1] + half)[:, None] + half[:, None] * _NODES
    position, velocity = trajectory.at(times)
    fixed = velocity + 1j * position
    _, grip = trajectory.forces(times)
    slip = parameters.radius_ratio + (position.conj() * fixed).imag
    ends = np.concatenate([[0], np.cumsum(counts)])

    def work(power: np.ndarray) -> np.ndarray:
        running: np.ndarray = np.concatenate([[0.0], np.cumsum(half * (power @ _WEIGHTS))])
        return running[ends]

    def at_events(events: np.ndarray, values: np.ndarray) -> np.ndarray:
        shares = np.zeros(len(ends))
        shares[1:-1][events] = values
        return np.cumsum(shares)

    force = parameters.rho * np.exp(1j * parameters.phi)
    kinetic, spring = _stored(trajectory)
    impact, landing = trajectory.is_impact, trajectory.is_landing
    impacts, landings = trajectory.log_of(impact), trajectory.log_of(landing)
    return EnergyLedger(
        times=edges[ends],
        kinetic=kinetic,
        spring=spring,
        unbalance=work((fixed.conj() * force).real),
        damping=work(-parameters.gamma * np.abs(fixed) ** 2),
        impacts=at_events(impact, impacts.contact_work),
        # A landing stands for the last bounces of a chatter; its work is a correction to their friction.
        friction=work(grip * slip) + at_events(landing, landings.contact_work),
        drive=work(-parameters.radius_ratio * grip)
        + at_events(impact, impacts.drive_work)
        + at_events(landing, landings.drive_work),
        scales=trajectory.rotor.scales,
    )


def _pieces(trajectory: Trajectory) -> tuple[np.ndarray, np.ndarray]:
    """Edges of the stretches to integrate, and the number of stretches in each segment."""
    bounds = np.append(trajectory.segment_starts, trajectory.time)
    lengths = np.diff(bounds)
    fastest = np.abs(trajectory.rotor.system.exponents).max()
    flying = trajectory.segment_phases[:, 0] == Phase.FLIGHT
    counts = np.where(flying, np.ceil(lengths * fastest / LONGEST_PIECE), 1).astype(int)
    counts = np.maximum(counts, 1)
    owner = np.repeat(np.arange(len(counts)), counts)
    place = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
    return np.append(bounds[owner] + lengths[owner] * place / counts[owner], trajectory.time), counts


def _stored(trajectory: Trajectory) -> tuple[np.ndarray, np.ndarray]:
    """Kinetic and spring energy at the start of each segment and at the end."""
    position, velocity = trajectory.rotor.system.state(trajectory.segment_amplitudes)
    position = np.append(position, trajectory.final.position)
    velocity = np.append(velocity, trajectory.final.velocity)
    omega = jeffcott_of(trajectory.rotor).parameters.omega
    return 0.5 * np.abs(velocity + 1j * position) ** 2, 0.5 * omega**2 * np.abs(position) ** 2
