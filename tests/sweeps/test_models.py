"""Sweeps of any model over any of its parameters, against the same disturbances followed one machine after another."""

import pytest
from compilation import sized
from linear_rotors import tilting
from refusals import assert_refused

import carom as cm
from carom.disturbances import Grid, VelocityKick
from carom.parameters import Scales
from carom.sweeps import GridAxis, open_sweep, plan_sweep, run_sweep

KICKS = Grid(VelocityKick(fastest=0.8), (sized(3, 1), 2))


@pytest.mark.jit_only
def test_a_linear_rotor_is_swept_over_its_parameters(tmp_path):
    rotor = tilting().model.replace(scales=Scales(50.0, 0.7e-3, 184.2))
    axes = GridAxis.between("gamma", 0.3, 0.6, 2), GridAxis.of("speed", ["1500 rpm", 190.0])
    plan = plan_sweep(rotor, axes, KICKS)
    run_sweep(plan, tmp_path / "store", threads=True)
    found, kept = open_sweep(tmp_path / "store"), run_sweep(plan).dataset
    assert (found.status == 1).all()
    for i, gamma in enumerate((0.3, 0.6)):
        for j, speed in enumerate(axes[1].values):
            moved = rotor.replace(gamma=gamma, speed=float(speed))
            shift = rotor.scales.velocity / moved.scales.velocity
            kicks = Grid(VelocityKick(fastest=0.8 * shift), KICKS.shape)
            expected = cm.map_basins(moved, kicks)
            assert found.recovered.values[i, j] == expected.share_recovered.fraction
    assert found.equals(kept)
    assert (found.smallest_unrecovered_kick.fillna(0.8) <= 0.8).all()


def test_what_cannot_be_swept():
    rotor = tilting().model
    for call, words in (
        (lambda: plan_sweep(rotor, [GridAxis.of("speed", [100.0])], KICKS), "mass, clearance and speed are not known"),
        (lambda: plan_sweep(rotor, [GridAxis.of("stiffness", [1e6])], KICKS), "stiffness"),
    ):
        assert_refused(call, words)


def test_plans_of_models_differ_where_the_models_do():
    rotor, axes = tilting().model, [GridAxis.of("gamma", [0.1])]
    plan, other = (plan_sweep(each, axes, KICKS) for each in (rotor, rotor.replace(mu=0.3)))
    assert plan.digest == plan_sweep(tilting().model, axes, KICKS).digest != other.digest
    assert plan.name == "Rotor"
