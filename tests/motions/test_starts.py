"""Starts: on the wall or inside it, kicks, and sizes with units."""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest
from linear_rotors import single
from machines import PAPER

import carom as cm
from carom import State, kick, simulate
from carom.base.outcome import InputError
from carom.models import jeffcott, rotor_of


@pytest.fixture
def rotor():
    return jeffcott(PAPER)


class TestStarts:
    def test_a_kick_starts_at_the_equilibrium(self, rotor):
        machine = PAPER.replace(gamma=0.3)
        motion = simulate(jeffcott(machine), kick(0.4, angle=0.2), 3.0)
        assert motion.start.position == jeffcott(machine).equilibrium
        assert motion.start.velocity == pytest.approx(cmath.rect(0.4, 0.2), abs=1e-16)

    def test_no_kick_no_motion(self):
        motion = simulate(jeffcott(PAPER.replace(gamma=0.3)), kick(0.0), 100.0)
        assert np.allclose(motion.position(motion.sample(50)), motion.start.position, rtol=0, atol=1e-15)

    @pytest.mark.parametrize("radius", [1.0 + 2e-12, 1.1, 1e11])
    def test_outside_the_wall(self, rotor, radius):
        with pytest.raises(InputError, match=r"^start position = .*inside the wall, \|U\| <= 1") as caught:
            simulate(rotor, State(radius * cmath.exp(1j)), 1.0)
        assert caught.value.field == "start position"

    def test_one_coordinate_is_measured_at_its_planes(self):
        """Planes that move more or less than the coordinate meet their walls at other positions than one."""
        model = single(1).model
        with pytest.raises(InputError, match=r"inside the wall, \|U\| <= 1 \(here \|U\| = 1.125\)"):
            simulate(model, State(0.9 + 0j), 1.0)
        wide = simulate(
            model.replace(touchdowns=[replace(model.equations.touchdowns[0], plane=[0.5])]), State(1.5 + 0j), 0.1
        )
        assert wide.radius(np.zeros(1)) == pytest.approx(0.75, abs=1e-14)

    def test_a_kick_from_an_equilibrium_outside_the_wall(self):
        with pytest.raises(InputError, match=r"^kick = .*outside the wall"):
            simulate(jeffcott(PAPER.replace(gamma=0.01)), kick(0.1), 1.0)

    @pytest.mark.parametrize("radius", [1.0, 1.0 + 0.9e-12, 1.0 - 0.9e-12])
    def test_on_the_wall_to_within_rounding(self, rotor, radius):
        """Both sides of one count as the wall: outward speed strikes at once."""
        normal = cmath.exp(0.3j)
        motion = simulate(rotor, State(radius * normal, 0.5 * normal), 1.0)
        assert motion.contacts.time[0] == 0.0
        assert motion.radius(motion.sample(100)).max() <= 1.0 + 1e-12
        assert abs(motion.at(0.0)[0]) == pytest.approx(1.0, abs=4e-16)

    def test_just_inside_the_wall(self, rotor):
        normal = cmath.exp(0.3j)
        motion = simulate(rotor, State((1.0 - 2e-12) * normal, 0.5 * normal), 1.0)
        assert motion.contacts.time[0] == pytest.approx(4e-12, rel=1e-3)


def test_a_motion_goes_on_from_where_another_has_ended():
    heavy = rotor_of(cm.load("examples/dropped-rotor.toml"))
    start = cm.State(0.2, 1.5 - 0.3j)
    whole = cm.simulate(heavy, start, 30.0)
    first = cm.simulate(heavy, start, 11.0)
    assert first.final.time == 11.0
    assert "time=11.0" in repr(first.final)
    later = cm.simulate(heavy, first.final, 19.0)
    assert later.begins == 11.0
    assert later.final.time == 30.0
    assert later.final.position == pytest.approx(whole.final.position, abs=1e-12)
    assert later.final.velocity == pytest.approx(whole.final.velocity, abs=1e-12)
    # Without weight a state says everything, whatever the time.
    assert cm.simulate(heavy.unforced, start, 11.0).final.time == 0.0
    with pytest.raises(InputError, match=r"^start time = nan: a real number"):
        cm.simulate(heavy, cm.State(0.2, time=math.nan), 1.0)


@pytest.mark.parametrize(
    ("state", "says"),
    [
        (State(0.1, time=1j), "^start time = 1j: a real number"),
        (State(0.1, time=1e308), "^start time = 1e\\+308: a real number, up to 1e\\+12"),
        (State(0.1, velocity=1e99), "^start velocity = 1e\\+99: a speed up to 1e\\+12"),
        (State(np.ma.masked), "^start position = --: finite numbers"),
        (State(0.1, races=5), "^start races = 5: 0 finite"),
        (State(0.1, shaft=(1j, 0)), "^start shaft = .*: 0 finite"),
    ],
)
def test_a_state_of_other_things_than_numbers_is_refused(state, says):
    with pytest.raises(InputError, match=says):
        simulate(PAPER, state, 1.0)


def test_a_time_that_no_computer_awaits_is_refused_in_the_unit_of_who_asks():
    machine = cm.load("examples/keogh-cole.toml")
    says = r"^until = 1e12 s: a finite time above 0, .*, up to 5.429e\+06 s \(1e\+09/Omega\); without it a motion is followed until"
    with pytest.raises(InputError, match=says):
        simulate(machine, kick("1 mm/s"), "1e12 s")
