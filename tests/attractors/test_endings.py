"""What became of disturbances: counts against the endings themselves."""

import pytest
from machines import PAPER

from carom import find_attractors, simulate
from carom.models import jeffcott

pytestmark = pytest.mark.jit_only


@pytest.fixture(scope="module")
def found():
    return find_attractors(jeffcott(PAPER))


def test_touching_are_those_whose_motion_reaches_the_wall(found):
    touched = found.touched

    for ending in found.disturbances:
        motion = simulate(found.rotor, ending.start.state, max(ending.time, 1.0))
        assert (ending in touched) == bool(len(motion.contacts) or motion.lasting_contacts)


def test_hardest_impulse_is_that_of_its_motion(found):
    hardest = max(found.disturbances, key=lambda ending: ending.hardest_impulse)
    motion = simulate(found.rotor, hardest.start.state, hardest.time)

    assert found.hardest_impulse == pytest.approx(motion.contacts.normal_impulse.max(), rel=1e-12)


def test_example_has_contact_where_there_is_one_with_contact(found):
    for member in found:
        example = found.example_of(member)
        assert example.attractor == member.name
        if member.count:
            assert example.start.disturbance
        touched = [ending for ending in found.touched if ending.attractor == member.name]
        assert not touched or example in touched
