"""Lasting contact at several planes at once: its series, and the loop that follows it."""

import numpy as np
import pytest
from linear_rotors import tilting

from carom.core.advance import advance
from carom.core.contact_series import rub_series
from carom.core.event_log import EventLog
from carom.core.layout import rub_workspace, workspace
from carom.core.phases import AWAY, BACKWARD_SLIP, FLIGHT, FORWARD_SLIP, ROLLING
from carom.core.rub import fly_or_rub_all, forces_all, next_phase, press
from carom.core.settling import memory
from carom.core.taylor import series_step, sum_series

ROTOR = tilting(forcing=np.array([0.88 + 0.18j, 0.05]))
SYSTEM = ROTOR.model.system
SIGNS = {FORWARD_SLIP: 1, BACKWARD_SLIP: -1, ROLLING: 0}


def on_walls(angles, rates, inside=()):
    """Amplitudes with each plane at an angle on its wall, turning at a rate; or inside, at half its clearance."""
    places = np.exp(1j * np.array(angles)) * [0.5 if plane in inside else 1.0 for plane in (0, 1)]
    speeds = 1j * np.array(rates) * places
    return SYSTEM.amplitudes(np.linalg.solve(ROTOR.planes, places), np.linalg.solve(ROTOR.planes, speeds))


def fixed(amplitudes):
    """State in the fixed frame at time zero."""
    position, velocity = SYSTEM.state(amplitudes)
    return position, velocity + 1j * position


@pytest.mark.parametrize(
    ("contact", "rates"),
    [
        ((FORWARD_SLIP, FORWARD_SLIP), (0.3, -0.2)),
        ((FORWARD_SLIP, BACKWARD_SLIP), (0.3, -30.0)),
        ((ROLLING, FORWARD_SLIP), (-21.0, 0.4)),
        ((ROLLING, ROLLING), (-21.0, -21.0)),
        ((FORWARD_SLIP, AWAY), (0.3, 0.1)),
        ((AWAY, FLIGHT), (0.3, 0.1)),
    ],
)
def test_the_series_keeps_to_the_walls_with_the_forces_of_the_equations(contact, rates):
    contact = np.array(contact)
    amplitudes = on_walls((0.4, 1.1), rates, inside=np.flatnonzero(contact == AWAY))
    work = rub_workspace(4, 2)
    rub_series(SYSTEM.arrays, contact, amplitudes, work)
    slips = {plane: SIGNS[phase] for plane, phase in enumerate(contact.tolist()) if phase > FLIGHT}
    if slips:
        acceleration, forces = ROTOR.rubbing(0.0, *fixed(amplitudes), slips)
        for (plane, _), (normal, along) in zip(slips.items(), forces, strict=True):
            assert work.push[plane, 0] * ROTOR.felt[plane] == pytest.approx(normal, abs=1e-11)
            assert work.grip[plane, 0] * ROTOR.felt[plane] == pytest.approx(along, abs=1e-11)
    else:
        acceleration = ROTOR.free(0.0, *fixed(amplitudes))
    for plane in set(range(2)) - set(slips):
        place, speed = ROTOR.planes[plane] @ fixed(amplitudes)[0], ROTOR.planes[plane] @ fixed(amplitudes)[1]
        expected = (np.conj(place) * (ROTOR.planes[plane] @ acceleration)).real + abs(speed) ** 2
        # The sum is the same in both frames: half the second derivative of |y|².
        assert work.push[plane, 0] == pytest.approx(expected, abs=1e-11)
    step = series_step(work)
    moved = np.empty(4, complex)
    for share in (0.3, 1.0):
        sum_series(work, share * step, moved)
        for plane in slips:
            place, speed = SYSTEM.at_plane(moved, plane)
            assert abs(abs(place) - 1.0) < 1e-13
            assert abs((np.conj(place) * speed).real) < 1e-12
            if contact[plane] == ROLLING:
                assert abs(speed + 1j * SYSTEM.arrays.surface_speed[plane] * place) < 1e-11
    if slips:
        position, velocity = ROTOR.follow(0.0, step, *fixed(amplitudes), slips)
        turn = np.exp(-1j * step)
        assert np.allclose(SYSTEM.state(moved)[0], position * turn, rtol=0, atol=1e-11)
        assert np.allclose(SYSTEM.state(moved)[1], velocity * turn - 1j * position * turn, rtol=0, atol=1e-10)


def test_what_keeps_a_plane_on_its_wall_depends_on_the_contact_at_the_other():
    amplitudes = on_walls((0.4, 1.1), (0.3, -0.2))
    work = rub_workspace(4, 2)
    push, rate = press(SYSTEM.arrays, np.array([FLIGHT, FORWARD_SLIP]), 0, amplitudes, work)
    acceleration, _ = ROTOR.rubbing(0.0, *fixed(amplitudes), {1: 1})
    place, speed = (ROTOR.planes[0] @ part for part in fixed(amplitudes))
    expected = (np.conj(place) * (ROTOR.planes[0] @ acceleration)).real + abs(speed) ** 2
    assert push == pytest.approx(expected, abs=1e-12)
    alone, _ = press(SYSTEM.arrays, np.array([FLIGHT, AWAY]), 0, amplitudes, work)
    assert abs(alone - push) > 1e-3
    contact = np.array([FLIGHT, FORWARD_SLIP])
    later = fly_or_rub_all(
        SYSTEM.arrays, amplitudes[None], contact[None], np.zeros((1, 0), np.int64), np.zeros(1), np.array([1e-5]), work
    )[0]
    changed, _ = press(SYSTEM.arrays, contact, 0, later, work)
    assert (changed - push) / 1e-5 == pytest.approx(rate, rel=1e-3, abs=1e-3)


def test_a_plane_that_does_not_slip_rolls_within_the_cone_of_friction_and_slips_outside():
    work = rub_workspace(4, 2)
    decided = set()
    for angle in np.linspace(0.0, 6.0, 13):
        amplitudes = on_walls((angle, angle + 0.3), (-21.0, 0.1))
        contact = np.array([FORWARD_SLIP, FORWARD_SLIP])
        found = next_phase(SYSTEM.arrays, contact, 0, amplitudes, work)
        _, ((normal, along), _) = ROTOR.rubbing(0.0, *fixed(amplitudes), {0: 0, 1: 1})
        assert contact.tolist() == [FORWARD_SLIP, FORWARD_SLIP]
        if abs(along) <= ROTOR.friction * normal:
            assert found == ROLLING
        else:
            assert found == (FORWARD_SLIP if along < 0.0 else BACKWARD_SLIP)
        decided.add(found)
        forces = forces_all(SYSTEM.arrays, amplitudes[None], np.array([[ROLLING, FORWARD_SLIP]]), np.zeros(1), work)[0]
        assert forces[0] * ROTOR.felt[0] == pytest.approx((normal, along), abs=1e-10)
    assert decided


def test_contact_at_one_plane_changes_with_what_happens_at_the_other():
    """From one rub at the first plane: the second comes to its wall, strikes, chatters and rubs as well."""
    amplitudes, contact = on_walls((0.35, 0.35), (0.0, 0.0), inside=(1,)), np.array([FORWARD_SLIP, AWAY])
    log = EventLog.empty(2000, 4, 2)
    outcome, time, count = advance(
        SYSTEM.arrays, SYSTEM.table, amplitudes, 60.0, contact, log, memory(4), workspace(4), rub_workspace(4, 2)
    )
    assert time > 0.5
    phases = set(map(tuple, log.phases[:count].tolist()))
    assert len(phases) > 1
    assert set(log.stations[:count].tolist()) == {0, 1}
    for before, plane in zip(log.before[:count], log.stations[:count], strict=True):
        for other in (0, 1):
            assert abs(SYSTEM.at_plane(before, other)[0]) < 1.0 + 1e-12
        assert plane in (0, 1)
    # Where a plane stays in contact it has no radial speed, whatever the other does.
    for state, row in zip(log.after[:count], log.phases[:count], strict=True):
        for plane in np.flatnonzero(row):
            place, speed = SYSTEM.at_plane(state, plane)
            assert abs((np.conj(place) * speed).real) < 1e-11
    assert outcome != 0
