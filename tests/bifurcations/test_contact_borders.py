"""Borders of orbits with lasting contact: the neighbouring orbit, and what fresh simulations do beside the border."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from machines import PAPER

from carom import simulate
from carom.bifurcations import Bifurcation, Border, continue_orbit, examine_border
from carom.models import jeffcott
from carom.motions import State
from carom.orbits import rubbing_orbits
from carom.orbits.admissibility import departure
from carom.orbits.orbit import Orbit
from carom.outcome import Outcome, Phase
from carom.parameters import Parameters
from tests.bifurcations.test_rubbing import CHATTERING

pytestmark = pytest.mark.jit_only

PRESSED = PAPER.replace(omega=0.7362, rho=0.2389, mu=0.5159, d=0.1636, gamma=0.0375, radius_ratio=0.868)
"""A stable motion with lasting contact ends at the onset of it."""


def aloft(orbit: Orbit) -> State:
    """State in the middle of the longest flight."""
    longest = max(np.flatnonzero([segment.kind.flies for segment in orbit.word]), key=lambda i: orbit.durations[i])
    node = orbit.rotor.system.amplitudes_of(orbit.nodes)[longest]
    begun = departure(orbit.rotor, orbit.word[longest], node)
    return State.of(*orbit.rotor.system.state(orbit.rotor.system.fly(begun, np.array(0.5 * orbit.durations[longest]))))


def on(orbit: Orbit) -> Parameters:
    parameters: Parameters = orbit.rotor.parameters
    return parameters


@cache
def located(machine: Parameters, kind: str, low: float, high: float) -> Bifurcation:
    points = [
        point
        for orbit in rubbing_orbits(machine)
        for point in continue_orbit(orbit, "gamma", (low, high)).special
        if point.kind == kind
    ]
    return points[0]


@cache
def examined(machine: Parameters, kind: str, low: float, high: float) -> Border:
    return examine_border(located(machine, kind, low, high))


ONSET = CHATTERING, "contact-onset", 0.14, 0.2
PERMANENT = CHATTERING, "permanent-contact", 0.17, 0.25
STABLE_ONSET = PRESSED, "contact-onset", 0.03, 0.045


@pytest.mark.parametrize("border", [ONSET, PERMANENT, STABLE_ONSET])
def test_the_neighbour_is_what_a_simulation_does_on_the_other_side(border):
    found = examined(*border)
    (orbit,) = [each for each in found.neighbours if each is not None]
    assert orbit is found.beyond
    assert orbit.admissible
    assert (on(orbit).gamma - found.point.value) * found.inside < 0.0
    start = aloft(orbit)
    motion = simulate(orbit.rotor, start, orbit.period)
    # It comes back as closely as the derivative of the period carries what rounding leaves.
    apart = abs(motion.final.position - start.position) + abs(motion.final.velocity - start.velocity)
    assert apart < 1e-9
    lasting = (motion.segment_phases > Phase.FLIGHT).any()
    assert lasting == (not orbit.word.flies)
    if orbit.word.flies:
        assert int(motion.is_impact.sum()) == orbit.impacts


@pytest.mark.parametrize("border", [ONSET, PERMANENT, STABLE_ONSET])
def test_the_neighbour_attracts_or_repels_as_it_says(border):
    """A simulation that starts beside it comes nearer, or goes away, period by period."""
    orbit = examined(*border).beyond
    assert orbit is not None
    before, size, period = aloft(orbit), 1e-9, orbit.period
    motion = simulate(orbit.rotor, State(before.position, before.velocity * (1.0 + size)), 5.0 * period)
    start = np.array([before.position, before.velocity])
    apart = [np.abs(np.array(motion.at(np.array(k * period))) - start).max() for k in range(6)]
    # What leads along the orbit neither grows nor shrinks: the distance of a stable one falls to that.
    if orbit.stable:
        assert apart[5] < 5.0 * apart[0]
    else:
        assert apart[5] > 10.0 * apart[0]


def test_the_number_of_impacts_beyond_an_onset_is_that_of_fresh_motions():
    found = examined(*STABLE_ONSET)
    assert found.verdict == "continuous"
    assert found.beyond is not None
    assert found.beyond.stable
    assert "a continuous transition" in found.words
    assert f"{found.beyond.impacts - 1} × impact+ (stable)" in found.words
    # Other starts than that of the examination, at a distance of their own from the orbit.
    rng, before = np.random.default_rng(3), aloft(found.point.orbit)
    for _ in range(3):
        start = State(before.position, before.velocity * (1.0 + 1e-5 * rng.normal()))
        motion = simulate(found.beyond.rotor, start, settle=True)
        assert (motion.outcome, motion.multiplicity) == (Outcome.BOUNCING, found.beyond.impacts)
        # On the side of the orbit itself there is lasting contact.
        there = jeffcott(on(found.point.orbit).replace(gamma=found.point.value + found.inside * found.distances[-1]))
        assert simulate(there, start, settle=True).outcome is Outcome.MIXED


def test_the_departure_from_the_orbit_falls_with_the_distance():
    found = examined(*STABLE_ONSET)
    slope = np.polyfit(np.log(found.distances), np.log(found.departures), 1)[0]
    # It is proportional to the distance but for the number of impacts, which changes with its logarithm.
    assert slope == pytest.approx(1.0, abs=0.3)


def test_beyond_permanent_contact_the_flights_are_short():
    """Their height falls with the fourth power of their duration: whether one is found at the smallest distance is up to rounding."""
    found = examined(*PERMANENT)
    assert found.beyond is not None
    assert found.beyond.segments == "lift land slide+"
    distance = abs(on(found.beyond).gamma - found.point.value)
    assert np.isclose(distance, found.distances, rtol=1e-6).any()
    # The flight lasts as long as the normal force of the sliding that repeats would be below zero, times a number.
    assert 1e-3 < found.beyond.durations[0] < 1e-2
