"""Motions stop where the rotor is deeper in its touchdown bearing than the model holds, or reaches a magnet."""

import dataclasses

import numpy as np
import pytest
from flexible_machines import munich

import carom as cm
from carom.base.outcome import Outcome
from carom.models.touchdown import FARTHEST
from carom.motions import drop_loads
from carom.motions.loads import excess_pull

pytestmark = pytest.mark.jit_only

DEEP = [
    "mass=10 kg",
    "damping=800 N s/m",
    "stiffness=1e6 N/m",
    "eccentricity=0.03 mm",
    "clearance=0.3 mm",
    "rotor_radius=25 mm",
    "speed=9000 rpm",
    "friction=0.35",
    "gravity=9.81",
]


def machine(tmp_path, *changes):
    entries = [setting.split("=", 1) for setting in DEEP if not setting.startswith(("friction", "gravity"))]
    lines = ["[machine]", *(f'{name} = "{text}"' for name, text in entries), "friction = 0.35", "[gravity]"]
    wall = ["[touchdown]", 'law = "kelvin-voigt"', 'stiffness = "5e7 N/m"', 'damping = "2000 N s/m"']
    path = tmp_path / "deep.toml"
    path.write_text("\n".join([*lines, *wall]), encoding="utf-8")
    return cm.load(path, changes)


def test_a_motion_stops_where_it_is_beyond_the_model(tmp_path):
    motion = cm.simulate(machine(tmp_path), cm.drop())
    assert motion.outcome is Outcome.BEYOND_MODEL
    radii = motion.radius(motion.segment_starts)
    assert radii[-1] > FARTHEST
    assert (radii[:-1] <= FARTHEST).all()
    assert motion.time == motion.segment_starts[-1]
    # Nothing before is changed by it.
    until = 0.9 * motion.time
    before = cm.simulate(machine(tmp_path), cm.drop(), until)
    assert before.outcome is Outcome.TIME_REACHED
    # Both take other steps; what the motion makes of their rounding stays below this.
    assert abs(before.at(until)[0] - motion.at(until)[0]) < 1e-6


def test_a_map_ends_a_start_as_one_motion_does(tmp_path):
    case, random = machine(tmp_path), np.random.default_rng(5)
    speeds = 3.0 * np.sqrt(random.random(12)) * np.exp(2j * np.pi * random.random(12))
    starts = [cm.kick(abs(speed), float(np.angle(speed))).stages(case)[1] for speed in speeds]
    ends = cm.settle(
        case, cm.State([start.position for start in starts], [start.velocity for start in starts]), until=400.0
    )
    alone = [cm.simulate(case, start, 400.0, settle=True) for start in starts]
    assert ends.outcomes.tolist() == [motion.outcome for motion in alone]
    assert {Outcome.BEYOND_MODEL, Outcome.LEVITATED} <= set(ends.outcomes.tolist())
    beyond = ends.outcomes == Outcome.BEYOND_MODEL
    assert (np.abs(ends.positions[beyond]) > FARTHEST).all()
    assert [motion.time for motion in alone] == pytest.approx(ends.times.tolist(), abs=1e-6)


@pytest.mark.parametrize("share", [0.1, 0.26, 0.51, 0.9])
def test_the_pull_of_a_differential_pair_is_above_the_linear_one(share):
    gap, bias = 5e-4, 2.5

    def force(place, current=0.0):
        return (bias + current) ** 2 / (gap - place) ** 2 - (bias - current) ** 2 / (gap + place) ** 2

    slope = 1e9 * force(1e-9 * gap) / gap
    assert force(share * gap) / (slope * share * gap) - 1.0 == pytest.approx(excess_pull(share), rel=1e-6)


def test_iron_takes_from_the_pull():
    """Finite elements of a magnet pair, gap about 0.78 mm, slope 2.157e5 N/m: what the law without iron gives is a bound."""
    for place, force in ((0.2e-3, 46.12), (0.4e-3, 123.37)):
        assert 0.0 < force / (2.157e5 * place) - 1.0 < excess_pull(place / 0.78e-3)


def test_a_motion_stops_at_a_magnet(tmp_path):
    case = machine(tmp_path, "air_gap=0.45 mm")
    motion = cm.simulate(case, cm.drop())
    assert motion.outcome is Outcome.BEYOND_MODEL
    radii = motion.radius(motion.segment_starts)
    assert radii[-1] > 1.5 >= radii[:-1].max()
    reach = drop_loads(motion).magnets
    assert reach.reached
    assert reach.words.startswith("The rotor reaches a magnet")
    kicked = cm.simulate(case, cm.kick("150 mm/s"), 100.0)
    found, farthest = drop_loads(kicked).magnets, kicked.radius(np.linspace(0.0, kicked.time, 5000)).max()
    assert found.share == pytest.approx(farthest / 1.5, rel=1e-3)
    assert not found.reached
    assert f"{100.0 * found.share:.2g} % of an air gap" in found.words


def test_magnets_of_a_flexible_machine(tmp_path):
    def bearings(gap):
        return [dataclasses.replace(each, air_gap=gap) for each in munich().bearings]

    machine = munich(longest_element=0.2, bearings=bearings(4e-4)).with_modes(3)
    motion = cm.simulate(machine.model, cm.kick("495 mm/s", "30 deg"), "12 ms")
    times = np.linspace(0.0, motion.time, 1000)
    shapes = (
        np.array([machine.machine.rotor.row_at(each.node) for each in machine.machine.bearings]) @ machine.basis.shapes
    )
    size = machine.scales.length * np.sqrt(machine.scales.mass)
    places = size * motion.at(times)[0][:, : machine.vectors] @ shapes.T  # m
    share = drop_loads(motion).magnets.share
    assert share == pytest.approx(np.abs(places).max() / 4e-4, rel=1e-3)
    at_events = np.abs(size * motion.at(motion.segment_starts)[0][:, : machine.vectors] @ shapes.T).max(axis=1)
    near = munich(longest_element=0.2, bearings=bearings(0.99 * at_events.max())).with_modes(3)
    stopped = cm.simulate(near.model, cm.kick("495 mm/s", "30 deg"), "12 ms")
    assert stopped.outcome is Outcome.BEYOND_MODEL
    assert drop_loads(stopped).magnets.reached
    assert stopped.time == pytest.approx(motion.segment_starts[at_events > 0.99 * at_events.max()][0], rel=1e-9)
