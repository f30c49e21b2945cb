"""Maps of sweeps show what is stored, where it is stored, with words and units."""

import dataclasses

import numpy as np
import pytest
from matplotlib.collections import QuadMesh
from sweep_tasks import Failing, basins_plan

from carom import plots
from carom.outcome import InputError
from carom.parameters import Case, Machine, Zones
from carom.sweeps import GridAxis, open_sweep, run_sweep
from carom.sweeps.plan import SweepPlan
from carom.sweeps.studies import StudyTask

MACHINE = Machine(
    mass=50.0, damping=1400.0, stiffness=9.8e5, eccentricity=0.3e-3, clearance=0.7e-3, rotor_radius=0.04,
    speed=184.2, unbalance_phase=0.21, friction=0.15, restitution=0.95,
)  # fmt: skip


@pytest.fixture(scope="module")
def failing(tmp_path_factory):
    """Damping over friction, spaced evenly and geometrically; the largest dampings failed."""
    path = tmp_path_factory.mktemp("sweep") / "s.zarr"
    run_sweep(dataclasses.replace(basins_plan(), task=Failing(above=0.85)), path, workers=1, threads=True)
    return open_sweep(path).load()


@pytest.fixture(scope="module")
def studies(tmp_path_factory):
    axes = (GridAxis("speed", "linear", (100.0, 300.0), 5), GridAxis("damping", "list", (500.0, 5000.0), 2))
    case = Case("machine", MACHINE.parameters, MACHINE, Zones())
    plan = SweepPlan(case, axes, StudyTask(0, False, (0.3, 0.4, 0.5), has_scales=True), (5, 2))
    path = tmp_path_factory.mktemp("sweep") / "s.zarr"
    run_sweep(plan, path, workers=1, threads=True)
    return open_sweep(path).load()


def shades(figure):
    (mesh,) = [entry for entry in figure.axes[0].collections if isinstance(entry, QuadMesh)]
    return mesh.get_array()


def test_shades_are_the_stored_numbers_in_their_places(failing):
    figure = plots.sweep_map(failing, "value", "a title")
    axes = figure.axes[0]

    np.testing.assert_array_equal(shades(figure).filled(np.nan), failing.value.values.T)
    assert shades(figure).mask.sum() == 5
    assert (axes.get_xscale(), axes.get_yscale()) == ("linear", "log")
    assert axes.get_xlabel() == r"scaled damping $\gamma$"
    assert axes.get_title() == "a title"
    assert figure.axes[1].get_ylabel() == "what varies"
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["no value"]


def test_logarithmic_axes_have_plain_numbers(failing):
    axes = plots.sweep_map(failing, "value").axes[0]
    axes.get_figure().draw_without_rendering()
    low, high = axes.get_ylim()
    shown = [text.get_text() for text in axes.get_yticklabels() if low <= text.get_position()[1] <= high]
    assert shown
    assert all(float(text) for text in shown)
    assert not any(text.get_text() for text in axes.get_yticklabels(minor=True))


def test_flags_have_colours_with_words(failing, studies):
    figure = plots.sweep_map(failing, "status")
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["waiting", "done", "failed"]
    figure = plots.sweep_map(studies, "levitates")
    assert [text.get_text() for text in figure.legends[0].get_texts()][:2] == ["no", "yes"]
    assert figure.legends[0].get_title().get_text() == studies.levitates.attrs["long_name"]
    assert len(figure.axes) == 1


@pytest.mark.parametrize(
    ("name", "label"),
    [
        ("levitation_radius", r"radius of the contact-free whirl ($c_\mathrm{r}$)"),
        ("levitation_radius_si", "radius of the contact-free whirl (m)"),
        ("rub_force", r"normal force of the stable synchronous rub ($m$ $c_\mathrm{r}$ $\Omega^2$)"),
        ("stable_orbits", "stable orbits with one impact a period"),
    ],
)
def test_bar_has_words_and_unit(studies, name, label):
    figure = plots.sweep_map(studies, name)

    assert figure.axes[1].get_ylabel() == label
    assert figure.axes[0].get_xlabel().endswith("(rpm)")
    assert figure.axes[0].get_ylabel().endswith("(N s/m)")


def test_one_axis_is_a_line(studies):
    figure = plots.sweep_map(studies.sel(damping=500.0), "levitation_radius")
    (line,) = figure.axes[0].lines

    np.testing.assert_array_equal(line.get_ydata(), studies.levitation_radius.values[:, 0])
    np.testing.assert_allclose(line.get_xdata(), studies.speed.values * 30 / np.pi, rtol=1e-15)


def test_what_cannot_be_drawn_is_told(studies):
    with pytest.raises(InputError, match=r"name = levitation: one of: .*levitation_radius"):
        plots.sweep_map(studies, "levitation")
    with pytest.raises(InputError, match="choose values of the other dimensions"):
        plots.sweep_map(studies.sel(damping=500.0, speed=100.0), "levitation_radius")
