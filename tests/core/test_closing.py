"""The impacts of a period: by the orbit that closes, however slowly a motion draws near, by both ways to follow one."""

from dataclasses import dataclass

import numpy as np
import pytest
from machines import PAPER

from carom import State, find_attractors, find_orbits, settle, simulate
from carom.base.outcome import Outcome
from carom.core.closing import ATTRACTS, OPEN, REPELS, close, least_period
from carom.core.settling import memory
from carom.models import jeffcott
from carom.motions.settling import _tools
from carom.parameters import Parameters

SPIRALLING = Parameters(
    gamma=0.03689825909891265,
    omega=1.4589520528119624,
    rho=0.7571463310809883,
    phi=0.7817202056358399,
    mu=0.22251753962804233,
    d=0.8837279243562883,
    radius_ratio=1.866004796662468,
)
"""Its one bouncing motion has 3 impacts a period; motions turn about it by nearly a seventh of a turn a period."""
DOUBLING = 0.083381417512481
"""Damping at which a multiplier of B1,d of the source paper's machine passes −1."""
REPEATING = (Outcome.BOUNCING, Outcome.MIXED)


def drawn_starts(random, count):
    points = np.sqrt(random.random((2, count))) * np.exp(2j * np.pi * random.random((2, count)))
    return points[0], 2.0 * points[1]


@dataclass
class Closed:
    positions: np.ndarray
    velocities: np.ndarray
    period: float
    found: int


def closed(rotor, position, velocity, impacts):
    """The orbit of so many impacts next to a state just before one of them, or nothing."""
    states, durations = np.empty((impacts + 1, 2), complex), np.empty(impacts)
    states[0] = rotor.system.amplitudes(position, velocity)
    found = close(rotor.system.arrays, rotor.system.table, states, durations, *_tools())
    return None if found == OPEN else Closed(*rotor.system.state(states[:-1]), float(durations.sum()), found)


def assert_closes(rotor, position, velocity, impacts):
    """An orbit with that many impacts, and no fewer, goes on as simulation says; the orbit."""
    orbit = closed(rotor, position, velocity, impacts)
    assert orbit is not None
    assert orbit.found == ATTRACTS
    start = State(complex(orbit.positions[0]), complex(orbit.velocities[0]))
    log = simulate(rotor, start, 1.5 * orbit.period + 1.0).contacts
    states = np.stack([np.exp(1j * log.angle), log.radial_speed, log.angular_speed])
    size = 1.0 + np.abs(states[:, 0]).max()
    assert np.abs(states[:, impacts] - states[:, 0]).max() < 1e-9 * size
    assert log.time[impacts] - log.time[0] == pytest.approx(orbit.period, rel=1e-9)
    for fewer in range(1, impacts):
        assert np.abs(states[:, fewer] - states[:, 0]).max() > 1e-7
    return orbit


@pytest.mark.jit_only
def test_an_orbit_with_three_impacts_is_told_so_however_it_is_reached():
    rotor = jeffcott(SPIRALLING)
    positions, velocities = drawn_starts(np.random.default_rng(1), 24)
    ends = settle(rotor, State(positions, velocities))
    bouncing = np.flatnonzero(ends.outcomes == Outcome.BOUNCING)
    assert len(bouncing) > 12
    assert set(ends.multiplicities[bouncing]) == {3}
    orbits = [assert_closes(rotor, ends.positions[i], ends.velocities[i], 3) for i in bouncing[:10]]
    assert np.ptp([orbit.period for orbit in orbits]) < 1e-9
    for place in bouncing[:4]:
        alone = simulate(rotor, State(positions[place], velocities[place]), 2e5, settle=True)
        assert alone.multiplicity == (3 if alone.outcome is Outcome.BOUNCING else 0)
    names = {member.name for member in find_attractors(rotor, count=24)}
    assert {name for name in names if "impact" in name} == {"3-impact bouncing"}


@pytest.mark.jit_only
@pytest.mark.parametrize("away", [-1e-5, -1e-9, 1e-9, 1e-7, 1e-5])
def test_next_to_a_period_doubling_one_impact_is_told_from_two(away):
    rotor = jeffcott(PAPER.replace(gamma=DOUBLING + away))
    leaving = find_orbits(rotor)["B1,d"].departure
    faster = leaving.velocity * np.array([0.9999, 1.0001])
    ends = settle(rotor, State(np.full(2, leaving.position), faster))
    assert ends.multiplicities.tolist() == [1 if away > 0.0 else 2] * 2
    alone = [simulate(rotor, State(leaving.position, complex(speed)), 2e5, settle=True) for speed in faster]
    assert [motion.multiplicity for motion in alone] == [1 if away > 0.0 else 2] * 2


def test_an_orbit_that_is_not_closed_yet_is_found_next_to_a_state():
    rotor = jeffcott(PAPER)
    known = find_orbits(rotor)["B1,d"]
    before = known.section.state
    near = closed(rotor, before.position, before.velocity * (1.0 + 1e-5j), 1)
    assert near is not None
    assert near.found == ATTRACTS
    assert near.period == pytest.approx(known.period, rel=1e-11)
    assert near.positions[0] == pytest.approx(before.position, abs=1e-10)
    assert near.velocities[0] == pytest.approx(before.velocity, abs=1e-10)
    assert closed(rotor, before.position, 1.05 * before.velocity, 1) is None


def test_an_orbit_that_repels_closes_but_does_not_attract():
    rotor = jeffcott(PAPER.replace(gamma=0.08))
    before = find_orbits(rotor)["B1,d"].section.state
    found = closed(rotor, before.position, before.velocity * (1.0 + 1e-6), 1)
    assert found is not None
    assert found.found == REPELS


def test_what_is_known_of_an_orbit_is_not_asked_again_nor_taken_for_more():
    """The state at an orbit of one impact is kept: answers are the same with it and without, next to it and elsewhere."""
    rotor = jeffcott(PAPER)
    orbits = {orbit.name: orbit for orbit in find_orbits(rotor)}
    states = [
        rotor.system.amplitudes(orbit.section.state.position, orbit.section.state.velocity)
        for orbit in (orbits["B1,d"], orbits["B1,c"])
    ]
    contact, log, known, work, rub = _tools()

    def impacts(state, recollection):
        return least_period(
            rotor.system.arrays, rotor.system.table, state.copy(), 1, contact, log, recollection, work, rub
        )

    for scale in (0.0, 1e-9, 1e-7):
        for state in states:
            near = state * (1.0 + scale)
            assert impacts(near, known) == impacts(near, memory(2))
    assert np.abs(known.attracted - states[0]).max() < 1e-6  # the stable one, never the other
    known.rubbed = 1
    known.attracted[:] = states[1]
    assert impacts(states[1], known) == impacts(states[1], memory(2)) != 1


@pytest.mark.jit_only
def test_a_motion_that_only_passes_by_an_orbit_goes_on():
    """B1,d of this machine has the multipliers -1.043 and 0.951: a motion comes within 1e-8 of it, and leaves."""
    parameters = Parameters(
        gamma=0.16155610137935947, omega=0.8615319990097938, rho=0.7570556724764941, phi=0.7489482538116126,
        mu=0.37569101757556383, d=0.5310701214526219, radius_ratio=1.6389580250449938,
    )  # fmt: skip
    rotor = jeffcott(parameters)
    start = State(-0.9376157591840666 - 0.049885059556011j, 1.1903963754385933 + 0.6414778990507444j)
    orbit = next(orbit for orbit in find_orbits(rotor) if orbit.name == "B1,d")
    assert not orbit.stable
    together = settle(rotor, State(np.array([start.position]), np.array([start.velocity])))
    # In double precision a motion may stay on the orbit itself for ever: that is no end either.
    on_orbit = settle(rotor, State(np.array([orbit.departure.position]), np.array([orbit.departure.velocity])))
    alone = simulate(rotor, start, settle=True)
    assert (alone.outcome, alone.multiplicity) == (together.outcomes[0], together.multiplicities[0])
    assert np.abs(alone.contacts.radial_speed - orbit.radial_speed).min() < 1e-7
    for endings in (together, on_orbit):
        impacts = int(endings.multiplicities[0])
        if endings.outcomes[0] in REPEATING and impacts > 0:
            assert closed(rotor, endings.positions[0], endings.velocities[0], impacts).found == ATTRACTS


@pytest.mark.jit_only
def test_no_number_is_named_where_no_orbit_closes():
    """Rub brings irregular bouncing back to the same state to the last bit: 2674 computed impacts then repeat themselves."""
    parameters = Parameters(
        gamma=0.010919582190453933, omega=0.37741706708713113, rho=1.1060646732905892, phi=1.229913015103592,
        mu=0.12190001982830612, d=0.9124514915788788, radius_ratio=1.7067500966210072,
    )  # fmt: skip
    positions = np.array([-0.9529923594883638 + 0.27279210388634423j, 0.6602592005764265 + 0.1451056352397193j])
    velocities = np.array([1.5912335089848553 - 0.33757891694966446j, -0.8325178172900114 - 0.9984458821653093j])
    ends = settle(jeffcott(parameters), State(positions, velocities))
    assert set(ends.outcomes) <= set(REPEATING)
    assert ends.multiplicities.tolist() == [0, 0]


@pytest.mark.jit_only
@pytest.mark.parametrize("friction", [0.0, 0.02])
def test_elastic_bounces_that_become_ever_lower_are_no_orbit(friction):
    """Bounces of any number a period close, but for what damping takes: neither route may name one of these numbers."""
    parameters = Parameters(0.125, 0.1, 1.7, 3.06, friction, 1.0, 0.98)
    rotor, random = jeffcott(parameters), np.random.default_rng(8)
    positions, velocities = drawn_starts(random, 12)
    together = settle(rotor, State(positions, velocities))
    low = 0
    for index, start in enumerate(zip(positions, velocities, strict=True)):
        alone = simulate(rotor, State(*start), settle=True)
        assert (together.outcomes[index], together.multiplicities[index]) == (alone.outcome, alone.multiplicity)
        assert alone.multiplicity == 0 or alone.contacts.radial_speed[-alone.multiplicity :].max() > 0.01
        low += alone.outcome is Outcome.LOW_BOUNCES or (alone.outcome in REPEATING and alone.multiplicity == 0)
    assert low > 8


@pytest.mark.jit_only
def test_an_orbit_with_rub_closes_too():
    parameters = PAPER.replace(gamma=0.0431456484, omega=1.25902546543, rho=1.31671186334, phi=0.0)
    rotor = jeffcott(parameters.replace(mu=0.427612705, d=0.43781982, radius_ratio=2.0))
    motion = simulate(rotor, State(0.3, 0.5 + 1.0j), 1e5, settle=True)
    assert motion.outcome is Outcome.MIXED
    assert_closes(rotor, motion.final.position, motion.final.velocity, motion.multiplicity)
