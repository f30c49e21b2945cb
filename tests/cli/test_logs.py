"""Contact logs as files hold what the motion has, in SI units, and appear whole or not at all."""

import csv

import numpy as np
import pytest
import xarray
from linear_rotors import single
from yielding_walls import with_walls

from carom import State, kick, load, simulate
from carom.base.outcome import Phase
from carom.cli.logs import write_csv, write_netcdf
from carom.models import KelvinVoigt, jeffcott
from carom.parameters import Scales

pytestmark = pytest.mark.jit_only


@pytest.fixture
def motion(machine):
    return simulate(jeffcott(load(machine).parameters), kick(0.1, 2.0), 150.0)


def rows_of(path):
    with path.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def test_csv_holds_impacts_and_lasting_contacts_in_order(motion, tmp_path):
    write_csv(motion, str(tmp_path / "log.csv"))
    rows = rows_of(tmp_path / "log.csv")
    scales = motion.rotor.scales

    impacts = [row for row in rows if row["kind"] == "impact"]
    assert [float(row["time [s]"]) for row in impacts] == (motion.contacts.time * scales.time).tolist()
    assert [float(row["normal_impulse [N s]"]) for row in impacts] == (
        motion.contacts.normal_impulse * scales.impulse
    ).tolist()
    slides = [row for row in rows if row["kind"] == "slide (forward-slip)"]
    assert len(slides) == len(motion.lasting_contacts) > 0
    assert float(slides[-1]["end [s]"]) == motion.time * scales.time
    times = [float(row["time [s]"]) for row in rows]
    assert times == sorted(times)


def test_netcdf_holds_the_same_with_units(motion, tmp_path):
    write_netcdf(motion, str(tmp_path / "log.nc"))

    with xarray.open_dataset(tmp_path / "log.nc", engine="h5netcdf") as read:
        assert read["normal_impulse"].attrs["units"] == "N s"
        assert np.array_equal(read["time"], motion.contacts.time * motion.rotor.scales.time)
        assert read["lasting_phase"].values.tolist() == [contact.phase for contact in motion.lasting_contacts]
        meanings = dict(
            zip(
                np.atleast_1d(read["lasting_phase"].attrs["flag_values"]).tolist(),
                read["lasting_phase"].attrs["flag_meanings"].split(),
                strict=True,
            )
        )
        assert meanings[Phase.FORWARD_SLIP] == "forward_slip"
        assert read.attrs["outcome"] == motion.outcome.label
        assert read.attrs["gamma"] == motion.rotor.parameters.gamma
        assert read.attrs["end_time"] == motion.time * motion.rotor.scales.time


def test_contacts_with_a_wall_that_gives_way(tmp_path):
    scales = Scales(mass=50.0, clearance=0.7e-3, speed=184.2)
    motion = simulate(with_walls(single(1), KelvinVoigt(1e4, 3.0), scales), State(0.2, 1.0), 8.0)
    write_csv(motion, str(tmp_path / "log.csv"))
    write_netcdf(motion, str(tmp_path / "log.nc"))

    rows, touches = rows_of(tmp_path / "log.csv"), motion.contacts
    assert [row["kind"] for row in rows] == ["forward-slip"] * len(touches)
    assert [float(row["peak_force [N]"]) for row in rows] == (touches.peak_force * scales.force).tolist()
    assert [float(row["time [s]"]) for row in rows] == (touches.time * scales.time).tolist()
    with xarray.open_dataset(tmp_path / "log.nc", engine="h5netcdf", decode_times=False) as read:
        assert np.array_equal(read["deepest"], touches.deepest * scales.length)
        assert len(read["lasting_phase"]) == len(motion.lasting_contacts)
