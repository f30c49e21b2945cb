"""Contacts while the base moves as recorded, against DOP853 with events in the fixed frame and in that of the shaft."""

import cmath

import compliant_reference as reference
import numpy as np
import pytest
from limited_reference import follow, struck
from linear_rotors import planar_rotor
from machines import PAPER, rest_position

import carom as cm
from carom.disturbances import BaseRecord
from carom.models import HuntCrossley, KelvinVoigt, Touchdown

pytestmark = pytest.mark.jit_only
# Short, and of a rotor that loses much in an impact: bounces that accumulate are no events one by one.
RECORD = BaseRecord(*np.array([[0.0, 0.4, 0.7, 1.5, 1.8, 2.6, 3.5], [0.0, 2.0, 1.0, -3.0, 0.0, 2.0, 0.0], [0.0, 1.0, -2.0, 0.0, 2.0, 1.0, 0.0]]))  # fmt: skip


def at_the_end(rotor, record):
    """Place and velocity in the frame of the shaft where the record ends, and the number of contacts until then."""
    parts = cm.simulate(*record.apply(rotor)).parts[: len(record.times) - 1]
    place, speed = (complex(each) for each in (parts[-1].final.position, parts[-1].final.velocity))
    return place, speed, sum(len(part.contacts) for part in parts)


@pytest.mark.parametrize("size", [1.6, 2.0])
def test_impacts_on_a_rigid_bearing(size):
    machine, record = PAPER.replace(rho=0.2, gamma=0.3), RECORD.scaled(size)
    place, speed, contacts = at_the_end(cm.models.jeffcott(machine), record)
    state, impacts = np.array([rest_position(machine), 1j * rest_position(machine)]), 0

    def rebound(_, state):
        return np.array([state[0] / abs(state[0]), struck(*state, machine.d, machine.mu, machine.radius_ratio)])

    for begins, ends in zip(record.times[:-1], record.times[1:], strict=True):

        def rates(time, state, begins=begins):
            base = np.interp(begins + time, record.times, record.accelerations)
            push = machine.rho * cmath.exp(1j * (begins + time + machine.phi)) - base
            return np.array([state[1], push - machine.gamma * state[1] - machine.omega**2 * state[0]])

        state, found = follow(rates, state, ends - begins, ends=lambda _, state: abs(state[0]) - 1.0, after=rebound, longest=0.5)  # fmt: skip
        impacts += len(found)
    turn = cmath.exp(-1j * record.times[-1])
    assert contacts == impacts >= 1
    assert place == pytest.approx(state[0] * turn, abs=1e-8)
    assert speed == pytest.approx((state[1] - 1j * state[0]) * turn, abs=1e-8)


class Shaken(reference.Rotor):
    """The reference on a base that moves as recorded."""

    record: BaseRecord

    def contact(self, time, position, velocity, phases):
        base = np.interp(time, self.record.times, self.record.accelerations)
        object.__setattr__(self, "turning", [(-1j, np.array([-base]))])
        return super().contact(time, position, velocity, phases)


@pytest.mark.parametrize(
    ("law", "same"),
    [
        (KelvinVoigt(2e3, 9.0), reference.KelvinVoigt(2e3, 9.0)),
        (HuntCrossley(3e3, 0.6, 1.5), reference.HuntCrossley(3e3, 0.6, 1.5)),
    ],
)
def test_contacts_with_a_compliant_bearing(law, same):
    gamma, omega, unbalance = 0.3, 0.7, 0.1 * cmath.exp(0.3j)
    record = RECORD.scaled(2.0)
    rotor = planar_rotor(gamma, omega**2, unbalance, [Touchdown([1.0], law, 0.1, 50.0)])
    place, speed, contacts = at_the_end(rotor, record)
    shaken = Shaken.planar(gamma, omega, 0.1, 0.3, reference.Plane((1.0,), same, 0.1, 50.0))
    object.__setattr__(shaken, "record", record)
    rest = complex(rotor.system.rest[0])
    position, velocity, phases, touches = [rest], [0j], None, 0
    for begins, ends in zip(record.times[:-1], record.times[1:], strict=True):
        found = reference.follow(shaken, position, velocity, ends, begins, phases)
        position, velocity, phases = found.position, found.velocity, found.phases
        touches += sum(event.phase in reference.TOUCHING for event in found.events)
    assert min(contacts, touches) > 2  # one across a sample counts in both stages
    assert place == pytest.approx(position[0], abs=1e-8)
    assert speed == pytest.approx(velocity[0], abs=1e-8)
