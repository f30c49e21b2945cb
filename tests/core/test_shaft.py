"""Flights at the speed that the shaft has, and what changes it in an impact."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from turning_reference import SLIDES, Turning

from carom.core.contact_series import rub_series
from carom.core.flow import acceleration, displacement, velocity
from carom.core.layout import rub_workspace
from carom.core.phases import AWAY, BACKWARD_SLIP, FLIGHT, FORWARD_SLIP, ROLLING, lasts
from carom.core.rub import next_phase, press, rest_on_wall, wall_push
from carom.core.shaft import change_speed, enter_flight, leave_flight, lever_of_shaft, surface_excess
from carom.core.taylor import series_step, sum_series
from carom.models import Rigid, Shaft, Touchdown, from_matrices

SIGNS = {FORWARD_SLIP: 1, BACKWARD_SLIP: -1, ROLLING: 0}

ROTOR = from_matrices(
    mass=[[1.0, 0.05], [0.05, 0.3]],
    damping=[[0.1, 0.01], [0.01, 0.04]],
    stiffness=[[0.6, 0.02], [0.02, 0.2]],
    forcing=[0.3 + 0.1j, 0.05 - 0.03j],
    touchdowns=[Touchdown([1.0, 0.8], Rigid(0.8), 0.2, 3.0), Touchdown([1.0, -0.7], Rigid(0.7), 0.3, 2.0)],
    shaft=Shaft(2.0, 0.05),
)
SYSTEM = ROTOR.system
PLACE = int(SYSTEM.arrays["shaft"][0])


def turning(speed, angle):
    """Amplitudes of a state with a shaft at this speed and angle."""
    amplitudes = SYSTEM.amplitudes(np.array([0.2 + 0.1j, 0.1]), np.array([0.3, 0.5j]))
    amplitudes[PLACE], amplitudes[PLACE + 1] = np.exp(1j * angle), speed
    return amplitudes


def rates(amplitudes):
    """Rates of the amplitudes in flight, from the matrices."""
    position, speed = SYSTEM.state(amplitudes)
    drive = amplitudes[PLACE] * amplitudes[PLACE + 1].real ** 2
    a = np.linalg.solve(
        ROTOR.equations.mass,
        ROTOR.equations.forcing * drive - ROTOR.equations.damping @ speed - ROTOR.equations.stiffness @ position,
    )
    found = SYSTEM.to_modes @ np.concatenate([speed, a])
    found[PLACE] = 1j * (amplitudes[PLACE + 1].real - 1.0) * amplitudes[PLACE]
    return found


@pytest.mark.parametrize("speed", [1.0, 0.6, -0.2])
def test_a_flight_follows_the_equations(speed):
    start = turning(speed, 0.4)
    found = solve_ivp(lambda _, c: rates(c), (0.0, 7.0), start, method="DOP853", rtol=1e-13, atol=1e-14).y[:, -1]
    assert SYSTEM.fly(start, 7.0) == pytest.approx(found, abs=1e-12)


@pytest.mark.parametrize("speed", [1.0, 0.6, -0.2, 2.5])
def test_the_rotor_of_a_flight_moves_as_the_rotor_does(speed):
    start = turning(speed, 0.4)
    rotor, table = SYSTEM.own_records()
    flying = start.copy()
    enter_flight(rotor, table, flying)
    for plane in range(2):
        assert displacement(rotor, plane, flying) == pytest.approx(displacement(SYSTEM.arrays, plane, start), abs=1e-14)
        assert velocity(rotor, plane, flying) == pytest.approx(velocity(SYSTEM.arrays, plane, start), abs=1e-14)
        expected = np.einsum("k,k->", rotor["acceleration_rows"][plane], flying)
        assert acceleration(SYSTEM.arrays, plane, start) == pytest.approx(expected, abs=1e-13)
    exponent = 1j * (speed - 1.0)
    times = table["spacing"] * np.arange(len(table["growth"]))
    assert table["growth"][:, PLACE] == pytest.approx(np.exp(exponent * times) - 1.0, abs=1e-15)
    assert table["bounds"][:, PLACE] == pytest.approx(abs(exponent) ** np.arange(1, 4), rel=1e-14)
    leave_flight(rotor, flying)
    assert flying == pytest.approx(start, abs=1e-14)
    assert rotor["rows"].tolist() == SYSTEM.arrays["rows"].tolist()
    assert rotor["acceleration_rows"].tolist() == SYSTEM.arrays["acceleration_rows"].tolist()


def test_a_friction_impulse_changes_the_speed_and_moves_the_planes_by_the_lever():
    before = turning(0.7, 0.4)
    after = before.copy()
    change_speed(SYSTEM.arrays, 1, -0.3, after)
    faster = (after - before)[PLACE + 1].real
    felt = (
        1.0 / (ROTOR.equations.planes[1] @ np.linalg.solve(ROTOR.equations.mass, ROTOR.equations.planes[1].conj())).real
    )
    assert faster == pytest.approx(-0.3 * felt * 1.0 / 2.0, rel=1e-13)
    for plane in range(2):
        place = displacement(SYSTEM.arrays, plane, before)
        normal = place / abs(place)
        moved = normal.conjugate() * (velocity(SYSTEM.arrays, plane, after) - velocity(SYSTEM.arrays, plane, before))
        surface = surface_excess(SYSTEM.arrays, plane, after) - surface_excess(SYSTEM.arrays, plane, before)
        expected = lever_of_shaft(SYSTEM.arrays, plane, normal, before) * faster
        assert moved + 1j * surface == pytest.approx(expected, abs=1e-14)


def on_walls(angles, slips, speed=0.7, inside=()):
    """Amplitudes with each plane on its wall, at an angle and with a slip; or inside, at half its clearance."""
    amplitudes = turning(speed, 0.4)
    radii = SYSTEM.arrays["surface_speed"] - 1.0
    places = np.exp(1j * np.array(angles)) * [0.5 if plane in inside else 1.0 for plane in (0, 1)]
    rates = 1j * (np.array(slips) - radii * speed - 1.0) * places
    found = SYSTEM.amplitudes(
        np.linalg.solve(ROTOR.equations.planes, places), np.linalg.solve(ROTOR.equations.planes, rates)
    )
    found[PLACE : PLACE + 2] = amplitudes[PLACE : PLACE + 2]
    return found


def reference_at(amplitudes, contact=()):
    """Reference and its numbers in a state."""
    reference = Turning(ROTOR)
    for plane, phase in enumerate(contact):
        if lasts(phase):
            reference.phases[plane], reference.senses[plane] = SLIDES, SIGNS[phase]
    position, speed = SYSTEM.state(amplitudes)
    return reference, reference.start(position, speed, amplitudes[PLACE + 1].real, np.angle(amplitudes[PLACE]))


@pytest.mark.parametrize(
    ("contact", "slips"),
    [
        ((FORWARD_SLIP, BACKWARD_SLIP), (0.3, -2.0)),
        ((ROLLING, FORWARD_SLIP), (0.0, 0.4)),
        ((ROLLING, ROLLING), (0.0, 0.0)),
        ((FORWARD_SLIP, AWAY), (0.3, 0.1)),
    ],
)
def test_the_series_of_contact_has_the_forces_of_the_equations_and_keeps_to_them(contact, slips):
    amplitudes = on_walls((0.4, 1.1), slips, inside=[1] if contact[1] == AWAY else [])
    work = rub_workspace(SYSTEM.modes, 2)
    rub_series(SYSTEM.arrays, np.array(contact), amplitudes, work)
    reference, y = reference_at(amplitudes, contact)
    forces = reference.forces(y)
    for plane, (normal, along) in forces.items():
        assert work.push[plane, 0] * SYSTEM.arrays["masses"][plane] == pytest.approx(normal, abs=1e-12)
        assert work.grip[plane, 0] * SYSTEM.arrays["masses"][plane] == pytest.approx(along, abs=1e-12)
    assert work.series[1, PLACE + 1].real == pytest.approx(reference.rates(y, forces)[9], abs=1e-13)
    moved = np.empty(SYSTEM.modes, complex)
    sum_series(work, series_step(work), moved)
    assert abs(moved[PLACE]) == pytest.approx(1.0, abs=1e-14)
    later, at = reference_at(moved)
    for plane in forces:
        radius, _, along = later.local(plane, at)
        assert radius == pytest.approx(1.0, abs=1e-13)
        assert along.real == pytest.approx(0.0, abs=1e-12)
        if contact[plane] == ROLLING:
            assert later.slip(plane, at) == pytest.approx(0.0, abs=1e-12)


def test_what_keeps_a_plane_on_its_wall_and_its_rate():
    amplitudes = on_walls((0.4, 1.1), (0.3, 0.1), inside=[1])
    work = rub_workspace(SYSTEM.modes, 2)
    assert wall_push(SYSTEM.arrays, 0, amplitudes) == pytest.approx(
        press(SYSTEM.arrays, np.array([FLIGHT, AWAY]), 0, amplitudes, work), abs=1e-13
    )
    rest_on_wall(SYSTEM.arrays, 0, amplitudes, True)
    reference, y = reference_at(amplitudes)
    assert reference.slip(0, y) == pytest.approx(0.0, abs=1e-14)
    assert next_phase(SYSTEM.arrays, np.array([FLIGHT, AWAY]), 0, amplitudes, work) in SIGNS
