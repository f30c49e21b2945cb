"""Sweeps planned in Python: the same as those of files, in memory as in a store."""

import shutil

import pytest
import xarray
from sweep_tasks import stored_bytes

import carom as cm
from carom.base.outcome import InputError
from carom.disturbances import Sample, VelocityKick
from carom.sweeps import GridAxis, StudyTask, load_sweep, open_sweep, plan_sweep, run_sweep

EXAMPLE = "examples/keogh-cole.toml"
FILE = """
machine = "machine.toml"
seed = 3
chunk = 2
[axes.speed]
from = "900 rpm"
to = "1800 rpm"
count = 3
[axes.damping]
values = ["1400 N s/m", 5600]
{work}
"""
KICKS = '[basins]\nstarts = 30\ndisturbance = {kind = "kick", fastest = "0.1 m/s"}'
STUDY = "[study]\ndisturbances = 15"
AXES = GridAxis.between("speed", "900 rpm", "1800 rpm", 3), GridAxis.of("damping", ["1400 N s/m", 5600])


def without_history(data):
    return data.assign_attrs(history="", sweep_file="", machine_file="").load()


@pytest.fixture
def machine(tmp_path):
    shutil.copy(EXAMPLE, tmp_path / "machine.toml")
    return cm.load(tmp_path / "machine.toml")


@pytest.mark.jit_only
@pytest.mark.parametrize("work", [KICKS, STUDY])
def test_file_and_python_give_the_same_in_a_store_and_in_memory(tmp_path, machine, work):
    (tmp_path / "sweep.toml").write_text(FILE.format(work=work))
    read = load_sweep(tmp_path / "sweep.toml")
    kicks = Sample(VelocityKick.of(machine, "100 mm/s"), 30, seed=3)
    planned = plan_sweep(machine, AXES, kicks if work == KICKS else StudyTask(15), seed=3, chunk=2)

    assert planned == read
    assert planned.digest == read.digest
    tally = run_sweep(read, tmp_path / "file.zarr", workers=2, threads=True)
    assert (tally.done, tally.store) == (6, tmp_path / "file.zarr")
    run_sweep(planned, tmp_path / "python.zarr", workers=1, threads=True)
    assert stored_bytes(tmp_path / "file.zarr") == stored_bytes(tmp_path / "python.zarr")
    inside = run_sweep(planned)
    assert (inside.done, inside.waiting, inside.store) == (6, 0, None)
    stored = without_history(open_sweep(tmp_path / "file.zarr"))
    xarray.testing.assert_identical(without_history(inside.dataset), stored)
    xarray.testing.assert_identical(without_history(tally.dataset), stored)


@pytest.mark.parametrize(
    ("axes", "more", "words"),
    [
        ([], {}, "axes = nothing given: must be one or more"),
        ([AXES[0], AXES[0]], {}, "axes = speed, speed: must be one or more, each for another"),
        ([AXES[1], GridAxis.of("gamma", [0.1])], {}, "sets damping, which is set too"),
        (AXES, {"seed": -1}, "seed = -1"),
        (AXES, {"chunk": 0}, "chunk = 0"),
    ],
)
def test_what_cannot_be_planned(machine, axes, more, words):
    with pytest.raises(InputError, match=words):
        plan_sweep(machine, axes, StudyTask(), **more)
