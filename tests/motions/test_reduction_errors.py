"""What the reduction of a flexible machine changes along a motion, against the motion of all modes."""

import pytest
from flexible_machines import munich

import carom as cm
from carom.motions import drop_loads, follow_loads
from carom.rotors.reduction_errors import reduction_error

MACHINE = munich(longest_element=0.2)
KICK = cm.kick("495 mm/s", "30 deg")


def by(start):
    return lambda reduced: (reduced.model, start)


@pytest.mark.parametrize("start", [KICK, cm.drop()])
def test_first_peaks_are_within_the_error_that_is_told(start):
    reduced = MACHINE.with_modes(3)
    motion = cm.simulate(reduced.model, start, "12 ms")
    found = reduction_error(reduced, drop_loads(motion), by(start))
    exact = cm.simulate(MACHINE.whole.model, start, "12 ms")
    assert found.finer >= 2 * found.vectors > 2 * reduced.modes
    for plane, change in enumerate(found.changes):
        one, other = (each.seen_at(plane).contacts.peak_force[0] for each in (motion, exact))
        assert 0.0 < abs(one - other) / max(one, other) <= found.error
        assert 3.0 * change <= found.error
    assert f"{found.finer} vectors in place of {found.vectors}" in found.words


def test_nothing_is_told_of_all_modes_and_without_contact():
    still = cm.kick("1 mm/s", "0 deg")
    reduced = MACHINE.with_modes(3)
    assert reduction_error(reduced, follow_loads(reduced.model, still, "12 ms"), by(still)) is None
    whole = MACHINE.whole
    assert reduction_error(whole, follow_loads(whole.model, KICK, "1 ms"), by(KICK)) is None
