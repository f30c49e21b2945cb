"""The sample of disturbances: reproducible, spread as said, and its endings true."""

import numpy as np
import pytest

from carom.orbits import single_impact_orbits
from carom.outcome import Outcome
from carom.parameters import Parameters
from carom.rotors import jeffcott
from carom.study.disturbances import KICK_DIRECTIONS, KICK_SPEEDS, Ending, simulate_disturbances
from carom.trajectories import simulate

SOURCE = Parameters(gamma=0.1, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=400 / 7)

pytestmark = pytest.mark.jit_only


@pytest.fixture(scope="module")
def bouncing():
    rotor = jeffcott(SOURCE)
    return rotor, single_impact_orbits(rotor)


@pytest.fixture(scope="module")
def trials(bouncing):
    rotor, orbits = bouncing
    return simulate_disturbances(rotor, [orbits["B1,d"]])


def test_sample_is_the_same_every_time(bouncing, trials):
    rotor, orbits = bouncing

    assert simulate_disturbances(rotor, [orbits["B1,d"]]) == trials
    assert len(trials) == 200


def test_kicks_leave_levitation_in_all_directions(bouncing, trials):
    rotor, _ = bouncing
    kicks = trials.of_kind("kick")

    assert len(kicks) == len(KICK_SPEEDS) * KICK_DIRECTIONS
    assert {member.start.position for member in kicks} == {rotor.equilibrium}
    for speed in KICK_SPEEDS:
        alike = kicks.of_speed(speed)
        assert len(alike) == KICK_DIRECTIONS
        assert abs(sum(member.start.velocity for member in alike)) < 1e-12 * KICK_DIRECTIONS


def test_starts_lie_within_the_clearance(trials):
    starts = trials.of_kind("start")
    positions = np.array([member.start.position for member in starts])

    assert len(starts) == 200 - len(trials.of_kind("kick"))
    assert np.abs(positions).max() < 1.0
    # Even over the area: half of them beyond 1/√2, with three standard deviations of room.
    assert abs((np.abs(positions) > 0.5**0.5).mean() - 0.5) < 1.5 / len(starts) ** 0.5
    assert max(member.speed for member in starts) <= 0.5


def test_endings_are_where_a_longer_simulation_stays(bouncing, trials):
    rotor, orbits = bouncing
    for ending, group in trials.endings.items():
        member = group.members[0]
        motion = simulate(rotor, member.start, member.time + 200.0)
        late = motion.contacts.time > member.time + 1e-6
        if ending.outcome is Outcome.LEVITATED:
            assert not late.any()
            assert not motion.lasting_contacts or motion.lasting_contacts[-1].end <= member.time
        elif ending.orbit:
            orbit = orbits[ending.orbit]
            assert motion.contacts.radial_speed[late] == pytest.approx(orbit.radial_speed, rel=1e-6)
            assert np.diff(motion.contacts.time[late]) == pytest.approx(orbit.period, rel=1e-6)
        elif ending.outcome is Outcome.FORWARD_RUB:
            assert not late.any()
            assert motion.lasting_contacts[-1].end == motion.time


def test_counts_add_up(trials):
    assert sum(len(group) for group in trials.endings.values()) == len(trials)
    assert trials.recovered == len(trials.endings.get(Ending(Outcome.LEVITATED), ()))
    assert len(trials.touching) + sum(member.impacts == 0 == member.lasting_contacts for member in trials) == len(
        trials
    )


def test_smallest_unrecovered_kick(trials):
    smallest = trials.smallest_unrecovered_kick

    lost = [member for member in trials.of_kind("kick") if member.ending.outcome is not Outcome.LEVITATED]
    assert smallest == min(member.speed for member in lost)
    assert all(member.recovers for member in trials.of_kind("kick") if member.speed < smallest)


def test_hardest_impulse_and_final_force_are_those_of_the_motions(bouncing, trials):
    rotor, _ = bouncing
    hardest = max(trials, key=lambda member: member.hardest_impulse)
    rubbing = next(member for member in trials if member.ending.outcome is Outcome.FORWARD_RUB)

    assert trials.hardest_impulse == hardest.trajectory(rotor).contacts.normal_impulse.max()
    # The normal force of the stable rub of this machine.
    assert rubbing.final_force == pytest.approx(0.790999609972159, abs=1e-6)


def test_machine_that_cannot_levitate_gets_only_starts():
    rotor = jeffcott(SOURCE.replace(gamma=0.05))
    shares = []
    trials = simulate_disturbances(rotor, [], shares.append)

    assert len(trials.of_kind("start")) == len(trials) == 200
    assert trials.smallest_unrecovered_kick is None
    assert trials.recovered == 0
    assert shares[-1] == 1.0


@pytest.mark.parametrize(
    ("ending", "words"),
    [
        (Ending(Outcome.BOUNCING, "B1,d", 1), "bouncing on B1,d"),
        (Ending(Outcome.BOUNCING, "", 3), "bouncing with 3 impacts a period"),
        (Ending(Outcome.BOUNCING), "bouncing without ever repeating"),
        (Ending(Outcome.ROLLING), "rolling backward whirl"),
    ],
)
def test_words_of_endings(ending, words):
    assert ending.words == words


def test_every_outcome_of_a_motion_has_words():
    for outcome in Outcome:
        if outcome >= Outcome.TIME_REACHED and outcome is not Outcome.CHATTER:
            assert Ending(outcome).words != outcome.label
