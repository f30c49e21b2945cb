"""Orbits of any word: closure, multipliers, margins and admissibility, each against an independent route."""

import mpmath
import numpy as np
import pytest

from carom.models import Rotor, jeffcott
from carom.motions import State, simulate
from carom.orbits import Kind, Orbit, Word, find_orbits, impact_map, orbit_near, orbit_of_motion
from carom.orbits.admissibility import why_virtual
from carom.orbits.orbit import margins_of
from carom.orbits.shooting import ShootingStart, closed_flights, converged, links_of, pack, unpack
from carom.orbits.simulated_search import impacts_between
from tests.compilation import sized
from tests.machines import PAPER, exact_matrix, random_parameters

DOUBLED = PAPER.replace(gamma=0.083)


def two_impacts() -> Orbit:
    """The orbit of two impacts below the period doubling of the paper's machine, from a simulation."""
    one = find_orbits(DOUBLED)["B1,d"]
    start = State(0.999 * one.position, 1.001 * one.departure.velocity)
    orbit = orbit_of_motion(simulate(DOUBLED, start, settle=True))
    assert orbit is not None
    return orbit


def as_shot(orbit: Orbit) -> Orbit:
    """A single-impact orbit of the closed form, solved again by shooting from a start beside it."""
    rng = np.random.default_rng(0)
    nudge = 1e-4 * (rng.normal(size=(*orbit.nodes.shape, 2)) @ [1.0, 1j])
    shot = orbit_near(orbit.rotor, orbit.word, ShootingStart(orbit.nodes + nudge, orbit.durations * 1.0001), orbit.name)
    assert shot is not None
    return shot


def test_single_impact_orbits_of_shooting_are_those_of_the_closed_form():
    rng = np.random.default_rng(1)
    compared = 0
    for _ in range(sized(12, 2, 100)):
        for orbit in find_orbits(random_parameters(rng)):
            radius = orbit.multipliers.spectral_radius
            # A start beside an orbit next to a fold may lead to the other one.
            if abs(orbit.radial_speed) < 1e-2 or radius > 1e3 or np.abs(orbit.multipliers.values - 1.0).min() < 0.05:
                continue
            shot = as_shot(orbit)
            compared += 1
            assert abs(shot.period - orbit.period) < 1e-12 * (1.0 + orbit.period) / min(1.0, orbit.radial_speed**2)
            size = (1.0 + np.abs(orbit.nodes).max()) * (1.0 + radius)
            assert np.abs(shot.nodes - orbit.nodes).max() < 1e-12 * size / min(1.0, orbit.radial_speed**2)
            assert np.abs(
                np.sort_complex(shot.multipliers.values) - np.sort_complex(orbit.multipliers.values)
            ).max() < (1e-9 * (1.0 + radius))
            assert shot.reason == orbit.reason
    assert compared > 0


def test_multipliers_are_those_of_the_product_of_one_impact_derivatives():
    orbit = two_impacts()
    product = np.eye(3)
    for section in orbit.sections:
        product = impact_map(orbit.rotor, section).jacobian @ product
    expected = sorted(np.linalg.eigvals(product), key=lambda value: (-abs(value), -value.imag))
    assert np.abs(orbit.multipliers.values - expected).max() < 1e-10


def test_the_orbit_closes_in_thirty_digits():
    """The flight by the matrix exponential, the law of impact and the time of arrival, all in 30 digits."""
    orbit = two_impacts()
    with mpmath.workdps(30):
        matrix = exact_matrix(orbit.rotor.parameters)
        state = exact_state(orbit.section)
        first = state
        for duration in orbit.durations:
            state = exact_arrival(matrix, orbit.rotor, exact_rebound(orbit.rotor, state), mpmath.mpf(duration))
        assert max(abs(a - b) for a, b in zip(first, state, strict=True)) < mpmath.mpf("1e-12")


def exact_state(section) -> list:
    normal = mpmath.expj(mpmath.mpf(section.angle))
    return [normal, normal * mpmath.mpc(section.radial_speed, section.angular_speed)]


def exact_rebound(rotor: Rotor, state: list) -> list:
    position, velocity = state
    local = mpmath.conj(position) * velocity
    factor = (1 + mpmath.mpf(rotor.parameters.d)) * mpmath.mpc(1, rotor.parameters.mu)
    return [position, velocity - factor * local.real * position]


def exact_arrival(matrix, rotor: Rotor, state: list, guess) -> list:
    """State where the flight meets the wall next to a time."""
    parameters = rotor.parameters
    rest = mpmath.mpf(parameters.rho) * mpmath.expj(mpmath.mpf(parameters.phi))
    rest /= mpmath.mpc(mpmath.mpf(parameters.omega) ** 2 - 1, parameters.gamma)

    def at(time) -> list:
        moved = mpmath.expm(matrix * time) * mpmath.matrix([state[0] - rest, state[1]])
        return [moved[0] + rest, moved[1]]

    time = mpmath.findroot(lambda t: abs(at(t)[0]) - 1, (guess, guess * (1 + mpmath.mpf("1e-8"))))
    return at(time)


def test_where_the_word_is_not_what_the_machine_does():
    one = find_orbits(PAPER)["B1,d"]
    start = ShootingStart(one.nodes, one.durations)
    assert why_virtual(one.rotor, one.word, start) == ""
    assert "opposite direction" in why_virtual(one.rotor, Word.of(Kind.IMPACT_BACKWARD), start)
    assert "not stop" in why_virtual(one.rotor, Word.of(Kind.IMPACT_STOPPED), start)
    doubled = why_virtual(one.rotor, one.word, ShootingStart(one.nodes, 2.0 * one.durations))
    assert "before its period is over" in doubled


def test_margins_of_the_doubled_orbit():
    orbit = two_impacts()
    assert orbit.margins.approach == pytest.approx(min(section.radial_speed for section in orbit.sections), rel=1e-12)
    times = np.linspace(0.0, orbit.period, 40_001)
    radii = np.abs(orbit.path(times))
    begins = np.array([0.0, orbit.durations[0], orbit.period])
    away = np.abs(times[1:-1, None] - begins).min(axis=1) > 0.01
    inner = (radii[1:-1] > radii[:-2]) & (radii[1:-1] > radii[2:]) & away
    assert orbit.margins.radius == pytest.approx(1.0 - radii[1:-1][inner].max() ** 2, abs=1e-6)
    motion = orbit.trajectory(2.0)
    assert np.abs(np.abs(motion.position(times)) - radii).max() < 1e-9


def test_the_compiled_iteration_ends_where_the_other_ends():
    orbit, rng = two_impacts(), np.random.default_rng(5)
    for _ in range(6):
        moved = pack(ShootingStart(orbit.nodes, orbit.durations)) + 1e-4 * rng.normal(size=10)
        start = unpack(moved, 2)
        links, found = converged(orbit.rotor, orbit.word, start), closed_flights(orbit.rotor, orbit.word, start)
        assert links is not None
        assert found is not None
        assert np.abs(pack(found) - pack(links.start)).max() < 1e-12
        # The start itself is left as it is.
        assert np.array_equal(pack(start), moved)
    lost = ShootingStart(np.full((2, 2), np.nan + 0j), orbit.durations)
    assert closed_flights(orbit.rotor, orbit.word, lost) is None
    # A duration that becomes negative on the way ends it.
    assert closed_flights(orbit.rotor, orbit.word, ShootingStart(orbit.nodes, 1e-3 * orbit.durations)) is None


def test_the_jacobian_of_a_grazing_impact_is_regular():
    """Where the multipliers are infinite the equations of the orbit are not singular."""
    rotor = jeffcott(PAPER)
    one = find_orbits(rotor)["B1,d"]
    flown = rotor.system.fly(rotor.system.amplitudes(one.departure.position, one.departure.velocity), np.array(0.3))
    node = np.array(rotor.system.state(flown))
    start = ShootingStart(np.array([one.nodes[0], node]), np.array([0.3, one.period - 0.3]))
    links = links_of(rotor, one.word.repeated(2), start)
    assert np.linalg.cond(links.jacobian) < 1e6


def test_without_friction_the_direction_of_the_slip_makes_no_other_word():
    smooth = jeffcott(PAPER.replace(mu=0.0, radius_ratio=0.05))
    motion = simulate(smooth, State(0.9 + 0j, 1.0 - 2.0j), 20.0)
    slips = smooth.parameters.radius_ratio + 1.0 + motion.contacts.angular_speed
    assert slips[0] < 0.0
    word, start = impacts_between(motion, 0, 1)
    assert str(word) == "impact+"
    at_wall = links_of(smooth, word, start).ends[0]
    assert at_wall == pytest.approx(smooth.system.states_of(motion.event_amplitudes[1:2])[0], abs=1e-9)
    assert margins_of(links_of(smooth, word, start), smooth, word).slip == np.inf
