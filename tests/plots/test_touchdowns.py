"""Figures of a touchdown: what each panel must show."""

from __future__ import annotations

from itertools import combinations

import matplotlib as mpl
import numpy as np
import pytest
from compilation import COMPILED
from machines import PAPER
from matplotlib.colors import to_rgb

import carom
from carom import plots
from carom.motions.ledger import energy_ledger
from carom.plots import LOOKS, touchdowns
from carom.plots.style import REGIMES


@pytest.fixture(scope="module")
def rub(damped):
    """A kick that ends in the stable rub."""
    return carom.simulate(damped.rotor, carom.kick(0.1, angle=0.2), until=45.0)


@pytest.fixture(autouse=True)
def _coarse_without_the_compiler(monkeypatch):
    if not COMPILED:
        monkeypatch.setattr("carom.plots.touchdowns._SAMPLES", 100)


@pytest.fixture(scope="module")
def ledger(rub):
    return energy_ledger(rub)


def _words(figure) -> str:
    texts = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    return " | ".join(texts)


def test_touchdown_tells_regimes_forces_and_energies_in_words_and_units(rub, ledger):
    figure = plots.touchdown(rub, ledger, title="kick")
    words = _words(figure)
    for expected in (
        "flight",
        "sliding, slip forward",
        "forward whirl",
        "normal force",
        "normal impulse",
        "work of the drive",
    ):
        assert expected in words
    labels = " ".join(axes.get_ylabel() for axes in figure.axes)
    assert "(N)" in labels
    assert "(N s)" in labels
    assert "(J)" in labels


def test_forces_are_drawn_in_contact_only_and_in_newtons(rub, damped):
    figure = plots.forces(rub)
    line = next(line for line in figure.axes[0].lines if "normal force" in line.get_label())
    times, values = line.get_data()
    shown = np.isfinite(values)
    assert times[shown].min() >= damped.ms * rub.lasting_contacts[0].start
    normal, _ = rub.forces(times[shown] / damped.ms)
    np.testing.assert_allclose(values[shown], normal * damped.scales.force)


def test_forces_of_a_motion_without_lasting_contact_show_impulses_alone(bouncing):
    figure = plots.forces(bouncing)
    assert len(figure.axes) == 2
    stems = figure.axes[1].collections[0].get_segments()
    assert len(stems) == len(bouncing.contacts)
    left = figure.axes[0]
    assert [text.get_text() for text in left.texts] == ["no lasting contact"]
    assert (list(left.get_yticks()), left.get_ylabel()) == ([], "")
    assert "force" not in _words(figure)


def test_words_stand_above_the_stems(bouncing):
    figure = plots.forces(bouncing)
    figure.draw_without_rendering()
    words = figure.axes[0].texts[0].get_window_extent()
    stems = figure.axes[1].collections[0]
    assert words.y0 > stems.get_window_extent().y1


def test_forces_of_a_motion_without_contact(damped):
    figure = plots.forces(carom.simulate(damped.rotor, carom.kick(0.01), until=5.0))
    assert [text.get_text() for text in figure.axes[0].texts] == ["no contact"]
    assert len(figure.axes) == 1


def test_forces_that_are_drawn_need_no_words(rub):
    assert len(plots.forces(rub).axes[0].texts) == 0


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


def test_areas_differ_in_grey():
    """Two regimes, or two directions of whirl, of nearly the same grey have different hatches."""
    for looks in (REGIMES, (LOOKS["forward"], LOOKS["backward"])):
        for one, other in combinations(looks, 2):
            grey = [float(np.dot((0.299, 0.587, 0.114), to_rgb(look.colour))) for look in (one, other)]
            assert abs(grey[0] - grey[1]) > 0.2 or one.hatch != other.hatch
    figure = plots.regimes(carom.simulate(PAPER, carom.kick(2.0, angle=2.0), until=4.0))
    hatched = {area.get_label(): area.get_hatch() for area in figure.axes[0].collections if "_" not in area.get_label()}
    assert hatched["backward whirl"]
    assert not hatched["flight"]


def test_large_forces_and_energies_are_in_kilo(damped):
    assert touchdowns._unit_of(10.0, "force", damped.scales) == (damped.scales.force, "N")
    assert touchdowns._unit_of(3265.0, "force", damped.scales) == (pytest.approx(1e-3 * damped.scales.force), "kN")
    assert touchdowns._unit_of(3265.0, "force", None) == (1.0, r"$m\,c_\mathrm{r}\,\Omega^2$")
