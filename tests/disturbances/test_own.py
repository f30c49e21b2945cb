"""A disturbance of a user's own can be used wherever one of carom can."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest
from machines import PAPER, SCALES

import carom as cm
from carom.base.outcome import InputError
from carom.basins import Basin, smallest_unrecovered
from carom.basins.document import basin_document
from carom.disturbances import Coordinate, Disturbance, Grid, Sample, Starts, VelocityKick
from carom.parameters import own_size

MACHINE = PAPER.replace(gamma=0.15, rho=0.3, scales=SCALES)
TURN = Coordinate("direction", "direction of the shift", 0.0, 2.0 * np.pi, periodic=True)


@dataclass(frozen=True)
class Shove(Disturbance):
    """The levitating rotor is shifted by a distance in any direction, and thrown at a velocity."""

    farthest: float = 0.5
    thrown: complex = 0.1 + 0.2j
    axes: tuple[str, ...] = ("x", "y")
    measured_in: ClassVar[dict[str, str]] = {"farthest": "length", "thrown": "velocity"}

    @property
    def coordinates(self):
        return Coordinate("shift", "distance of the shift", 0.0, self.farthest, "length"), TURN

    def starts(self, rotor, *values):
        shift, direction = values
        positions = rotor.equilibrium + shift * np.exp(1j * direction)
        inside = np.abs(positions) < 1.0
        return Starts.of(np.where(inside, positions, 0.0), self.thrown, inside)


PLAN = Grid(Shove(1.2), (6, 8))


@pytest.fixture(scope="module")
def basin():
    return cm.map_basins(MACHINE, PLAN)


def states(plan):
    starts = plan.starts(cm.models.jeffcott(MACHINE))
    return [
        cm.State(complex(position), complex(velocity))
        for position, velocity, there in zip(*(part.ravel() for part in starts[:3]), strict=True)
        if there
    ]


@pytest.mark.jit_only
def test_basins_of_an_own_disturbance_are_those_of_its_states(basin):
    alone = [cm.simulate(MACHINE, state, settle=True) for state in states(PLAN)]

    assert 0 < len(alone) < PLAN.count
    assert basin.starts == len(alone)
    assert basin.outcomes[basin.exists].tolist() == [motion.outcome for motion in alone]
    assert basin.dataset["shift"].attrs["units"] == "c_r"
    assert basin.dataset["shift_si"].attrs["units"] == "m"


@pytest.mark.jit_only
def test_results_with_an_own_disturbance_are_saved_and_read(basin, tmp_path):
    basin.save(tmp_path / "basin.nc")
    read = Basin.load(tmp_path / "basin.nc")

    assert read.plan == PLAN
    assert read.dataset.identical(basin.dataset)
    assert read.dataset.identical(cm.map_basins(read.rotor, read.plan).dataset)
    cm.plots.basin(read)
    document = basin_document(basin, None, 0.0)
    assert document["disturbances"]["model"] == {
        "kind": "shove",
        "farthest": 1.2,
        "thrown": [0.1, 0.2],
        "axes": ["x", "y"],
    }


@pytest.mark.jit_only
def test_attractors_that_own_disturbances_reach(basin):
    found = cm.find_attractors(MACHINE, PLAN, known=False)

    assert [ending.start.state for ending in found.endings] == states(PLAN)
    assert [ending.attractor.outcome for ending in found.endings] == basin.outcomes[basin.exists].tolist()
    assert {member.name: member.share_of_disturbances for member in found} == pytest.approx(basin.fractions)
    assert found.sample == PLAN
    assert "of the kind shove" in found.argument
    one = cm.find_attractors(MACHINE, Shove(0.4), count=15, seed=3, known=False)
    assert one.sample == Sample(Shove(0.4), 15, 3)
    assert [ending.start.state for ending in one.endings] == states(one.sample)


@pytest.mark.jit_only
def test_nothing_is_proven_of_a_kick_that_starts_elsewhere():
    @dataclass(frozen=True)
    class Elsewhere(VelocityKick):
        def starts(self, rotor, *values):
            starts = super().starts(rotor, *values)
            return Starts.of(np.full(starts.positions.shape, 0.999), starts.velocities, True)

    assert smallest_unrecovered(MACHINE, VelocityKick(0.5), directions=8, sizes=8).contact_free > 0.0
    found = smallest_unrecovered(MACHINE, Elsewhere(0.5), directions=8, sizes=8)
    assert (found.kind, found.contact_free) == ("elsewhere", 0.0)


def test_a_kind_names_one_class():
    with pytest.raises(InputError, match="kind = kick: another name: VelocityKick"):

        class KickStart(VelocityKick):
            kind = "kick"


def test_what_cannot_be_saved_is_refused():
    with pytest.raises(InputError, match="axes = "):
        Shove(axes=({"x"},)).describe()


def test_a_coordinate_has_a_unit_that_exists():
    with pytest.raises(InputError, match="scale = weight: one of: mass, length"):
        Coordinate("load", "weight of it", 0.0, 1.0, "weight")


def test_a_size_may_be_an_impulse():
    assert own_size("blow", "3 N s", "impulse", SCALES) == pytest.approx(
        3.0 / SCALES.impulse, rel=1e-15
    )  # one division
    with pytest.raises(InputError, match="an impulse"):
        own_size("blow", "3 N", "impulse", SCALES)
