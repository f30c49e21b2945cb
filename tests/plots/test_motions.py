"""Orbits and motions in both frames: what is drawn where, and what the words say."""

import numpy as np
import pytest
from machines import PAPER, SCALES

import carom
from carom import plots


def test_orbit_closes_in_the_rotating_frame_and_strikes_once_a_period_in_the_fixed(damped, read):
    orbit = damped.orbits["B1,d"]
    rotating, fixed = plots.orbit(orbit, periods=7).axes
    (path,) = read.lines(rotating, "path")
    x, y = path.get_data()
    assert complex(x[0], y[0]) == pytest.approx(damped.mm * orbit.position)
    assert (x[-1], y[-1]) == pytest.approx((x[0], y[0]))
    # theta' = -1.368 before the impact: backward in the fixed frame, as angular speed -1 is standstill there.
    assert (read.marked(rotating, "backward"), read.marked(rotating, "forward")) == (1, 0)
    assert (read.marked(fixed, "backward"), read.marked(fixed, "forward")) == (7, 0)
    (strikes,) = read.lines(fixed, "backward")
    turned = orbit.angle + orbit.period * np.arange(1, 8)
    np.testing.assert_allclose(strikes.get_xdata(), damped.mm * np.cos(turned), atol=1e-9)
    np.testing.assert_allclose(strikes.get_ydata(), damped.mm * np.sin(turned), atol=1e-9)


def test_motion_shows_every_impact_in_both_frames_by_whirl_direction(bouncing, read):
    forward = int((bouncing.contacts.angular_speed > -1.0).sum())
    backward = len(bouncing.contacts) - forward
    assert min(forward, backward) > 0
    for axes in plots.motion(bouncing).axes:
        assert (read.marked(axes, "forward"), read.marked(axes, "backward")) == (forward, backward)
        assert len(read.lines(axes, "path")) == 1


@pytest.mark.jit_only
def test_fast_rolling_keeps_to_the_circle(read):
    """Rolling backward the rotor goes round some nine times in 1/Omega: no chord may cut across."""
    start = carom.State(0j, 0.4 + 0j)
    whirl = carom.simulate(carom.models.jeffcott(PAPER.replace(gamma=0.05, scales=SCALES)), start, until=60.0)
    assert {contact.kind for contact in whirl.lasting_contacts} == {"slide", "roll"}
    for axes in plots.motion(whirl).axes:
        for kind in ("slide", "roll"):
            (band,) = read.lines(axes, kind)
            x, y = band.get_data()
            chords = np.hypot(np.diff(x), np.diff(y))
            assert np.nanmax(chords) < 0.05
        (path,) = read.lines(axes, "path")
        assert np.nanmax(np.abs(np.diff(np.hypot(*path.get_data())))) < 0.1
