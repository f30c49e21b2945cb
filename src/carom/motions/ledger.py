"""Energy ledger of a motion: stored energies, the works of all forces, and the error of the balance."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np
from numpy.polynomial import legendre

from carom.base.arguments import checked
from carom.base.outcome import InputError, Phase
from carom.core.wall_work import DAMPED
from carom.models import Matrices, Rotor
from carom.models.limits import saturation_accelerations, saturation_of
from carom.models.mode_arrays import TURN
from carom.motions.contacts import contact_works, lost_on_parting, stored
from carom.motions.kinematics import is_compliant, presses, race_speed, shaft_speed
from carom.motions.tables import LogTable, column
from carom.motions.trajectories import Trajectory
from carom.parameters import Scales

NODES, WEIGHTS = legendre.leggauss(16)
"""Gauss rule for a piece, on −1 … 1."""
LONGEST_PIECE = 1.5
"""Longest stretch, in ``1/max|λ|``, over which one Gauss rule is used; its error is below rounding."""
HERMITIAN = 1e-12
"""Largest skew part of a matrix, relative to its largest element, that counts as rounding."""


@dataclass(frozen=True, eq=False, repr=False)
class EnergyLedger(LogTable):
    """Energies of a motion over time in the fixed frame.

    All arrays have shape (k,): values at ``times``, which begin at zero and contain the ends of all segments.  Works
    are cumulative from the start; a positive work supplies energy to the rotor.  Gyroscopic forces do no work.  The
    energy of all masses is ``ŻᴴMŻ/2``, that of the springs ``ZᴴKZ/2`` with the Hermitian part of ``K``; the rest of
    ``K``, such as cross-coupled stiffness, does the circulatory work.  Contact works at all planes.

    A compliant wall stores the energy of its spring while it presses on the rotor.  Where plane and wall part at some depth, as the
    wall comes back more slowly, the rotor does not get that energy any more: it counts as lost at this moment.  Where they meet again
    before the plane has left the wall, the spring is as deep as the plane, and what it then holds, which is less, is taken back.

    A shaft at constant speed gets from its drive whatever friction takes.  One whose speed changes holds the energy ``Jσ²/2`` of its spin, which
    friction takes from it, and ``drive`` is the work of its drive's torque in contact; in flight the torque is left out of the motion.  The unbalance does its work through the bearing forces of an ideal axis: its torque on the
    shaft is left out too.
    """

    figure: ClassVar[str] = "energies"

    times: np.ndarray = column("time", "time")
    kinetic: np.ndarray = column("energy", "kinetic energy of all masses")
    spring: np.ndarray = column("energy", "energy of the springs")
    wall: np.ndarray = column("energy", "energy of the springs of walls that press on the rotor")
    races: np.ndarray = column("energy", "kinetic energy of the races that turn")
    shaft: np.ndarray = column("energy", "kinetic energy of the spin of a shaft whose speed changes")
    unbalance: np.ndarray = column("energy", "work of the unbalance since the start")
    damping: np.ndarray = column("energy", "work of damping since the start")
    circulatory: np.ndarray = column("energy", "work of circulatory forces since the start")
    forces: np.ndarray = column("energy", "work of weight and other external forces since the start")
    limits: np.ndarray = column("energy", "work not done by magnetic bearings at their limits, since the start")
    impacts: np.ndarray = column("energy", "work at the contact point in impacts since the start")
    friction: np.ndarray = column("energy", "work of friction in lasting contact since the start")
    drive: np.ndarray = column("energy", "work of the shaft's drive since the start")
    wall_loss: np.ndarray = column("energy", "work lost in walls, in dampers and at lift-off, since the start")
    race_drag: np.ndarray = column("energy", "work of drag on the races that turn since the start")
    scales: Scales | None = None

    dimension: ClassVar[str] = "times"

    @property
    def energy(self) -> np.ndarray:
        """Kinetic energy, that of the springs, and what walls, races and the shaft hold."""
        return self.kinetic + self.spring + self.wall + self.races + self.shaft

    @property
    def works(self) -> tuple[np.ndarray, ...]:
        """All works since the start."""
        contact = self.impacts, self.friction, self.drive, self.wall_loss, self.race_drag
        return self.unbalance, self.damping, self.circulatory, self.forces, self.limits, *contact

    @property
    def imbalance(self) -> float:
        """Largest error of the balance, relative to the largest energy or work that occurs; 0 at rest."""
        missing = np.abs(self.energy - self.energy[0] - np.sum(self.works, axis=0)).max()
        passed = max(self.energy.max(), *(np.abs(work).max() for work in self.works))
        return float(missing / passed) if passed > 0.0 else 0.0


@checked
def energy_ledger(trajectory: Trajectory) -> EnergyLedger:
    """Compute the energy ledger of a motion of any linear rotor.

    With ``w = U̇ + iU`` (velocities in the fixed frame, seen in the co-rotating one) and ``K = K₀ + K₁``, Hermitian and
    skew-Hermitian, the energy ``(wᴴMw + UᴴK₀U)/2`` changes by the power ``Re(wᴴF)`` of the unbalance, ``−wᴴDw`` of the
    damping, ``−Re(wᴴK₁U)`` of the circulatory forces, ``Re(wᴴMa(t))`` of forces that accelerate the coordinates by ``a(t)``, such
    as weight, what bearings at their limits do not give, and that of the contact forces.  A friction force ``F`` does the work ``F v`` on the contact point, which slips with
    ``v = s + r(1 + θ̇) − q``, and the drive gives ``−F s``: the centre moves along the wall with ``r(1 + θ̇)``, and a race that turns, whose
    surface moves with ``q``, takes ``−F q``.  A shaft whose speed ``σ`` changes takes ``sσF`` itself, its drive gives ``Tσ`` in contact, and its
    unbalance pushes with ``F(σ² − iσ̇)e^{i(ϑ−t)}`` (:mod:`carom.core.shaft`), also in the instant of an impact.  The normal force ``N`` of a compliant wall takes ``Nδ̇`` at the depth ``δ = r − 1``, which
    goes into its spring and its damper.

    Raises
    ------
    InputError
        The mass matrix is not Hermitian, so there is no kinetic energy.

    See Also
    --------
    carom.plots.energies, carom.plots.touchdown : draw it

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> ledger = cm.motions.energy_ledger(cm.simulate(machine, cm.kick("60 mm/s"), 40.0))
    >>> ledger.imbalance < 1e-12
    True
    """
    matrices = trajectory.rotor.matrices
    edges, counts = _pieces(trajectory)
    if np.abs(matrices.mass - matrices.mass.conj().T).max() > HERMITIAN * np.abs(matrices.mass).max():
        raise InputError("mass", matrices.mass.tolist(), "a Hermitian matrix: otherwise there is no kinetic energy")
    half = 0.5 * np.diff(edges)
    times = (edges[:-1] + half)[:, None] + half[:, None] * NODES
    position, fixed = _in_fixed_frame(*trajectory.at(times), len(matrices.mass))
    ends = np.concatenate([[0], np.cumsum(counts)])
    work, at_events = partial(_integrated, half, ends), partial(_summed, len(ends))
    histories = [seen.history(times) for seen in trajectory.at_each]
    slides, drives = np.sum([(each.friction_power, each.drive_power) for each in histories], axis=0)
    damping, stiffness = _on_conjugates(trajectory.rotor)
    circulates, turning = 0.5 * (stiffness - stiffness.T), np.exp(TURN * (trajectory.begins + times))
    skew = 0.5 * (matrices.stiffness - matrices.stiffness.conj().T)
    if np.abs(skew).max() <= HERMITIAN * np.abs(matrices.stiffness).max():
        skew = np.zeros_like(skew)
    kinetic, spring = _stored(trajectory, matrices)
    wall, wall_loss = _walls(trajectory)
    races, drag = _races(trajectory, times)
    shaft, push, torque, jolts = _spin(trajectory, times)
    impact, landing = (trajectory.impulses(each).events for each in (trajectory.is_impact, trajectory.is_landing))
    impacts, landings = trajectory.log_of(trajectory.is_impact), trajectory.log_of(trajectory.is_landing)
    if trajectory.rotor.system.shaft is None:
        drive = work(drives) + at_events(impact, impacts.drive_work) + at_events(landing, landings.drive_work)
    else:
        drive = work(torque)
    return EnergyLedger(
        times=edges[ends],
        kinetic=kinetic,
        spring=spring,
        wall=wall,
        races=races,
        shaft=shaft,
        unbalance=work(((fixed.conj() @ matrices.forcing) * push).real)
        + at_events(np.arange(len(jolts)), _work_of_jolts(trajectory, jolts)),
        damping=work(-_form(fixed, matrices.damping, fixed) - _form(fixed, damping, fixed.conj(), turning)),
        circulatory=work(-_form(fixed, skew, position) - _form(fixed, circulates, position.conj(), turning)),
        forces=work(_power_of_forces(trajectory, times, fixed)),
        limits=work(_power_of_excess(trajectory, times, fixed)),
        impacts=at_events(impact, impacts.contact_work),
        # A landing stands for the last bounces of a chatter; its work is a correction to their friction.
        friction=work(slides) + at_events(landing, landings.contact_work),
        drive=drive,
        wall_loss=wall_loss,
        race_drag=work(drag),
        scales=trajectory.rotor.scales,
    )


def _integrated(half: np.ndarray, ends: np.ndarray, power: np.ndarray) -> np.ndarray:
    """Work since the start, at the ends of segments, of a power (k, 16) at the nodes of stretches of such half lengths."""
    running: np.ndarray = np.concatenate([[0.0], np.cumsum(half * (power @ WEIGHTS))])
    return running[ends]


def _summed(count: int, events: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Sums since the start, at so many times of the ledger, of values in events."""
    shares = np.zeros(count)
    np.add.at(shares, events + 1, values)
    return np.cumsum(shares)


def _work_of_jolts(trajectory: Trajectory, jolts: np.ndarray) -> np.ndarray:
    """Work of the impulses that the unbalance of a shaft gives in events, (n,): with the mean of the velocities before and after."""
    matrices, coordinates = trajectory.rotor.matrices, len(trajectory.rotor.matrices.mass)
    states = (
        trajectory.rotor.system.state(each) for each in (trajectory.event_amplitudes, trajectory.segment_amplitudes[1:])
    )
    before, after = (_in_fixed_frame(*state, coordinates)[1] for state in states)
    done: np.ndarray = (0.5 * ((before + after).conj() @ matrices.forcing) * jolts).real
    return done


def _power_of_forces(trajectory: Trajectory, times: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Power of the forces that change with time in the frame of the rotor, weight among them; velocities (..., n) in the fixed frame."""
    power, since = np.zeros(times.shape), trajectory.begins + times
    rotor = trajectory.rotor
    for force in (*rotor.acting.forces, *rotor.definition.pull):
        power += (velocity.conj() * (force.at(since) @ rotor.matrices.mass.T)).sum(axis=-1).real
    return power


def _power_of_excess(trajectory: Trajectory, times: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Power of what controllers ask for beyond the limits of their bearings, with its sign changed; velocities (..., n) in the fixed frame."""
    system = trajectory.rotor.system
    if not system.limits:
        return np.zeros(times.shape)
    excess = saturation_of(system, trajectory.amplitudes_at(times)[0], trajectory.begins + times)
    push = excess @ (trajectory.rotor.matrices.mass @ saturation_accelerations(system)).T
    power: np.ndarray = (velocity.conj() * push).sum(axis=-1).real
    return power


def _form(left: np.ndarray, matrix: np.ndarray, right: np.ndarray, turning: np.ndarray | float = 1.0) -> np.ndarray:
    """``Re(aᴴAb)`` of vectors along the last axis; of conjugates ``b`` the form turns with the frame."""
    form: np.ndarray = (np.einsum("...i,ij,...j->...", left.conj(), matrix, right, optimize=True) * turning).real
    return form


def _on_conjugates(rotor: Rotor) -> np.ndarray:
    """Matrices of the forces ``−D′Z̄˙ − K′Z̄`` of anisotropic bearings, (2, n, n)."""
    pair = rotor.equations.conjugate
    return np.zeros((2, len(rotor.system.rest), len(rotor.system.rest))) if pair is None else pair


def _in_fixed_frame(position: np.ndarray, velocity: np.ndarray, coordinates: int) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates along a last axis, and their velocities in the fixed frame."""
    if coordinates == 1:
        position, velocity = position[..., None], velocity[..., None]
    return position, velocity + 1j * position


def _walls(trajectory: Trajectory) -> np.ndarray:
    """Compliant walls: energy of their springs, and what they have taken, at the times of the ledger."""
    held, lost = np.zeros((2, len(trajectory.segment_starts) + 1))
    works = contact_works(trajectory)
    for plane in range(trajectory.segment_phases.shape[1]):
        if not is_compliant(trajectory.rotor.system, plane):
            continue
        motion = trajectory.seen_at(plane)
        phases = motion.segment_phases[:, plane]
        held += stored(motion, motion.edge_amplitudes, np.append(phases, phases[-1]))
        lost[1:-1] -= lost_on_parting(motion)
        lost[works.segments + 1] -= works.found[:, plane, DAMPED]
    return np.stack([held, np.cumsum(lost)])


def _races(trajectory: Trajectory, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Kinetic energy of the races that turn, at the times of the ledger, and the power of their drag."""
    system = trajectory.rotor.system
    arrays, kinetic, power = system.arrays, np.zeros(len(trajectory.segment_starts) + 1), np.zeros(times.shape)
    for plane in np.flatnonzero(arrays.race >= 0).tolist():
        inertia = arrays.masses[plane] / arrays.race_gain[plane]  # by the square of the radius
        speeds = race_speed(system, plane, trajectory.edge_amplitudes)
        kinetic += 0.5 * inertia * speeds**2
        speed = race_speed(system, plane, trajectory.amplitudes_at(times)[0])
        power += inertia * arrays.exponents[arrays.race[plane]].real * speed**2
    return kinetic, power


def _stored(trajectory: Trajectory, matrices: Matrices) -> tuple[np.ndarray, np.ndarray]:
    """Kinetic and spring energy at the start of each segment and at the end."""
    position, velocity = trajectory.rotor.system.state(trajectory.segment_amplitudes)
    position = np.concatenate([position, np.asarray(trajectory.final.position)[None]])
    velocity = np.concatenate([velocity, np.asarray(trajectory.final.velocity)[None]])
    position, fixed = _in_fixed_frame(position, velocity, len(matrices.mass))
    spring = 0.5 * _form(position, matrices.stiffness, position)
    _, stiffness = _on_conjugates(trajectory.rotor)
    turning = np.exp(TURN * (trajectory.begins + np.append(trajectory.segment_starts, trajectory.time)))
    spring += 0.5 * _form(position, 0.5 * (stiffness + stiffness.T), position.conj(), turning)
    return 0.5 * _form(fixed, matrices.mass, fixed), spring


def _pieces(trajectory: Trajectory) -> tuple[np.ndarray, np.ndarray]:
    """Edges of the stretches to integrate, and the number of stretches in each segment: one where a Taylor series is followed."""
    bounds = np.append(trajectory.segment_starts, trajectory.time)
    lengths = np.diff(bounds)
    fastest = np.abs(trajectory.rotor.system.arrays["exponents"]).max()
    flying = (trajectory.segment_phases == Phase.FLIGHT).all(axis=1)
    counts = np.where(flying, np.ceil(lengths * fastest / LONGEST_PIECE), 1).astype(int)
    counts = np.maximum(counts, 1)
    owner = np.repeat(np.arange(len(counts)), counts)
    place = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
    return np.append(bounds[owner] + lengths[owner] * place / counts[owner], trajectory.time), counts


def _spin(trajectory: Trajectory, times: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """What a shaft whose speed changes does at times (k, 16): energy, push of the unbalance, power of the drive, jolts.

    The energy ``Jσ²/2`` is that at the start of each segment and at the end.  With the direction ``p`` of the unbalance and the friction forces
    ``F_q`` at the radii ``s_q`` the unbalance pushes with ``F(σ² − iβ)p``, ``Jβ = Σ_q s_q F_q`` (:mod:`carom.core.shaft`).  At an impact the
    speed jumps by ``Δσ`` and the unbalance gives the impulse ``−iFpΔσ``, which works with the mean of the velocities before and after.  At
    constant speed the unbalance pushes with ``F``, and the rest is zero.
    """
    system = trajectory.rotor.system
    if system.shaft is None:
        still = np.zeros(times.shape)
        events = len(trajectory.segment_starts) - 1
        return (np.zeros(events + 2), np.ones(times.shape, complex), still, np.zeros(events, complex))
    shaft, place = system.shaft.shaft, int(system.arrays.shaft[0])
    amplitudes, phases = trajectory.amplitudes_at(times)
    speed, direction = shaft_speed(system, amplitudes), amplitudes[..., place]
    braking = np.zeros(times.shape)
    for plane, radius in enumerate(system.arrays.surface_speed - 1.0):
        braking += radius / shaft.inertia * trajectory.seen_at(plane).forces_of(amplitudes, phases, times)[1]
    held = presses(phases).any(axis=-1)
    torque = shaft.torque * speed
    turns = shaft_speed(system, trajectory.edge_amplitudes)
    jumps = turns[1:-1] - shaft_speed(system, trajectory.event_amplitudes)
    return (
        0.5 * shaft.inertia * turns**2,
        (speed**2 - 1j * braking) * direction,
        np.where(held, torque, 0.0),
        -1j * jumps * trajectory.event_amplitudes[:, place],
    )
