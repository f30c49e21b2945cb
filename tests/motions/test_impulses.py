"""Impulses and forces at planes that feel a part of the mass: against momentum and energy of the whole rotor."""

import numpy as np
import pytest
from compilation import sized
from linear_rotors import random_rotor, tilting, to_fixed, touchdowns

from carom.base.outcome import Phase
from carom.closed_forms import find_equilibria
from carom.models import from_matrices
from carom.motions import State, Trajectory, drop_loads, energy_ledger, simulate
from carom.parameters import Scales

pytestmark = pytest.mark.jit_only


def at_random(random: np.random.Generator) -> Trajectory:
    """A motion with contact of a rotor of several coordinates and planes."""
    while True:
        rotor = random_rotor(int(random.integers(2**31)), n=2, planes=2)
        if rotor.system.rest_radius >= 1.0:
            continue
        velocity = random.normal(size=2) + 1j * random.normal(size=2)
        motion = simulate(rotor, State(rotor.system.rest, 3.0 * velocity), 8.0, max_events=400)
        if motion.is_impact.sum() > 3:
            return motion


def coordinates(motion: Trajectory, amplitudes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    n = len(motion.rotor.equations.mass)
    return tuple(np.reshape(part, (-1, n)) for part in motion.rotor.system.state(amplitudes))


def test_momentum_changes_by_the_logged_impulses():
    """``M ΔU̇ = Σ Wᴴ (−p_n + i p_t) e^{iθ}`` over the impacts of an instant, with the matrices of the rotor."""
    random = np.random.default_rng(41)
    for _ in range(sized(12, 4, 200)):
        motion = at_random(random)
        rotor = motion.rotor
        log = motion.log_of(motion.is_impact)
        hits, events = np.unique(motion.impulses(motion.is_impact).events, return_inverse=True)
        assert np.array_equal(hits, np.flatnonzero(motion.is_impact))
        push = (-log.normal_impulse + 1j * log.friction_impulse) * np.exp(1j * log.angle)
        given = np.zeros((len(hits), len(rotor.equations.mass)), complex)
        np.add.at(given, events, push[:, None] * rotor.equations.planes.conj()[log.touchdown_bearing - 1])
        _, before = coordinates(motion, motion.event_amplitudes[hits])
        _, after = coordinates(motion, motion.segment_amplitudes[1:][hits])
        changed = (after - before) @ rotor.equations.mass.T
        # Velocities are sums over modes.
        size = np.linalg.cond(rotor.system.basis) * (1.0 + np.abs(before).max())
        assert np.abs(changed - given).max() < 1e-13 * size


def test_energy_changes_by_the_works_of_the_log():
    random = np.random.default_rng(42)
    for _ in range(sized(12, 4, 200)):
        motion = at_random(random)
        mass, log, hits = motion.rotor.equations.mass, motion.log_of(motion.is_impact), np.flatnonzero(motion.is_impact)
        energies = []
        for amplitudes in (motion.event_amplitudes[hits], motion.segment_amplitudes[1:][hits]):
            _, speed = to_fixed(motion.segment_starts[1:][hits], *coordinates(motion, amplitudes))
            energies.append(0.5 * np.einsum("ki,ij,kj->k", speed.conj(), mass, speed).real)
        gained = energies[1] - energies[0]
        size = np.linalg.cond(motion.rotor.system.basis) * (1.0 + energies[0].max())
        events = np.searchsorted(hits, motion.impulses(motion.is_impact).events)
        worked = np.bincount(events, log.contact_work + log.drive_work)
        assert np.abs(gained - worked).max() < 1e-13 * size


def test_forces_and_impulses_add_up_to_the_change_of_momentum():
    """Over motions with impacts, sliding and rolling at two planes: ``M U̇ + D U`` integrates all forces."""
    rubbed = 0
    random = np.random.default_rng(43)
    for _ in range(sized(6, 3, 60)):
        phase = np.exp(2j * np.pi * random.random())
        rotor = tilting(
            forcing=np.array([0.85, 0.3 * random.random()]) * phase,
            mass=np.diag([1.0, random.uniform(0.2, 0.9)]),
            friction=random.uniform(0.05, 0.3),
        ).model
        motion = simulate(rotor, State(np.zeros(2, complex), random.normal(size=2) * phase), 30.0)
        rubbed += (motion.segment_phases != Phase.FLIGHT).all(axis=1).any()
        nodes, weights = np.polynomial.legendre.leggauss(20)
        edges = np.unique(np.concatenate([motion.segment_starts, np.linspace(0.0, 30.0, 300)]))
        half = 0.5 * np.diff(edges)
        times = (edges[:-1] + half)[:, None] + half[:, None] * nodes
        position, _ = motion.at(times)
        force = rotor.equations.forcing - position @ rotor.equations.stiffness.T
        for plane, row in enumerate(rotor.equations.planes):
            seen = motion.seen_at(plane)
            normal, friction = seen.forces(times)
            force += ((-normal + 1j * friction) * seen.at_plane(times)[0])[..., None] * row.conj()
        supplied = np.einsum("k,j,kjn->n", half, weights, force)
        for events in (motion.is_impact, motion.is_landing):
            log = motion.log_of(events)
            push = (-log.normal_impulse + 1j * log.friction_impulse) * np.exp(1j * log.angle)
            supplied += push @ rotor.equations.planes.conj()[log.touchdown_bearing - 1]
        change = (motion.final.velocity - motion.start.velocity) @ rotor.equations.mass.T
        change += (motion.final.position - motion.start.position) @ rotor.equations.damping.T
        # Every event is known to the rounding of its instant, in which the largest force may act or not.
        rounding = np.spacing(30.0) * np.abs(force).max() * len(motion.segment_starts)
        assert np.abs(change - supplied).max() < min(4.0 * rounding, 1e-11 * max(10.0, np.abs(change).max()))
    assert rubbed


def test_loads_of_all_planes_are_what_the_ledger_says():
    random = np.random.default_rng(44)
    for _ in range(sized(8, 3, 100)):
        motion = at_random(random)
        ledger, planes = energy_ledger(motion), range(len(motion.rotor.equations.planes))
        loads = [drop_loads(motion).planes[plane] for plane in planes]
        lost = sum(each.heat + each.restitution_loss for each in loads)
        assert lost == pytest.approx(-(ledger.impacts[-1] + ledger.friction[-1]), rel=1e-9)
        assert ledger.imbalance < 1e-9


def test_an_impulse_in_newton_seconds():
    """Half a rigid rotor of 50 kg hits the plane at its end: written down by hand."""
    mass, inertia, arm, clearance, speed = 50.0, 2.0, 0.25, 0.25e-3, 300.0
    # Coordinates: displacement of the centre and of the end due to tilt, both in clearances.
    matrix = np.diag([1.0, inertia / (mass * arm**2)])
    rotor = from_matrices(
        mass=matrix, damping=0.01 * np.eye(2), stiffness=0.2 * np.eye(2), forcing=np.zeros(2),
        touchdowns=touchdowns([[1.0, 1.0]], [0.0], [0.6], [150.0]),
        translation=[1.0, 0.0], scales=Scales(mass=mass, clearance=clearance, speed=speed),
    )  # fmt: skip
    motion = simulate(rotor, State(np.zeros(2, complex), np.array([0.7, 0.3 + 0j])), 4.0)
    first = motion.contacts.to_dataset().isel(contact=0)
    felt = 1.0 / (1.0 / mass + arm**2 / inertia)
    assert float(first["normal_impulse"]) == pytest.approx(felt * 1.6 * float(first["radial_speed"]), rel=1e-12)


def test_forces_of_rubs_are_those_of_the_motion():
    """Equilibria, by statics, and a motion that rests there, by its forces."""
    model = tilting(forcing=np.array([0.88 + 0.18j, 0.05])).model
    found = simulate(model, State(np.zeros(2, complex), np.zeros(2, complex)), settle=True)
    rubs = [at for at in find_equilibria(model) if at.planes == (0, 1) and at.stable]
    nearest = min(rubs, key=lambda at: np.abs(at.position - found.final.position).max())
    own = [float(found.seen_at(plane).forces(np.array(found.time))[0]) for plane in (0, 1)]
    assert np.allclose(nearest.normal_forces, own, rtol=1e-6)
