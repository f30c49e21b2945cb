"""Races that turn: motions against a general integrator, momentum, and what is refused."""

import numpy as np
import pytest
from linear_rotors import planar_rotor

import carom as cm
from carom.models import KelvinVoigt, Race, Rigid, Touchdown

GAMMA, OMEGA, PUSH = 0.1, 0.76, 3.0 / 7.0 * np.exp(0.21j)
START = cm.State(0.2 + 0.1j, 1.0)
SOFT = KelvinVoigt(1e3, 3.3)


def rotor_with(law, race, friction=0.15, surface_speed=57.14):
    return planar_rotor(GAMMA, OMEGA**2, PUSH, [Touchdown([1.0], law, friction, surface_speed, race)])


def test_what_cannot_turn_is_refused():
    with pytest.raises(cm.outcome.InputError, match=r"inertia = 0.0"):
        Race(0.0, 1.5)
    with pytest.raises(cm.outcome.InputError, match="start races"):
        cm.simulate(rotor_with(SOFT, Race(2.0, 1.5)), cm.State(0.1, 0.0, (1.0, 2.0)), 1.0)


@pytest.mark.jit_only
@pytest.mark.parametrize("restitution", [0.9, 0.3])
def test_impacts_on_a_rigid_wall_keep_the_momentum_of_rotor_and_race(restitution):
    """Friction turns both about the bearing: the rotor at the radius one, the race at its own; the shaft is held at its speed."""
    race = Race(2.0, 1.5)
    rotor = planar_rotor(0.0, OMEGA**2, 0.0, [Touchdown([1.0], Rigid(restitution), 0.2, 4.0, race)])
    motion = cm.simulate(rotor, START, 40.0)
    contacts = motion.contacts
    assert len(contacts) >= 8
    turned = np.cumsum(contacts.friction_impulse)
    assert motion.final.races[0] == pytest.approx(-(race.radius**2) / race.inertia * turned[-1], rel=1e-12)
    # The angular momentum of the rotor about the bearing changes by the same impulses.
    position, velocity = motion.final.position, motion.final.velocity + 1j * motion.final.position
    before = (np.conj(START.position) * (START.velocity + 1j * START.position)).imag
    assert (np.conj(position) * velocity).imag - before == pytest.approx(turned[-1], rel=1e-10)


def test_an_impact_is_stopped_by_the_least_impulse_that_stops_the_slip():
    """``min(μp, |v|/(1/m + R²/J))`` of the rotor at rest in the turning frame, struck radially."""
    race, friction, slip = Race(0.5, 1.5), 10.0, 3.0
    rotor = rotor_with(Rigid(0.6), race, friction=friction, surface_speed=slip)
    motion = cm.simulate(rotor, cm.State(0.2, 2.0), 1.5)
    contacts = motion.contacts
    first = contacts.friction_impulse[0]
    assert abs(first) == pytest.approx(abs(contacts.slip_before[0]) / (1.0 + race.radius**2 / race.inertia), rel=1e-12)
    assert contacts.sticks[0]
    weak = cm.simulate(rotor_with(Rigid(0.6), race, friction=0.01, surface_speed=slip), cm.State(0.2, 2.0), 1.5)
    assert abs(weak.contacts.friction_impulse[0]) == pytest.approx(0.01 * weak.contacts.normal_impulse[0], rel=1e-12)
