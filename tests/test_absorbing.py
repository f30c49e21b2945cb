"""The proven neighbourhood of the synchronous rub, and what ends motions by proof."""

from __future__ import annotations

import math

import numpy as np
import pytest
from machines import PAPER
from scipy.integrate import solve_ivp

import carom
from carom.absorbing import rub_neighbourhood
from carom.basins.motions import name_motions
from carom.core.fate import absorbed
from carom.ensembles import settle_all
from carom.outcome import Outcome, Phase
from carom.trajectories import State, fresh_memory, simulate
from carom.whirl import rolling, runaway_speed

pytestmark = pytest.mark.jit_only

SLENDER = PAPER.replace(radius_ratio=0.05)


def inside(found, count, seed):
    """Random sliding states of the neighbourhood."""
    rng = np.random.default_rng(seed)
    angles = found.angle + rng.uniform(-math.pi, math.pi, 40 * count)
    rates = rng.uniform(-1.0, 1.0, 40 * count)
    chosen = np.flatnonzero(found.contains(angles, rates))[:count]
    return angles[chosen], rates[chosen]


@pytest.mark.parametrize("gamma", [0.08, 0.2, 0.35])
def test_every_state_in_it_goes_over_to_the_rub(gamma):
    rotor = carom.jeffcott(PAPER.replace(gamma=gamma))
    found = rub_neighbourhood(rotor)
    angles, rates = inside(found, 60, seed=1)
    assert len(angles) > 20
    for position, rate in zip(np.exp(1j * angles), rates, strict=True):
        assert_slides_to_the_rub(rotor, found, State(position, 1j * rate * position))


def assert_slides_to_the_rub(rotor, found, start):
    """A motion goes over to the rub without leaving the wall, by the criterion of its place and speed alone."""
    motion = simulate(rotor, start, 1e5, settle=True)
    assert motion.outcome is Outcome.FORWARD_RUB
    assert not motion.is_impact.any()
    assert set(motion.segment_phases[1:]) == {Phase.FORWARD_SLIP}
    assert motion.final.position == pytest.approx(np.exp(1j * found.angle), abs=2e-9)
    assert abs(motion.final.velocity) < 1e-9


@pytest.mark.parametrize("seed", range(12))
def test_the_function_falls_along_sliding(seed):
    """``V`` of a general solver's path along the wall falls as the derivation says, at random machines."""
    rng = np.random.default_rng(seed)
    machine = PAPER.replace(
        gamma=float(rng.uniform(0.02, 0.3)),
        mu=float(rng.choice([0.0, rng.uniform(0.0, 0.5)])),
        rho=float(rng.uniform(0.5, 1.2)),
    )
    found = rub_neighbourhood(carom.jeffcott(machine))
    assert found is not None

    def rate(_, state):
        x, w = state[0] - machine.phi, state[1]
        force = machine.rho * math.cos(x) + (1.0 + w) ** 2 - machine.omega**2
        assert force > 0.0
        return [w, -machine.gamma * (1.0 + w) - machine.rho * math.sin(x) - machine.mu * force]

    angles, rates = inside(found, 3, seed)
    for angle, speed in zip(angles, rates, strict=True):
        path = solve_ivp(rate, (0.0, 40.0), [angle, speed], rtol=1e-10, atol=1e-12, max_step=0.05)
        values = found.value(*path.y)
        assert (np.diff(values) <= 1e-10).all()
        assert (values < found.level).all()
        weight = np.exp(2.0 * machine.mu * np.asarray(_ahead(found, path.y[0])))
        slope = -(machine.gamma + 2.0 * machine.mu) * path.y[1] ** 2 * weight
        expected = np.concatenate([[0.0], np.cumsum(0.5 * (slope[1:] + slope[:-1]) * np.diff(path.t))])
        assert values - values[0] == pytest.approx(expected, abs=2e-4)


def _ahead(found, angles):
    low = -math.pi - 2.0 * found.phase
    return np.mod(angles - found.angle - low, 2.0 * math.pi) + low


def test_the_wall_pushes_and_slip_is_forward_all_over_it():
    for machine in (PAPER, PAPER.replace(gamma=0.3), SLENDER):
        found = rub_neighbourhood(carom.jeffcott(machine))
        angles, rates = np.meshgrid(found.angle + np.linspace(-math.pi, math.pi, 801), np.linspace(-2.0, 2.0, 801))
        held = found.contains(angles, rates)
        push = machine.rho * np.cos(angles - machine.phi) + (1.0 + rates) ** 2 - machine.omega**2
        slip = machine.radius_ratio + 1.0 + rates
        assert held.any()
        assert push[held].min() > 0.0
        assert slip[held].min() > 0.0


def test_it_is_as_large_as_its_limit_allows():
    """Just beyond the level something gives: here the wall stops pushing."""
    machine = PAPER.replace(gamma=0.2)
    found = rub_neighbourhood(carom.jeffcott(machine))
    assert found.limit == "lift-off"
    angles, rates = np.meshgrid(found.angle + np.linspace(-2.0, 2.0, 2001), np.linspace(-1.0, 0.0, 2001))
    beyond = found.value(angles, rates) < 1.01 * found.level
    push = machine.rho * np.cos(angles - machine.phi) + (1.0 + rates) ** 2 - machine.omega**2
    assert push[beyond].min() < 0.0


def test_none_where_there_is_no_stable_rub():
    assert rub_neighbourhood(carom.jeffcott(PAPER.replace(gamma=0.5))) is None


def test_it_takes_no_loss_of_speed_at_impacts():
    machine = PAPER.replace(gamma=0.2)
    assert rub_neighbourhood(carom.jeffcott(machine.replace(d=1.0))) == rub_neighbourhood(carom.jeffcott(machine))


def test_none_where_double_precision_can_prove_none():
    fold = PAPER.rho * math.hypot(1.0, PAPER.mu) - PAPER.mu * (1.0 - PAPER.omega**2)
    assert rub_neighbourhood(carom.jeffcott(PAPER.replace(gamma=fold * (1.0 - 1e-4)))) is not None
    assert rub_neighbourhood(carom.jeffcott(PAPER.replace(gamma=fold * (1.0 - 1e-11)))) is None


# ------------------------------------------------------------------------------------------------ ends of motions


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
    rotor = carom.jeffcott(machine)
    found, recollection = rub_neighbourhood(rotor), fresh_memory(rotor, 1, absorb=True)
    angles, rates = rng.uniform(-math.pi, math.pi, 5000), rng.uniform(-1.0, 1.0, 5000)
    # Some to within a few parts in a million of the level, to both sides.
    share = np.sqrt(found.level / found.value(angles[2500:], rates[2500:]))
    rates[2500:] *= share * (1.0 + rng.uniform(-3e-6, 3e-6, 2500))
    known = [absorbed(recollection, np.exp(1j * angle), rate) for angle, rate in zip(angles, rates, strict=True)]
    values = found.value(angles, rates)
    clear = np.abs(values / found.level - 1.0) > 1e-8
    assert clear.mean() > 0.9
    np.testing.assert_array_equal(np.array(known)[clear], (values < found.level)[clear])
    assert found.contains(angles[known], rates[known]).all()
    assert not absorbed(fresh_memory(rotor, 1), np.exp(1j * found.angle), 0.0)


@pytest.fixture(params=[0.2, 0.3])
def rotor(request):
    return carom.jeffcott(PAPER.replace(gamma=request.param))


def sliding(found, times_level, seed):
    """Sliding states of a multiple of the level."""
    rng = np.random.default_rng(seed)
    angles = found.angle + rng.uniform(-0.3, 0.3, 200)
    room = 2.0 * (times_level * found.level - found.value(angles, np.zeros(200)))
    angles, room = angles[room > 0.0], room[room > 0.0]
    ahead = np.array(_ahead(found, angles))
    rates = np.sqrt(room * np.exp(-2.0 * found.friction * ahead)) * rng.choice([-1.0, 1.0], len(room))
    positions = np.exp(1j * angles)
    return positions, 1j * rates * positions


def test_an_ensemble_ends_a_motion_inside_at_once_and_outside_later(rotor):
    found = rub_neighbourhood(rotor)
    for times_level, at_once in ((0.999, True), (1.001, False)):
        starts = sliding(found, times_level, seed=5)
        assert len(starts[0]) > 50
        endings = settle_all(rotor, *starts)
        np.testing.assert_array_equal(endings.times == 0.0, at_once)
        if at_once:
            assert (endings.outcomes == Outcome.FORWARD_RUB).all()
            np.testing.assert_allclose(endings.positions, starts[0], atol=1e-15)
            np.testing.assert_allclose(endings.velocities, starts[1], atol=1e-15)


def test_the_proof_changes_when_motions_end_and_nothing_else(rotor, monkeypatch):
    rng = np.random.default_rng(11)
    count = 400
    turns = np.exp(2j * np.pi * rng.uniform(0.0, 1.0, (2, count)))
    starts = np.sqrt(rng.uniform(0.0, 1.0, count)) * turns[0], 2.0 * np.sqrt(rng.uniform(0.0, 1.0, count)) * turns[1]
    proven = settle_all(rotor, *starts)
    monkeypatch.setattr("carom.ensembles.fresh_memory", lambda rotor, patience, absorb: fresh_memory(rotor, patience))
    followed = settle_all(rotor, *starts)
    for name in ("outcomes", "impacts", "multiplicities"):
        np.testing.assert_array_equal(getattr(proven, name), getattr(followed, name), err_msg=name)
    rubs = proven.outcomes == Outcome.FORWARD_RUB
    assert rubs.sum() > 300
    assert (proven.times[rubs] < followed.times[rubs]).all()
    rolls = proven.outcomes == Outcome.ROLLING
    assert (proven.times[rolls] < followed.times[rolls]).all()
    others = ~(rubs | rolls)
    np.testing.assert_array_equal(proven.times[others], followed.times[others])
    names = [name_motions(rotor, endings.outcomes, endings) for endings in (proven, followed)]
    np.testing.assert_array_equal(names[0][0], names[1][0])
    assert names[0][1] == names[1][1]
    assert "synchronous rub" in names[0][1]
    found = rub_neighbourhood(rotor)
    for place in np.flatnonzero(rubs)[:30]:
        assert_slides_to_the_rub(rotor, found, State(proven.positions[place], proven.velocities[place]))


def test_a_slide_that_runs_round_is_still_told_from_the_rub(rotor):
    endings = settle_all(rotor, *sliding(rub_neighbourhood(rotor), 0.9, seed=6))
    endings.velocities[0] = 0.9j * endings.positions[0]
    named, names = name_motions(rotor, endings.outcomes, endings)
    assert [names[index] for index in named[:3]] == ["drifting rub", "synchronous rub", "synchronous rub"]


@pytest.mark.parametrize("gamma", [0.05, 0.1])
def test_the_runaway_ends_motions_earlier_and_changes_nothing_else(gamma, monkeypatch):
    rotor, rng, count = carom.jeffcott(PAPER.replace(gamma=gamma)), np.random.default_rng(12), 600
    turns = np.exp(2j * np.pi * rng.uniform(0.0, 1.0, (2, count)))
    starts = np.sqrt(rng.uniform(0.0, 1.0, count)) * turns[0], 2.0 * np.sqrt(rng.uniform(0.0, 1.0, count)) * turns[1]
    proven = settle_all(rotor, *starts)
    monkeypatch.setattr("carom.ensembles.fresh_memory", lambda rotor, patience, absorb: fresh_memory(rotor, patience))
    followed = settle_all(rotor, *starts)
    for name in ("outcomes", "impacts", "multiplicities"):
        np.testing.assert_array_equal(getattr(proven, name), getattr(followed, name), err_msg=name)
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


def test_no_runaway_where_rolling_does_not_hold():
    machine = PAPER.replace(gamma=1.05 * rolling(carom.jeffcott(PAPER)).largest_damping)
    assert fresh_memory(carom.jeffcott(machine), 1, absorb=True).runaway == math.inf
    assert fresh_memory(carom.jeffcott(PAPER), 1).runaway == math.inf
    assert fresh_memory(carom.jeffcott(PAPER), 1, absorb=True).runaway == pytest.approx(
        runaway_speed(carom.jeffcott(PAPER)).certain, rel=1e-8
    )
