"""Rotors of several coordinates and contact planes against a general integrator in the fixed frame."""

import numpy as np
import pytest
from compilation import sized
from linear_rotors import bending, single, tilting, to_fixed

from carom import State, kick, settle, simulate
from carom.base.outcome import Outcome, Phase

pytestmark = pytest.mark.jit_only

GROWN = 1e-7
"""Errors up to which bounces are compared; their growth is then a matter of first derivatives."""
CLOSE = 1e-9
SIGNS = {Phase.FORWARD_SLIP: 1, Phase.BACKWARD_SLIP: -1, Phase.ROLLING: 0}
ROTORS = {
    "2 modes, 2 planes": single(),
    "4 modes, 2 planes": tilting(),
    "pressed, 4 modes, 2 planes": tilting(forcing=np.array([0.88 + 0.18j, 0.05])),
    "8 modes, 1 plane": bending(1, restitution=0.6, forcing=np.array([0.6, 0.3, 0.1, 0.0])),
}
MORE = {"4 modes, 1 plane": tilting(1), "8 modes, 2 planes": bending()}
CASES = [*ROTORS, *(pytest.param(name, marks=pytest.mark.deep) for name in MORE)]


@pytest.fixture(params=CASES, scope="module")
def rotor(request):
    return {**ROTORS, **MORE}[request.param]


def motions(rotor, until, count):
    """Motions after kicks in several directions, or from the centre if it cannot levitate."""
    if (np.abs(rotor.model.system.arrays.offsets) >= 1.0).any():
        none = np.zeros(len(rotor.mass), complex)
        # The planes land in turn: first the one towards which a start tilts.
        tilts = np.resize([1.0, -1.0], len(none))
        return [simulate(rotor.model, State(none, 0.3 * k * tilts ** (k % 2)), until) for k in range(count)]
    kicks = [(2.0, 1.3), (1.2, 0.3), (0.7, 2.5), *((1.0 + 0.2 * k, 1.7 * k) for k in range(count))]
    return [simulate(rotor.model, kick(*push), until) for push in kicks[:count]]


def test_bounces_are_those_of_a_general_integrator(rotor):
    compared, planes = 0, set()
    for motion in motions(rotor, 30.0, sized(3, 1, 12)):
        hits = np.flatnonzero(motion.is_impact)
        flights = (motion.segment_phases[hits] == Phase.FLIGHT).all(axis=1).cumprod().sum()
        start = to_fixed(0.0, np.atleast_1d(motion.start.position), np.atleast_1d(motion.start.velocity))
        found = rotor.bounces(*start, 30.0, min(12, flights))
        times = motion.segment_starts[1:][hits]
        states = (
            np.reshape(part, (len(hits), len(rotor.mass)))
            for part in motion.rotor.system.state(motion.event_amplitudes[hits])
        )
        own = to_fixed(times, *states)
        for k, (time, plane, position, velocity) in enumerate(found):
            apart = np.abs(own[0][k] - position).max() + np.abs(own[1][k] - velocity).max()
            if apart > GROWN:
                break
            assert apart < CLOSE * (k + 1)
            assert abs(times[k] - time) < CLOSE
            assert motion.event_planes[hits[k]] == plane
            compared += 1
            planes.add(plane)
    assert compared >= sized(10, 4, 50)
    assert len(planes) == (2 if rotor in (ROTORS["4 modes, 2 planes"], MORE["8 modes, 2 planes"]) else len(planes))


def test_lasting_contact_is_that_of_a_general_integrator(rotor):
    """Each stretch of sliding or rolling, also at two planes at once: its end, and its normal forces and slip."""
    seen: set[tuple[int, ...]] = set()
    for motion in motions(rotor, 60.0, sized(4, 2, 16)):
        ends, system = np.append(motion.segment_starts, motion.time), motion.rotor.system
        lasting = np.flatnonzero((motion.segment_phases[:-1] != Phase.FLIGHT).any(axis=1) & (np.diff(ends[:-1]) > 1e-6))
        kinds = {tuple(motion.segment_phases[place].tolist()): place for place in lasting[::-1]}
        for place in {*kinds.values(), *lasting[: sized(40, 5, 400)].tolist()}:
            phases = motion.segment_phases[place]
            slips = {plane: SIGNS[Phase(phase)] for plane, phase in enumerate(phases) if phase != Phase.FLIGHT}
            begin, end = ends[place], ends[place + 1]
            first = to_fixed(begin, *(np.atleast_1d(part) for part in system.state(motion.segment_amplitudes[place])))
            last = to_fixed(end, *(np.atleast_1d(part) for part in system.state(motion.event_amplitudes[place])))
            found = rotor.follow(begin, end, *first, slips)
            assert sum(np.abs(one - other).max() for one, other in zip(found, last, strict=True)) < CLOSE
            middle = 0.5 * (begin + end)
            state = to_fixed(middle, *(np.atleast_1d(part) for part in motion.at(np.array(middle))))
            _, forces = rotor.rubbing(middle, *state, slips)
            for (plane, sign), (normal, along) in zip(slips.items(), forces, strict=True):
                own = motion.seen_at(plane).forces(np.array(middle))
                assert np.allclose(np.array(own), (normal, along), rtol=0, atol=CLOSE)
                assert normal > -CLOSE
                place_of, speed_of = (rotor.planes[plane] @ part for part in state)
                slip = rotor.radius_ratio + (np.conj(place_of) * speed_of).imag
                assert (
                    sign * slip > -CLOSE
                    if sign
                    else abs(slip) < CLOSE and abs(along) <= rotor.friction * normal + CLOSE
                )
            seen.add(tuple(phases.tolist()))
    assert seen
    if rotor is ROTORS["pressed, 4 modes, 2 planes"]:
        assert {(1, 1), (1, 0), (0, 1)} <= seen


def test_no_plane_leaves_its_clearance(rotor):
    for motion in motions(rotor, 60.0, 3):
        times = motion.sample(4000)
        for plane in range(len(rotor.planes)):
            assert motion.seen_at(plane).radius(times).max() < 1.0 + 1e-11


def test_planes_that_meet_their_walls_together():
    """A symmetric rotor without tilt: both ends strike at once, and are struck one after the other."""
    rotor = tilting(arms=(0.7, -0.7), gyroscopic=np.zeros((2, 2)), forcing=np.array([0.25 * np.exp(0.2j), 0.0]))
    outcomes = []
    for k in range(sized(8, 2, 100)):
        motion = simulate(rotor.model, kick(0.5 + 0.25 * k, 0.7 * k), 2000.0, settle=True)
        outcomes.append(motion.outcome)
        times = motion.sample(1000)
        assert max(motion.seen_at(plane).radius(times).max() for plane in (0, 1)) < 1.0 + 1e-11
    assert Outcome.GRAZING not in outcomes


@pytest.mark.parametrize(("inertia", "restitution"), [(0.1, 0.3), (0.06, 0.0), (0.1, 0.9)])
def test_impacts_that_alternate_in_one_instant_are_no_orbit(inertia, restitution):
    """Both ends start on their walls, coupled so that each impact drives the other end outward."""
    rotor = tilting(
        arms=(1.0, -1.0),
        mass=np.diag([1.0, inertia]),
        gyroscopic=np.zeros((2, 2)),
        damping=0.1 * np.diag([2.0, 2.0]),
        stiffness=0.3 * np.diag([2.0, 2.0]),
        forcing=np.array([0.2, 0.0]),
        friction=0.05,
        restitution=restitution,
    )
    start = State(np.array([1.0, 0.0]), np.array([1.0, 0.1]))
    alone = simulate(rotor.model, start, 400.0, settle=True)
    together = settle(rotor.model, State(start.position, start.velocity), until=400.0)
    assert alone.outcome is Outcome.LEVITATED
    assert together.outcomes == alone.outcome
    assert together.times == pytest.approx(alone.time, rel=1e-12)


def test_strong_coupling_keeps_planes_inside():
    random = np.random.default_rng(7)
    for _ in range(sized(4, 1, 60)):
        rotor = tilting(
            arms=(1.0, random.uniform(0.5, 1.2)),
            mass=np.diag([1.0, random.uniform(0.3, 3.0)]),
            friction=random.uniform(0.0, 0.5),
            restitution=random.uniform(0.0, 0.9),
        )
        start = State(np.zeros(2, complex), random.uniform(0.5, 3.0, 2) * np.exp(2j * np.pi * random.random(2)))
        motion = simulate(rotor.model, start, 30.0, max_events=3000)
        times = motion.sample(2000)
        assert max(motion.seen_at(plane).radius(times).max() for plane in (0, 1)) < 1.0 + 1e-11
