"""Torque of balls, temperatures and growth in a landing: against closed forms, integrators, the ledger and geometry."""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

import carom as cm
from carom.motions import Network, ball_torque, drop_loads, energy_ledger, follow_loads, simulation, thermal_network
from carom.motions.heating import RaceRecord, Temperatures
from carom.motions.kinematics import race_speed
from carom.parameters import TouchdownBearing

SIZES = {"balls": 16, "ball_diameter": "7.94 mm", "race_diameter": "60 mm", "race_inertia": 4e-5, "race_mass": 0.09}
FLOWS = {
    "shaft_conductance": 2.0,
    "landing_conductance": 1.0,
    "inner_conductance": 0.5,
    "outer_conductance": 0.7,
    "housing_conductance": 5.0,
}
TORQUES = {"torque_factor": 2, "load_factor": 0.0008, "viscosity": "30 mm^2/s"}


def bearing(**others):
    return TouchdownBearing("hunt-crossley", dissipation=0.5, **SIZES | others)


def test_one_body_in_closed_form():
    """``P/G (1 − e^(−Gt/C))``, and ``Pt/C`` without conductance, to rounding."""
    times = np.linspace(0.0, 90.0, 31)
    heats = 7.0 * np.diff(times)[:, None]
    found = Network(np.array([40.0]), np.array([[2.0]])).rises(np.diff(times), heats)[:, 0]
    np.testing.assert_allclose(found, 3.5 * -np.expm1(-times / 20.0), rtol=1e-13)
    alone = Network(np.array([40.0]), np.array([[0.0]])).rises(np.diff(times), heats)[:, 0]
    np.testing.assert_allclose(alone, 7.0 * times / 40.0, rtol=1e-13)


def test_the_steady_state_lets_out_what_comes_in():
    network = thermal_network(bearing(**FLOWS))
    power = np.array([3.0, 2.0, 5.0, 0.0])
    end = network.rises(np.array([1e6]), 1e6 * power[None])[-1]
    np.testing.assert_allclose(end, np.linalg.solve(network.conductances, power), rtol=1e-12)
    assert 2.0 * end[0] + 5.0 * end[3] == pytest.approx(10.0, rel=1e-12)


@pytest.mark.parametrize("flows", [FLOWS, {"inner_conductance": 0.5}])
def test_heat_in_pieces_against_integrators(flows):
    """Against the exponential of the whole matrix, whose last row counts what is lost, to 1e-11, and DOP853 at 1e-11, to 1e-8; the balance to 1e-12."""
    network, rng = thermal_network(bearing(**flows)), np.random.default_rng(4)
    durations, heats = rng.uniform(0.0, 30.0, 12), rng.uniform(0.0, 400.0, (12, 4))
    durations[3] = 0.0
    found = network.rises(durations, heats)
    lost = network.conductances.sum(axis=0)
    state, other = np.zeros(5), np.zeros(4)
    rates = -network.conductances / network.capacities[:, None]
    for lasted, heat, reached in zip(durations, heats, found[1:], strict=True):
        matrix = np.zeros((6, 6))
        matrix[:4, :4], matrix[4, :4], matrix[:4, 5] = rates * lasted, lost * lasted, heat / network.capacities
        state = (expm(matrix) @ np.append(state, 1.0))[:5]
        np.testing.assert_allclose(reached, state[:4], rtol=1e-11)
        power = heat / network.capacities / (lasted or 1.0)
        if lasted:
            course = solve_ivp(lambda _, y: rates @ y + power, (0.0, lasted), other, "DOP853", rtol=1e-11, atol=1e-11)  # noqa: B023
            other = course.y[:, -1]
        else:
            other = other + heat / network.capacities
        np.testing.assert_allclose(reached, other, rtol=1e-8)
    assert network.capacities @ found[-1] + state[4] == pytest.approx(heats.sum(), rel=1e-12)


@pytest.mark.parametrize(("angle", "load"), [(0.0, {}), (0.4, {"preload": 50.0}), (0.4, {"internal_clearance": 1e-5})])
def test_growth_is_that_of_the_geometry(angle, load):
    """Centres of the grooves move apart with their rings, radially and along the axis; grooves and balls grow.  Expansion is linear in the temperature, so that a small one agrees to its size."""
    angled = {"contact_angle": angle} if angle else {}
    given = bearing(expansion=1.2e-5, ball_expansion=3e-6, outer_conformity=0.53, **angled, **load)
    ring, warm = given.ring, np.array([0.0, 3e-3, 1e-3, 2e-3])
    found = Temperatures(given, np.array([0.0, 1.0]), 20.0 + np.stack([0.0 * warm, warm])).closures
    size, pitch = ring.ball_diameter, ring.pitch_diameter

    def pressed(_, race, balls, outer):
        inner, outside = 1.0 + 1.2e-5 * race, 1.0 + 1.2e-5 * outer
        radial = [0.5 * pitch + (f - 0.5) * size * sign * math.cos(angle) for f, sign in ((0.52, 1.0), (0.53, -1.0))]
        axial = [(f - 0.5) * size * math.sin(angle) for f in (0.52, 0.53)]
        apart = math.hypot(radial[0] * inner - radial[1] * outside, axial[0] * inner + axial[1] * outside)
        return apart - 0.52 * size * inner - 0.53 * size * outside + size * (1.0 + 3e-6 * balls)

    assert np.diff(found)[0] == pytest.approx(pressed(*warm) - pressed(0.0, 0.0, 0.0, 0.0), rel=1e-6)
    alike = bearing(**angled)
    same = Temperatures(alike, np.array([0.0, 1.0]), 20.0 + np.stack([0.0 * warm, 0.0 * warm + 50.0])).closures
    assert np.abs(same).max() < 1e-18


def test_clamped_balls_are_told():
    """Balls of a race that grows by more than its clearance bear ``K δ^1.5`` each; a preload grows, with the axial position kept."""
    values = 20.0 + np.array([[0.0] * 4, [0.0, 100.0, 0.0, 0.0], [0.0, 40.0, 0.0, 0.0]])
    found = Temperatures(bearing(internal_clearance="20 um"), np.arange(3.0), values)
    depth = 0.5 * (11.5e-6 * 100.0 * 60e-3 - 20e-6)
    assert found.growth == pytest.approx(11.5e-6 * 100.0 * 60e-3, rel=1e-12)
    assert found.clearance_left == pytest.approx(-2.0 * depth, rel=1e-12)
    assert found.load_by_growth == pytest.approx(found.bearing.ring.ball_stiffness * depth**1.5, rel=1e-12)
    assert (found.highest, found.hottest, found.preload_at_most) == (120.0, "race", None)
    assert "WARNING: the balls are clamped" in dict(found.rows())["growth by heat"]
    still = Temperatures(bearing(contact_angle=0.3, preload=80.0), np.arange(2.0), np.full((2, 4), 20.0))
    assert still.preload_at_most == pytest.approx(80.0, rel=1e-12)


def test_the_torque_of_palmgren_in_his_units():
    """N mm from mm, mm²/s and rpm; the load is the radial one, or by the preload of all rows."""
    found = ball_torque(bearing(**TORQUES), np.array([0.0, -400.0 * math.pi]), np.array([0.0, 500.0]))
    viscous = 2e-7 * np.array([160.0, (30.0 * 12000.0) ** (2.0 / 3.0)]) * 67.94**3
    np.testing.assert_allclose(1e3 * found, viscous + 0.0008 * np.array([0.0, 500.0]) * 67.94, rtol=1e-12)
    pressed = bearing(load_factor=0.001, contact_angle=0.3, preload=400.0, rows=2)
    loads = np.array([0.0, 100.0, 3000.0])
    np.testing.assert_allclose(
        ball_torque(pressed, 100.0 + 0.0 * loads, loads), 6.794e-5 * np.array([800.0, 790.0, 3000.0]), rtol=1e-12
    )
    assert ball_torque(bearing(running_torque=0.02), np.array([3.0]), np.array([5.0])) == 0.02
    assert ball_torque(bearing(race_drag=1e-4), np.array([-30.0]), np.array([5.0])) == pytest.approx(3e-3, rel=1e-14)


STATED = 'torque_factor = 1\nload_factor = 0.001\nviscosity = "20 mm^2/s"\nrace_mass = 0.02\nstarting_torque = 0.01\n'


@pytest.mark.jit_only
@pytest.mark.parametrize("name", ["touchdown-balls", "tum-flexible-rotor"])
def test_the_heat_of_a_landing(tmp_path, name, monkeypatch):
    """Of balls integrated in SI units over each segment of the motion, and all of it is in the parts; the same in pieces."""
    own = (
        ""
        if "balls" in name
        else 'race_inertia = "2e-6 kg m^2"\nballs = 9\nball_diameter = "2.5 mm"\nrace_diameter = "9 mm"\n'
    )
    lines = Path(f"examples/{name}.toml").read_text(encoding="utf-8").splitlines()
    path = tmp_path / "machine.toml"
    path.write_text(
        "".join(f"{line}\n{own + STATED if line.startswith('law =') else ''}" for line in lines), encoding="utf-8"
    )
    case = cm.load(path)
    motion = cm.simulate(case, cm.drop(), "25 ms")
    nodes, weights = np.polynomial.legendre.leggauss(14)
    starts, lasted = np.array(motion.segment_starts), motion.durations
    times = (starts[:, None] + 0.5 * lasted[:, None] * (1.0 + nodes)).ravel()
    planes = drop_loads(motion).planes
    for seen, plane in zip(motion.at_each, planes, strict=True):
        scales, race, stated = seen.scales, seen.rotor.races[seen.plane], seen.rotor.definition.bearing_at(seen.plane)
        speed = race_speed(seen.rotor.system, seen.plane, motion.amplitudes_at(times)[0]) / race.radius * scales.speed
        power = ball_torque(stated, speed, seen.history(times).normal_force * scales.force) * np.abs(speed)
        heat = (power.reshape(-1, 14) @ weights) @ (0.5 * lasted) * scales.time
        # The speed in a segment of contact is taken as linear, and its force as the mean.
        assert plane.turning.heat * scales.energy == pytest.approx(heat, rel=3e-4)
        rises = plane.temperatures.values[-1] - plane.temperatures.values[0]
        whole = (plane.turning.heat + plane.heat) * scales.energy
        assert thermal_network(stated).capacities @ rises == pytest.approx(whole, rel=1e-12)
        assert plane.si()["temperature"] == plane.temperatures.highest > 20.0
        assert plane.temperatures.times[-1] == pytest.approx(0.025, rel=1e-12)
        assert plane.turning.starts_at == pytest.approx(0.01 / (0.15 * race.radius * scales.length), rel=1e-12)
    monkeypatch.setattr(simulation, "CHUNK", 5)
    for one, other in zip(follow_loads(case, cm.drop(), "25 ms").planes, planes, strict=True):
        np.testing.assert_allclose(one.temperatures.values[-1], other.temperatures.values[-1], rtol=1e-10)
        assert one.turning.speed_ratio == pytest.approx(other.turning.speed_ratio, rel=1e-10)


@pytest.mark.jit_only
def test_the_drag_of_a_race_heats_its_balls():
    """Against the ledger; a race that comes up to speed, its cage, and the traction by the equations of race and balls."""
    given = ("race_inertia=2e-6", "ball_density=7800", "contact_angle=20 deg")
    case = cm.load("examples/touchdown-balls.toml", [f"touchdown_{each}" for each in given])
    motion = cm.simulate(case, cm.drop(), "60 ms")
    (plane,) = drop_loads(motion).planes
    assert plane.turning.heat == pytest.approx(-energy_ledger(motion).race_drag[-1], rel=1e-4)
    course = race_speed(motion.rotor.system, 0, motion.edge_amplitudes)
    reached = np.append(motion.segment_starts, motion.time)[course > 0.95 * 80.0]
    assert plane.turning.up_to_speed_at == reached[0]
    ring, radius = case.touchdown.ring, 20.25e-3
    inner = 0.5 * (51.35e-3 - 6.35e-3 * math.cos(math.radians(20.0)))
    turned = np.array([[2e-6, inner], [ring.inertia(7800.0), -inner]])
    assert plane.turning.ball_traction == pytest.approx(np.linalg.solve(turned, [0.15 * radius, 0.0])[1], rel=1e-9)
    cage = plane.turning.cage_speed / plane.race_at_end
    # The centre of a ball moves at half the speed of the race at the contact.
    assert cage * 0.5 * 51.35e-3 == pytest.approx(0.5 * inner, rel=1e-12)
    assert plane.temperatures is None


def test_long_records_keep_their_heat_and_their_time():
    record, rng = RaceRecord(), np.random.default_rng(1)
    pieces = rng.uniform(0.0, 1.0, (40_000, 4))
    pieces[7, 0] = 1e3
    for part in np.array_split(pieces, 9):
        record.pieces = np.concatenate([record.pieces, part])
    record.pieces = cm.motions.heating._gathered(record.pieces, 100)
    assert len(record.pieces) <= 2050
    np.testing.assert_allclose(record.pieces.sum(axis=0), pieces.sum(axis=0), rtol=1e-12)
