"""Base motion from a record: against DOP853 from sample to sample, and what a file must be."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import carom as cm
from carom.base.outcome import InputError
from carom.disturbances import BaseRecord
from carom.models import rotor_of
from carom.motions import energy_ledger

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
    scales, found = machine.parameters.scales, BaseRecord.read_csv(path, machine)
    assert np.array(found.times) * scales.time == pytest.approx([0.0, 2e-3, 5e-3])
    assert found.accelerations * scales.acceleration == pytest.approx([0.0, 9.80665j, -4.903325j])
    assert BaseRecord.from_description(found.scaled(2.0).describe()) == found.scaled(2.0)
    said = found.echo(rotor_of(machine)).words
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
        BaseRecord.read_csv(path, cm.load(KEOGH))
    assert words in str(problem.value)
    assert "\n" not in str(problem.value)


def test_what_has_no_record(tmp_path):
    with pytest.raises(InputError, match=r"No such file"):
        BaseRecord.read_csv(tmp_path / "none.csv", cm.load(KEOGH))
    with pytest.raises(InputError, match="accelerations have units"):
        BaseRecord.read_csv(tmp_path / "none.csv", cm.load("examples/source-paper.toml"))
    for times in ((0.0, 1.0, 1.0), (1.0, 2.0, 3.0), (0.0,)):
        with pytest.raises(InputError, match=r"^times = "):
            BaseRecord(times, (0.0,) * len(times), (0.0,) * len(times))
    falling = rotor_of(cm.load(WEIGHS)).without_levitation()
    with pytest.raises(InputError, match="levitat"):
        record(0.01).apply(falling)
