"""Motions as datasets and files: nothing is lost, and nothing is read that was not written so."""

import dataclasses

import numpy as np
import pytest
import xarray
from machines import PAPER, SCALES

from carom import State, drop, load, simulate
from carom.base.outcome import InputError
from carom.motions import Trajectory


@pytest.fixture(scope="module")
def motion():
    """Bounces, chatter and a slide."""
    found = simulate(PAPER.replace(gamma=0.05, d=0.5), State(0.5 + 0.0j, 0.1j), 60.0)
    assert len(found.contacts) > 3
    assert found.lasting_contacts
    return found


@pytest.mark.parametrize("scales", [None, SCALES])
def test_a_motion_is_read_as_it_was_written(motion, scales, tmp_path):
    written = simulate(motion.rotor.replace(scales=scales), motion.start, motion.time)
    written.save(tmp_path / "motion.nc")
    read = Trajectory.load(tmp_path / "motion.nc")

    for field in dataclasses.fields(Trajectory):
        one, other = getattr(written, field.name), getattr(read, field.name)
        if isinstance(one, np.ndarray):
            assert one.dtype == other.dtype, field.name
            np.testing.assert_array_equal(one, other)
        else:
            assert one == other, field.name
    times = np.linspace(0.0, motion.time, 200)
    np.testing.assert_array_equal(written.at(times), read.at(times))
    assert read.lasting_contacts == written.lasting_contacts


def test_a_motion_without_contact_is_kept_too(tmp_path):
    quiet = simulate(PAPER.replace(gamma=0.3), State(0.1j), 2.0)
    quiet.save(tmp_path / "quiet.nc")
    read = Trajectory.load(tmp_path / "quiet.nc")
    assert len(read.contacts) == 0
    assert read.final == quiet.final


def test_a_motion_of_several_stages_is_kept_with_all_of_them(tmp_path):
    machine = load("examples/dropped-rotor.toml")
    written = simulate(machine, drop(State(0j), regained_after="8 ms"), "20 ms")
    assert len(written.parts) == 2
    written.save(tmp_path / "stages.nc")
    read = Trajectory.load(tmp_path / "stages.nc")
    for one, other in zip(written.parts, read.parts, strict=True):
        assert (one.begins, one.time, one.outcome) == (other.begins, other.time, other.outcome)
        times = np.linspace(0.0, one.time, 50)
        np.testing.assert_array_equal(one.at(times), other.at(times))


def test_a_file_that_holds_no_motion_is_refused(motion, tmp_path):
    path = tmp_path / "motion.nc"
    with pytest.raises(InputError, match="cannot be read"):
        Trajectory.load(path)
    path.write_bytes(b"nothing")
    with pytest.raises(InputError, match="not netCDF"):
        Trajectory.load(path)
    motion.save(path)
    whole = path.read_bytes()
    path.write_bytes(whole[:-200] + bytes([whole[-200] ^ 1]) + whole[-199:])
    with pytest.raises(InputError, match="damaged"):
        Trajectory.load(path)

    from carom.base.files import load_dataset, save_dataset
    from carom.motions.storage import SEGMENTS

    motion.save(path)
    dataset = load_dataset(path, SEGMENTS)
    for changes in ({"outcome": "FLYING"}, {"parameters": "{}"}, {"start": "[1]"}):
        save_dataset(dataset.assign_attrs(changes), path)
        with pytest.raises(InputError, match="must hold a motion that carom has written"):
            Trajectory.load(path)
    save_dataset(xarray.Dataset({"other": 1}), path)
    with pytest.raises(InputError, match="must hold the variables segment_starts"):
        Trajectory.load(path)
