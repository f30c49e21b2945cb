"""Radius over time."""

import numpy as np
import pytest
from matplotlib.figure import Figure

import carom
from carom import plots


def test_wall_line_and_impacts_upon_it(damped, bouncing, read):
    (axes,) = plots.radius(bouncing).axes
    (wall,) = read.lines(axes, "wall")
    assert list(wall.get_ydata()) == [0.7, 0.7]
    strikes = np.concatenate([line.get_xdata() for key in ("forward", "backward") for line in read.lines(axes, key)])
    np.testing.assert_allclose(np.sort(strikes), damped.ms * bouncing.contacts.time)
    (path,) = read.lines(axes, "path")
    assert path.get_ydata().max() == pytest.approx(0.7)


def test_axes_are_in_the_units_of_the_machine(bouncing, damped):
    (axes,) = plots.radius(bouncing).axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("time $t$ (ms)", "radius $r$ (mm)")
    assert axes.get_xlim()[1] == pytest.approx(60.0 * damped.ms)
    assert axes.child_axes == []


def test_without_scales_units_are_those_of_the_equations(damped):
    parameters = damped.rotor.parameters.replace(scales=None)
    motion = carom.simulate(carom.models.jeffcott(parameters), carom.kick(0.35), until=20.0)
    (axes,) = plots.radius(motion).axes
    assert axes.child_axes == []
    assert axes.get_xlabel() == r"time $t$ ($1/\Omega$)"


def test_near_the_wall_the_gap_is_told_in_micrometres(damped):
    (axes,) = plots.radius(damped.orbits["B1,a"]).axes
    (right,) = axes.child_axes
    assert right.get_ylabel() == "gap to the wall (\N{GREEK SMALL LETTER MU}m)"
    assert axes.get_ylim()[0] > 0.99 * 0.7
    for gap, radius in ((0.0, 1.0), (0.35, 0.9995)):
        height = right.transData.transform((0.0, gap))[1]
        assert height == pytest.approx(axes.transData.transform((0.0, 0.7 * radius))[1])


def test_zones_lie_between_their_limits(bouncing, read):
    zones = carom.parameters.Zones((0.2, 0.35, 0.6))
    figure = plots.radius(bouncing, zones=zones)
    (axes,) = figure.axes
    bands = {patch.get_gid(): patch for patch in axes.patches if (patch.get_gid() or "").startswith("zone")}
    assert sorted(bands) == ["zone A", "zone B", "zone C", "zone D"]
    edges = [bands[f"zone {letter}"].get_y() for letter in "ABCD"]
    assert edges == pytest.approx([0.0, 0.7 * 0.2, 0.7 * 0.35, 0.7 * 0.6])
    assert {text.get_text() for text in axes.texts} == set("ABCD")
    assert "zones A to D" in read.legend(figure)


def test_orbit_repeats_and_is_named(damped, read):
    orbit = damped.orbits["B1,d"]
    figure = plots.radius(orbit, periods=4)
    (axes,) = figure.axes
    assert figure.get_suptitle() == r"$B_{\mathrm{1,d}}$ — admissible, stable"
    (strikes,) = read.lines(axes, "backward")
    np.testing.assert_allclose(strikes.get_xdata(), damped.ms * orbit.period * np.arange(1, 5))
    assert "radius (admissible, stable)" in read.legend(figure)


def test_virtual_part_is_faint(weak, read):
    (axes,) = plots.radius(weak.orbits["B1,d"]).axes
    (outside,) = read.lines(axes, "outside")
    assert outside.get_linestyle() == ":"
    assert np.nanmin(outside.get_ydata()) > 0.7
    assert axes.get_ylim()[1] > np.nanmax(outside.get_ydata())


def test_end_is_marked_unless_time_ran_out(damped, bouncing, chattering, read):
    assert read.lines(plots.radius(bouncing).axes[0], "end") == []
    figure = plots.radius(chattering)
    (end,) = read.lines(figure.axes[0], "end")
    assert end.get_xdata()[0] == pytest.approx(damped.ms * chattering.time)
    assert "end: chatter, ends in lasting contact" in read.legend(figure)


def test_lasting_contact_is_a_band_for_as_long_as_it_lasts(damped, rubbing, read):
    (contact,) = rubbing.lasting_contacts
    (band,) = read.lines(plots.radius(rubbing).axes[0], "slide")
    during = np.asarray(band.get_xdata())[np.isfinite(band.get_xdata())]
    assert (during.min(), during.max()) == pytest.approx((damped.ms * contact.start, damped.ms * contact.end))


def test_motion_that_ends_at_its_start(damped, read):
    rub = next(point for point in damped.equilibria if point.kind == "rub" and point.stable)
    motion = carom.simulate(damped.rotor, carom.State(rub.position), until=10.0, stop_at_chatter=True)
    assert motion.time == 0.0
    (axes,) = plots.radius(motion).axes
    assert read.marked(axes, "end") == 1
    assert axes.get_ylim()[0] == 0.0


@pytest.fixture(scope="module")
def long(damped):
    """Many bounces on B1,d after some irregular ones."""
    return carom.simulate(damped.rotor, carom.kick(0.35, angle=0.2), until=600.0)


@pytest.mark.jit_only
def test_a_long_motion_is_an_envelope_and_its_last_turns(damped, long, read):
    figure = plots.radius(long)
    whole, last = figure.axes
    assert read.lines(whole, "path") == []
    (band,) = [entry for entry in whole.collections if entry.get_gid() == "envelope"]
    corners = band.get_paths()[0].vertices
    settled = corners[corners[:, 0] > 500.0 * damped.ms]
    orbit = np.abs(damped.orbits["B1,d"].path(np.linspace(0.0, damped.orbits["B1,d"].period, 2001)))
    assert settled[:, 1].min() == pytest.approx(damped.mm * orbit.min(), rel=2e-3)
    assert settled[:, 1].max() == pytest.approx(0.7, rel=1e-6)
    assert read.marked(whole, "forward") == read.marked(whole, "backward") == 0, "hundreds of marks would hide the wall"
    (path,) = read.lines(last, "path")
    assert last.get_xlim() == pytest.approx((damped.ms * (600.0 - 16.0 * np.pi), damped.ms * 600.0))
    assert read.marked(last, "backward") == (long.contacts.time >= 600.0 - 16.0 * np.pi).sum()
    assert np.nanmin(path.get_ydata()) == pytest.approx(damped.mm * orbit.min(), rel=2e-3)
    assert "radius, from smallest to largest" in read.legend(figure)


@pytest.mark.jit_only
def test_a_settled_end_needs_no_panel_of_its_own(damped):
    """A rub that follows many bounces shows nothing in its last turns."""
    motion = carom.simulate(damped.rotor, carom.kick(0.1, angle=0.2), until=60.0)
    assert len(plots.radius(motion).axes) == 1


@pytest.mark.jit_only
def test_long_motions_stay_small_files(damped, tmp_path):
    long = carom.simulate(damped.rotor, carom.kick(0.9, angle=0.2), until=60_000.0)
    (svg,) = plots.save(plots.radius(long), tmp_path / "long", ("svg",))
    assert svg.stat().st_size < 300_000


def test_own_axes(bouncing):
    figure = Figure()
    axes = figure.subplots()
    assert plots.radius(bouncing, axes=axes) is figure
    assert axes.get_legend() is not None
