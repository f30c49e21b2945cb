"""Levitation lost: free fall with the whirl at the release, in closed form, and levitation that is back."""

import cmath
import dataclasses
import math

import numpy as np
import pytest

import carom as cm
from carom.base.outcome import InputError, Outcome
from carom.disturbances import Drop, whirl
from carom.models import Stage, in_stages, rotor_of

pytestmark = pytest.mark.jit_only

HEAVY = cm.load("examples/dropped-rotor.toml")
ROTOR = rotor_of(HEAVY)
PULL = 9.81 / (0.25e-3 * (300.0 * math.pi) ** 2)


def fallen(times, place, speed, eccentricity, phase, pull=PULL):
    """Position in the fixed frame of a free rotor, by integrating its two forces by hand."""
    turned = np.exp(1j * times) - 1.0 - 1j * times
    return place + speed * times - 0.5j * pull * times**2 - eccentricity * cmath.exp(1j * phase) * turned


@pytest.mark.parametrize("phase", [None, 0.7, "-130 deg"])
def test_it_falls_from_levitation_with_its_whirl(phase):
    motion = cm.simulate(HEAVY, cm.drop(phase=phase), until=5.0)
    ahead = {None: 0.5 * math.pi, 0.7: 0.7, "-130 deg": math.radians(-130.0)}[phase]
    unbalance = -0.5 * math.pi + ahead
    whirl = ROTOR.unforced.equilibrium * cmath.exp(1j * unbalance)
    times = np.linspace(0.0, 5.0, 11)
    expected = fallen(times, whirl - 1j * PULL / HEAVY.parameters.omega**2, 1j * whirl, HEAVY.parameters.rho, unbalance)
    assert not len(motion.contacts)
    assert motion.position(times, "fixed") == pytest.approx(expected, abs=1e-13)


def test_from_the_centre_it_touches_after_the_time_of_free_fall():
    motion = cm.simulate(HEAVY.replace(eccentricity=0.0), cm.drop(cm.State(0.0)))
    first = motion.contacts.time[0] * motion.rotor.scales.time
    assert first == pytest.approx(7.139215615e-3, abs=5e-13)
    assert motion.position(motion.contacts.time[0], "fixed") == pytest.approx(-1j, abs=1e-12)


@pytest.mark.parametrize("start", [None, cm.State(0.2 + 0.1j, 0.3 - 0.2j)])
def test_a_vertical_rotor_is_pulled_to_no_side(start):
    """Its centre of mass goes on straight, and what whirls goes round it, until the wall is reached."""
    vertical = dataclasses.replace(HEAVY, gravity=cm.parameters.Gravity(direction="axial"))
    motion = cm.simulate(vertical, cm.drop(start, phase=0.0), until=800.0)
    assert motion.rotor.acting.weight is None
    whirl = ROTOR.unforced.equilibrium * -1j
    place, speed = (whirl, 0.0) if start is None else (start.position, start.velocity)
    touched = motion.contacts.time[0]
    times = np.linspace(0.0, touched, 11)
    expected = fallen(times, place, speed + 1j * place, HEAVY.parameters.rho, -0.5 * math.pi, 0.0)
    assert motion.position(times, "fixed") == pytest.approx(
        expected, abs=1e-10
    )  # over 100 turns, 1e-12 over the first ones
    assert abs(expected[-1]) == pytest.approx(1.0, abs=1e-10)


def test_the_rotor_that_falls_has_its_weight_and_no_levitation():
    rotor, _ = cm.drop().stages(HEAVY)
    assert not rotor.has_closed_forms
    assert rotor.forces == ROTOR.forces
    assert rotor.value("omega") == rotor.value("gamma") == 0.0


def test_levitation_is_back_after_a_time():
    motion = cm.simulate(HEAVY, cm.drop(regained_after="10 ms"))
    falls, levitates = motion.parts
    assert falls.outcome is Outcome.TRIGGERED
    assert falls.time * HEAVY.parameters.scales.time == pytest.approx(0.01, rel=1e-15)
    assert len(falls.contacts) == 1
    assert levitates.rotor.value("omega") == ROTOR.value("omega")
    assert motion.outcome is Outcome.LEVITATED
    # A later time than that at which it settles: the fall is followed until then all the same.
    assert cm.simulate(HEAVY, cm.drop(regained_after="9 s")).parts[0].outcome is Outcome.TRIGGERED


def test_turned_by_an_angle_everything_is_turned():
    """Down, the unbalance and the state at the release."""
    start, angle = cm.State(0.1 + 0.3j, -0.2 + 0.1j), 0.83
    turned = HEAVY.replace(unbalance_phase=angle)
    turned = type(turned)(
        turned.name,
        turned.parameters,
        turned.machine,
        turned.zones,
        gravity=cm.parameters.Gravity(9.81, angle - math.pi / 2),
    )
    turn = cmath.exp(1j * angle)
    one = cm.simulate(HEAVY, cm.drop(start), until=60.0)
    other = cm.simulate(turned, cm.drop(cm.State(start.position * turn, start.velocity * turn)), until=60.0)
    times = np.linspace(0.0, 60.0, 50)
    assert len(one.contacts) == len(other.contacts) > 3
    assert other.position(times) == pytest.approx(one.position(times) * turn, abs=1e-9)


def test_it_is_released_from_a_whirl():
    """At a radius and speed in the fixed frame, without the weight that levitation bears."""
    motion = cm.simulate(HEAVY, cm.drop(whirl("0.1 mm", "-75 Hz", "90 deg")), until=2.0)
    place, speed = 0.4j, -0.5j * 0.4j
    times = np.linspace(0.0, 2.0, 5)
    expected = fallen(times, place, speed, HEAVY.parameters.rho, HEAVY.parameters.phi)
    assert motion.position(times, "fixed") == pytest.approx(expected, abs=1e-13)


@pytest.mark.parametrize(
    ("machine", "drop", "words"),
    [
        (cm.load("examples/source-paper.toml"), Drop(), "^gravity = nothing given: a drop needs weight"),
        (in_stages((Stage(ROTOR),)), Drop(), "^machine = .*: a machine of one stage"),
        (HEAVY.replace(stiffness="1e5 N/m"), Drop(), "^levitation = up to 1.97 clearances"),
        (HEAVY, Drop(phase="3 mm"), "^phase = 3 mm: must be an angle"),
        (HEAVY, Drop(regained_after=-1.0), "^regained_after = -1.0: a finite time above 0"),
        (HEAVY, Drop(whirl(1.5, 1.0)), "^whirl radius = 1.5: must be from 0 to the clearance"),
        (HEAVY, Drop(whirl("0.1 mm", "3 mm")), "^whirl speed = 3 mm: must be an angular speed"),
        (HEAVY, Drop(race_speed="500 rpm"), "^race_speed = 500 rpm: a touchdown bearing with a race that turns"),
        (HEAVY, Drop(cm.State(2.0)), "^start position = .*: inside the wall"),
    ],
)
def test_what_cannot_be_dropped(machine, drop, words):
    with pytest.raises(InputError, match=words):
        cm.simulate(machine, drop)


def test_a_machine_that_states_no_weight_falls_by_it_from_its_centre():
    """The bias currents carry the weight before; released there at rest, without unbalance, it touches after √(2c/g)."""
    machine = cm.load("examples/keogh-cole.toml", ["eccentricity=0"])
    motion = cm.simulate(machine, Drop(regained_after="20 ms"))
    first = motion.parts[0].contacts.time[0] * machine.parameters.scales.time
    assert first == pytest.approx(math.sqrt(2.0 * machine.machine.clearance / 9.81), rel=1e-12)
    # Levitation that is regained needs no stiffness for the weight.
    assert motion.parts[1].rotor.acting.weight is None
