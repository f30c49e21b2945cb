"""Maps of sweeps show what is stored, where it is stored, with words and units."""

import dataclasses

import numpy as np
import pytest
from drawn_legends import legend_words
from machines import REAL
from matplotlib.collections import QuadMesh
from matplotlib.path import Path
from sweep_tasks import Failing, basins_plan

from carom import plots
from carom.base.outcome import InputError
from carom.parameters import Case, Zones
from carom.sweeps import GridAxis, StudyTask, SweepPlan, open_sweep, run_sweep


@pytest.fixture(scope="module")
def failing(tmp_path_factory):
    """Damping over friction, spaced evenly and geometrically; the largest dampings failed."""
    path = tmp_path_factory.mktemp("sweep") / "s.zarr"
    run_sweep(dataclasses.replace(basins_plan(), task=Failing(above=0.85)), path, workers=1, threads=True)
    return open_sweep(path).load()


@pytest.fixture(scope="module")
def studies(tmp_path_factory):
    axes = (GridAxis("speed", "linear", (100.0, 300.0), 5), GridAxis("damping", "list", (500.0, 5000.0), 2))
    case = Case("machine", REAL.parameters, REAL, Zones())
    plan = SweepPlan(case, axes, StudyTask(0, (0.3, 0.4, 0.5), has_scales=True), (5, 2))
    path = tmp_path_factory.mktemp("sweep") / "s.zarr"
    run_sweep(plan, path, workers=1, threads=True)
    return open_sweep(path).load()


def shades(figure):
    (mesh,) = [entry for entry in figure.axes[0].collections if isinstance(entry, QuadMesh)]
    return mesh.get_array()


def cells(figure, key):
    """Middles of the cells that are drawn as having no value for one reason."""
    (patch,) = [entry for entry in figure.axes[0].patches if entry.get_gid() == key]
    (mesh,) = [entry for entry in figure.axes[0].collections if isinstance(entry, QuadMesh)]
    corners = mesh.get_coordinates()
    middles = 0.25 * (corners[1:, 1:] + corners[1:, :-1] + corners[:-1, 1:] + corners[:-1, :-1])
    # A compound path is inside where one of its rectangles is.
    inside = [
        Path(polygon).contains_points(middles.reshape(-1, 2))
        for polygon in patch.get_path().to_polygons(closed_only=True)
    ]
    return np.any(inside, axis=0).reshape(middles.shape[:2]).T


def test_shades_are_the_stored_numbers_in_their_places(failing):
    figure = plots.sweep_map(failing, "value")
    axes = figure.axes[0]

    np.testing.assert_array_equal(shades(figure).filled(np.nan), failing.value.values.T)
    assert shades(figure).mask.sum() == 5
    assert (axes.get_xscale(), axes.get_yscale()) == ("linear", "log")
    assert axes.get_xlabel() == r"scaled damping $\gamma$"
    assert figure.axes[1].get_ylabel() == "what varies"
    assert legend_words(figure) == ["failed"]


def test_cells_without_a_value_say_why(failing, studies):
    """The reasons look different, lie where they hold, and are stated in words."""
    known = failing.assign(value=failing.value.where(failing.status == 1).where(failing.mu > 0.06))
    known["status"] = known.status.where(known.gamma > 0.6, 0).where(known.mu < 0.15, 2).astype("int8")
    known["value"] = known.value.where(known.status == 1)
    known["possible"] = known.status * 0 + (known.gamma < 0.7)
    figure = plots.sweep_map(known, "value")
    blank = known.value.isnull()

    assert legend_words(figure) == ["no levitation", "no such value", "not computed yet", "failed"]
    np.testing.assert_array_equal(cells(figure, "waiting"), (blank & (known.status == 0)).values)
    np.testing.assert_array_equal(cells(figure, "failed"), (blank & (known.status == 2)).values)
    computed = blank & (known.status == 1)
    np.testing.assert_array_equal(cells(figure, "no-levitation"), (computed & (known.possible == 0)).values)
    np.testing.assert_array_equal(cells(figure, "none"), (computed & (known.possible > 0)).values)
    looks = {(entry.get_facecolor(), entry.get_hatch()) for entry in figure.axes[0].patches}
    assert len(looks) == 4


def test_what_cannot_be_drawn_is_told(studies):
    with pytest.raises(InputError, match=r"name = levitation: one of: .*levitation_radius"):
        plots.sweep_map(studies, "levitation")
    with pytest.raises(InputError, match="choose values of the other dimensions"):
        plots.sweep_map(studies.sel(damping=500.0, speed=100.0), "levitation_radius")
