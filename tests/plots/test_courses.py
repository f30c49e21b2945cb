"""Motions over time."""

import numpy as np
import pytest

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


@pytest.mark.jit_only
def test_long_motions_stay_small_files(damped, tmp_path):
    long = carom.simulate(damped.rotor, carom.kick(0.9, angle=0.2), until=60_000.0)
    (svg,) = plots.save(plots.radius(long), tmp_path / "long", ("svg",))
    assert svg.stat().st_size < 300_000


def test_forces_are_drawn_in_contact_only_and_in_newtons(damped):
    # A kick that ends in the stable rub.
    rub = carom.simulate(damped.rotor, carom.kick(0.1, angle=0.2), until=45.0)
    drawn = [line for axes in plots.touchdown(rub).axes for line in axes.lines]
    line = [line for line in drawn if "normal force" in line.get_label()][-1]
    times, values = line.get_data()
    shown = np.isfinite(values)
    assert times[shown].min() >= damped.ms * rub.lasting_contacts[0].start
    normal, _ = rub.forces(times[shown] / damped.ms)
    np.testing.assert_allclose(values[shown], normal * damped.scales.force)
