"""Base motion from a record: against DOP853 from sample to sample, and what a file must be."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import carom as cm
from carom.base.outcome import InputError
from carom.cli.starts import with_requirement
from carom.disturbances import BaseRecord
from carom.models import rotor_of
from carom.motions import energy_ledger
from carom.studies.survives import at_full_size
from carom.studies.wording import Wording

KEOGH, INSTANT = "examples/keogh-cole.toml", 0.3
WEIGHS, ON_MOUNT = "tests/machines/gravity.toml", "tests/machines/mount.toml"


def record(size, samples=41, end=30.0):
    """A rough motion from rest along both axes, sampled at times that are not equally far apart."""
    draw = np.random.default_rng(1).normal
    times = np.linspace(0.0, 1.0, samples) ** 1.2 * end
    x, y = size * draw(size=(2, samples))
    return BaseRecord(tuple(times), (0.0, *x[1:]), (0.0, *y[1:]))


def reference(rotor, shaken, start):
    """Coordinates in the fixed frame and their rates at the end, by DOP853."""
    mass, damping, gyroscopic, stiffness, forcing = rotor.matrices
    n, times, values = len(mass), np.array(shaken.times), shaken.accelerations
    weight = np.zeros(n) if rotor.acting.weight is None else rotor.acting.weight
    inverse = np.linalg.inv(mass)

    def rates(time, state):
        place, speed = state[:n], state[n:]
        base = np.interp(time - INSTANT, times, values)
        push = forcing * np.exp(1j * time) - (damping - 1j * gyroscopic) @ speed - stiffness @ place
        return np.concatenate([speed, inverse @ push + weight - base * rotor.carried_by_housing])

    turn = np.exp(1j * INSTANT)
    place, speed = np.atleast_1d(start.position) * turn, np.atleast_1d(start.velocity) * turn
    state = np.concatenate([place, speed + 1j * place])
    for begins, ends in zip(times[:-1] + INSTANT, times[1:] + INSTANT, strict=True):
        found = solve_ivp(rates, (begins, ends), state, "DOP853", rtol=1e-12, atol=1e-13, max_step=0.1)
        state = found.y[:, -1]
    return state


@pytest.mark.parametrize(("path", "size"), [(KEOGH, 0.01), (WEIGHS, 1e-4), (ON_MOUNT, 1e-4)])
def test_flights_through_a_record_are_those_of_dop853(path, size):
    """Of a rotor, of one that sags by its weight, and of one whose touchdown bearing is on a mount, which is shaken too."""
    rotor, shaken = rotor_of(cm.load(path)), record(size)
    moved, start = shaken.apply(rotor, instant=INSTANT)
    motion = cm.simulate(moved, start)
    assert not any(len(part.contacts) for part in motion.parts)
    last = motion.earlier[-1]
    expected = reference(rotor, shaken, start)
    turn = np.exp(1j * (INSTANT + shaken.times[-1]))
    place, speed = (np.atleast_1d(each) * turn for each in last.at(np.array(last.time)))
    assert np.concatenate([place, speed + 1j * place]) == pytest.approx(expected, abs=1e-8)
    assert max(energy_ledger(part).imbalance for part in motion.parts[:9]) < 1e-13


def test_a_shaft_on_anisotropic_supports_moves_as_under_a_shock_that_is_sampled_finely():
    machine = cm.load("tests/machines/flexible-support.toml")
    peak, duration, angle = 0.02, 2.0, 0.7
    times = np.linspace(0.0, duration, 401)
    values = peak * np.sin(np.pi * times / duration) * np.exp(1j * angle)
    found = cm.simulate(*BaseRecord(tuple(times), tuple(values.real), tuple(values.imag)).apply(machine)).earlier[-1]
    exact = cm.simulate(*cm.BaseShock(peak, duration).apply(machine, peak, angle)).earlier[-1]
    # Straight lines between samples leave h²/12 of the curvature.
    error = np.abs(found.at(np.array(found.time))[0] - exact.at(np.array(exact.time))[0]).max()
    assert error < 2e-5 * peak


def test_a_file_has_units(tmp_path):
    path = tmp_path / "quake.csv"
    path.write_text("t [ms],y (g)\n5,0\n7,1\n10,-0.5\n", encoding="utf-8")
    machine = cm.load(KEOGH)
    scales, found = machine.parameters.scales, BaseRecord.read(str(path), machine).model
    assert np.array(found.times) * scales.time == pytest.approx([0.0, 2e-3, 5e-3])
    assert found.accelerations * scales.acceleration == pytest.approx([0.0, 9.80665j, -4.903325j])
    assert BaseRecord.from_description(found.scaled(2.0).describe()) == found.scaled(2.0)
    said = found.echo(rotor_of(machine), found.peak, 0.0).words
    assert said.startswith("Base motion quake.csv: 3 samples over 5 ms, linear in between, at most 1 g")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "must be a CSV file with a heading such as"),
        ("time (s),z (g)\n0,0\n1,0\n", "its heading is time (s),z (g)"),
        ("time (s),x\n0,0\n1,0\n", "its heading is time (s),x"),
        ("time (s)\n0\n1\n", "its heading is time (s)"),
        ("time (m),x (g)\n0,0\n1,0\n", "base-record time = 1 m: must be"),
        ("time (s),x (g)\n0,0\n", "must have from 2 to 20000 samples, not 1"),
        ("time (s),x (g)\n0,0\n1,a\n", "must have 2 numbers in sample 2, not 1,a"),
        ("time (s),x (g)\n0,0\n1,1,2\n", "must have 2 numbers in sample 2, not 1,1,2"),
        ("time (s),x (g)\n0,0\n1,1\n1,2\n", "times that increase: sample 3 has 1,2"),
        ("time (s),x (g)\n0,nan\n1,1\n", "sample 1 has 0,nan"),
    ],
)
def test_what_is_no_record_has_one_line(tmp_path, text, words):
    path = tmp_path / "quake.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as problem:
        BaseRecord.read(str(path), cm.load(KEOGH))
    assert words in str(problem.value)
    assert "\n" not in str(problem.value)


def test_what_has_no_record(tmp_path):
    with pytest.raises(InputError, match=r"No such file"):
        BaseRecord.read(str(tmp_path / "none.csv"), cm.load(KEOGH))
    with pytest.raises(InputError, match="accelerations have units"):
        BaseRecord.read(str(tmp_path / "none.csv"), cm.load("examples/source-paper.toml"))
    for times in ((0.0, 1.0, 1.0), (1.0, 2.0, 3.0), (0.0,)):
        with pytest.raises(InputError, match=r"^times = "):
            BaseRecord(times, (0.0,) * len(times), (0.0,) * len(times))
    falling = rotor_of(cm.load(WEIGHS)).without_levitation()
    with pytest.raises(InputError, match="levitat"):
        record(0.01).apply(falling)


@pytest.mark.parametrize(
    ("path", "size"),
    [
        (KEOGH, 0.05),
        (WEIGHS, 1e-2),
        ("tests/machines/limits.toml", 1e-2),
        ("tests/machines/race.toml", 0.1),
        pytest.param("tests/machines/flexible-support.toml", 0.05, marks=pytest.mark.deep),
    ],
)
@pytest.mark.parametrize("kind", ["record", "series"])
def test_many_motions_end_where_each_does_alone(path, size, kind):
    """Through amplitudes that are set where a section begins, and through stages; with contacts."""
    rotor = rotor_of(cm.load(path))
    model = record(size, 21) if kind == "record" else cm.BaseShock(4.0 * size, 2.0, pulses=3, pause=1.5)
    sizes, angles = model.coordinates[0].high * np.array([0.5, 1.0]), np.array([0.7, 2.0])
    instants = np.array([0.3, 1.0]) * rotor.depends_on_instant
    starts, sections = model.starts(rotor, sizes, angles, instant=instants), len(model.sections(rotor))
    for place, given in enumerate(zip(sizes, angles, strict=True)):
        motion = cm.simulate(*model.apply(rotor, *given, instant=instants[place]))
        if starts.ended[place]:
            assert motion.outcome == starts.ended[place]
            continue
        ended = motion.parts[sections - 1].final
        assert ended.position == pytest.approx(starts.positions[place], abs=1e-10)
        assert ended.velocity == pytest.approx(starts.velocities[place], abs=1e-10)
        assert starts.touched[place] == any(len(part.contacts) for part in motion.parts[:sections])


def test_a_series_of_pulses_is_a_record_that_is_sampled_finely():
    """Along one line in the fixed frame, whatever the shaft turns between the pulses."""
    rotor, series = rotor_of(cm.load(KEOGH)), cm.BaseShock(0.01, 2.0, pulses=3, pause=1.5)
    last = cm.simulate(*series.apply(rotor, 0.01, 0.4)).earlier[-1]
    times = np.linspace(0.0, 9.0, 2251)
    pulse = np.where(times % 3.5 <= 2.0, np.sin(np.pi * np.minimum(times % 3.5, 2.0) / 2.0), 0.0)
    values = 0.01 * np.exp(0.4j) * pulse
    sampled = cm.simulate(*BaseRecord(tuple(times), tuple(values.real), tuple(values.imag)).apply(rotor)).earlier[-1]
    # Straight lines between samples leave h²/12 of the curvature.
    assert last.at(np.array(last.time))[0] == pytest.approx(sampled.at(np.array(sampled.time))[0], abs=3e-8)


def test_sizes_of_a_record_and_of_a_series(tmp_path):
    path, machine = tmp_path / "quake.csv", cm.load(KEOGH)
    path.write_text("t [ms],y (g)\n5,0\n7,1\n10,-0.5\n", encoding="utf-8")
    scales, rotor = machine.parameters.scales, rotor_of(machine)
    single = BaseRecord.single_of(f"{path}, 2 g, 30 deg", scales, "--base-record")
    assert "at most 2 g (2 times the record), turned by 30°" in single.echo(rotor).words
    as_is = BaseRecord.single_of(str(path), scales, "--base-record")
    assert as_is.values == (as_is.model.peak, 0.0)
    for text in ("2", "3 ms", "0 g", "2 g, 0, 1"):
        with pytest.raises(InputError, match=r"^--base-record = "):
            BaseRecord.single_of(f"{path}, {text}", scales, "--base-record")
    faster = rotor.replace(speed=2.0 * rotor.value("speed"))
    moved = single.model.rescaled(scales, faster.scales)
    assert moved.peak * faster.scales.acceleration == pytest.approx(single.model.peak * scales.acceleration)
    assert moved.times[-1] * faster.scales.time == pytest.approx(5e-3)
    series = cm.BaseShock.read("5 g, 11 ms, 0, 3, 20 ms", machine)
    assert (series.model.pulses, series.model.pause * scales.time) == (3, pytest.approx(0.02))
    assert "3 pulses with pauses of 20 ms" in series.echo(rotor).words
    with pytest.raises(InputError, match="a whole number for PULSES"):
        cm.BaseShock.read("5 g, 11 ms, 0, some", machine)
    with pytest.raises(InputError, match="pulses: a whole number from 1 to 100"):
        cm.BaseShock.read("5 g, 11 ms, 0, 0", machine)


def test_records_are_mapped_and_searched_as_shocks_are():
    """Of one pulse that is sampled finely: the smallest that does not come back is that of the shock."""
    machine, times = cm.load("examples/keogh-cole.toml"), np.linspace(0.0, 0.9, 31)
    record = BaseRecord(tuple(times), tuple(np.sin(np.pi * times / 0.9)), (0.0,) * 31)
    shares = [
        cm.map_basins(machine, cm.Grid(model, (4, 6))).share_recovered for model in (record, cm.BaseShock(1.0, 0.9))
    ]
    assert shares[0].count == shares[1].count
    record, shock = (cm.basins.smallest_unrecovered(machine, each).size for each in (record, cm.BaseShock(1.0, 0.9)))
    assert record == pytest.approx(shock, rel=2e-2)


def test_a_study_asks_whether_a_record_is_survived(tmp_path):
    path, case = tmp_path / "quake.csv", cm.load("examples/spindle.toml")
    path.write_text("t [ms],y (g)\n0,0\n4,1\n9,-0.5\n12,0\n", encoding="utf-8")
    case = with_requirement(case, f"{path}, 6 g")
    faster = case.replace(speed="30000 rpm")
    for each in (case, faster):
        scales = each.parameters.scales
        required = each.requirement.own(scales)
        assert required.base_record.largest * scales.acceleration == pytest.approx(6.0 * 9.80665)
        assert required.base_record.times[-1] * scales.time == pytest.approx(0.012)
    (found,) = (each for each in at_full_size(rotor_of(case), required) if each.kind == "base_record")
    assert found.back.count + found.lost <= found.back.total
    assert Wording(scales).required(required)[1] == "base motion quake.csv up to 6 g"
    with pytest.raises(InputError, match="without an angle"):
        with_requirement(case, f"{path}, 6 g, 30 deg")
