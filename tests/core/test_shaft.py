"""Flights at the speed that the shaft has, and what changes it in an impact."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from carom.core.flow import acceleration, displacement, velocity
from carom.core.layout import copy_of
from carom.core.shaft import change_speed, enter_flight, leave_flight, lever_of_shaft, surface_excess
from carom.models import LinearRotor, Rigid, Shaft, Touchdown

ROTOR = LinearRotor.in_fixed_frame(
    mass=[[1.0, 0.05], [0.05, 0.3]],
    damping=[[0.1, 0.01], [0.01, 0.04]],
    stiffness=[[0.6, 0.02], [0.02, 0.2]],
    forcing=[0.3 + 0.1j, 0.05 - 0.03j],
    touchdowns=[Touchdown([1.0, 0.8], Rigid(0.8), 0.2, 3.0), Touchdown([1.0, -0.7], Rigid(0.7), 0.3, 2.0)],
    shaft=Shaft(2.0),
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
    a = np.linalg.solve(ROTOR.mass, ROTOR.forcing * drive - ROTOR.damping @ speed - ROTOR.stiffness @ position)
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
    felt = 1.0 / (ROTOR.planes[1] @ np.linalg.solve(ROTOR.mass, ROTOR.planes[1].conj())).real
    assert faster == pytest.approx(-0.3 * felt * 1.0 / 2.0, rel=1e-13)
    for plane in range(2):
        place = displacement(SYSTEM.arrays, plane, before)
        normal = place / abs(place)
        moved = normal.conjugate() * (velocity(SYSTEM.arrays, plane, after) - velocity(SYSTEM.arrays, plane, before))
        surface = surface_excess(SYSTEM.arrays, plane, after) - surface_excess(SYSTEM.arrays, plane, before)
        expected = lever_of_shaft(SYSTEM.arrays, plane, normal, before) * faster
        assert moved + 1j * surface == pytest.approx(expected, abs=1e-14)


def test_a_copy_of_a_record_is_its_own():
    copied = copy_of(SYSTEM.arrays)
    copied["rows"][0, 0] += 1.0
    assert copied["rows"][0, 0] != SYSTEM.arrays["rows"][0, 0]
    assert copied["columns"].tolist() == SYSTEM.arrays["columns"].tolist()
