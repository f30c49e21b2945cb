"""States at lift-off, and the search for periodic motions with lasting contact from them."""

from __future__ import annotations

import numpy as np
import pytest

from carom import find_orbits, simulate
from carom.models import jeffcott
from carom.orbits import lift_off_of, rubbing_orbits
from carom.orbits.rubbing import lift_off_state
from carom.orbits.shooting import Start, links_of, pack_free, unpack_free
from carom.orbits.word import Kind, Word
from carom.outcome import CaromError, Phase
from tests.bifurcations.test_rubbing import CHATTERING
from tests.machines import PAPER


def test_lift_offs_leave_the_wall():
    rotor = jeffcott(CHATTERING)
    lifted = 0
    for whirl in (1, -1):
        for angle in np.linspace(-np.pi, np.pi, 25):
            state = lift_off_state(rotor, whirl, float(angle))
            if state is None:
                continue
            lifted += 1
            motion = simulate(rotor, state, 1e-3)
            assert motion.segment_phases[-1] == Phase.FLIGHT
            assert abs(motion.final.position) < 1.0
    assert lifted > 10


@pytest.mark.jit_only
def test_what_is_told_of_a_lift_off_is_what_the_simulation_does():
    (orbit,) = rubbing_orbits(CHATTERING)
    assert orbit.name == "rubbing 1"
    told, motion = lift_off_of(orbit), orbit.trajectory()
    (contact,) = [each for each in motion.lasting_contacts if each.end - each.start > 1e-6]
    # The completion of a chatter replaces bounces that last about 1e-6.
    assert told.contact_time == pytest.approx(contact.end - contact.start, abs=2e-6)
    assert told.landing_force == pytest.approx(float(motion.forces(np.array([contact.start]))[0][0]), abs=1e-5)
    state = lift_off_state(jeffcott(CHATTERING), told.whirl, told.angle)
    assert abs(state.position - motion.start.position) < 1e-12
    assert abs(state.velocity - motion.start.velocity) < 1e-9
    with pytest.raises(CaromError, match="never lifts off"):
        lift_off_of(find_orbits(PAPER)["B1,d"])


@pytest.mark.jit_only
def test_derivatives_are_those_of_differences():
    """Of the equations from a lift-off to the next, and of those of sliding that never leaves the wall, away from an orbit."""
    (orbit,) = rubbing_orbits(CHATTERING)
    step = 1e-6
    alone = Word.of(Kind.SLIDE_FORWARD)
    starts = {
        orbit.word: Start(orbit.nodes, orbit.durations),
        alone: Start(orbit.nodes[orbit.word.kinds == Kind.LIFT], np.array([3.0])),
    }
    for word, start in starts.items():
        unknowns = pack_free(word, start)
        unknowns += 1e-3 * np.sin(np.arange(len(unknowns)))

        def left_sides(at: np.ndarray, word: Word = word) -> tuple[np.ndarray, np.ndarray]:
            return links_of(orbit.rotor, word, unpack_free(word, at)).reduced

        changes = step * np.eye(len(unknowns))
        expected = np.array(
            [(left_sides(unknowns + c)[0] - left_sides(unknowns - c)[0]) / (2.0 * step) for c in changes]
        )
        # Third derivatives of about 1e2 times the square of the step, and rounding of 1e-14 over the step.
        assert np.abs(left_sides(unknowns)[1] - expected.T).max() < 1e-7


@pytest.mark.jit_only
def test_where_a_chatter_is_none_the_equations_are_not_defined():
    """A first impact at rest in this frame, whose derivatives are singular: branches end there, they do not fail."""
    (orbit,) = rubbing_orbits(CHATTERING)
    nodes = orbit.nodes.copy()
    landing = int(np.flatnonzero(orbit.word.kinds == Kind.LAND)[0])
    nodes[landing, 1] = 0.0
    residual, jacobian = links_of(orbit.rotor, orbit.word, Start(nodes, orbit.durations)).reduced
    assert not np.isfinite(residual).all()
    assert not np.isfinite(jacobian).all()
