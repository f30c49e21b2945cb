"""Radius over time."""

import numpy as np
import pytest
from matplotlib.figure import Figure

import carom
from carom import plots


def test_wall_line_and_impacts_upon_it(bouncing, read):
    (axes,) = plots.radius(bouncing).axes
    (wall,) = read.lines(axes, "wall")
    assert list(wall.get_ydata()) == [1.0, 1.0]
    strikes = np.concatenate([line.get_xdata() for key in ("forward", "backward") for line in read.lines(axes, key)])
    np.testing.assert_array_equal(np.sort(strikes), bouncing.contacts.time)
    (path,) = read.lines(axes, "path")
    assert path.get_ydata().max() == pytest.approx(1.0)


def test_axes_tell_both_units(bouncing, damped):
    (axes,) = plots.radius(bouncing).axes
    assert axes.get_xlabel() == r"time $t$ (units of $1/\Omega$ = 5.43 ms)"
    assert axes.get_ylabel() == r"radius $r$ (units of $c_\mathrm{r}$ = 0.7 mm)"
    top, right = axes.child_axes
    assert (top.get_xlabel(), right.get_ylabel()) == ("time (ms)", "radius (mm)")
    assert top.get_xlim()[1] == pytest.approx(axes.get_xlim()[1] * 1e3 / damped.scales.speed)
    assert right.get_ylim()[1] == pytest.approx(axes.get_ylim()[1] * 0.7)


def test_without_scales_no_second_axes(damped):
    parameters = damped.rotor.parameters.replace(scales=None)
    motion = carom.simulate(carom.models.Jeffcott(parameters), carom.kick(0.35), until=20.0)
    (axes,) = plots.radius(motion).axes
    assert axes.child_axes == []
    assert axes.get_xlabel() == r"time $t$ (units of $1/\Omega$)"


def test_near_the_wall_the_gap_is_told_in_micrometres(damped):
    (axes,) = plots.radius(damped.orbits["B1,a"]).axes
    _, right = axes.child_axes
    assert right.get_ylabel() == "gap to the wall (\N{GREEK SMALL LETTER MU}m)"
    assert axes.get_ylim()[0] > 0.99
    for gap, radius in ((0.0, 1.0), (0.35, 0.9995)):
        height = right.transData.transform((0.0, gap))[1]
        assert height == pytest.approx(axes.transData.transform((0.0, radius))[1])


def test_zones_lie_between_their_limits(bouncing, read):
    zones = carom.parameters.Zones((0.2, 0.35, 0.6))
    figure = plots.radius(bouncing, zones=zones)
    (axes,) = figure.axes
    bands = {patch.get_gid(): patch for patch in axes.patches if (patch.get_gid() or "").startswith("zone")}
    assert sorted(bands) == ["zone A", "zone B", "zone C", "zone D"]
    edges = [bands[f"zone {letter}"].get_y() for letter in "ABCD"]
    assert edges == pytest.approx([0.0, 0.2, 0.35, 0.6])
    assert {text.get_text() for text in axes.texts} == set("ABCD")
    assert "zones A to D" in read.legend(figure)


def test_orbit_repeats_and_is_named(damped, read):
    orbit = damped.orbits["B1,d"]
    figure = plots.radius(orbit, periods=4)
    (axes,) = figure.axes
    assert figure.get_suptitle() == r"$B_{\mathrm{1,d}}$ — admissible, stable"
    (strikes,) = read.lines(axes, "backward")
    np.testing.assert_allclose(strikes.get_xdata(), orbit.period * np.arange(1, 5))
    assert "radius (admissible, stable)" in read.legend(figure)


def test_virtual_part_is_faint(weak, read):
    (axes,) = plots.radius(weak.orbits["B1,d"]).axes
    (outside,) = read.lines(axes, "outside")
    assert outside.get_linestyle() == ":"
    assert np.nanmin(outside.get_ydata()) > 1.0
    assert axes.get_ylim()[1] > np.nanmax(outside.get_ydata())


def test_end_is_marked_unless_time_ran_out(bouncing, chattering, read):
    assert read.lines(plots.radius(bouncing).axes[0], "end") == []
    figure = plots.radius(chattering)
    (end,) = read.lines(figure.axes[0], "end")
    assert end.get_xdata()[0] == chattering.time
    assert "end: chatter, ends in lasting contact" in read.legend(figure)


def test_lasting_contact_is_a_band_for_as_long_as_it_lasts(rubbing, read):
    (contact,) = rubbing.lasting_contacts
    (band,) = read.lines(plots.radius(rubbing).axes[0], "slide")
    during = np.asarray(band.get_xdata())[np.isfinite(band.get_xdata())]
    assert (during.min(), during.max()) == (contact.start, contact.end)


def test_motion_that_ends_at_its_start(damped, read):
    rub = next(point for point in damped.equilibria if point.kind == "rub" and point.stable)
    motion = carom.simulate(damped.rotor, carom.State(rub.position), until=10.0, stop_at_chatter=True)
    assert motion.time == 0.0
    (axes,) = plots.radius(motion).axes
    assert read.marked(axes, "end") == 1
    assert axes.get_ylim()[0] == 0.0


@pytest.mark.jit_only
def test_long_motions_are_stored_as_pixels(damped, tmp_path, read):
    long = carom.simulate(damped.rotor, carom.kick(0.9, angle=0.2), until=60_000.0)
    figure = plots.radius(long)
    (svg,) = plots.save(figure, tmp_path / "long", ("svg",))
    (path,) = read.lines(figure.axes[0], "path")
    # As text the points alone would need two numbers of some ten digits each.
    assert svg.stat().st_size < 10 * len(path.get_xdata())


def test_own_axes(bouncing):
    figure = Figure()
    axes = figure.subplots()
    assert plots.radius(bouncing, axes=axes) is figure
    assert axes.get_legend() is not None
