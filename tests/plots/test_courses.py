"""Motions over time."""

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure

import carom
from carom import plots
from carom.motions.ledger import energy_ledger


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


@pytest.fixture(scope="module")
def rub(damped):
    """A kick that ends in the stable rub."""
    return carom.simulate(damped.rotor, carom.kick(0.1, angle=0.2), until=45.0)


@pytest.fixture(scope="module")
def ledger(rub):
    return energy_ledger(rub)


def _words(figure) -> str:
    texts = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    return " | ".join(texts)


def test_forces_are_drawn_in_contact_only_and_in_newtons(rub, damped):
    drawn = [line for axes in plots.touchdown(rub).axes for line in axes.lines]
    line = [line for line in drawn if "normal force" in line.get_label()][-1]
    times, values = line.get_data()
    shown = np.isfinite(values)
    assert times[shown].min() >= damped.ms * rub.lasting_contacts[0].start
    normal, _ = rub.forces(times[shown] / damped.ms)
    np.testing.assert_allclose(values[shown], normal * damped.scales.force)


def test_energies_draw_every_account(ledger):
    figure = plots.energies(ledger)
    drawn = {line.get_label(): line.get_ydata() for line in figure.axes[0].lines}
    np.testing.assert_allclose(drawn["work of the drive"], ledger.scales.energy * ledger.drive)
    assert "(J)" in figure.axes[0].get_ylabel()
    assert len([label for label in drawn if not label.startswith("_")]) == 6


def test_user_settings_are_left_alone(rub, ledger):
    before = dict(mpl.rcParams)
    plots.touchdown(rub, ledger)
    assert dict(mpl.rcParams) == before


def test_touchdown_tells_forces_speeds_and_energies_in_words_and_units(rub, ledger, read):
    figure = plots.touchdown(rub, ledger, title="kick")
    words = read.legend(figure)
    assert {"normal force", "slip of the contact", "work of the drive", "lasting contact, sliding"} <= set(words)
    labels = " ".join(axes.get_ylabel() for axes in figure.axes)
    for unit in ("(mm)", "(N)", "(N s)", "(m/s)", "(J)"):
        assert unit in labels


def test_a_motion_without_lasting_contact_has_impulses_and_one_of_a_single_impact_no_empty_panel(
    bouncing, damped, read
):
    panels = plots.touchdown(bouncing).axes
    stems = [len(each.get_segments()) for axes in panels for each in axes.collections]
    assert stems[-1] == len(bouncing.contacts)
    struck = carom.simulate(damped.rotor, carom.kick(0.35, angle=0.2), until=2.0)
    assert len(struck.contacts) == 1
    figure = plots.touchdown(struck)
    assert len(figure.axes) == 1
    assert figure.axes[0].get_xlim()[0] < 0.0
    assert any(words.startswith("impulse at most") for words in read.legend(figure))
