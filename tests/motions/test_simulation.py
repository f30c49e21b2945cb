"""Slices of a motion: no compiled call lasts for long, and what stalls is told."""

from __future__ import annotations

import pytest

import carom as cm


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


@pytest.mark.jit_only
def test_a_race_that_stops_within_picoseconds_is_told_and_not_followed():
    machine = cm.load("examples/touchdown-balls.toml", ["touchdown.race_drag=1e6 N m s"])
    motion = cm.simulate(machine, cm.drop(), "100 ms")
    assert motion.outcome is cm.outcome.Outcome.STALLED
    assert "race_inertia" in motion.outcome.meaning
