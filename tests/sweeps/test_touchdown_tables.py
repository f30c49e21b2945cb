"""Sweeps of machines with the tables ``[touchdown]`` and ``[gravity]``."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import carom as cm
from carom.base.outcome import InputError
from carom.parameters import Gravity, TouchdownBearing
from carom.sweeps import GridAxis, StudyTask, load_sweep, plan_sweep

EXAMPLES = Path(__file__).parents[2] / "examples"
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
    rigid = (EXAMPLES / "keogh-cole.toml").read_text(encoding="utf-8")
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


@pytest.mark.jit_only
def test_kicks_and_studies_of_a_bearing_that_gives_way(machine, tmp_path):
    fast = cm.disturbances.Sample(cm.disturbances.VelocityKick(0.9), 20, seed=2)
    cm.run_sweep(plan_sweep(machine, [STIFFNESS], fast), tmp_path / "kicks", workers=1, progress=False)
    with cm.open_sweep(tmp_path / "kicks") as found:
        assert found["possible"].values.tolist() == [20, 20]
        assert (found["status"] == 1).all()
    task = StudyTask(disturbances=12)
    cm.run_sweep(plan_sweep(machine, [STIFFNESS], task), tmp_path / "studies", workers=1, progress=False)
    with cm.open_sweep(tmp_path / "studies") as found:
        assert (found["status"] == 1).all()
        rubs = [
            sum(
                rub.status == "admissible"
                for rub in cm.find_equilibria(machine.replace(touchdown_stiffness=each)).members[1:]
            )
            for each in (1e7, 1e8)
        ]
        assert found["rubs"].values.tolist() == rubs
        assert np.isnan(found["runaway_speed"]).all()  # known for rigid walls alone


@pytest.mark.jit_only
def test_a_study_under_weight_has_levitation_about_the_sag(machine, tmp_path):
    weights = GridAxis.of("gravity", [1.0, 2.0])
    cm.run_sweep(
        plan_sweep(machine, [weights], StudyTask(disturbances=8)), tmp_path / "heavy", workers=1, progress=False
    )
    with cm.open_sweep(tmp_path / "heavy") as found:
        assert (found["status"] == 1).all()
        held = [cm.closed_forms.levitation(machine.replace(gravity=each)).reach for each in (1.0, 2.0)]
        assert found["levitation_radius"].values == pytest.approx(held, rel=1e-12)
        assert found["rubs"].values.tolist() == [0, 0]


def test_what_cannot_be_varied_is_refused(machine, tmp_path):
    rigid = cm.load(EXAMPLES / "keogh-cole.toml")
    with pytest.raises(InputError, match=r"axes.touchdown_stiffness = .*no table \[touchdown\]"):
        plan_sweep(rigid, [STIFFNESS], KICKS)
    with pytest.raises(InputError, match=r"axes.restitution = .*vary touchdown_restitution"):
        plan_sweep(machine, [GridAxis.of("restitution", [0.1, 0.2])], KICKS)
    with pytest.raises(InputError, match="touchdown_stifness = varied: unknown name"):
        load_sweep(sweep_file(machine, tmp_path, "[axes.touchdown_stifness]\nvalues = [1e7, 1e8]"))
