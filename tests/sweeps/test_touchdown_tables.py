"""Sweeps of machines with the tables ``[touchdown]`` and ``[gravity]``."""

from dataclasses import replace
from pathlib import Path

import pytest

import carom as cm
from carom.base.outcome import InputError
from carom.parameters import Gravity, TouchdownBearing
from carom.sweeps import GridAxis, load_sweep, plan_sweep

SOFT = """
[touchdown]
law = "kelvin-voigt"
stiffness = "1e8 N/m"
restitution = 0.8
"""
STIFFNESS = GridAxis.of("touchdown_stiffness", ["1e7 N/m", 1e8])
KICKS = cm.disturbances.Sample(cm.disturbances.VelocityKick(0.5), 10)


@pytest.fixture
def machine(tmp_path):
    rigid = Path("examples/keogh-cole.toml").read_text(encoding="utf-8")
    lines = [line for line in rigid.splitlines() if not line.startswith("restitution")]
    path = tmp_path / "machine.toml"
    path.write_text("\n".join(lines) + SOFT, encoding="utf-8")
    return cm.load(path)


def sweep_file(machine, tmp_path, axes, work="[study]\ndisturbances = 0"):
    path = tmp_path / "sweep.toml"
    path.write_text(f'machine = "machine.toml"\n{axes}\n{work}\n', encoding="utf-8")
    return path


def test_entries_of_the_touchdown_bearing_and_gravity_can_be_axes(machine, tmp_path):
    plan = plan_sweep(machine, [STIFFNESS, GridAxis.of("gravity", ["1 m/s^2", "9.81 m/s^2"])], KICKS)
    there = plan.case_at((1, 0))
    assert there.touchdown == replace(machine.touchdown, stiffness=1e8)
    assert there.gravity == Gravity(1.0)
    text = '[axes.touchdown_stiffness]\nfrom = "1e7 N/m"\nto = "1e9 N/m"\ncount = 3\nspacing = "log"'
    read = load_sweep(sweep_file(machine, tmp_path, text))
    assert [read.case_at((place,)).touchdown.stiffness for place in range(3)] == pytest.approx([1e7, 1e8, 1e9])


def test_another_bearing_gravity_or_drive_is_another_plan(machine):
    axis = GridAxis.of("friction", [0.1, 0.2])
    others = [
        machine,
        machine.replace(touchdown_stiffness="2e8 N/m"),
        machine.replace(gravity=9.81),
        machine.replace(gravity=1.0),
        replace(machine, drive=cm.parameters.Drive(polar_inertia=0.02)),
        replace(machine, touchdown=TouchdownBearing("hunt-crossley", 1e8, dissipation=0.3)),
    ]
    digests = [plan_sweep(other, [axis], KICKS).digest for other in others]
    assert len(set(digests)) == len(others)


def test_what_cannot_be_varied_is_refused(machine, tmp_path):
    rigid = cm.load("examples/keogh-cole.toml")
    with pytest.raises(InputError, match=r"axes.touchdown_stiffness = .*no table \[touchdown\]"):
        plan_sweep(rigid, [STIFFNESS], KICKS)
    with pytest.raises(InputError, match=r"axes.restitution = .*vary touchdown_restitution"):
        plan_sweep(machine, [GridAxis.of("restitution", [0.1, 0.2])], KICKS)
    with pytest.raises(InputError, match="touchdown_stifness = varied: unknown name"):
        load_sweep(sweep_file(machine, tmp_path, "[axes.touchdown_stifness]\nvalues = [1e7, 1e8]"))
