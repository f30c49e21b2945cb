"""What contact forces do where bearings are anisotropic, against the equations of motion in the fixed frame."""

import numpy as np
import pytest

from carom.base.outcome import Phase
from carom.core.contact_series import contact_forces, rub_series
from carom.core.layout import rub_workspace
from carom.core.taylor import sum_series
from carom.core.wall import push_station
from carom.models import KelvinVoigt, Touchdown, from_matrices
from carom.models.limits import Limit, with_limits

MASS, STIFFNESS, DAMPING = np.diag([1.0, 0.3]), np.array([[0.6, 0.1], [0.1, 0.4]]), 0.1 * np.eye(2)
ACROSS = np.array([[[0.03, 0.0], [0.0, 0.01]], [[0.15 + 0.05j, 0.0], [0.0, 0.1]]])
ROW = np.array([1.0, 0.2])
BEGINS = 0.7
POSITION, VELOCITY = np.array([0.9 + 0.6j, 0.1]), np.array([0.3 - 0.2j, 0.4j])


def system_of(limits=()):
    plane = Touchdown(ROW, KelvinVoigt(stiffness=50.0, damping=1.0), 0.15, 8.0)
    rotor = from_matrices(
        mass=MASS, damping=DAMPING, stiffness=STIFFNESS, forcing=[0.1, 0.0], touchdowns=[plane], conjugate=ACROSS
    )
    return with_limits(rotor.system, limits) if limits else rotor.system


def accelerations(position, velocity, force, time):
    """Of the coordinates in the fixed frame, by a force on the plane there."""
    push = np.array([0.1, 0.0]) * np.exp(1j * time) + ROW * force - DAMPING @ velocity - STIFFNESS @ position
    push = push - ACROSS[0] @ velocity.conj() - ACROSS[1] @ position.conj()
    return np.linalg.solve(MASS, push)


def at(system, amplitudes, time):
    """Coordinates and velocities in the fixed frame."""
    position, velocity = system.state(amplitudes)
    turn = np.exp(1j * time)
    return position * turn, (velocity + 1j * position) * turn


def test_an_impulse_changes_the_state_as_it_changes_velocities():
    system = system_of()
    before = system.amplitudes(POSITION, VELOCITY, BEGINS)
    after, change = np.empty_like(before), 0.4 - 0.7j
    push_station(system.arrays, 0, change, before, after)
    (place, speed), (moved, faster) = (system.state(each) for each in (before, after))
    assert moved == pytest.approx(place, abs=1e-13)
    gained = np.linalg.solve(MASS, ROW) / (ROW @ np.linalg.solve(MASS, ROW)) * change
    assert faster - speed == pytest.approx(gained, abs=1e-13)
    # The state says all: from it follow the amplitudes.
    assert after == pytest.approx(system.amplitudes(moved, faster, BEGINS), abs=1e-13)


@pytest.mark.parametrize("bound", [None, 0.05])
def test_the_series_of_contact_obeys_the_equations_of_motion(bound):
    pull = np.array([0.5, 0.0])
    limits = () if bound is None else (Limit(bound, pull, 0.0 * pull, np.array([1.0, 0.0])),)
    system = system_of(limits)
    amplitudes = system.amplitudes(POSITION, VELOCITY, BEGINS)
    contact = np.array([int(Phase.FORWARD_SLIP)])
    work = rub_workspace(system.modes, 1, system.limits)
    work.clock = BEGINS
    excess = 0j
    if limits:
        work.limited[:] = 2, 2  # both axes at their upper bounds
    rub_series(system.arrays, contact, amplitudes, work)
    step, moved = 1e-3, np.empty((3, system.modes), complex)
    for place, time in enumerate((-step, 0.0, step)):
        sum_series(work, time, moved[place])
    states = [at(system, each, BEGINS + time) for each, time in zip(moved, (-step, 0.0, step), strict=True)]
    rates = (states[2][1] - states[0][1]) / (2.0 * step)
    position, velocity = states[1]
    if limits:
        asked = pull @ position
        excess = complex(asked.real - bound, asked.imag - bound)
    y, v = ROW @ position, ROW @ velocity
    normal = y / abs(y)
    size = 50.0 * (abs(y) - 1.0) + (normal.conjugate() * v).real
    wanted = accelerations(position, velocity, -size * (1.0 + 0.15j) * normal, BEGINS) + np.array([excess, 0.0])
    # The difference is right to the square of the step.
    assert rates == pytest.approx(wanted, abs=1e-4)
    contact_forces(system.arrays, contact, amplitudes, work)
    felt = ROW @ np.linalg.solve(MASS, ROW)
    assert work.push[0, 0] == pytest.approx(size * felt, rel=1e-12)
