"""Slices of a motion: no compiled call lasts for long, and what stalls is stated."""

import pytest

import carom as cm
from carom.base.outcome import Outcome
from carom.motions.settling import SettlingProgress


@pytest.mark.jit_only
def test_a_flight_in_slices_is_the_same_flight(monkeypatch):
    machine, start = cm.load("examples/keogh-cole.toml"), cm.kick("60 mm/s")
    whole = cm.simulate(machine, start)
    monkeypatch.setattr("carom.motions.settling.SLICE", 10)
    sliced = cm.simulate(machine, start)
    assert sliced.outcome is whole.outcome
    assert len(sliced.contacts) == len(whole.contacts)
    # Flights are followed in pieces: each adds a rounding error, which impacts carry on.
    assert sliced.segment_starts == pytest.approx(whole.segment_starts, abs=1e-9)


def test_steps_that_take_next_to_no_time_stall():
    """The steps of the stiffest walls, flights without an event, and the steps of a race that stops within picoseconds."""
    stiff, flying, race = SettlingProgress(), SettlingProgress(), SettlingProgress()
    assert not any(stiff.stalls(256, 256 * 1e-5) for _ in range(300))
    assert not any(flying.stalls(0, 1.0) for _ in range(300))
    assert any(race.stalls(256, 256 * 1e-9) for _ in range(300))


def test_a_machine_that_is_too_stiff_to_be_followed_ends_as_stalled():
    """A race with so much drag stands still in less than a billionth of a turn, and flights have to be looked at as often."""
    case = cm.load("examples/touchdown-balls.toml", ["touchdown_race_drag=1e8"])
    motion = cm.simulate(case, cm.drop(), "10 ms")
    assert motion.outcome is Outcome.STALLED
    assert 0.0 < motion.time < 1.0
