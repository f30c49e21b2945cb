"""Records: read from files, and refused in one line where they are broken."""

import numpy as np
import pytest
import xarray
from scipy.io import savemat

import carom as cm
from carom.base.outcome import InputError
from carom.fitting import Channel, Record, read_record
from carom.models import rotor_of

SPINDLE = rotor_of(cm.load("examples/spindle.toml"))
SPEED = SPINDLE.scales.speed
TIMES = np.arange(400) / 20_000.0
ORBIT = 100e-6 * np.exp(300j * TIMES) + 20e-6 * np.exp(1j * SPEED * TIMES)
AXES = (Channel.read("x [m]"), Channel.read("y [m]"))


def record(times=TIMES, orbit=ORBIT):
    return Record("record", times, np.column_stack([orbit.real, orbit.imag]), AXES)


def test_a_record_is_the_same_from_all_formats(tmp_path):
    table = np.column_stack([1e3 * TIMES, 1e6 * ORBIT.real, 1e6 * ORBIT.imag])
    np.savetxt(tmp_path / "a.csv", table, delimiter=",", header="time [ms],x [um],y [um]", comments="", fmt="%.17g")
    savemat(tmp_path / "a.mat", {"t": table[:, 0], "probes": table[:, 1:]})
    named = {name: ("m", column) for name, column in zip(("time", "x", "y"), table.T, strict=True)}
    dataset = xarray.Dataset(named)
    for name, unit in (("time", "ms"), ("x", "um"), ("y", "um")):
        dataset[name].attrs["units"] = unit
    dataset.to_netcdf(tmp_path / "a.nc")
    columns = {".csv": None, ".mat": "t = time [ms], probes_1 = x [um], probes_2 = y [um]", ".nc": None}
    for suffix, text in columns.items():
        found = read_record(tmp_path / f"a{suffix}", text)
        assert found.times == pytest.approx(TIMES, rel=1e-14)
        assert found.values == pytest.approx(record().values, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "direction", "place", "number"),
    [
        ("x [um]", 0.0, "bearing", 1),
        ("y at bearing 2 [mm]", np.pi / 2, "bearing", 2),
        ("-45 deg at node 3 (um)", -np.pi / 4, "node", 3),
        ("magnetic_bearing_2_sensor_y [m]", np.pi / 2, "sensor", 2),
    ],
)
def test_a_column_says_what_it_shows(text, direction, place, number):
    found = Channel.read(text)
    assert (found.direction, found.place, found.number) == (pytest.approx(direction), place, number)


def broken(change):
    orbit, times = ORBIT.copy(), TIMES.copy()
    change(orbit, times)
    return orbit, times


def cases():
    def missing(orbit, times):
        times[200:] += 3e-4

    def clipped(orbit, times):
        orbit.real[:] = np.minimum(orbit.real, 60e-6)

    def lost(orbit, times):
        orbit[7] = np.nan

    def stuck(orbit, times):
        orbit.imag[:] = 1e-6

    def back(orbit, times):
        times[30] = times[29]

    yield missing, "gap from"
    yield clipped, "this one is clipped"
    yield lost, "no number in sample 8"
    yield stuck, "a channel that changes"
    yield back, "times that increase"


@pytest.mark.parametrize(("change", "message"), list(cases()))
def test_a_broken_record_is_refused_in_a_line(change, message):
    orbit, times = broken(change)
    with pytest.raises(InputError, match=message) as problem:
        record(times, orbit)
    assert "\n" not in str(problem.value)


@pytest.mark.parametrize(
    ("times", "orbit", "message"),
    [
        (TIMES, 1000.0 * ORBIT, "is the unit right"),
        (TIMES, 1e-3 * ORBIT * 0.5, "is the unit right"),
        (50.0 * TIMES, ORBIT, "at least 2 samples a turn"),
        (TIMES, 1j * ORBIT.conj(), "they are swapped"),
    ],
)
def test_a_record_of_another_machine_is_refused(times, orbit, message):
    with pytest.raises(InputError, match=message):
        record(times, orbit).check(SPINDLE)


def test_unknown_columns_are_refused_by_name(tmp_path):
    (tmp_path / "a.csv").write_text(
        "t,probe\n" + "\n".join(f"{t},{1e6 * z.real}" for t, z in zip(TIMES, ORBIT, strict=True))
    )
    with pytest.raises(InputError, match="column = t: such as"):
        read_record(tmp_path / "a.csv")
    with pytest.raises(InputError, match="a column of the file: t, probe"):
        read_record(tmp_path / "a.csv", "time = time [s], probe = x [um]")
    with pytest.raises(InputError, match="its unit in brackets"):
        read_record(tmp_path / "a.csv", "time [s], x")


def test_a_history_that_carom_has_written_is_read_as_it_is(tmp_path):
    """All places of a flexible machine, against the history itself."""
    machine = cm.load("examples/tum-flexible-rotor.toml")
    motion = cm.simulate(machine, cm.kick("20 mm/s"), "10 ms")
    dataset = motion.channels("0.1 ms", (4,), machine)
    cm.motions.write_channels(dataset, str(tmp_path / "history.csv"))
    names = [name for name in dataset.data_vars if name.endswith(("_x", "_y")) and "current" not in name]
    kept = [f"{name} [m] = {name} [m]" for name in names if "sensor" in name or "bearing" not in name]
    found = read_record(tmp_path / "history.csv", ", ".join(["time [s] = time [s]", *kept]))
    rotor = rotor_of(machine)
    clocks = rotor.scales.speed * found.times
    turned = (motion.at(np.minimum(clocks, motion.time))[0] * np.exp(1j * clocks)[:, None]).T
    for channel, column in zip(found.channels, found.values.T, strict=True):
        seen = (channel.row(rotor) @ turned * np.exp(-1j * channel.direction)).real
        assert column == pytest.approx(seen, abs=1e-12)
