"""The orbit of a whirl that stays in contact: that of the same word which Newton's method finds from a guess of its own."""

from __future__ import annotations

import numpy as np
import pytest
from linear_rotors import touchdowns

from carom.models import from_matrices, jeffcott
from carom.motions import State, simulate
from carom.orbits.admissibility import why_virtual
from carom.orbits.exponents import lyapunov_exponents, orbit_exponents
from carom.orbits.orbit import orbit_near
from carom.orbits.recognising import orbit_of_motion, orbit_of_whirl, segments_of
from carom.orbits.shooting import Start, links_of
from carom.orbits.word import Kind, Word
from carom.parameters import Parameters
from tests.orbits.test_orbit import CHATTERING

pytestmark = pytest.mark.jit_only
ROTOR = jeffcott(CHATTERING.replace(gamma=0.25))


@pytest.fixture(scope="module")
def whirl():
    """The backward whirl that slides all the way round; it repels."""
    p = ROTOR.parameters
    # Where friction and damping balance on average: μ(W² − ω²) + γW = 0.
    speed = -(p.gamma + np.sqrt(p.gamma**2 + 4.0 * p.mu**2 * p.omega**2)) / (2.0 * p.mu) - 1.0
    node = np.exp(2j) * np.array([[1.0, 1j * speed]])
    return orbit_near(ROTOR, Word.of(Kind.SLIDE_FORWARD), Start(node, np.array([2.0 * np.pi / abs(speed)])))


def beside(whirl, change=0.0):
    position, velocity = whirl.nodes[0]
    position /= abs(position)
    turning = (np.conj(position) * velocity).imag
    return State(position, 1j * turning * (1.0 + change) * position)


def test_a_whirl_that_slides_all_the_way_round(whirl):
    assert whirl.admissible
    for begun in (0.2, 1.1, 1.9):
        motion = simulate(ROTOR, beside(whirl), begun * whirl.period)
        found = orbit_of_whirl(motion, whirl.period * (1.0 + 1e-6))
        assert str(found.word) == "slide+"
        assert found.period == pytest.approx(whirl.period, rel=1e-11)


def test_its_exponent_is_the_rate_at_which_simulated_motions_part(whirl):
    """The difference of two motions is a delay and a part that grows at this rate."""
    times = whirl.period * np.array([1.0, 2.0, 3.0])
    plain, other = (
        simulate(ROTOR, beside(whirl, change), 3.1 * whirl.period).at_plane(times)[0] for change in (0.0, 1e-7)
    )
    first, second = np.diff(other - plain)
    rate = np.log(abs(second / first)) / whirl.period
    assert rate == pytest.approx(orbit_exponents(whirl).values[0], rel=1e-5)
    assert orbit_exponents(whirl).values.tolist()[1:] == [0.0, -np.inf, -np.inf]


def test_rolling_alone_has_no_such_orbit():
    motion = simulate(jeffcott(CHATTERING), State(1.0, -80j), settle=True)
    assert orbit_of_whirl(motion, 0.108) is None


def test_a_chatter_after_an_impact_that_grazes():
    """The chatter does not begin with the slow impact from which the rotor does not return at once."""
    rotor, place = jeffcott(CHATTERING), np.exp(2j)
    motion = simulate(rotor, State(place, (1e-7 - 1.0j) * place), 30.0)
    hits, landing = np.flatnonzero(motion.is_impact), np.flatnonzero(motion.is_landing)[0]
    next_flight = int(hits[hits > landing][0])
    for brief in (False, True):
        word, begin = segments_of(motion, 0, next_flight + 1, brief=brief)
        assert str(word) == "impact+ land slide+ lift impact+"
        # Each segment ends where the simulation does.
        assert np.abs(links_of(rotor, word, begin).arrivals[:-1] - begin.nodes[1:]).max() < 1e-12


def test_impacts_without_rebound_that_do_not_stay():
    """After the first of two impacts nothing presses the rotor outward: it leaves the wall, although it does not rebound."""
    machine = Parameters(gamma=0.0182, omega=0.102, rho=0.101, phi=0.0, mu=0.194, d=0.0, radius_ratio=3.18)
    orbit = orbit_of_motion(simulate(machine, State(-0.9 + 0.36j, 0.37 + 0.92j), settle=True))
    assert str(orbit.word) == "impact+ land slide+ lift"
    assert orbit.admissible
    # Of a disturbed motion, the states at the first impacts come closer by the multiplier in each period.
    start = State(orbit.departure.position, (1.0 + 1e-8) * orbit.departure.velocity)
    motion = simulate(machine, start, 5.0 * orbit.period)
    states = motion.rotor.system.states_of(motion.arrivals[motion.is_impact])
    apart = np.abs(states - orbit.nodes[0]).max(axis=1)
    apart = apart[apart < 1e-5]
    # The second derivative, some hundreds, times the distance of 1e-7.
    assert apart[2] / apart[1] == pytest.approx(orbit.multipliers.spectral_radius, rel=1e-4)
    measured = lyapunov_exponents(machine, orbit.departure, 60, transient=20)
    assert measured.across[0] == pytest.approx(orbit_exponents(orbit).across[0], rel=1e-6)


@pytest.mark.parametrize(
    ("machine", "impacts"),
    [
        (Parameters(gamma=0.0701, omega=0.101, rho=0.381, phi=0.0, mu=0.0, d=0.106, radius_ratio=0.218), 13),
        (Parameters(gamma=0.0386, omega=0.201, rho=0.682, phi=0.0, mu=0.474, d=0.17, radius_ratio=1.07), 7),
    ],
)
@pytest.mark.parametrize("touched", [0, 1])
def test_a_plane_that_is_never_touched_changes_no_orbit(machine, impacts, touched):
    """The planar rotor beside a coordinate that it does not feel, with a contact plane far from that coordinate's motion."""
    alone = orbit_of_motion(simulate(machine, State(0.1, -1.0 - 1.0j), settle=True))
    rotor = from_matrices(
        mass=np.eye(2),
        damping=np.diag([machine.gamma, 0.3]),
        stiffness=np.diag([machine.omega**2, 0.7]),
        forcing=[machine.rho, 0.3],
        touchdowns=touchdowns(
            [[1.0, 0.0], [0.0, 0.1]][:: 1 - 2 * touched],
            [machine.mu] * 2,
            [machine.d] * 2,
            [machine.radius_ratio + 1.0] * 2,
        ),
    )
    motion = simulate(rotor, State.of([0.1, 0.0], [-1.0 - 1.0j, 0.1]), settle=True)
    assert motion.multiplicity == impacts
    orbit = orbit_of_motion(motion)
    assert {each.place for each in orbit.happenings} == {touched}
    assert orbit.impacts == alone.impacts
    assert orbit.period == pytest.approx(alone.period, rel=1e-10)
    moduli, others = np.abs(orbit.multipliers.values), np.abs(alone.multipliers.values)
    # Those of the other coordinate, in pairs of one modulus, besides.
    assert all(np.abs(moduli - other).min() < 1e-6 for other in others)


@pytest.mark.parametrize("shift", [4e-12, -4e-12])
def test_what_newtons_method_leaves_at_the_wall_makes_no_orbit_virtual(shift):
    """Where contact begins or ends, the radial speed, the force or the slip is zero, or anything of the size of its tolerance."""
    machine = Parameters(gamma=0.0386, omega=0.201, rho=0.682, phi=0.0, mu=0.474, d=0.17, radius_ratio=1.07)
    orbit = orbit_of_motion(simulate(machine, State(0.1, -1.0 - 1.0j), settle=True))
    assert str(orbit.word) == "lift land slide+ slide- roll slide+"
    assert orbit.admissible
    place = orbit.nodes[:, 0] / np.abs(orbit.nodes[:, 0])
    nodes = orbit.nodes + shift * np.column_stack([place, (1.0 + 0.5j) * place])
    assert why_virtual(orbit.rotor, orbit.word, Start(nodes, orbit.durations)) == ""
    # The lift-off and the end of rolling 1e-6 too early are no rounding.
    for segment in (0, 5):
        nodes = orbit.nodes.copy()
        nodes[segment, 1] += np.sign(segment - 1) * 1e-6j * place[segment]
        assert "would end" in why_virtual(orbit.rotor, orbit.word, Start(nodes, orbit.durations))
