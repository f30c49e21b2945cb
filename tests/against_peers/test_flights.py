"""Single flights and their first crossings, against general-purpose integrators with a terminal event at the wall."""

import cmath
import math

import numpy as np
import pytest
from compilation import sized
from machines import random_parameters

from carom.base.outcome import Outcome
from carom.core.events import INSIDE, LEAVING, first_crossing
from carom.core.layout import workspace
from carom.models import jeffcott
from carom.parameters import Parameters

from .bouncing import Flight, HeyokaFlights, arrival_matrix, flight_error, stiffness_and_force

DAMPING = {"underdamped": 0.3, "critical": 2.0, "nearly critical": 2.0 * (1.0 + 1e-10), "overdamped": 7.0}
"""``γ/ω``; ``random`` draws machines of every damping."""
CLEAR, CONTACT = int(Outcome.CLEAR), int(Outcome.CONTACT)


def random_start(random: np.random.Generator, on_wall: bool) -> tuple[complex, complex]:
    """A state inside, or on the wall with inward speed."""
    speed = 10 ** random.uniform(-2.0, 1.0)
    if on_wall:
        position = cmath.rect(1.0, random.uniform(-math.pi, math.pi))
        return position / abs(position), -position * cmath.rect(speed, random.uniform(-1.5, 1.5))
    position = cmath.rect(0.99 * math.sqrt(random.random()), random.uniform(-math.pi, math.pi))
    return position, cmath.rect(speed, random.uniform(-math.pi, math.pi))


def assert_same_flight(parameters: Parameters, start: tuple[complex, complex], horizon: float, peer) -> Flight | None:
    """Same end at the wall or the same state at the horizon, to the error of the peer; ``None`` if it may have missed one.

    A peer with steps of a finite length misses excursions over the wall that fit between their ends.
    """
    rotor, work, theirs = jeffcott(parameters), workspace(2), peer(*start, horizon)
    amplitudes, how = rotor.system.amplitudes(*start), LEAVING if abs(start[0]) > 1.0 - 1e-12 else INSIDE
    outcome, time = first_crossing(rotor.system.arrays, rotor.system.table, 0, amplitudes, horizon, how, work)
    assert outcome in (CLEAR, CONTACT)
    position, velocity = (complex(value) for value in rotor.system.state(work.end))
    error = flight_error(rotor, peer, *start, theirs.steps)
    outward = (position.conjugate() * velocity).real
    stiffness, force = stiffness_and_force(parameters)
    acceleration = force - complex(parameters.gamma, 2.0) * velocity - stiffness * position
    bend = abs((position.conjugate() * acceleration).real + abs(velocity) ** 2)
    if outcome == CONTACT:
        assert outward > 0.0
        # f = |y|² − 1 rises above zero for about 2f'/|f''| and by f'²/(2|f''|), with f' twice the outward speed.
        width, height = 2.0 * outward / bend, outward**2 / bend
        if not theirs.hit or theirs.duration > time + 0.5 * width:
            assert height < 4.0 * error
            return None
    assert theirs.hit == (outcome == CONTACT)
    if outcome == CLEAR:
        assert abs(position - theirs.position) <= error
        assert abs(velocity - theirs.velocity) <= error
        return theirs
    if outward**2 < 1e3 * bend * error:
        # So nearly tangential that first derivatives do not tell what an error of the state does to the time.
        return None
    local, other = (u.conjugate() * v for u, v in ((position, velocity), (theirs.position, theirs.velocity)))
    turned = cmath.phase(theirs.position * position.conjugate())
    differences = np.abs([turned, other.real - local.real, other.imag - local.imag, theirs.duration - time])
    bounds = error * np.linalg.norm(arrival_matrix(parameters, position, velocity), axis=1)
    assert (differences <= 1.01 * bounds).all(), differences / bounds
    return theirs


def fly_many(random: np.random.Generator, damping: str, count: int, peer_of) -> tuple[int, int]:
    """Number of flights compared that end at the wall, and that stay clear."""
    hits, clear = 0, 0
    for number in range(count):
        parameters = random_parameters(random)
        if damping != "random":
            parameters = parameters.replace(gamma=DAMPING[damping] * parameters.omega)
        start = random_start(random, on_wall=number % 3 == 0)
        flight = assert_same_flight(parameters, start, 15.0, peer_of(parameters))
        if flight is not None:
            hits, clear = hits + flight.hit, clear + (not flight.hit)
    return hits, clear


@pytest.mark.jit_only
@pytest.mark.parametrize("damping", ["random", *DAMPING])
def test_flights_end_as_heyoka_says(damping):
    pytest.importorskip("heyoka", reason="heyoka is not installed (it has no package for this platform)")
    count = sized(80, 80, 400)
    hits, clear = fly_many(np.random.default_rng(31), damping, count, HeyokaFlights)
    assert hits > 0.375 * count
    assert clear > 0.05 * count
    assert hits + clear > 0.975 * count
