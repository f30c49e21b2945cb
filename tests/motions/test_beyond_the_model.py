"""Motions stop where the rotor is deeper in its touchdown bearing than the model holds."""

import numpy as np
import pytest

import carom as cm
from carom.disturbances.echo import echo_of_drop
from carom.models import model_of
from carom.models.touchdown import FARTHEST
from carom.outcome import Outcome
from carom.studies import DropStudy

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


def test_it_is_told_since_when(tmp_path):
    case = machine(tmp_path)
    motion = cm.simulate(case, cm.drop())
    said = echo_of_drop(motion.start, 0.0, None, case.gravity, case.parameters.scales)
    headline = DropStudy(case, said, motion).headline
    assert headline.startswith("Beyond the model since ")
    assert "deeper in a touchdown bearing than the model holds" in headline


def test_a_map_ends_a_start_as_one_motion_does(tmp_path):
    case, random = machine(tmp_path), np.random.default_rng(5)
    speeds = 3.0 * np.sqrt(random.random(12)) * np.exp(2j * np.pi * random.random(12))
    starts = [cm.kick(abs(speed), float(np.angle(speed))).state(model_of(case)) for speed in speeds]
    ends = cm.settle(case, [start.position for start in starts], [start.velocity for start in starts], until=400.0)
    alone = [cm.simulate(case, start, 400.0, settle=True) for start in starts]
    assert ends.outcomes.tolist() == [motion.outcome for motion in alone]
    assert {Outcome.BEYOND_MODEL, Outcome.LEVITATED} <= set(ends.outcomes.tolist())
    beyond = ends.outcomes == Outcome.BEYOND_MODEL
    assert (np.abs(ends.positions[beyond]) > FARTHEST).all()
    assert [motion.time for motion in alone] == pytest.approx(ends.times.tolist(), abs=1e-6)
