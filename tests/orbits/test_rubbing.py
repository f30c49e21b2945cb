"""States at lift-off, and the search for periodic motions with lasting contact from them."""

from __future__ import annotations

import numpy as np
import pytest

from carom import find_orbits, simulate
from carom.models import Jeffcott
from carom.orbits import lift_off_of, rubbing_orbits
from carom.orbits.rubbing import lift_off_state
from carom.outcome import CaromError, Phase
from tests.bifurcations.test_rubbing import CHATTERING
from tests.machines import PAPER


def test_lift_offs_leave_the_wall():
    rotor = Jeffcott(CHATTERING)
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
    state = lift_off_state(Jeffcott(CHATTERING), told.whirl, told.angle)
    assert abs(state.position - motion.start.position) < 1e-12
    assert abs(state.velocity - motion.start.velocity) < 1e-9
    with pytest.raises(CaromError, match="never lifts off"):
        lift_off_of(find_orbits(PAPER)["B1,d"])
