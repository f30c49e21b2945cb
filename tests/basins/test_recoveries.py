"""Shares of drops that come back, with a recovery action and without."""

import numpy as np
import pytest

import carom as cm
from carom.base.outcome import InputError
from carom.basins import compare_recoveries
from carom.parameters import RecoveryAction

pytestmark = pytest.mark.jit_only

MACHINE = cm.load("examples/dropped-rotor.toml")
EARLY = RecoveryAction("early", regain_after="20 ms")
STIFF = RecoveryAction("stiff", regain_after="20 ms", lasts="0.1 s", gains={"damping": "3600 N s/m"})
NEVER = RecoveryAction("never", regain_quiet="20 ms", quiet_speed="1e-9 m/s", lasts="0.1 s", set_point="20 um")


def test_shares_are_those_of_single_drops():
    found = compare_recoveries(MACHINE, (STIFF, EARLY, NEVER), 12, kicks_up_to="150 mm/s", seed=3, threads=1)
    assert [row.recovery.name for row in found.each] == ["early", "no action, 20 ms", "stiff", "never"]
    for row in found.each:
        assert sum(row.ends.values()) == 12
        assert row.share.low <= row.share.fraction <= row.share.high
        assert row.ends.get("levitation", 0) == row.share.count
    draw = np.random.default_rng(3)
    phases, angles = 2.0 * np.pi * draw.random((2, 12))
    speeds = 0.15 / MACHINE.parameters.scales.velocity * np.sqrt(draw.random(12))
    ends = [
        cm.simulate(MACHINE, cm.drop(cm.kick(speed, angle), phase=phase, regained_after="20 ms")).outcome.label
        for speed, angle, phase in zip(speeds.tolist(), angles.tolist(), phases.tolist(), strict=True)
    ]
    assert ends.count("levitated") == found.each[0].share.count
    # It never is that slow.
    assert found.each[1].ends == found.each[3].ends == {"levitation not regained": 12}
    early, stiff = found.each[0], found.each[2]
    assert stiff.with_it_alone - stiff.without_it_alone == stiff.share.count - early.share.count
    again = compare_recoveries(MACHINE, (STIFF, EARLY, NEVER), 12, kicks_up_to="150 mm/s", seed=3, threads=2)
    assert again.document() == found.document()


def test_what_has_not_settled_in_time_does_not_come_back():
    late = compare_recoveries(MACHINE, (EARLY,), 3, until="21 ms").each[0]
    assert (late.share.count, late.ends) == (0, {"not settled": 3})
    assert compare_recoveries(MACHINE, (EARLY,), 3, until="19 ms").each[0].ends == {"levitation not regained": 3}


def test_without_a_recovery_there_is_nothing_to_compare():
    with pytest.raises(InputError, match=r"^recovery = nothing given: one or more tables \[\[recovery\]\]"):
        compare_recoveries(MACHINE)
