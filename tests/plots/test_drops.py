"""Figures of a drop: what they must show."""

import numpy as np
import pytest

import carom as cm
from carom import plots
from carom.motions import drop_loads
from carom.motions.courses import first_contacts

pytestmark = pytest.mark.jit_only


@pytest.fixture(scope="module")
def soft():
    return cm.simulate(cm.load("examples/touchdown-balls.toml"), cm.drop(regained_after="20 ms"), "60 ms")


def words(figure):
    return " ".join(text.get_text() for legend in figure.legends for text in legend.get_texts())


def line(axes, name):
    (found,) = [each for each in axes.lines if each.get_gid() == name]
    return found


def test_the_orbit_and_how_deep_it_goes(soft):
    (plane,) = drop_loads(soft).planes
    left, right, bar = plots.drop_orbit(soft).axes
    deepest = np.nanmin(line(right, "contact").get_ydata())
    # Drawn with the time of the largest force, next to which the depth is largest.
    assert deepest == pytest.approx(-1e6 * plane.si()["depth"], rel=1e-4)
    (path,) = [each for each in left.collections if each.get_gid() == "path"]
    assert np.hypot(*np.concatenate(path.get_segments()).T).max() == pytest.approx(0.25 - 1e-3 * deepest, rel=1e-6)
    assert bar.get_xlabel() == "time $t$ (ms)"
    assert (np.diff(path.get_array()) > 0.0).all()
    # It falls down the y axis, where the angle counts from.
    below = line(right, "path")
    assert abs(below.get_xdata()[np.nanargmin(below.get_ydata())]) < 2.0
    assert right.get_ylim()[0] < deepest
    assert {"weight"} <= {each.get_gid() for each in left.texts}
    assert "largest force" in words(plots.drop_orbit(soft))


def test_force_slip_and_race_over_time(soft):
    (plane,) = drop_loads(soft).planes
    figure = plots.touchdown(soft)
    gap, force, speed = figure.axes
    drawn = line(force, "normal force")
    assert drawn.get_ydata().max() == pytest.approx(plane.si()["force"], rel=1e-12)
    peak = drawn.get_xdata()[drawn.get_ydata().argmax()]
    assert peak == pytest.approx(1e3 * plane.force_at * soft.rotor.scales.time, rel=1e-9)
    assert line(speed, "race").get_ydata()[-1] == pytest.approx(plane.race_at_end * 300 * np.pi * 20.25e-3, rel=1e-9)
    slip = line(speed, "slip").get_ydata()
    assert np.isnan(slip).any()
    assert line(gap, "stage").get_xdata()[0] == pytest.approx(20.0)
    assert gap.get_xlim()[1] == pytest.approx(1e3 * (soft.begins + soft.time) * soft.rotor.scales.time)


def test_a_rigid_wall_shows_impulses_and_its_beginning_beside_the_whole():
    rigid = cm.simulate(cm.load("examples/dropped-rotor.toml", ["restitution=0.1"]), cm.drop())
    (plane,) = drop_loads(rigid).planes
    figure = plots.touchdown(rigid)
    beside = [axes for axes in figure.axes if axes.get_ylabel().startswith("impulse")]
    dots = beside[-1].lines[0].get_ydata()
    assert dots.max() == pytest.approx(plane.si()["impulse"], rel=1e-12)
    assert "impulse of an impact (right axis)" in words(figure)
    assert "surface of the race" not in words(figure)
    _, right, _ = plots.drop_orbit(rigid, until=20.0).axes
    assert right.get_title() == "close to the wall"


def test_forces_of_all_bearings_and_how_fast_races_turn(soft):
    (plane,) = drop_loads(soft).planes
    force, turning = plots.landing(soft).axes
    assert line(force, "normal force").get_ydata().max() == pytest.approx(plane.si()["force"], rel=1e-12)
    assert line(turning, "shaft").get_ydata() == pytest.approx(9000.0)
    assert line(turning, "race").get_ydata()[-1] == pytest.approx(9000.0 * plane.race_at_end, rel=1e-9)
    rigid = cm.simulate(cm.load("tests/machine_files/four-degrees.toml"), cm.drop(), "20 ms")
    titles = [axes.get_title() for axes in plots.landing(rigid).axes if axes.get_title()]
    assert titles == ["touchdown bearing 1", "touchdown bearing 2"]


def test_temperatures_have_a_panel_for_each_bearing_that_states_the_mass_of_its_race():
    warm = cm.load(
        "examples/touchdown-balls.toml", ["touchdown_race_mass=0.06 kg", "touchdown_internal_clearance=8 um"]
    )
    motion = cm.simulate(warm, cm.drop(), "20 ms")
    (plane,) = drop_loads(motion).planes
    *_, temperature = plots.landing(motion).axes
    drawn = [each for each in temperature.lines if each.get_gid() == "race"]
    assert drawn[0].get_ydata() == pytest.approx(plane.temperatures.values[:, 1])
    assert drawn[0].get_xdata()[-1] == pytest.approx(20.0)


def test_a_shaft_on_its_way_to_standstill_and_its_first_events():
    machine, drive = cm.load("examples/touchdown-balls.toml"), cm.parameters.Drive("2e-5 kg m^2", brake="0.05 N m")
    slowed = cm.motions.spin_down(machine, cm.drop(), drive=drive, steps=20, keep=10**6)
    speed, radius = slowed.plot().axes
    times, speeds = line(speed, "shaft").get_data()
    assert times[-1] == pytest.approx(1e3 * slowed.time * slowed.scales.time)
    assert speeds[-1] == 0.0
    assert line(radius, "radius 1").get_ydata().max() == slowed.largest[0][0]
    # All of it is kept, so its loads are the same, and contacts that go on through stages are one.
    (whole,), (kept,) = slowed.loads.planes, drop_loads(slowed.motion).planes
    assert (kept.force, kept.contacts, kept.heat) == (whole.force, whole.contacts, whole.heat)
    assert first_contacts(slowed.motion, 3) == pytest.approx(1.02 * whole_end(slowed.motion, 3), abs=1e-2)
    assert slowed.motion.channels("1 ms").shaft_speed.values[-1] < 0.05 * 300 * np.pi


def whole_end(motion, number):
    """End of a contact, counted from 1: the first two have gone by when the force becomes zero for the third time."""
    found = motion.channels(2e-3)
    held = found.touchdown_1_normal_force.values > 0.0
    (ends,) = np.nonzero(held[:-1] & ~held[1:])
    return found.time.values[ends[number - 1]] / motion.scales.time
