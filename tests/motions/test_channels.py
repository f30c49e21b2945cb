"""Histories of a motion: displacements, forces, speeds and currents as sensors would see them."""

from pathlib import Path

import numpy as np
import pytest
import xarray
from scipy.io import loadmat

import carom as cm
from carom.base.outcome import InputError
from carom.motions import write_channels

pytestmark = pytest.mark.jit_only

TILTING = "tests/machine_files/four-degrees.toml"


def test_a_fall_from_the_centre():
    machine = cm.load("examples/touchdown-balls.toml").replace(eccentricity=0.0)
    fall = cm.simulate(machine, cm.drop(cm.State(0)), "6 ms").channels("50 us")
    assert fall.sizes["time"] == 121
    assert fall.time.values[-1] == pytest.approx(6e-3, rel=1e-12)
    # Exponentials of the mode of a fall: rounding of squares of small times.
    assert fall.touchdown_1_y.values == pytest.approx(-0.5 * 9.81 * fall.time.values**2, rel=1e-12, abs=1e-19)
    assert fall.shaft_speed.values == pytest.approx(9000 * np.pi / 30)
    assert (fall.touchdown_1_race_speed == 0.0).all()


def test_contact_forces_are_those_of_the_motion():
    motion = cm.simulate(cm.load("examples/touchdown-balls.toml"), cm.drop(), "20 ms")
    found, scales = motion.channels("10 us"), motion.rotor.scales
    times = np.minimum(found.time.values / scales.time, motion.time)
    normal, friction = motion.forces(times)
    assert normal.max() > 0.0
    assert found.touchdown_1_normal_force.values == pytest.approx(scales.force * normal, rel=1e-12)
    assert found.touchdown_1_friction_force.values == pytest.approx(scales.force * friction, rel=1e-12)
    place = scales.clearance * motion.position(times, "fixed")
    assert found.touchdown_1_x.values == pytest.approx(place.real, rel=1e-9, abs=1e-18)


def test_currents_and_places_obey_newton():
    """The centre of mass is accelerated by the magnets and the unbalance alone: bias currents carry the weight."""
    step = 2e-6
    motion = cm.simulate(cm.load(TILTING), cm.kick("5 mm/s", "40 deg"), "1 ms")
    found = motion.channels(f"{step} s", (2, 5))
    assert (found.touchdown_1_normal_force == 0.0).all()
    places = {name: found[f"{name}_x"].values + 1j * found[f"{name}_y"].values for name in ("node_2", "node_5")}
    currents = [
        found[f"magnetic_bearing_{n}_current_x"].values + 1j * found[f"magnetic_bearing_{n}_current_y"].values
        for n in (1, 2)
    ]
    # Station 2 is 0.12 m before the centre of mass, station 5 0.15 m behind it; ks = -1e5 N/m, ki = 100 N/A, 30 g mm.
    centre = (0.15 * places["node_2"] + 0.12 * places["node_5"]) / 0.27
    force = 1e5 * (places["node_2"] + places["node_5"]) - 100.0 * sum(currents)
    force += 30e-6 * 2000.0**2 * np.exp(2000j * found.time.values)
    four = np.array([-1.0, 16.0, -30.0, 16.0, -1.0]) / (12.0 * step**2)
    acceleration = np.convolve(centre, four, "valid")
    # Differences of the fourth order leave (2e-6 s / 1e-4 s)^4/90 of what the filter of the derivative does.
    assert 12.0 * acceleration == pytest.approx(force[2:-2], abs=1e-6 * np.abs(force).max())


def test_currents_keep_their_limit(tmp_path):
    """The centre of mass is accelerated by weight, unbalance and magnets whose currents, with the bias currents, are cut off at 0.8 A along each axis."""
    path, step = tmp_path / "limited.toml", 2e-6
    path.write_text(Path(TILTING).read_text().replace("ki =", 'current_limit = "0.8 A"\nki ='))
    found = cm.simulate(cm.load(path), cm.kick("40 mm/s", "220 deg"), "1 ms").channels(f"{step} s", (2, 5))
    places = {name: found[f"{name}_x"].values + 1j * found[f"{name}_y"].values for name in ("node_2", "node_5")}
    # Bias currents carry 12 kg by levers of 0.15 m and 0.12 m.
    whole = [
        found[f"magnetic_bearing_{n}_current_x"].values
        + 1j * (found[f"magnetic_bearing_{n}_current_y"].values - 12.0 * 9.81 * lever / 0.27 / 100.0)
        for n, lever in ((1, 0.15), (2, 0.12))
    ]
    assert max(np.abs(each.view(float)).max() for each in whole) == pytest.approx(0.8, rel=1e-12)
    centre = (0.15 * places["node_2"] + 0.12 * places["node_5"]) / 0.27
    force = 1e5 * (places["node_2"] + places["node_5"]) - 100.0 * sum(whole) - 12.0j * 9.81
    force += 30e-6 * 2000.0**2 * np.exp(2000j * found.time.values)
    acceleration = 12.0 * np.convolve(centre, [1.0, -2.0, 1.0], "valid") / step**2
    assert acceleration == pytest.approx(force[1:-1], abs=1e-3 * np.abs(force).max())


def test_currents_are_unknown_while_levitation_is_lost():
    machine = cm.load(TILTING)
    found = cm.simulate(machine, cm.drop(regained_after="2 ms"), "4 ms").channels("50 us", (0,), machine)
    assert np.isnan(found.magnetic_bearing_1_current_x.values[:40]).all()
    assert np.isfinite(found.magnetic_bearing_1_current_x.values[40:]).all()
    # Touchdown bearing 1 is at station 0.
    assert found.node_0_y.values == pytest.approx(found.touchdown_1_y.values, rel=1e-9)


def test_files_hold_the_same_numbers_with_their_units(tmp_path):
    found = cm.simulate(cm.load("examples/touchdown-balls.toml"), cm.drop(), "8 ms").channels("0.1 ms")
    for name in ("a.csv", "a.mat", "a.nc"):
        write_channels(found, str(tmp_path / name))
    heading = (tmp_path / "a.csv").read_text().splitlines()[0].split(",")
    assert heading[:2] == ["time [s]", "touchdown_1_x [m]"]
    rows = np.loadtxt(tmp_path / "a.csv", delimiter=",", skiprows=1)
    matlab, back = loadmat(tmp_path / "a.mat", simplify_cells=True), xarray.open_dataset(tmp_path / "a.nc")
    assert len(heading) == 1 + len(found.data_vars)
    for column, (name, unit) in enumerate(each.rstrip("]").split(" [") for each in heading):
        assert rows[:, column] == pytest.approx(found[name].values, rel=1e-11)
        assert (matlab[name] == found[name].values).all()
        assert (back[name] == found[name]).all()
        assert unit == matlab["units"][name] == back[name].attrs["units"]
    with pytest.raises(InputError, match=r"a file that ends in \.csv, \.mat, \.nc"):
        write_channels(found, str(tmp_path / "a.txt"))


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"every": "1 ns"}, "every = 1 ns: must make at most 5000000"),
        ({"nodes": (1,)}, "nodes = 1: must be left out: this rotor has no nodes"),
        ({"nodes": (9,), "machine": TILTING}, "nodes = 9: a node of the shaft: 0 to 6"),
    ],
)
def test_bad_input(options, words):
    machine = cm.load(options.pop("machine", "examples/touchdown-balls.toml"))
    with pytest.raises(InputError, match=words):
        cm.simulate(machine, cm.drop(), "8 ms").channels(**options, machine=machine)
