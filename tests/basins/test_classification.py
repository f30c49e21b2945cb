"""Basins: every disturbance ends as it does alone, and the dataset says how it was done."""

import json
from dataclasses import asdict

import numpy as np
import pytest
from machines import PAPER, SCALES

import carom
from carom.base.outcome import InputError, Outcome
from carom.basins import Basin, map_basins
from carom.disturbances import AnyState, BaseShock, BladeLoss, ContactRelease, Grid, Sample, StateSlice, VelocityKick

pytestmark = pytest.mark.jit_only

MACHINE = PAPER.replace(gamma=0.15, rho=0.3, scales=SCALES)
"""Levitation, B1,d and the synchronous rub coexist, each with a basin of some size."""


@pytest.fixture(scope="module")
def rotor():
    return carom.models.jeffcott(MACHINE)


def test_motions_have_the_names_of_the_attractors(rotor):
    basin = map_basins(rotor, Grid(StateSlice(), (24, 24)))
    assert set(basin.fractions) == {"levitation", "B1,d", "synchronous rub"}
    assert sum(basin.fractions.values()) == pytest.approx(1.0)
    index, outcomes = basin.dataset["motion"].values, basin.outcomes
    for name, outcome in (
        ("levitation", Outcome.LEVITATED),
        ("B1,d", Outcome.BOUNCING),
        ("synchronous rub", Outcome.FORWARD_RUB),
    ):
        np.testing.assert_array_equal(index == basin.motions.index(name), outcomes == outcome)
    assert basin.starts == basin.exists.sum() < 24 * 24
    assert (index[~basin.exists] == -1).all()


@pytest.mark.parametrize(
    "plan",
    [
        Grid(VelocityKick(1.0), (4, 5)),
        pytest.param(Grid(VelocityKick(0.01), (4, 5)), marks=pytest.mark.deep),
        pytest.param(Grid(BaseShock(1.0, 0.7), (4, 5)), marks=pytest.mark.deep),
        Grid(BladeLoss(0.05), (5,)),
        Grid(ContactRelease("rotating"), (7,)),
        pytest.param(Grid(StateSlice(0.1 + 0.2j), (4, 5)), marks=pytest.mark.deep),
        Sample(AnyState(1.0), 20, seed=3),
    ],
)
def test_a_file_holds_all_it_takes_to_do_it_again(rotor, plan, tmp_path):
    basin = map_basins(rotor, plan)
    basin.save(tmp_path / "basins.nc")
    read = Basin.load(tmp_path / "basins.nc")
    assert read.plan == plan
    assert read.parameters == MACHINE
    assert read.dataset.identical(basin.dataset)
    assert [asdict(name) for name in read.motions] == [asdict(name) for name in basin.motions]
    assert map_basins(read.rotor, read.plan).dataset.identical(basin.dataset)


def test_the_dataset_follows_the_conventions(rotor):
    kicks = map_basins(rotor, Grid(VelocityKick(1.0), (10, 12)), source={"machine_file": "machine.toml"})
    dataset = kicks.dataset
    outcome = dataset["outcome"]
    flags = dict(zip(outcome.attrs["flag_values"].tolist(), outcome.attrs["flag_meanings"].split(), strict=True))
    assert flags[20] == "levitated"
    assert flags[-1] == "no_start"
    assert set(np.unique(outcome.values)) <= set(flags)
    for name, variable in dataset.variables.items():
        assert variable.attrs["long_name"], name
        assert "units" in variable.attrs or "flag_values" in variable.attrs, name
    np.testing.assert_allclose(dataset["speed_si"], dataset["speed"] * SCALES.velocity)
    assert dataset["speed_si"].attrs["units"] == "m/s"
    assert {"carom", "numba", "numpy"} == {part.split()[0] for part in dataset.attrs["source"].split(", ")}
    assert dataset.attrs["machine_file"] == "machine.toml"
    assert json.loads(dataset.attrs["parameters"]) == MACHINE.as_dict()
    assert "proof" in dataset.attrs["criteria"]


def test_shares_of_a_sample_have_an_interval(rotor):
    basin = map_basins(rotor, Sample(VelocityKick(1.0), 200, seed=1))
    share = basin.share_recovered
    assert share.low < share.fraction < share.high
    assert "95 % confidence" in share.words
    levitating = basin.share_of("levitation")
    assert (levitating.count, levitating.low, levitating.high) == (share.count, share.low, share.high)
    assert levitating.words == share.words.replace("come back", "end in levitation")
    with pytest.raises(InputError, match="one of"):
        basin.share_of("flying")
