"""Periodic motions of rotors that weigh something: whole turns of the shaft, closed, judged, and compared with other routes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from compliant_reference import BACKWARD, FORWARD, follow
from heavy_rotors import ONE, PHASE, RIGID, SIX, SOFT, THREE, heavy, of_two_coordinates, settled
from scipy.optimize import brentq, linear_sum_assignment

import carom as cm
from carom.models import Force, KelvinVoigt, Rigid, jeffcott
from carom.orbits import Kind, Word, find_orbits, lyapunov_exponents, orbit_exponents, orbit_near
from carom.orbits.shooting import Start, links_of, pack_free, unpack_free
from carom.outcome import InputError
from carom.parameters import Parameters

pytestmark = pytest.mark.jit_only
WORDS = {
    "three": ("impact+ impact+ impact+", 1),
    "one": ("impact+", 1),
    "six": ("impact+ impact+ impact+ impact+ impact+ impact+", 2),
    "landing": ("lift land slide+", 2),
    "plastic": ("lift land slide+ lift land slide+", 2),
    "bouncing": (" ".join(["slide+ lift"] * 4), 2),
    "parting": (" ".join(["slide+ free lift"] * 3), 1),
    "sticking": ("slide+ lift slide+ roll slide+ lift slide+ lift slide+ lift slide+ lift", 2),
}
ROTORS = RIGID | {name: rotor for name, (rotor, _) in SOFT.items()}


@pytest.fixture(scope="module")
def orbits():
    return {name: settled(rotor) for name, rotor in ROTORS.items()}


def in_flight(orbit):
    """State in the middle of the longest flight."""
    flight = int(np.argmax(orbit.durations * [segment.kind.flies for segment in orbit.word]))
    middle = float(orbit.durations[:flight].sum() + 0.5 * orbit.durations[flight])
    return cm.simulate(orbit.rotor, orbit.departure, middle).final


@pytest.mark.parametrize("name", WORDS)
def test_a_settled_motion_is_closed_and_takes_whole_turns(name, orbits):
    orbit = orbits[name]
    word, turns = WORDS[name]
    assert [str(turned) for turned in map(orbit.word.turned, range(len(orbit.word)))].count(word)
    assert orbit.turns == turns
    assert orbit.period == pytest.approx(math.tau * turns, rel=1e-13)
    assert orbit.links.size < 1e-13
    assert orbit.admissible
    assert orbit.stable
    assert len(orbit.multipliers.values) == 4
    # The weight points as it does at the time of the node, which has one entry more than coordinates and rates.
    assert np.abs(orbit.nodes[:, 2]) == pytest.approx(1.0, abs=1e-12)
    begins = orbit.time + np.concatenate([[0.0], np.cumsum(orbit.durations)[:-1]])
    assert orbit.nodes[:, 2] == pytest.approx(np.exp(-1j * begins), abs=1e-12)


@pytest.mark.parametrize("name", ["three", "plastic", "parting"])
def test_the_derivative_of_the_equations_is_that_of_their_differences(name, orbits):
    orbit, rotor = orbits[name], ROTORS[name]
    rng = np.random.default_rng(1)
    unknowns, m = pack_free(orbit.word, orbit.start), len(orbit.word)
    # Off the orbit, with a weight that is not that of the rotor.
    unknowns = unknowns + 1e-3 * rng.normal(size=len(unknowns))
    free = unpack_free(orbit.word, unknowns)
    assert free.nodes.shape == (m, 3)

    def reduced(change):
        return links_of(rotor, orbit.word, unpack_free(orbit.word, unknowns + change)).reduced

    step = 1e-6
    differences = [(reduced(step * e)[0] - reduced(-step * e)[0]) / (2.0 * step) for e in np.eye(len(unknowns))]
    assert reduced(0.0)[1] == pytest.approx(np.transpose(differences), abs=1e-5, rel=1e-5)


@pytest.mark.parametrize("name", WORDS)
def test_a_motion_simulated_from_it_repeats_for_many_turns(name, orbits):
    orbit = orbits[name]
    middle = in_flight(orbit).time - orbit.time
    motion = cm.simulate(ROTORS[name], orbit.departure, 40 * orbit.period)
    positions, velocities = motion.at(middle + orbit.period * np.arange(40))
    # As stable orbits they forget rounding; that of chatters leaves out bounces.
    assert positions == pytest.approx(positions[0], abs=1e-10)
    assert velocities == pytest.approx(velocities[0], abs=1e-10)


@pytest.mark.parametrize("name", SOFT)
def test_an_integrator_of_the_equations_of_motion_repeats_it(name, orbits):
    orbit, (_, reference) = orbits[name], SOFT[name]
    begin = in_flight(orbit)
    # In the frame of the reference, weight points along the negative real axis at time zero.
    ahead = begin.position * -1j, begin.velocity * -1j
    motion = follow(reference, [ahead[0]], [ahead[1]], begin.time + orbit.period, begin.time)
    touches = sum(
        segment.kind.lasts and arrives for segment, arrives in zip(orbit.word, orbit.word.arrives, strict=True)
    )
    assert sum(event.phase in (FORWARD, BACKWARD) for event in motion.events) >= touches
    assert motion.position[0] == pytest.approx(ahead[0], abs=1e-9)
    assert motion.velocity[0] == pytest.approx(ahead[1], abs=1e-9)


def stroboscopic(rotor, begin, period, step):
    """Derivative of the state after a period by that at a time, the phase of the weight fixed, by differences of simulations."""
    n = np.size(begin.position)

    def after(change):
        state = np.concatenate([np.atleast_1d(begin.position), np.atleast_1d(begin.velocity)]) + change.view(complex)
        start = cm.State(*((state[:n], state[n:]) if n > 1 else state), time=begin.time)
        end = cm.simulate(rotor, start, period).final
        return np.concatenate([np.atleast_1d(part) for part in (end.position, end.velocity)]).view(float)

    return np.array([(after(step * e) - after(-step * e)) / (2.0 * step) for e in np.eye(4 * n)]).T


def apart(first, second):
    """Largest distance of the values of two lists in the best order."""
    distances = np.abs(np.asarray(first)[:, None] - np.asarray(second))
    return distances[linear_sum_assignment(distances)].max()


@pytest.mark.parametrize("name", WORDS)
def test_all_multipliers_are_those_of_the_stroboscopic_map(name, orbits):
    orbit, rotor = orbits[name], ROTORS[name]
    values = np.linalg.eigvals(stroboscopic(rotor, in_flight(orbit), orbit.period, 1e-5))
    # Central differences of a step of 1e-5; where two multipliers are zero, their square root of it.
    tolerance = 1e-7 if np.abs(orbit.multipliers.values).min() > 1e-6 else 2e-4
    assert apart(values, orbit.multipliers.values) < tolerance


@pytest.mark.parametrize("law", [Rigid(0.5), KelvinVoigt(1e3, 10.0)], ids=["rigid", "yielding"])
def test_rotors_of_several_coordinates_and_planes(law):
    rotor = of_two_coordinates(law, 0.38)
    orbit = settled(rotor, 0.1, 0.2)
    assert orbit.turns == 1
    assert {0, 1} == set(orbit.word.planes.tolist())
    assert orbit.admissible
    assert len(orbit.multipliers.values) == 8
    values = np.linalg.eigvals(stroboscopic(rotor, in_flight(orbit), orbit.period, 1e-5))
    assert apart(values, orbit.multipliers.values) < 1e-7


def test_an_orbit_turns_with_weight_and_unbalance():
    numbers = 0.123, 0.383, 0.388, 0.399, 0.05, 0.5, 3.0
    orbit = settled(ONE)
    both = settled(heavy(*numbers, phi=PHASE + 0.7, direction=-1j * np.exp(0.7j)))
    assert both.nodes[:, :2] == pytest.approx(orbit.nodes[:, :2] * np.exp(0.7j), abs=1e-12)
    assert both.multipliers.values == pytest.approx(orbit.multipliers.values, abs=1e-11)
    # Weight that points elsewhere at time zero is the same weight at another time.
    later = settled(heavy(*numbers, direction=-1j * np.exp(0.7j)))
    assert later.nodes[:, :2] == pytest.approx(orbit.nodes[:, :2], abs=1e-12)
    assert later.time == pytest.approx((orbit.time + 0.7) % math.tau, abs=1e-12)


@pytest.fixture(scope="module")
def of_one_turn():
    """An orbit of a rotor without weight that takes one turn of the shaft, by the closed form; it need not be a motion."""

    def bounce(gamma):
        return find_orbits(jeffcott(Parameters(gamma, 0.6, 3 / 7, 0.21, 0.15, 0.95, 400 / 7)), 7.5)["B2,c"]

    return bounce(brentq(lambda gamma: bounce(gamma).period - math.tau, 0.01, 0.03, xtol=1e-15))


@pytest.mark.parametrize("pull", [1e-3, 1e-4])
def test_a_small_weight_leaves_two_of_the_phases_of_an_orbit_that_takes_one_turn(pull, of_one_turn):
    rotor = of_one_turn.rotor.under(Force(-1j, np.array([-1j * pull])))

    def at(phase):
        nodes = np.append(of_one_turn.nodes, [[np.exp(-1j * phase)]], axis=1)
        return orbit_near(rotor, of_one_turn.word, Start(nodes, of_one_turn.durations))

    first, second = at(1.690), at(1.690 + math.pi)
    assert first.turns == second.turns == 1
    # To first order the weight acts on the phase as a pendulum without inertia: two places half a turn apart, one of which repels.
    assert second.time - first.time == pytest.approx(math.pi, abs=5.0 * pull)
    for orbit in (first, second):
        assert np.abs(orbit.nodes[:, :2] - of_one_turn.nodes).max() < 5.0 * pull
        others = sorted(orbit.multipliers.values, key=lambda value: abs(value - 1.0))
        assert apart(others[1:], of_one_turn.multipliers.values) < 20.0 * pull
    slow = [min(orbit.multipliers.values.real - 1.0, key=abs) / pull for orbit in (first, second)]
    assert slow[0] < 0.0 < slow[1]
    assert slow[0] == pytest.approx(-slow[1], rel=50.0 * pull)


@pytest.mark.parametrize("name", ["three", "one", "six", "bouncing", "parting"])
def test_measured_exponents_are_those_of_the_multipliers(name, orbits):
    orbit = orbits[name]
    exact, motion = orbit_exponents(orbit), lyapunov_exponents(ROTORS[name], orbit.departure, 600, transient=60)
    assert len(exact.values) == 5
    # The sum by the trace of the flow and the determinants of impacts, or the work of the walls' damping, is another route.  A direction
    # that shrinks to 1e-9 of its size in a period, as where the rotor parts from its wall, is known to seven digits.
    within = 1e-6 if name == "parting" else 1e-9
    assert exact.values.sum() == pytest.approx(exact.volume, rel=within)
    assert motion.values.sum() == pytest.approx(motion.volume, rel=within)
    # Over whole periods but a part, in which the directions of a pair turn.
    assert motion.values == pytest.approx(exact.values, abs=5e-3)
    assert exact.along == 0.0


def test_a_search_finds_orbits_and_says_how_many_turns_they_take():
    found = find_orbits(THREE, impacts=3, guesses=40)
    assert [orbit.turns for orbit in found if orbit.stable]
    assert all(orbit.admissible for orbit in found)
    assert "turns" in dict(found[0].rows())
    (stable,) = [orbit for orbit in found if orbit.stable and orbit.impacts == 3 and orbit.turns == 1]
    assert stable.period == pytest.approx(settled(THREE).period)
    assert found.search.on_listed > 0


def test_a_start_of_the_wrong_weight_is_corrected_to_its_size():
    orbit = settled(SIX)
    nodes = orbit.nodes.copy()
    nodes[:, 2] *= 1.02
    found = orbit_near(SIX, orbit.word, Start(nodes, orbit.durations * 1.001))
    assert np.abs(found.nodes[:, 2]) == pytest.approx(1.0, abs=1e-12)
    assert found.nodes == pytest.approx(orbit.nodes, abs=1e-11)
    with pytest.raises(InputError, match=r"^start = \(6, 2\): nodes of shape \(6, 3\)"):
        orbit_near(SIX, orbit.word, Start(nodes[:, :2], orbit.durations))


def test_forces_that_change_in_the_fixed_frame_are_refused():
    shaken = jeffcott(THREE.planar).under(Force(0.5j, np.array([0.3])))
    with pytest.raises(InputError, match=r"^machine = forces that change in the fixed frame: .*, or weight$"):
        orbit_near(shaken, Word.of(Kind.IMPACT_FORWARD), Start(np.ones((1, 2), complex), np.ones(1)))
    assert settled(shaken) is None
