"""Files of basins: whole or not at all, and what is damaged is one line and never a wrong number."""

import random
import shutil
import subprocess

import numpy as np
import pytest
import xarray
from compilation import sized
from damage import CONTENT, spoilt

from carom.base.files import load_dataset, save_dataset
from carom.base.outcome import InputError
from carom.basins import Basin, GainMap

DATASET = xarray.Dataset(
    {
        "outcome": (
            ("x", "y"),
            np.arange(600, dtype=np.int8).reshape(20, 30),
            {"flag_values": np.array([0, 20], np.int8)},
        ),
        "time": (("x", "y"), np.linspace(0.0, 1.0, 600).reshape(20, 30), {"units": "1/Omega"}),
    },
    coords={"x": np.linspace(-1.0, 1.0, 20)},
    attrs={"parameters": "{}"},
)


def test_what_is_read_is_what_was_written(tmp_path):
    save_dataset(DATASET, tmp_path / "b.nc")

    assert load_dataset(tmp_path / "b.nc", ("outcome", "time")).identical(DATASET)
    assert [file.name for file in tmp_path.iterdir()] == ["b.nc"]


def test_other_readers_of_netcdf_take_the_file(tmp_path):
    save_dataset(DATASET, tmp_path / "b.nc")
    with xarray.open_dataset(tmp_path / "b.nc", engine="h5netcdf") as read:
        np.testing.assert_array_equal(read["outcome"], DATASET["outcome"])


@pytest.mark.parametrize("kind", CONTENT)
def test_damaged_files_are_one_line(tmp_path, kind):
    file, chance = tmp_path / "b.nc", random.Random(4)
    save_dataset(DATASET, file)
    whole = file.read_bytes()
    for _ in range(sized(30, 30, 400)):
        data = spoilt(whole, chance, kind)
        file.write_bytes(data)
        if data != whole:
            with pytest.raises(InputError, match=r"^file = .*: (is damaged|must hold|cannot be read)"):
                load_dataset(file, ("outcome",))
    file.write_bytes(whole)
    assert load_dataset(file, ("outcome",)).identical(DATASET)


@pytest.mark.parametrize("result", [Basin, GainMap])
def test_files_that_hold_something_else(tmp_path, result):
    save_dataset(DATASET.drop_vars(["outcome", "time"]), tmp_path / "b.nc")
    with pytest.raises(InputError, match=r"must hold the variables [a-z_, ]*$"):
        result.load(tmp_path / "b.nc")
    DATASET.to_netcdf(tmp_path / "b.nc", engine="h5netcdf")
    with pytest.raises(InputError, match="and end with the checksum that carom writes"):
        result.load(tmp_path / "b.nc")
    (tmp_path / "b.nc").unlink()
    (tmp_path / "b.nc").mkdir()
    with pytest.raises(InputError, match=r"^file = .* cannot be read"):
        result.load(tmp_path / "b.nc")


def test_full_disk_is_one_line(tmp_path):
    mounted = shutil.which("mount") and not subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=16k", "tmpfs", str(tmp_path)], capture_output=True, check=False
    ).returncode  # fmt: skip
    if not mounted:
        pytest.skip("only root may mount a small disk")
    try:
        large = DATASET.assign(noise=("z", np.random.default_rng(1).random(100_000)))
        with pytest.raises(InputError, match="cannot be written"):
            save_dataset(large, tmp_path / "b.nc")
        assert not list(tmp_path.iterdir())
    finally:
        subprocess.run(["umount", str(tmp_path)], check=True)
