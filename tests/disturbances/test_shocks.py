"""The levitating rotor through a half-sine shock of its housing, against a general solver in the fixed frame."""

import cmath
import math

import numpy as np
import pytest
from limited_reference import follow, struck
from machines import PAPER, rest_position

import carom
from carom.disturbances.following import follow_machines
from carom.disturbances.shocks import states_after
from carom.models import Force

pytestmark = pytest.mark.jit_only


def followed(parameters, peak, duration, direction, weight=0j):
    """State at the end of the pulse by DOP853 in the fixed frame, impacts one by one; and how many there were.

    Under a weight, an acceleration in the fixed frame, the rotor sags by what its spring gives.
    """

    def rates(time, state):
        push = weight + parameters.rho * cmath.exp(1j * (time + parameters.phi))
        push -= peak * math.sin(math.pi * time / duration) * cmath.rect(1.0, direction)
        return np.array([state[1], push - parameters.gamma * state[1] - parameters.omega**2 * state[0]])

    def rebound(_, state):
        speed = struck(*state, parameters.d, parameters.mu, parameters.radius_ratio)
        return np.array([state[0] / abs(state[0]), speed])

    rest = rest_position(parameters)
    start = [rest + weight / parameters.omega**2, 1j * rest]
    (place, speed), impacts = follow(
        rates, start, duration, ends=lambda _, state: abs(state[0]) - 1.0, after=rebound, longest=duration
    )
    turn = cmath.exp(-1j * duration)
    return place * turn, (speed - 1j * place) * turn, len(impacts)


def after(parameters, peak, duration, direction):
    found = states_after(
        carom.BaseShock(peak, duration), carom.models.jeffcott(parameters), np.array([peak]), np.array([direction])
    )
    return complex(found[0][0]), complex(found[1][0]), bool(found[2][0])


def impacts_as_followed(machine, peak, duration, direction, error):
    """Impacts during the pulse, at the end of which the state is that of the general solver."""
    place, speed, impacts = followed(machine, peak, duration, direction)
    position, velocity, ended = after(machine, peak, duration, direction)
    assert position == pytest.approx(place, abs=error)
    assert velocity == pytest.approx(speed, abs=error)
    assert impacts or not ended
    return impacts


@pytest.mark.parametrize("gamma", [0.0, 0.1, 2 * 0.76, 6.0])
@pytest.mark.parametrize(("peak", "duration", "direction"), [(0.05, 1.3, 0.3), (0.2, 0.4, 2.0), (0.04, 9.0, 4.0)])
def test_without_contact(gamma, peak, duration, direction):
    machine = PAPER.replace(rho=0.1, gamma=gamma)
    assert not impacts_as_followed(machine, peak, duration, direction, error=1e-10)


@pytest.mark.parametrize(("peak", "duration", "direction"), [(6.0, 1.3, 0.3), (1.5, 2.5, 2.0), (4.0, 2.0, 4.0)])
def test_with_impacts_during_the_pulse(peak, duration, direction):
    machine = PAPER.replace(rho=0.2, gamma=0.3)
    assert impacts_as_followed(machine, peak, duration, direction, error=1e-8)


@pytest.mark.parametrize(("peak", "duration", "direction"), [(16.0, 1.0, 0.0), (8.0, 3.0, 0.0), (16.0, 3.0, 1.0)])
def test_pressed_to_the_wall_when_the_pulse_ends(peak, duration, direction):
    """A hard pulse and little rebound: the rotor slides along the wall at its end, and starts from there."""
    machine = PAPER.replace(rho=0.2, gamma=0.3, d=0.1)
    position, velocity, ended = after(machine, peak, duration, direction)
    assert abs(position) == pytest.approx(1.0, abs=1e-15)
    assert (position.conjugate() * velocity).real == pytest.approx(0.0, abs=1e-12)
    assert not ended
    found = carom.simulate(carom.models.jeffcott(machine), carom.State(position, velocity), 1.0)
    assert found.outcome is carom.base.outcome.Outcome.TIME_REACHED


def test_a_short_shock_is_a_kick():
    """With the velocity change 2âT/π kept, the shock tends to a kick against its direction."""
    machine = PAPER.replace(rho=0.2)
    rest, change = rest_position(machine), 0.3
    apart = []
    for duration in (1e-2, 1e-3):
        position, velocity, _ = after(machine, math.pi * change / (2.0 * duration), duration, 0.7)
        apart.append(abs(velocity + cmath.rect(change, 0.7)) + abs(position - rest))
    assert apart[1] < 2e-3
    assert apart[0] / apart[1] == pytest.approx(10.0, rel=1e-3)


@pytest.mark.parametrize("detuned", [0.0, 1e-9, 1e-5, 1e-2])
def test_in_resonance_without_damping(detuned):
    machine = PAPER.replace(rho=0.1, gamma=0.0)
    duration = math.pi / machine.omega * (1.0 + detuned)
    assert not impacts_as_followed(machine, 0.1, duration, 0.4, error=1e-10)


def test_a_motion_through_the_pulse_and_after_it():
    machine = carom.models.jeffcott(PAPER.replace(rho=0.2, gamma=0.3))
    shock = carom.BaseShock(6.0, 1.3)
    motion = carom.simulate(*shock.apply(machine, 0.3))
    pulse, after_it = motion.parts
    position, velocity, _ = after(machine.parameters, 6.0, 1.3, 0.3)
    assert (pulse.begins, pulse.time, after_it.begins) == (0.0, 1.3, 1.3)
    assert len(pulse.contacts) == followed(machine.parameters, 6.0, 1.3, 0.3)[2]
    assert pulse.final.position == pytest.approx(position, abs=1e-12)
    assert pulse.final.velocity == pytest.approx(velocity, abs=1e-12)
    ends = carom.simulate(machine, carom.State(position, velocity))
    assert motion.outcome is ends.outcome
    # In the fixed frame the path is continuous where one stage ends and the next begins.
    assert after_it.position(0.0, "fixed") == pytest.approx(pulse.position(1.3, "fixed"), abs=1e-12)


WEIGHT = 0.05 - 0.11j


@pytest.mark.parametrize(
    ("peak", "duration", "direction", "struck"), [(0.05, 1.3, 0.3, False), (6.0, 1.3, 0.3, True), (1.5, 2.5, 2.0, True)]
)
def test_a_rotor_that_weighs_something_goes_on_under_the_weight_as_it_points_then(peak, duration, direction, struck):
    machine = PAPER.replace(rho=0.2, gamma=0.3)
    rotor = carom.models.jeffcott(machine).under(Force(-1j, np.array([WEIGHT])))
    place, speed, impacts = followed(machine, peak, duration, direction, WEIGHT)
    assert (impacts > 0) == struck
    shock = carom.BaseShock(peak, duration)
    state = shock.release(rotor, direction)
    assert state.position == pytest.approx(place, abs=1e-8)
    assert state.velocity == pytest.approx(speed, abs=1e-8)
    assert state.time == duration
    motion = carom.simulate(*shock.apply(rotor, direction))
    pulse, after_it = motion.parts
    assert pulse.final.position == pytest.approx(state.position, abs=1e-12)
    assert after_it.begins == duration
    # As one of many, it ends as the single motion does.
    plan = carom.Grid(shock, (3, 4))
    (ends,) = follow_machines([(rotor, plan.starts(rotor))], 100)
    peaks, directions = (each.ravel() for each in np.meshgrid(*plan.values(), indexing="ij"))
    for number, outcome in enumerate(ends.outcomes.ravel().tolist()):
        one = carom.simulate(*carom.BaseShock(peaks[number], duration).apply(rotor, directions[number]))
        assert one.outcome == outcome


def test_a_shock_knows_of_no_other():
    machine = carom.models.jeffcott(PAPER.replace(rho=0.2, gamma=0.3, d=0.3))
    peaks, directions = np.linspace(0.1, 12.0, 9), np.linspace(0.0, 6.0, 9)
    together = states_after(carom.BaseShock(12.0, 1.7), machine, peaks, directions)
    for place in range(9):
        alone = states_after(
            carom.BaseShock(12.0, 1.7), machine, peaks[place : place + 1], directions[place : place + 1]
        )
        for one, all_ in zip(alone, together, strict=True):
            assert one[0] == all_[place]
