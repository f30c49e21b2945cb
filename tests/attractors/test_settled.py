"""What settled motions repeat."""

import dataclasses

import pytest
from machines import PAPER

from carom import State, find_equilibria, find_orbits, simulate
from carom.attractors.settled import forces_on, same_motion, settled_motion, whirl_of
from carom.base.outcome import Outcome
from carom.models import jeffcott
from carom.parameters import Parameters

pytestmark = pytest.mark.jit_only


def settled(rotor, state):
    return simulate(rotor, state, 1e5, settle=True)


def test_where_no_orbit_closes_the_last_impacts_are_compared():
    rotor = jeffcott(PAPER.replace(gamma=0.0832))
    leaving = find_orbits(rotor)["B1,d"].departure
    doubled = [
        settled(rotor, State(leaving.position, factor * leaving.velocity)) for factor in (0.999, 1.001, 1.01, 0.99)
    ]
    rotor = jeffcott(PAPER)
    bouncing = settled(rotor, State(0.2 + 0.1j, -1.0 + 0.5j))
    ends = [dataclasses.replace(settled_motion(motion), orbit=None) for motion in doubled]

    assert all(same_motion(ends[0], ended) for ended in ends)
    assert not same_motion(ends[0], settled_motion(doubled[0]))
    assert not same_motion(ends[0], dataclasses.replace(settled_motion(bouncing), orbit=None, multiplicity=2))


def test_bouncing_with_rub_repeats_an_orbit_with_lasting_contact():
    parameters = Parameters(0.0431456484, 1.25902546543, 1.31671186334, 0.0, 0.427612705, 0.43781982, 2.0)
    motion = settled(jeffcott(parameters), State(0.3, 0.5 + 1.0j))
    ended = settled_motion(motion)

    assert ended.outcome is Outcome.MIXED
    assert ended.multiplicity == motion.multiplicity
    assert ended.orbit.stable
    assert ended.orbit.admissible
    assert not ended.orbit.flies
    times = motion.segment_starts[1:][motion.is_impact]
    assert ended.period == pytest.approx(motion.time - times[-motion.multiplicity], rel=1e-9)


def test_synchronous_rub_presses_with_the_force_of_its_equilibrium():
    rotor = jeffcott(PAPER.replace(gamma=0.2))
    rub = find_equilibria(rotor)[1]
    motion = settled(rotor, State(rub.position, 0.05j * rub.position))
    ended = settled_motion(motion)

    assert (ended.outcome, ended.synchronous, ended.period) == (Outcome.FORWARD_RUB, True, None)
    impulse, force = forces_on(ended)
    assert impulse == 0.0
    assert force == pytest.approx(rub.normal_force, rel=1e-8)
    assert whirl_of(ended) == "forward"
