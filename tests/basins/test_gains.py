"""Gain maps: each node is the basin of its machine, and the least change is enough."""

import math

import numpy as np
import pytest
from machines import PAPER, SCALES

import carom
from carom.base.outcome import InputError, Outcome
from carom.basins import GainMap, map_basins, map_gains
from carom.disturbances import Grid, Sample, VelocityKick

pytestmark = pytest.mark.jit_only

MACHINE = PAPER.replace(gamma=0.152, scales=SCALES)
KICKS = Grid(VelocityKick.of(MACHINE, "20 mm/s"), (10, 10))
OVER = {"stiffness": (7.0e5, 1.4e6, 5), "damping": (500.0, 4500.0, 6)}


def test_each_node_is_the_basin_of_its_machine():
    found = map_gains(MACHINE, KICKS, OVER, source={"machine_file": "machine.toml"})
    levitates = found.dataset["levitates"].values > 0.0
    assert levitates.any()
    assert not levitates.all()
    for i, stiffness in enumerate(found.dataset["stiffness"].values):
        for k, damping in enumerate(found.dataset["damping"].values):
            machine = MACHINE.replace(stiffness=stiffness, damping=damping)
            rotor = carom.models.jeffcott(machine)
            node = found.dataset.isel(stiffness=i, damping=k)
            assert levitates[i, k] == (abs(rotor.equilibrium) < 1.0)
            if not levitates[i, k]:
                assert node["recovered"] == 0.0
                continue
            basin = map_basins(rotor, KICKS)
            assert node["recovered"] == basin.share_recovered.fraction
            speeds, angles = (
                axis.ravel() for axis in np.meshgrid(*(basin.dataset[k] for k in ("speed", "direction")), indexing="ij")
            )
            gone = ~np.isin(basin.outcomes.ravel(), (Outcome.LEVITATED, Outcome.GRAZING))
            if gone.any():
                assert node["smallest_unrecovered_kick"] == pytest.approx(speeds[gone].min())
                apart = angles[gone & (speeds == speeds[gone].min())] - float(node["smallest_unrecovered_kick_angle"])
                assert np.abs(np.exp(1j * apart) - 1.0).min() < 1e-9
            else:
                assert np.isnan(node["smallest_unrecovered_kick"])
                assert np.isnan(node["smallest_unrecovered_kick_angle"])


def test_physical_kicks_stay_what_they_are_when_the_speed_changes():
    found = map_gains(MACHINE, KICKS, {"speed": (120.0, 400.0, 2), "damping": (3000.0, 6000.0, 2)})
    slow = MACHINE.replace(speed=120.0, damping=3000.0)
    plan = Grid(VelocityKick.of(slow, "20 mm/s"), (10, 10))
    assert plan.model.fastest == pytest.approx(KICKS.model.fastest * slow.scales.time / MACHINE.scales.time, rel=1e-12)
    share = map_basins(carom.models.jeffcott(slow), plan).share_recovered
    assert found.dataset["recovered"].values[0, 0] == pytest.approx(share.fraction, abs=0.011)


def test_samples_and_dimensionless_axes_and_files(tmp_path):
    plan = Sample(VelocityKick(0.2), 60, seed=5)
    limits = {"patience": 9_000, "max_events": 90_000}
    found = map_gains(PAPER.replace(gamma=0.15), plan, {"omega": 3, "gamma": 4}, **limits)
    low, middle, high = (found.dataset[name].values for name in ("recovered_low", "recovered", "recovered_high"))
    able = found.dataset["levitates"].values > 0.0
    assert (low <= middle).all()
    assert (middle <= high).all()
    assert (low[able] < high[able]).all()
    found.save(tmp_path / "gains.nc")
    read = GainMap.load(tmp_path / "gains.nc")
    assert read.dataset.identical(found.dataset)
    assert (read.plan, read.present, read.present_share) == (found.plan, found.present, found.present_share)
    assert [axis.name for axis in read.axes] == ["omega", "gamma"]
    assert {name: read.dataset.attrs[name] for name in limits} == limits


@pytest.mark.parametrize(
    ("over", "complaint"),
    [
        ({"gamma": 4}, "two names"),
        ({"gama": 4, "omega": 4}, "gamma"),
        ({"stiffness": 1, "damping": 4}, "at least 2"),
        ({"stiffness": (2.0, 1.0, 4), "damping": 4}, "ascending order"),
        ({"stiffness": (1.0, math.inf, 4), "damping": 4}, "over = .*a finite number"),
        ({"stiffness": 4, "damping": (-1.0, 10.0, 4)}, "damping"),
    ],
)
def test_what_cannot_be_mapped(over, complaint):
    with pytest.raises(InputError, match=complaint):
        map_gains(MACHINE, KICKS, over)
