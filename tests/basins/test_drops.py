"""Basins of drops say what single drops say, and what is known in closed form."""

import math

import numpy as np
import pytest
from machines import PAPER

import carom as cm
from carom.base.outcome import InputError
from carom.basins import DropMap, map_drops
from carom.basins.document import drop_map_document
from carom.basins.drops import MEASURES
from carom.disturbances.following import NO_START
from carom.motions import drop_loads

pytestmark = pytest.mark.jit_only

BALLS, RIGID = "examples/touchdown-balls.toml", "examples/dropped-rotor.toml"


@pytest.fixture(scope="module")
def balls():
    return cm.load(BALLS)


@pytest.fixture(scope="module")
def found(balls):
    """Levitation lost and regained, on a race that turns, by the phase of the unbalance and the speed of the shaft."""
    return map_drops(
        balls, cm.drop(regained_after="12 ms", race_speed="500 rpm"), {"phase": 5, "speed": 3}, until="40 ms"
    )


def test_fresh_drops_agree_with_the_map(balls, found):
    random = np.random.default_rng(7)
    dataset = found.dataset
    for _ in range(4):
        at = tuple(int(random.integers(count)) for count in dataset["outcome"].shape)
        phase, speed = dataset["phase"].values[at[0]], dataset["speed"].values[at[1]]
        machine = balls.replace(speed=float(speed))
        drop = cm.drop(phase=f"{math.degrees(phase)!r} deg", regained_after="12 ms", race_speed="500 rpm")
        motion = cm.simulate(machine, drop, "40 ms", settle=True)
        loads = drop_loads(motion)
        (plane,) = loads.planes
        si = plane.si()
        assert dataset["outcome"].values[at] == loads.outcome
        # Text and number of a size differ by rounding, which impacts enlarge.
        for name in ("force", "impulse", "depth", "heat", "pressure", "contact_time", "power"):
            assert float(dataset[name].values[at]) == pytest.approx(si[name], rel=1e-8)
        assert dataset["contacts"].values[at] == plane.contacts
        assert float(dataset["time"].values[at]) == pytest.approx(loads.time * machine.parameters.scales.time, rel=1e-9)


def test_it_is_kept(found, tmp_path):
    found.save(tmp_path / "drops.nc")
    again = DropMap.load(tmp_path / "drops.nc")
    assert again.dataset.identical(found.dataset)
    assert again.motions == found.motions
    assert again.limits == {"force": 5000.0, "heat": 50.0, "depth": 5e-5, "pressure": 4.2e9}
    assert sum(again.fractions.values()) == pytest.approx(1.0)
    assert again.present == pytest.approx((0.5 * math.pi, 300.0 * math.pi))
    assert "phase 36 to 324°, speed 4,500 to 18,000 rpm" in repr(again)
    values = found.dataset["force"].values
    assert found.hardest == "force"
    assert f"{values.max():,.0f} N" in found.worst
    assert found.exceeding("force").tolist() == (values > 5000.0).tolist()


def test_it_says_where_a_force_still_grows(balls):
    """Drag of the race drives a slow whirl faster and faster; the drop at rest has had its largest force."""
    over = {"speed": ("9000 rpm", "30000 rpm", 2), "friction": (0.05, 0.5, 2)}
    falls = map_drops(balls, over=over)
    growing = falls.still_growing
    for place in np.ndindex(2, 2):
        speed, friction = (float(falls.dataset[name].values[at]) for name, at in zip(over, place, strict=True))
        loads = cm.motions.follow_loads(balls.replace(speed=speed, friction=friction), cm.drop(), settle=True)
        assert growing[place] == loads.planes[0].still_growing
    assert growing.any()
    assert not growing.all()
    assert drop_map_document(falls)["still_growing"] == growing.tolist()
    assert (", still growing at speed" in falls.worst) == growing.flat[falls.dataset["force"].values.argmax()]


def test_machines_that_cannot_levitate_are_not_dropped():
    weak = cm.load(RIGID)
    falls = map_drops(weak, over={"stiffness": (1e5, 1e6, 2), "friction": (0.1, 0.2, 2)}, until="10 ms")
    assert (falls.dataset["outcome"].values[0] == NO_START).all()
    assert (falls.dataset["outcome"].values[1] != NO_START).all()
    assert falls.exists.tolist() == [[False, False], [True, True]]
    assert all(np.isnan(falls.dataset[name].values[0]).all() for name in MEASURES)
    with pytest.raises(InputError, match="levitation = of none of the machines"):
        map_drops(weak, over={"stiffness": (1e5, 1.1e5, 2), "friction": (0.1, 0.2, 2)})


def test_wrong_input(balls):
    with pytest.raises(InputError, match=r"^over = phase: two names$"):
        map_drops(balls, over={"phase": 4})
    with pytest.raises(InputError, match="unknown name"):
        map_drops(balls, over={"phase": 4, "spede": 4})
    with pytest.raises(InputError, match="needed: the drop states no regained_after"):
        map_drops(balls, over={"phase": 4, "regained_after": 4})
    with pytest.raises(InputError, match="gravity"):
        map_drops(PAPER)
