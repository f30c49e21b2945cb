"""Orbits and motions in both frames: what is drawn where, and what the words say."""

import numpy as np
import pytest

import carom
from carom import plots


def test_wall_is_the_clearance_in_mm_in_both_frames(damped, read):
    figure = plots.orbit(damped.orbits["B1,d"])
    assert len(figure.axes) == 2
    for axes in figure.axes:
        (wall,) = read.lines(axes, "wall")
        np.testing.assert_allclose(np.hypot(wall.get_xdata(), wall.get_ydata()), 0.7)
        assert axes.get_aspect() == 1.0


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


def test_each_impact_of_an_orbit_with_two_is_marked(damped, read):
    branch = carom.continue_orbit(damped.orbits["B1,d"], "gamma", (0.08, 0.1))
    (doubling,) = (point for point in branch.special if point.kind == "period-doubling")
    orbit = carom.bifurcations.switch(doubling, (0.082, 0.0834)).orbits[-1]
    assert orbit.impacts == 2
    rotating, fixed = plots.orbit(orbit, periods=3).axes
    (strikes,) = read.lines(rotating, "backward")
    angles = sorted(section.angle for section in orbit.sections)
    places = damped.mm * np.exp(1j * np.array(angles))
    found = np.array(sorted(strikes.get_xdata() + 1j * strikes.get_ydata(), key=np.angle))
    np.testing.assert_allclose(found, places, atol=1e-9)
    assert read.marked(fixed, "backward") == 6
    (marks,) = read.lines(plots.radius(orbit, periods=3).axes[0], "backward")
    np.testing.assert_allclose(marks.get_xdata()[:2], damped.ms * np.cumsum(orbit.durations), rtol=1e-12)


def test_part_of_a_virtual_orbit_beyond_the_wall_is_faint_and_dotted(weak, read):
    orbit = weak.orbits["B1,d"]
    figure = plots.orbit(orbit)
    assert orbit.reason in figure.get_suptitle()
    for axes in figure.axes:
        (inside,), (outside,) = read.lines(axes, "path"), read.lines(axes, "outside")
        assert outside.get_linestyle() == ":"
        assert outside.get_color() == plots.LOOKS["outside"].colour
        assert np.nanmax(np.hypot(*inside.get_data())) <= weak.mm * (1.0 + 1e-9)
        assert np.nanmax(np.hypot(*outside.get_data())) > 1.2 * weak.mm
        assert np.ptp(axes.get_xlim()) > 2.5 * weak.mm
    assert "virtual part, outside the clearance" in read.legend(figure)
    # The contact-free point lies beyond the wall as well: hollow.
    (point,) = read.lines(figure.axes[0], "contact-free")
    assert point.get_markerfacecolor() == "white"


def test_orbit_too_small_to_be_seen_is_enlarged(damped, read):
    rotating, _ = plots.orbit(damped.orbits["B1,b"]).axes
    (inner,) = rotating.child_axes
    (path,) = read.lines(inner, "path")
    x, y = path.get_data()
    low, high = inner.get_xlim()
    assert low < x.min() < x.max() < high
    assert np.ptp(x) + np.ptp(y) > 0.5 * (high - low)
    assert plots.orbit(damped.orbits["B1,d"]).axes[0].child_axes == []


def test_motion_shows_every_impact_in_both_frames_by_whirl_direction(bouncing, read):
    forward = int((bouncing.contacts.angular_speed > -1.0).sum())
    backward = len(bouncing.contacts) - forward
    assert min(forward, backward) > 0
    for axes in plots.motion(bouncing).axes:
        assert (read.marked(axes, "forward"), read.marked(axes, "backward")) == (forward, backward)
        assert len(read.lines(axes, "path")) == 1


def test_motion_starts_and_ends_where_it_does(damped, bouncing, read):
    rotating, fixed = plots.motion(bouncing).axes
    for axes, turn in ((rotating, 1.0), (fixed, np.exp(1j * bouncing.time))):
        (end,) = read.lines(axes, "end")
        last = damped.mm * bouncing.final.position * turn
        assert (end.get_xdata()[0], end.get_ydata()[0]) == pytest.approx((last.real, last.imag))


def test_motion_without_its_transient(damped, bouncing, read):
    rotating, _ = plots.motion(bouncing, since=50.0).axes
    assert (
        read.marked(rotating, "forward") + read.marked(rotating, "backward") == (bouncing.contacts.time >= 50.0).sum()
    )
    (start,) = read.lines(rotating, "start")
    (path,) = [line for line in read.lines(rotating, "path") if len(line.get_xdata()) > 2]
    assert len(path.get_xdata()) >= 2000, "the part that is shown is drawn smoothly"
    first = damped.mm * bouncing.position(np.array([50.0]))[0]
    assert (start.get_xdata()[0], start.get_ydata()[0]) == pytest.approx((first.real, first.imag))


@pytest.mark.parametrize("since", [-1.0, 60.1])
def test_transient_longer_than_the_motion(bouncing, since):
    with pytest.raises(
        carom.base.outcome.InputError, match=r"since = .*: a time from 0 to the end of the motion at 60/Omega"
    ):
        plots.motion(bouncing, since=since)


def test_lasting_contact_is_a_band_on_the_wall(rubbing, chattering, read):
    (contact,) = rubbing.lasting_contacts
    assert contact.kind == "slide"
    figure = plots.motion(rubbing)
    for axes in figure.axes:
        (band,) = read.lines(axes, "slide")
        np.testing.assert_allclose(np.hypot(*band.get_data())[np.isfinite(band.get_xdata())], 0.7)
        assert read.lines(axes, "roll") == []
        assert band.get_linewidth() > 1.5 * read.lines(axes, "wall")[0].get_linewidth()
    assert "lasting contact, sliding" in read.legend(figure)
    assert "lasting contact, sliding" not in read.legend(plots.motion(chattering))


@pytest.mark.jit_only
def test_fast_rolling_keeps_to_the_circle(weak, read):
    """Rolling backward the rotor goes round some nine times in 1/Omega: no chord may cut across."""
    start = carom.State(0j, 0.4 + 0j)
    whirl = carom.simulate(weak.rotor, start, until=60.0)
    assert {contact.kind for contact in whirl.lasting_contacts} == {"slide", "roll"}
    for axes in plots.motion(whirl).axes:
        for kind in ("slide", "roll"):
            (band,) = read.lines(axes, kind)
            x, y = band.get_data()
            chords = np.hypot(np.diff(x), np.diff(y))
            assert np.nanmax(chords) < 0.05
        (path,) = read.lines(axes, "path")
        assert np.nanmax(np.abs(np.diff(np.hypot(*path.get_data())))) < 0.1


def test_motion_that_never_leaves_the_wall(damped, read):
    rub = next(point for point in damped.equilibria if point.kind == "rub" and point.stable)
    motion = carom.simulate(damped.rotor, carom.State(rub.position), until=10.0)
    assert len(motion.contacts) == 0
    rotating, fixed = plots.motion(motion).axes
    for axes in (rotating, fixed):
        assert len(read.lines(axes, "slide")) == 1
    (band,) = read.lines(plots.radius(motion).axes[0], "slide")
    assert (np.nanmin(band.get_xdata()), np.nanmax(band.get_xdata())) == pytest.approx((0.0, 10.0 * damped.ms))


@pytest.mark.jit_only
def test_of_a_long_motion_the_last_turns_are_drawn(damped, read):
    long = carom.simulate(damped.rotor, carom.kick(0.35, angle=0.2), until=600.0)
    figure = plots.motion(long)
    rotating, fixed = figure.axes
    turn = 2.0 * np.pi
    (path,) = [line for line in read.lines(fixed, "path") if len(line.get_xdata()) > 2]
    start = complex(path.get_xdata()[0], path.get_ydata()[0])
    assert start == pytest.approx(damped.mm * long.position(np.array([600.0 - 8.0 * turn]), "fixed")[0])
    shown = (long.contacts.time >= 600.0 - 8.0 * turn).sum()
    assert read.marked(fixed, "backward") + read.marked(fixed, "forward") == shown
    assert read.marked(rotating, "backward") + read.marked(rotating, "forward") == shown
    (points,) = read.lines(fixed, "once a turn")
    times = turn * np.arange(len(points.get_xdata()))
    assert times[-1] < 600.0 - 8.0 * turn <= times[-1] + turn
    there = points.get_xdata() + 1j * points.get_ydata()
    np.testing.assert_allclose(there, damped.mm * long.position(times, "fixed"), atol=1e-9)
    words = read.legend(figure)
    assert {"path of the rotor centre, last 8 turns", "before: once a turn of the shaft"} <= set(words)
    whole = plots.motion(long, turns=100)
    assert not any("turn" in text for text in read.legend(whole))
