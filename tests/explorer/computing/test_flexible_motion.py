"""A kick of a flexible machine, followed at each touchdown plane."""

from __future__ import annotations

import numpy as np
import pytest
from flexible_pages import reduced

import carom
from carom.explorer.computing.flexible_motion import MOST_SAMPLES, follow_flexible

pytestmark = pytest.mark.jit_only


@pytest.fixture(scope="module")
def rotor():
    return reduced().model


@pytest.fixture(scope="module")
def kicked(rotor):
    speed = 0.3 / rotor.scales.velocity
    return follow_flexible(rotor, 0.0, speed), carom.simulate(rotor, carom.kick(speed, "90 deg"), "0.05 s")


def test_it_is_the_simulated_motion_at_each_plane(rotor, kicked):
    found, motion = kicked
    times = found.times[found.times < motion.time].astype(float)
    for plane, shown in enumerate(found.planes):
        at, _ = motion.seen_at(plane).at_plane(times)
        drawn = shown.x[: len(times)] + 1j * shown.y[: len(times)]
        # Single precision of positions and of times, over which the rotor moves by some clearances per unit.
        assert np.abs(drawn - at).max() < 1e-4
        assert len(shown.force) == len(found.times) <= MOST_SAMPLES


def test_forces_and_depths_are_those_of_the_contacts(kicked):
    found, motion = kicked
    for plane, shown in enumerate(found.planes):
        touches = motion.seen_at(plane).touches
        assert shown.hardest == pytest.approx(touches.peak_force.max(), rel=1e-9)
        assert shown.deepest == pytest.approx(touches.deepest.max(), rel=1e-9)
        assert 0.0 < shown.force.max() <= shown.hardest * (1.0 + 1e-5)
        assert f"{touches.peak_force.max() * motion.rotor.scales.force:.3g} N" in shown.words


def test_what_is_seen_is_said(kicked):
    found, _ = kicked
    assert found.words == "A kick of 300 mm/s at 90° meets touchdown bearings 1 and 2 and ends in levitation."
    assert found.whole


def test_a_small_kick_ends_without_contact(rotor):
    found = follow_flexible(rotor, 0.01 / rotor.scales.velocity, 0.0)
    assert found.words.endswith("ends in levitation without contact.")
    assert [plane.words for plane in found.planes] == ["no contact"] * 2
    assert not any(plane.force.any() for plane in found.planes)
