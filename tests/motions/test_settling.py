"""Motions of ensembles end where their end is proven, and nothing else changes."""

import math

import numpy as np
import pytest
from linear_rotors import planar_rotor, random_rotor, tilting, touchdowns
from machines import PAPER
from sliding_motions import ahead_of, assert_slides_to_the_rub

import carom
from carom.attractors.naming import name_motions
from carom.base.outcome import Outcome, Phase
from carom.closed_forms import rub_neighbourhood, runaway_speed
from carom.core.closing import PASSES
from carom.core.planar_proofs import absorbed
from carom.core.settling import memory
from carom.models import from_matrices
from carom.motions import State, settle, simulate
from carom.motions.settling import fresh_memory, least_recurrence, settled

pytestmark = pytest.mark.jit_only


@pytest.mark.parametrize("seed", range(5))
def test_the_kernel_knows_the_same_states(seed):
    """All round the wall, and up to the level but for rounding."""
    rng = np.random.default_rng(seed)
    machine = PAPER.replace(
        gamma=float(rng.uniform(0.02, 0.3)),
        mu=float(rng.choice([0.0, rng.uniform(0.0, 0.5)])),
        rho=float(rng.uniform(0.5, 1.2)),
        phi=float(rng.uniform(-3.0, 3.0)),
    )
    rotor = carom.models.jeffcott(machine)
    found, recollection = rub_neighbourhood(rotor), fresh_memory(rotor, 1, absorb=True)
    angles, rates = rng.uniform(-math.pi, math.pi, 5000), rng.uniform(-1.0, 1.0, 5000)
    # Some to within a few parts in a million of the level, to both sides.
    share = np.sqrt(found.level / found.value(angles[2500:], rates[2500:]))
    rates[2500:] *= share * (1.0 + rng.uniform(-3e-6, 3e-6, 2500))
    known = [
        absorbed(recollection.proofs, recollection.rub_position, np.exp(1j * angle), rate)
        for angle, rate in zip(angles, rates, strict=True)
    ]
    values = found.value(angles, rates)
    clear = np.abs(values / found.level - 1.0) > 1e-8
    assert clear.mean() > 0.9
    np.testing.assert_array_equal(np.array(known)[clear], (values < found.level)[clear])
    assert found.contains(angles[known], rates[known]).all()
    unproven = fresh_memory(rotor, 1)
    assert not absorbed(unproven.proofs, unproven.rub_position, np.exp(1j * found.angle), 0.0)


@pytest.fixture(params=[0.2, 0.3])
def rotor(request):
    return carom.models.jeffcott(PAPER.replace(gamma=request.param))


def sliding(found, times_level, seed):
    """Sliding states of a multiple of the level."""
    rng = np.random.default_rng(seed)
    angles = found.angle + rng.uniform(-0.3, 0.3, 200)
    room = 2.0 * (times_level * found.level - found.value(angles, np.zeros(200)))
    angles, room = angles[room > 0.0], room[room > 0.0]
    ahead = np.array(ahead_of(found, angles))
    rates = np.sqrt(room * np.exp(-2.0 * found.friction * ahead)) * rng.choice([-1.0, 1.0], len(room))
    positions = np.exp(1j * angles)
    return positions, 1j * rates * positions


def test_an_ensemble_ends_a_motion_inside_at_once_and_outside_later(rotor):
    found = rub_neighbourhood(rotor)
    for times_level, at_once in ((0.999, True), (1.001, False)):
        starts = sliding(found, times_level, seed=5)
        assert len(starts[0]) > 50
        endings = settle(rotor, State(*starts))
        np.testing.assert_array_equal(endings.times == 0.0, at_once)
        if at_once:
            assert (endings.outcomes == Outcome.FORWARD_RUB).all()
            np.testing.assert_allclose(endings.positions, starts[0], atol=1e-15)
            np.testing.assert_allclose(endings.velocities, starts[1], atol=1e-15)


def settled_both_ways(rotor, count, seed, monkeypatch):
    """Endings with proofs and without: they differ in nothing but when and where they were known."""
    rng = np.random.default_rng(seed)
    turns = np.exp(2j * np.pi * rng.uniform(0.0, 1.0, (2, count)))
    starts = np.sqrt(rng.uniform(0.0, 1.0, count)) * turns[0], 2.0 * np.sqrt(rng.uniform(0.0, 1.0, count)) * turns[1]
    proven = settle(rotor, State(*starts))
    monkeypatch.setattr(
        "carom.motions.portions.fresh_memory", lambda rotor, patience, absorb, trigger: fresh_memory(rotor, patience)
    )
    followed = settle(rotor, State(*starts))
    for name in ("outcomes", "impacts", "multiplicities"):
        np.testing.assert_array_equal(getattr(proven, name), getattr(followed, name), err_msg=name)
    return proven, followed


def test_the_proof_changes_when_motions_end_and_nothing_else(rotor, monkeypatch):
    proven, followed = settled_both_ways(rotor, 400, 11, monkeypatch)
    rubs = proven.outcomes == Outcome.FORWARD_RUB
    assert rubs.sum() > 300
    assert (proven.times[rubs] < followed.times[rubs]).all()
    rolls = proven.outcomes == Outcome.ROLLING
    assert (proven.times[rolls] < followed.times[rolls]).all()
    others = ~(rubs | rolls)
    np.testing.assert_array_equal(proven.times[others], followed.times[others])
    names = [name_motions(rotor, endings) for endings in (proven, followed)]
    np.testing.assert_array_equal(names[0][0], names[1][0])
    assert names[0][1] == names[1][1]
    assert "synchronous rub" in names[0][1]
    found = rub_neighbourhood(rotor)
    for place in np.flatnonzero(rubs)[:30]:
        assert_slides_to_the_rub(rotor, found, State(proven.positions[place], proven.velocities[place]))


@pytest.mark.parametrize("gamma", [0.05, 0.1])
def test_the_runaway_ends_motions_earlier_and_changes_nothing_else(gamma, monkeypatch):
    rotor, count = carom.models.jeffcott(PAPER.replace(gamma=gamma)), 600
    proven, followed = settled_both_ways(rotor, count, 12, monkeypatch)
    rolls = np.flatnonzero(proven.outcomes == Outcome.ROLLING)
    assert len(rolls) > 0.05 * count
    assert (proven.times[rolls] < followed.times[rolls]).all()
    whirl = -1.0 - (proven.positions.conjugate() * proven.velocities)[rolls].imag
    assert (whirl > runaway_speed(rotor).certain).all()
    for place in rolls[:10]:
        state = State(proven.positions[place], proven.velocities[place])
        onward = simulate(rotor, state, 1e4, settle=True)
        assert onward.outcome is Outcome.ROLLING
        assert not len(onward.contacts)


def test_a_rub_that_runs_round_the_wall_is_not_judged_as_one_at_rest():
    """Of a rotor whose rubs are not known; a full turn has shown that it is steady."""
    rotor = tilting(forcing=np.array([2.0, 0.05])).model
    contact = np.array([int(Phase.FORWARD_SLIP), -1])
    for angle in np.linspace(0.0, 6.0, 13):
        recollection, place = fresh_memory(rotor, 100), np.exp(1j * angle)
        amplitudes = rotor.system.amplitudes(np.array([0.9, 0.125]) * place, np.array([0.3j, 0.04j]) * place)
        assert recollection.resting
        assert settled(rotor, amplitudes, contact, Outcome.FORWARD_RUB, recollection) == (Outcome.FORWARD_RUB, 0)
        assert recollection.resting == 1


@pytest.mark.jit_only
@pytest.mark.parametrize("gamma", [0.082, 0.085, 0.1])
def test_multiplicities_of_any_rotor_are_those_of_the_planar_one(gamma):
    """Also next to period doubling, at a damping of 0.08338, where motions recur after two periods first."""
    one = PAPER.replace(gamma=gamma)
    model = from_matrices(
        mass=np.eye(2),
        damping=np.diag([gamma, 0.2]),
        stiffness=np.diag([one.omega**2, 0.7]),
        forcing=[one.rho * np.exp(1j * one.phi), 0.3],
        touchdowns=touchdowns([[1.0, 0.0]], [one.mu], [one.d], [one.radius_ratio + 1.0]),
    )
    orbit = carom.find_orbits(one)["B1,d"].departure
    for nudge in (0.99, 1.005):
        state = State(orbit.position, nudge * orbit.velocity)
        planar = simulate(one, state, settle=True)
        general = simulate(model, State(np.array([state.position, 0.1]), np.array([state.velocity, 0.0])), settle=True)
        assert (general.outcome, general.multiplicity) == (planar.outcome, planar.multiplicity)
        if planar.outcome is Outcome.BOUNCING and gamma != 0.082:
            assert general.multiplicity == 1


@pytest.mark.jit_only
def test_a_motion_that_passes_by_a_repelling_orbit_goes_on():
    """Started on a saddle, to rounding, it recurs there and then leaves."""
    one = PAPER.replace(gamma=0.1)
    saddle = carom.find_orbits(one)["B1,b"]
    rotor = planar_rotor(
        one.gamma,
        one.omega**2,
        one.rho * np.exp(1j * one.phi),
        touchdowns([[1.0], [0.1]], [one.mu] * 2, [one.d] * 2, [one.radius_ratio + 1.0] * 2),
    )
    system, contact = rotor.system, np.array([0, -1])
    own = memory(system.modes)
    before = saddle.section.state
    amplitudes = system.amplitudes(before.position, before.velocity * (1.0 + 1e-11))
    assert least_recurrence(system, amplitudes, contact, 1, own) == PASSES
    stable = carom.find_orbits(one)["B1,d"].section.state
    amplitudes = system.amplitudes(stable.position, stable.velocity)
    assert least_recurrence(system, amplitudes, contact, 1, own) == 1
    assert least_recurrence(system, amplitudes, contact, 6, own) == 1
    assert least_recurrence(system, amplitudes, contact, 0, own) == 0


def test_a_whirl_that_never_repeats_is_known_for_what_it_is():
    """Its stick and slip do not keep time with its turns: it never recurs, and goes on turning backward in contact."""
    rotor = random_rotor(10_008, n=4, planes=1)
    motion = simulate(rotor, carom.kick(2.0, angle=1.0))
    assert motion.outcome is Outcome.BACKWARD_WHIRL
    later = simulate(rotor, motion.final, 400.0)
    assert (later.segment_phases[1:] != Phase.FLIGHT).all()  # it starts on the wall, in flight for no time
    assert {Phase.FORWARD_SLIP, Phase.ROLLING} <= set(later.segment_phases.ravel().tolist())
    turns = np.unwrap(np.angle(later.at_plane(np.linspace(0.0, 400.0, 40_000))[0])) / (2.0 * np.pi)
    # Backward in the fixed frame, which the co-rotating one turns through forward.
    assert turns[-1] - turns[0] < -1.5 * 400.0 / (2.0 * np.pi)
