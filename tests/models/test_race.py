"""Races that turn: motions against a general integrator, momentum, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import carom as cm
from carom.models import HuntCrossley, KelvinVoigt, Race, Rigid, Touchdown, from_matrices

GAMMA, OMEGA, PUSH = 0.1, 0.76, 3.0 / 7.0 * np.exp(0.21j)
START = cm.State(0.2 + 0.1j, 1.0)
SOFT = KelvinVoigt(1e3, 3.3)


def rotor_with(law, race, friction=0.15, surface_speed=57.14):
    return from_matrices(
        mass=[[1.0]],
        damping=[[GAMMA]],
        stiffness=[[OMEGA**2]],
        forcing=[PUSH],
        touchdowns=[Touchdown([1.0], law, friction, surface_speed, race)],
    )


class Reference:
    """The same rotor for a general integrator: position, velocity and speed of the race's surface, from event to event."""

    def __init__(self, law, race, friction, surface_speed):
        self.law, self.friction, self.surface_speed = law, friction, surface_speed
        self.gain, self.decay = race.radius**2 / race.inertia, race.drag / race.inertia
        self.start = race.radius * race.speed

    def local(self, y):
        z, v = complex(y[0], y[1]), complex(y[2], y[3])
        along = v * (abs(z) / z)
        return z, v, abs(z), along

    def push(self, y):
        _, _, radius, along = self.local(y)
        depth, law = radius - 1.0, self.law
        if isinstance(law, KelvinVoigt):
            return law.stiffness * depth + law.damping * along.real
        return law.stiffness * max(depth, 0.0) ** law.exponent * (1.0 + law.dissipation * along.real)

    def slip(self, y):
        _, _, radius, along = self.local(y)
        return self.surface_speed - 1.0 + radius + along.imag - y[4]

    def free(self, y):
        z, v, _, _ = self.local(y)
        return -(GAMMA + 2j) * v - (OMEGA**2 - 1.0 + 1j * GAMMA) * z + PUSH

    def holding(self, y):
        """Friction with which the slip stays zero."""
        z, _, radius, along = self.local(y)
        pull = (self.free(y) * (radius / z)).imag
        turning = along.imag / radius
        return (-along.real + turning * along.real - self.decay * y[4] - pull) / (1.0 + self.gain)

    def rate(self, contact, sense):
        def rate(_, y):
            z, v, radius, _ = self.local(y)
            a, grip = self.free(y), 0.0
            if contact:
                push = self.push(y)
                grip = -sense * self.friction * push if sense else self.holding(y)
                a += complex(-push, grip) * (z / radius)
            return [v.real, v.imag, a.real, a.imag, -self.decay * y[4] - self.gain * grip]

        return rate

    def events(self, phase, sense):
        gap = lambda _, y: np.hypot(y[0], y[1]) - 1.0  # noqa: E731
        margins = {"flight": [(gap, 1)], "parted": [(gap, -1), (lambda _, y: self.push(y), 1)]}
        if phase in margins:
            return margins[phase]
        end = (
            (lambda _, y: sense * self.slip(y))
            if sense
            else (lambda _, y: self.friction * self.push(y) - abs(self.holding(y)))
        )
        force = (lambda _, y: self.push(y)) if isinstance(self.law, KelvinVoigt) else (lambda _, y: 1.0)
        return [(gap, -1), (force, -1), (end, -1)]

    def follow(self, until):
        time, phase, sense = 0.0, "flight", 1
        y = np.array([START.position.real, START.position.imag, START.velocity.real, 0.0, self.start])
        seen = set()
        while time < until - 1e-13:
            events = []
            for margin, direction in self.events(phase, sense):
                margin.terminal, margin.direction = True, direction
                events.append(margin)
            step = 0.1 if phase == "flight" else 0.005
            options = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-14, "max_step": step, "events": events}
            found = solve_ivp(self.rate(phase == "contact", sense), (time, until), y, **options)
            time, y = found.t[-1], found.y[:, -1]
            seen.add((phase, sense if phase == "contact" else 0))
            if found.status != 1:
                break
            event = next(k for k, times in enumerate(found.t_events) if len(times))
            if phase == "contact" and event == 2:
                if sense and abs(self.holding(y)) <= self.friction * self.push(y):
                    sense = 0
                else:
                    sense = -sense if sense else (-1 if self.holding(y) > 0.0 else 1)
            else:
                phase = {"flight": ("contact",), "contact": ("flight", "parted"), "parted": ("flight", "contact")}[
                    phase
                ][event]
                sense = 1 if self.slip(y) > 0.0 else -1
        return y, seen


@pytest.mark.jit_only
@pytest.mark.parametrize(
    ("law", "race", "friction", "surface_speed", "kinds"),
    [
        (KelvinVoigt(1e4, 3.3), Race(40.0, 57.14, 0.5), 0.15, 57.14, {0, 1}),
        (HuntCrossley(1e4, 0.05), Race(5.0, 1.5, 2.5, 0.1), 0.6, 1.5, {0, 1, -1}),
        (SOFT, Race(0.5, 1.5, 0.02, 0.1), 0.6, 1.2, {0, 1}),
    ],
)
def test_motions_against_a_general_integrator(law, race, friction, surface_speed, kinds):
    y, seen = Reference(law, race, friction, surface_speed).follow(8.0)
    assert {sense for phase, sense in seen if phase == "contact"} == kinds
    motion = cm.simulate(rotor_with(law, race, friction, surface_speed), START, 8.0)
    assert motion.final.position == pytest.approx(complex(y[0], y[1]), abs=1e-11)
    assert motion.final.velocity == pytest.approx(complex(y[2], y[3]), abs=1e-11)
    assert motion.final.races == pytest.approx((y[4],), abs=1e-10)


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
    rotor = from_matrices(
        mass=[[1.0]],
        damping=[[0.0]],
        stiffness=[[OMEGA**2]],
        forcing=[0.0],
        touchdowns=[Touchdown([1.0], Rigid(restitution), 0.2, 4.0, race)],
    )
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
