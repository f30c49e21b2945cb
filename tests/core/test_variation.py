"""Changes of a state through impact, flight and arrival, against differences of the motion itself."""

import numpy as np
import pytest
from flights import parameters

from carom.base.outcome import Outcome
from carom.core import events
from carom.core.flow import displacement, fly_all, velocity
from carom.core.friction import STOPPED, friction_margin, sense_of, slip_of, velocity_change
from carom.core.laws.choice import LAWS
from carom.core.layout import rotor_record, workspace
from carom.core.table import flight_table
from carom.core.variation import carry_through_impact, saltation_step, shift
from carom.core.wall import wall_of
from carom.models import jeffcott

STEP = 1e-3
"""Step of the differences below, whose error is of the order of its sixth power."""
STENCIL = ((3.0, 1 / 60), (2.0, -9 / 60), (1.0, 45 / 60), (-1.0, -45 / 60), (-2.0, 9 / 60), (-3.0, -1 / 60))


def difference(function, direction):
    """Derivative of a function of amplitudes in a direction, by a central difference of order six."""
    step = STEP / np.abs(direction).max()
    return sum(weight * function(share * step * direction) for share, weight in STENCIL) / step


def general_arrays():
    """Four modes, a pair among them, and two planes."""
    random = np.random.default_rng(11)
    exponents = np.array([-0.4 - 1.3j, -0.2 + 0.9j, -0.1 + 2.1j, -1j])
    rows = 0.5 * (random.normal(size=(2, 4)) + 1j * random.normal(size=(2, 4)))
    columns = random.normal(size=(4, 2)) + 1j * random.normal(size=(4, 2))
    columns[3] = 0.0
    return rotor_record(
        exponents=exponents,
        driven=np.array([False, True, False, False]),
        offsets=np.array([0.2 + 0.1j, -0.1j]),
        rows=rows,
        columns=columns,
        friction=np.array([0.6, 0.4]),
        restitution=np.array([0.8, 0.5]),
        surface_speed=np.array([1.0, -1.5]),
        law=np.array([LAWS.index("rigid"), LAWS.index("falling")]),
        law_number=np.array([0.0, 0.7]),
    )


def arrival(arrays, table, plane, amplitudes, start, horizon=20.0):
    """Time and amplitudes where a flight meets a plane."""
    work = workspace(len(amplitudes))
    outcome, time = events.first_crossing(arrays, table, plane, amplitudes, horizon, start, work)
    assert outcome == Outcome.CONTACT
    return time, work.end.copy()


def directions_of(modes):
    """All real directions."""
    return np.concatenate([np.eye(modes), 1j * np.eye(modes)]).astype(complex)


def check_carry_to_wall(arrays, table, plane, amplitudes):
    modes = len(amplitudes)
    duration, end = arrival(arrays, table, plane, amplitudes, events.INSIDE)
    outward = (displacement(arrays, plane, end).conjugate() * velocity(arrays, plane, end)).real
    if outward < 0.5:
        return False
    carried, delays = directions_of(modes), np.empty(2 * modes)
    saltation_step(arrays, plane, duration, end, carried, delays)
    for direction, found, delay in zip(directions_of(modes), carried, delays, strict=True):

        def moved(change):
            time, state = arrival(arrays, table, plane, amplitudes + change, events.INSIDE)
            return np.append(state, time)

        expected = difference(moved, direction)
        scale = 1.0 + np.abs(carried).max()
        # Order six: the error is the seventh derivative times STEP⁶, and rounding over STEP.
        assert np.allclose(found, expected[:-1], rtol=0, atol=1e-9 * scale)
        assert delay == pytest.approx(expected[-1].real, abs=1e-9 * scale)
    return True


MACHINES = [(0.1, 0.76), (1.52, 0.76), (1.52 * (1 + 1e-9), 0.76), (4.0, 0.9), (0.0, 2.0)]


@pytest.mark.parametrize("machine", MACHINES)
def test_arrival_of_the_planar_rotor(machine):
    rotor = jeffcott(parameters(*machine))
    for angle in (0.3, 2.0, 4.1):
        amplitudes = rotor.system.amplitudes(0.2 * np.exp(1j * angle), 6.0 * np.exp(2j * angle))
        assert check_carry_to_wall(rotor.system.arrays, rotor.system.table, 0, amplitudes)


@pytest.mark.parametrize("plane", [0, 1])
def test_arrival_at_a_plane_of_a_general_rotor(plane):
    arrays = general_arrays()
    table = flight_table(arrays.exponents, arrays.driven.astype(bool))
    random, checked = np.random.default_rng(12), 0
    while checked < 4:
        amplitudes = random.normal(size=4) + 1j * random.normal(size=4)
        start = abs(displacement(arrays, plane, amplitudes))
        work = workspace(4)
        outcome, time = events.first_crossing(arrays, table, plane, amplitudes, 10.0, events.INSIDE, work)
        if start < 0.9 and outcome == Outcome.CONTACT and time > 0.2:
            checked += check_carry_to_wall(arrays, table, plane, amplitudes)


@pytest.mark.parametrize("plane", [0, 1])
def test_impact_of_a_general_rotor(plane):
    """Changes along the wall and off it, of a state that slips and of one whose slip stops."""
    arrays = general_arrays()
    random = np.random.default_rng(13)

    def struck(amplitudes):
        position, speed = displacement(arrays, plane, amplitudes), velocity(arrays, plane, amplitudes)
        normal, wall = position / abs(position), wall_of(arrays, plane)
        local = normal.conjugate() * speed
        return amplitudes + arrays.columns[:, plane] * (normal * velocity_change(local, wall)), sense_of(
            local, wall
        ) == STOPPED

    seen = set()
    for _ in range(200):
        before = random.normal(size=4) + 1j * random.normal(size=4)
        position, speed = displacement(arrays, plane, before), velocity(arrays, plane, before)
        local, wall = position.conjugate() * speed / abs(position), wall_of(arrays, plane)
        slip, margin = slip_of(local, wall), abs(friction_margin(local, wall))
        # Differences must not step over the edge between slipping and not, nor over the middle of the plane.
        if local.real < 0.1 or margin < 0.2 or abs(slip) < 0.2 or abs(position) < 0.5:
            continue
        seen.add(struck(before)[1])
        carried = directions_of(4)
        carry_through_impact(arrays, plane, before, carried)
        for direction, found in zip(directions_of(4), carried, strict=True):
            expected = difference(lambda change: struck(before + change)[0], direction)  # noqa: B023
            assert np.allclose(found, expected, rtol=0, atol=1e-9 * (1.0 + np.abs(found).max()))
    assert seen == {False, True}


def test_shift_moves_along_the_motion():
    arrays = general_arrays()
    amplitudes = np.array([0.3, 0.2j, -0.4, 0.1 + 0.1j])
    moved, delays = np.zeros((2, 4), complex), np.array([0.7, -0.2])
    shift(arrays, amplitudes, moved, delays)
    for found, delay in zip(moved, delays, strict=True):

        def flown(change):
            return fly_all(arrays, amplitudes[None], np.array([change[0].real]))[0]

        expected = delay * difference(flown, np.array([1.0 + 0j]))
        assert np.allclose(found, expected, rtol=0, atol=1e-11)


@pytest.mark.parametrize("machine", MACHINES[:2])
@pytest.mark.parametrize("angular_speed", [-2.0, 0.5, -50.9])
def test_a_whole_impact_map(machine, angular_speed):
    """Impact, flight and arrival one after the other, with a slip that goes on and one that stops."""
    rotor = jeffcott(parameters(*machine, rho=2.0).replace(mu=0.2, d=0.8))
    arrays = rotor.system.arrays
    position = np.exp(0.4j)
    before = rotor.system.amplitudes(position, complex(2.5, angular_speed) * position)

    def mapped(change):
        start = before + change
        place = displacement(arrays, 0, start)
        normal = place / abs(place)
        impulse = normal * velocity_change(normal.conjugate() * velocity(arrays, 0, start), wall_of(arrays, 0))
        time, state = arrival(arrays, rotor.system.table, 0, start + arrays.columns[:, 0] * impulse, events.LEAVING)
        return np.append(state, time)

    directions = np.array([rotor.system.amplitude_change(0.0, 1.0), rotor.system.amplitude_change(0.0, 1j)])
    carried, delays, nominal = directions.copy(), np.empty(2), mapped(np.zeros(2))
    carry_through_impact(arrays, 0, before, carried)
    saltation_step(arrays, 0, nominal[-1].real, nominal[:-1], carried, delays)
    for direction, found, delay in zip(directions, carried, delays, strict=True):
        expected = difference(mapped, direction)
        scale = 1.0 + np.abs(carried).max()
        assert np.allclose(found, expected[:-1], rtol=0, atol=1e-8 * scale)
        assert delay == pytest.approx(expected[-1].real, abs=1e-8 * scale)
