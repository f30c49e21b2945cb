"""What the touchdown bearing gets: the log of impacts, its units, and the forces of lasting contact at every instant."""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest
from compilation import sized
from drawn_motions import EVENTS, MANY
from hypothesis import given
from hypothesis import strategies as st
from linear_rotors import random_rotor, single, tilting, to_fixed, touchdowns
from machines import PAPER, SCALES
from yielding_walls import with_walls

from carom import kick
from carom.base.outcome import Phase
from carom.closed_forms import find_equilibria
from carom.models import HuntCrossley, KelvinVoigt, from_matrices, jeffcott
from carom.motions import State, Trajectory, drop_loads, energy_ledger, simulate
from carom.parameters import Parameters, Scales

START = State(0.3 + 0.1j, 0.9 - 0.4j)
EPSILON = 2.0**-52
INSTANTS = sized(400, 12)


@pytest.fixture(scope="module")
def motion():
    return simulate(jeffcott(PAPER), START, 30.0)


class TestContactLog:
    def test_states_before_and_after(self, motion):
        log = motion.contacts
        position, velocity = motion.at(log.time)
        assert np.allclose(log.angle, np.angle(position), rtol=0, atol=1e-14)
        assert np.allclose(log.radial_speed_after, (position.conj() * velocity).real, rtol=0, atol=1e-13)
        assert np.allclose(log.angular_speed_after, (position.conj() * velocity).imag, rtol=0, atol=1e-13)
        assert np.all(log.radial_speed > 0)
        assert np.allclose(log.radial_speed_after, -PAPER.d * log.radial_speed, rtol=1e-12, atol=0)

    def test_impulses_and_slip(self, motion):
        log = motion.contacts
        assert np.allclose(log.normal_impulse, (1.0 + PAPER.d) * log.radial_speed, rtol=1e-12, atol=0)
        assert np.allclose(log.slip_before, PAPER.radius_ratio + 1.0 + log.angular_speed, rtol=1e-15, atol=0)
        assert np.allclose(log.slip_after - log.slip_before, log.friction_impulse, rtol=0, atol=1e-13)
        assert not log.sticks.any()
        assert np.allclose(log.friction_impulse, -PAPER.mu * log.normal_impulse, rtol=0, atol=1e-13)

    def test_slip_that_stops(self):
        rotor = jeffcott(PAPER.replace(mu=2.0, radius_ratio=0.5))
        log = simulate(rotor, State(0.2, 3.0 + 1.0j), 20.0).contacts
        assert log.sticks.any()
        assert np.allclose(log.slip_after[log.sticks], 0.0, rtol=0, atol=1e-14)

    def test_dataset(self, motion):
        log = motion.contacts
        plain, si = log.to_dataset(), replace(log, scales=SCALES).to_dataset()
        assert dict(plain.sizes) == {"contact": len(log)}
        assert plain["time"].attrs == {
            "units": "1/Omega",
            "long_name": "time of the impact, of entering the wall, or of the start of the motion",
        }
        assert si["normal_impulse"].attrs["units"] == "N s"
        assert plain["heat"].attrs["units"] == "m c_r^2 Omega^2"
        for name in plain:
            assert plain[name].attrs["long_name"]
            assert np.array_equal(plain[name].values, getattr(log, name), equal_nan=plain[name].dtype.kind == "f")

    def test_an_empty_log(self):
        motion = simulate(jeffcott(PAPER.replace(gamma=0.3, rho=0.1)), kick(0.0), 5.0)
        assert len(motion.contacts) == 0
        assert motion.contacts.to_dataset().sizes["contact"] == 0
        assert motion.sample(10).shape == (10,)

    def test_works_follow_from_speeds_and_impulses_in_si_units(self, motion):
        """Joules are newton seconds times metres per second, kilograms times its square."""
        si = replace(motion.contacts, scales=SCALES).to_dataset()
        radial, radial_after = si["radial_speed"], si["radial_speed_after"]
        assert np.allclose(si["normal_impulse"], SCALES.mass * (radial - radial_after), rtol=1e-12, atol=0)
        along = SCALES.clearance * (si["angular_speed_after"] - si["angular_speed"])
        assert np.allclose(si["friction_impulse"], SCALES.mass * along, rtol=1e-9, atol=0)
        normal = -0.5 * si["normal_impulse"] * (radial + radial_after)
        friction = 0.5 * si["friction_impulse"] * (si["slip_before"] + si["slip_after"])
        assert np.allclose(-si["normal_loss"] - si["heat"], normal + friction, rtol=1e-12, atol=0)
        surface = PAPER.radius_ratio * SCALES.velocity
        assert np.allclose(si["drive_work"], -surface * si["friction_impulse"], rtol=1e-12, atol=0)


# ------------------------------------------------------------------------------------------------ force histories


def test_force_at_the_synchronous_rub_in_newtons():
    """At rest in the co-rotating frame the wall carries ``N``, and friction ``μN`` against the spin."""
    rotor = jeffcott(PAPER)
    rub = next(entry for entry in find_equilibria(rotor) if entry.kind == "rub" and entry.stable)
    resting = simulate(rotor, State(rub.position), 20.0)
    normal, friction = resting.forces(np.linspace(0.0, 20.0, 50))
    assert np.allclose(normal, rub.normal_force, rtol=1e-9, atol=0)
    assert np.allclose(friction, -PAPER.mu * rub.normal_force, rtol=1e-9, atol=0)
    # ρ sin x + μρ cos x = −γ − μ(1 − ω²) and N = ρ cos x + 1 − ω², by hand.
    kappa = 1.0 - PAPER.omega**2
    x = math.asin(-(PAPER.gamma + PAPER.mu * kappa) / (PAPER.rho * math.hypot(1.0, PAPER.mu))) - math.atan(PAPER.mu)
    newtons = SCALES.mass * SCALES.clearance * SCALES.speed**2 * (PAPER.rho * math.cos(x) + kappa)
    assert SCALES.force * normal[0] == pytest.approx(newtons, rel=1e-9)


@pytest.mark.jit_only
def test_a_history_holds_forces_slip_and_powers_in_contact_only():
    parameters = PAPER.replace(gamma=0.2, d=0.5)
    motion = simulate(jeffcott(parameters), START, 40.0)
    history = motion.history()
    touching = history.phase != Phase.FLIGHT
    assert np.array_equal(history.time, motion.sample())
    assert touching.any()
    assert not touching.all()
    normal, friction = motion.forces(history.time)
    position, velocity = motion.at(history.time)
    assert np.array_equal(history.normal_force, normal)
    assert np.array_equal(history.friction_force, friction)
    assert np.allclose(history.angle, np.angle(position), rtol=0, atol=1e-15)
    assert np.all(history.gap >= -1e-12)
    assert np.all(np.abs(history.gap[touching]) <= 1e-12)
    assert np.allclose(
        history.slip[touching], parameters.radius_ratio + 1.0 + (position.conj() * velocity).imag[touching]
    )
    for values in (
        history.normal_force,
        history.friction_force,
        history.slip,
        history.friction_power,
        history.drive_power,
    ):
        assert not values[~touching].any()
        assert values[touching].all()
    assert np.all(history.friction_power[touching] < 0.0)


def test_powers_of_a_history_sum_to_the_works_of_the_ledger():
    """Sliding at the synchronous rub, where both are steady: ``−μN(s + 1)`` lost as heat and ``μNs`` from the drive."""
    rotor = jeffcott(PAPER)
    rub = next(entry for entry in find_equilibria(rotor) if entry.kind == "rub" and entry.stable)
    resting = simulate(rotor, State(rub.position), 20.0)
    history, ledger = resting.history(np.linspace(0.0, 20.0, 11)), energy_ledger(resting)
    for power, work, slip in (
        (history.friction_power, ledger.friction, -PAPER.radius_ratio - 1.0),
        (history.drive_power, ledger.drive, PAPER.radius_ratio),
    ):
        assert np.allclose(power, PAPER.mu * rub.normal_force * slip, rtol=1e-9, atol=0)
        assert work[-1] == pytest.approx(20.0 * power[0], rel=1e-9)
    si = replace(history, scales=SCALES).to_dataset()
    assert np.allclose(si["friction_power"], si["friction_force"] * si["slip"], rtol=1e-12, atol=0)
    assert [si[name].units for name in ("normal_force", "slip", "friction_power", "gap", "time")] == [
        "N",
        "m/s",
        "W",
        "m",
        "s",
    ]


# ------------------------------------------------------------------------------------------------ at every instant


@st.composite
def rubbing(draw, phase: Phase):
    """A machine and a start that goes on in this phase: pressed, and slipping this way or rolling."""
    ratio = draw(st.floats(3.7, 60.0))
    parameters = Parameters(
        gamma=draw(st.one_of(st.just(0.0), st.floats(1e-3, 3.0))),
        # Not at resonance, where positions are summed from large terms.
        omega=draw(st.one_of(st.floats(0.2, 0.9), st.floats(1.1, 2.5))),
        rho=draw(st.one_of(st.just(0.0), st.floats(1e-3, 1.2))),
        phi=draw(st.floats(-math.pi, math.pi)),
        mu=draw(st.floats(1e-3, 1.0) if phase is not Phase.ROLLING else st.floats(0.5, 2.0)),
        d=draw(st.floats(0.0, 0.99)),
        radius_ratio=ratio,
    )
    # |W| above √(ω² + ρ) presses at every angle.
    fast = math.sqrt(parameters.omega**2 + parameters.rho) + draw(st.floats(0.01, 3.0))
    whirl = {Phase.FORWARD_SLIP: fast, Phase.BACKWARD_SLIP: -ratio - draw(st.floats(0.01, 5.0)), Phase.ROLLING: -ratio}
    position = cmath.rect(1.0, draw(st.floats(-math.pi, math.pi)))
    return parameters, State(position, 1j * (whirl[phase] - 1.0) * position)


def check_every_instant(motion: Trajectory) -> None:
    """Contact presses, friction stays in its cone and never pushes with the slip, and the rotor neither leaves nor enters."""
    parameters = motion.rotor.parameters
    for stretch in motion.lasting_contacts:
        times = np.linspace(stretch.start, stretch.end, INSTANTS, endpoint=False)
        normal, friction = motion.forces(times)
        position, velocity = motion.at(times)
        local = position.conj() * velocity
        slip = parameters.radius_ratio + 1.0 + local.imag
        speed = 1.0 + np.abs(velocity)
        # Forces are sums of terms of the size of the accelerations; a time is known to a spacing of doubles.
        rounding = (64 * EPSILON + 4 * np.spacing(stretch.end) * speed) * (
            speed**2 + parameters.omega**2 + parameters.rho
        )
        assert np.abs(np.abs(position) - 1.0).max() <= 1e-12
        assert np.all(np.abs(local.real) <= 64 * EPSILON * speed)
        assert np.all(normal >= -rounding)
        assert np.all(np.abs(friction) <= parameters.mu * normal * (1.0 + 4 * EPSILON) + rounding)
        # The slip is a sum of speeds: at the ends of a stretch it is zero to their rounding.
        slip_rounding = 64 * EPSILON * speed
        assert np.all(friction * slip <= rounding * np.abs(slip) + np.abs(friction) * slip_rounding)
        if stretch.phase is Phase.ROLLING:
            assert np.all(np.abs(slip) <= slip_rounding)
        else:
            direction = 1.0 if stretch.phase is Phase.FORWARD_SLIP else -1.0
            assert np.all(direction * slip >= -slip_rounding - rounding)
            assert np.all(np.abs(friction + direction * parameters.mu * normal) <= rounding)


@pytest.mark.parametrize("phase", [Phase.FORWARD_SLIP, Phase.BACKWARD_SLIP, Phase.ROLLING])
@MANY
@given(data=st.data())
def test_the_law_of_contact_holds_at_every_instant(phase, data):
    parameters, start = data.draw(rubbing(phase))
    motion = simulate(jeffcott(parameters), start, 8.0, max_events=EVENTS)
    first = motion.lasting_contacts[0]
    assert first.start == 0.0
    if phase is not Phase.ROLLING:
        assert first.phase is phase
    check_every_instant(motion)


@pytest.mark.jit_only
@pytest.mark.parametrize("law", [KelvinVoigt(1e3, 60.0), HuntCrossley(1e4, 0.1)])
def test_history_in_a_wall_that_gives_way(law):
    """Gap, slip and powers from position and velocity in the fixed frame; nothing where the plane has parted from its wall."""
    motion = simulate(with_walls(single(1), law), State(0.2 + 0.1j, 1.0 + 0.3j), 8.0)
    history = motion.history()
    place, rate = motion.at_plane(history.time)
    radius, speed = np.abs(place), rate + 1j * place
    held = np.isin(history.phase, (Phase.FORWARD_SLIP, Phase.BACKWARD_SLIP, Phase.ROLLING))
    parted = history.phase == Phase.SEPARATED
    assert np.array_equal(history.gap, 1.0 - radius)
    assert history.gap[held | parted].max() < 1e-12
    assert parted.any() == isinstance(law, KelvinVoigt)
    slip = 20.0 + (place.conj() * speed).imag / radius
    assert np.allclose(history.slip[held], slip[held], rtol=1e-12, atol=0)
    assert np.allclose(history.friction_force[held], -0.15 * history.normal_force[held], rtol=1e-12, atol=0)
    assert np.allclose(history.friction_power, history.friction_force * history.slip, rtol=1e-12, atol=0)
    assert np.allclose(history.drive_power, -20.0 * history.friction_force, rtol=1e-12, atol=0)
    for values in (history.normal_force, history.friction_force, history.slip, history.drive_power):
        assert not values[~held].any()
    assert not motion.contacts.is_impact.any()
    assert all(contact.phase is not Phase.SEPARATED for contact in motion.lasting_contacts)


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
