"""Touchdown bearings with different clearances: results of each plane in SI units."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from flexible_machines import SOFT, munich
from linear_rotors import planar_rotor
from scipy.integrate import solve_ivp

import carom as cm
from carom.models import Rigid, Touchdown
from carom.orbits import find_orbits
from carom.parameters import Scales, TouchdownBearing
from carom.plots.plane import orbit_path
from carom.rotors import TouchdownPlane, load_machine, synchronous_response
from carom.studies import found_orbits_document

RACE = {"race_inertia": 1e-5, "race_drag": 1e-6, "mount_mass": 0.3, "mount_stiffness": 2e6, "mount_damping": 50.0}
WALLS = {
    "soft": SOFT,
    "curved": TouchdownBearing("hunt-crossley", 1e8, dissipation=0.5, exponent=1.5, **RACE),
    "restituting": TouchdownBearing("kelvin-voigt", 1e7, restitution=0.6),
}


def with_clearances(machine, clearances, unit):
    """The machine with these clearances, in which lengths have another unit."""
    planes = zip(machine.touchdowns, clearances, strict=True)
    touchdowns = [dataclasses.replace(plane, clearance=clearance) for plane, clearance in planes]
    return dataclasses.replace(machine, clearance=unit, touchdowns=touchdowns)


@pytest.mark.jit_only
@pytest.mark.parametrize("wall", WALLS)
def test_the_unit_of_lengths_changes_no_result_in_si_units(wall):
    """Clearances of the machine, and the same stated by each bearing of a machine with another unit of length."""
    found = []
    for machine in (
        with_clearances(munich(touchdown=WALLS[wall]), (None, 0.3e-3), 0.2e-3),
        with_clearances(munich(touchdown=WALLS[wall]), (0.2e-3, None), 0.3e-3),
        with_clearances(munich(touchdown=WALLS[wall]), (0.2e-3, 0.3e-3), 0.07e-3),
    ):
        motion = cm.simulate(machine.with_modes(4).model, cm.drop(), "9 ms")
        loads = cm.motions.drop_loads(motion).planes
        rows = [[*plane.si().values(), plane.force_at * plane.scales.time] for plane in loads]
        for plane in (0, 1):
            seen = motion.seen_at(plane)
            dataset = seen.to_dataset(seen.sample(50))
            rows.append(np.append(dataset["x"].values[[5, 20]] / 0.2e-3, dataset["normal_force"].values.max()))
            rows.append([seen.contacts.to_dataset()[name].values[0] for name in ("deepest", "radial_speed", "heat")])
        found.append(np.concatenate(rows))
    for other in found[1:]:
        # Each contact enlarges what rounding has changed.
        assert other == pytest.approx(found[0], rel=1e-6, abs=1e-6)


def test_the_file_states_a_clearance_for_each_bearing(tmp_path):
    first, second = Path("examples/tum-flexible-rotor.toml").read_text(encoding="utf-8").rsplit('"0.2 mm"', 1)
    (tmp_path / "two.toml").write_text(f'{first}"0.3 mm"{second}', encoding="utf-8")
    machine = load_machine(tmp_path / "two.toml")
    assert machine.clearances == pytest.approx((0.2e-3, 0.3e-3))
    assert machine.clearance == pytest.approx(0.2e-3)
    response = synchronous_response(machine, [50.0])
    sizes = response.touchdowns.major[0] + response.sags
    assert response.reach[0] == pytest.approx(sizes / np.array([0.2e-3, 0.3e-3]))
    assert [machine.model.system.scales_at(plane, machine.model.scales).length for plane in (0, 1)] == pytest.approx(
        [0.2e-3, 0.3e-3]
    )


@pytest.mark.jit_only
def test_two_clearances_against_an_integrator_in_si_units():
    """A drop with contacts in clearances of 0.15 and 0.25 mm, by ``solve_ivp`` with the equations of motion in m and N."""
    wall = TouchdownBearing("kelvin-voigt", stiffness=3e6, damping=300.0)
    touchdowns = [TouchdownPlane(2, wall, 4.8e-3, 0.15, 0.15e-3), TouchdownPlane(12, wall, 4.8e-3, 0.15, 0.25e-3)]
    machine = munich(touchdowns=touchdowns, clearance=0.2e-3).with_modes(3)
    model, end = machine.model, 0.011
    motion = cm.simulate(model, cm.drop(), f"{end} s")
    found = [motion.seen_at(plane).contacts.to_dataset() for plane in (0, 1)]

    system = _Dropped(machine)
    place, velocity = (part * model.scales.length for part in model.system.kicked(0.0))
    # Rates of the co-rotating frame, in which a place at rest turns.
    start = np.concatenate([place, (velocity + 1j * place) * model.scales.speed])
    assert model.without_levitation().scales == model.scales
    times = np.linspace(0.0, end, 20001)
    solved = solve_ivp(system.rates, (0.0, end), start, "DOP853", times, rtol=1e-9, atol=1e-13, max_step=2e-5)
    forces = np.array([system.normal(state) for state in solved.y.T])
    for plane in (0, 1):
        touched = forces[:, plane] > 0.0
        assert touched.any()
        first = times[touched.argmax()]
        assert found[plane]["time"].values[0] == pytest.approx(first, abs=times[1])
        # To the distance of the samples: a peak is flat.
        assert found[plane]["peak_force"].values.max() == pytest.approx(forces[:, plane].max(), rel=1e-4)


class _Dropped:
    """The reduced rotor without levitation, in m, N and s, on walls that push and rub; a state holds places, then rates, of all coordinates."""

    def __init__(self, machine):
        own, at = machine.equations, machine.machine
        has_mass = own.mass.any(axis=1)
        self.kept = np.flatnonzero(has_mass)
        pick = np.ix_(has_mass, has_mass)
        self.speed, self.walls = (
            at.speed,
            [(each, room) for each, room in zip(at.touchdowns, at.clearances, strict=True)],
        )
        self.spin = own.unlevitated[0][pick] - 1j * self.speed * own.gyroscopic[pick]
        self.stiffness, self.planes = own.unlevitated[1][pick], own.rows.touchdowns[:, has_mass]
        self.forcing = self.speed**2 * own.forcing[has_mass]
        self.weight = np.zeros(len(self.kept), complex)
        self.weight[0] = -9.81j * np.sqrt(at.rotor.mass)
        self.unit = np.sqrt(at.rotor.mass)
        self.count = len(has_mass)

    def contact(self, plane, place, rate):
        """Normal force and the force on the rotor."""
        wall, room = self.walls[plane]
        at, speed = self.planes[plane] @ place, self.planes[plane] @ rate
        radius = abs(at)
        out = (at.conjugate() * speed).real / radius
        force = wall.bearing.stiffness * (radius - room) + wall.bearing.damping * out
        normal = max(force, 0.0) if radius > room else 0.0
        # The surface of the shaft is far faster than its axis: the contact slips forward.
        return normal, -normal * (1.0 + 1j * wall.friction) * at / radius

    def split(self, state):
        place, rate = state[: self.count], state[self.count :]
        return place[self.kept] * self.unit, rate[self.kept] * self.unit

    def normal(self, state):
        place, rate = self.split(state)
        return [self.contact(plane, place, rate)[0] for plane in (0, 1)]

    def rates(self, time, state):
        place, rate = self.split(state)
        push = self.forcing * np.exp(1j * self.speed * time) + self.weight - self.spin @ rate - self.stiffness @ place
        for plane in (0, 1):
            push = push + self.planes[plane] * self.contact(plane, place, rate)[1]
        change = np.zeros_like(state)
        change[: self.count] = state[self.count :]
        change[self.count + self.kept] = push / self.unit
        return change


@pytest.mark.jit_only
def test_orbits_are_told_in_the_clearance_of_their_plane():
    """One coordinate and one wall in two units of length: the same orbits, in N s, m/s and mm."""
    gamma, omega, rho, wide = 0.1, 0.76, 3.0 / 7.0, 2.0
    found = []
    for unit in (1.0, wide):  # clearances in the unit of length
        plane = Touchdown([1.0 / unit], Rigid(0.95), 0.15, 21.0, clearance=unit)
        rotor = planar_rotor(gamma, omega**2, rho * unit, [plane], scales=Scales(3.0, 1e-3 / unit, 200.0))
        orbits = find_orbits(rotor, impacts=1, guesses=60)
        # Beside it the rolling backward whirl, which has no impact.
        (stable,) = (orbit for orbit in orbits if orbit.stable and orbit.impacts == 1)
        entries = found_orbits_document(orbits)["orbits"]
        (entry,) = (each for each in entries if each["stable"] and each["name"] == str(stable.name))
        circle = orbit_path(stable, 1, 0)[1]
        found.append([entry["period_si"], entry["radial_speed_si"], entry["normal_impulse_si"], np.abs(circle).max()])
    assert found[1] == pytest.approx(found[0], rel=1e-9)
