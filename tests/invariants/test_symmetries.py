"""What must not matter: the direction of the axes, the units; and what an ideal machine conserves."""

import cmath
import math

import numpy as np
import pytest
from drawn_motions import EVENTS, MANY, machines, starts
from hypothesis import assume, given
from hypothesis import strategies as st
from machines import machine_of

from carom.models import jeffcott
from carom.motions import State, simulate
from carom.parameters import Scales

EPSILON = 2.0**-52
UNTIL = 6.0


def states(motion, times):
    """Positions and velocities, shape (2, n)."""
    return np.array(motion.at(times))


def growth(machine, start, times):
    """By how much a small change of the start has grown, per unit, at given times; for motions where it is small."""
    shift = 1e-8
    rotor = jeffcott(machine)
    nominal = simulate(rotor, start, UNTIL, max_events=EVENTS)
    inward = 1.0 - shift
    moved = simulate(rotor, State(start.position * inward, start.velocity * inward), UNTIL, max_events=EVENTS)
    assume(nominal.time == moved.time == UNTIL)
    assume(len(nominal.segment_starts) == len(moved.segment_starts))
    assume(np.array_equal(nominal.segment_phases, moved.segment_phases))
    # A slow impact magnifies changes by the inverse of its speed, which a shift of this size would not show.
    assume(nominal.contacts.radial_speed.min(initial=1.0) > 1e-3)
    # Near an impact a shift of time changes the velocity by its jump.
    far = np.all(np.abs(times[:, None] - nominal.segment_starts[None, 1:]) > 1e-4, axis=1)
    ratio = np.abs(states(nominal, times[far]) - states(moved, times[far])).max(initial=0.0) / shift
    assume(ratio < 1e3)
    return nominal, times[far], 1.0 + ratio


@MANY
@given(machines(), starts(), st.floats(-math.pi, math.pi))
def test_turning_the_unbalance_and_the_start_turns_the_motion(machine, start, angle):
    nominal, times, amplification = growth(machine, start, np.linspace(0.0, UNTIL, 60))
    turn = cmath.rect(1.0, angle)
    turned = simulate(
        jeffcott(machine.replace(phi=machine.phi + angle)),
        State(turn * start.position, turn * start.velocity),
        UNTIL,
        max_events=EVENTS,
    )
    assume(len(nominal.segment_starts) == len(turned.segment_starts))
    size = 10.0 + machine.radius_ratio
    error = np.abs(states(turned, times) - turn * states(nominal, times)).max(initial=0.0)
    assert error <= 200 * EPSILON * size * amplification


@MANY
@given(
    machines(),
    starts(),
    st.floats(1e-3, 1e3).map(lambda mass: Scales(mass=mass, clearance=3e-4, speed=500.0 / mass**0.2)),
)
def test_machines_with_the_same_parameters_move_alike(machine, start, scales):
    """Through SI units and back: other mass, clearance and speed, the same motion in its own units."""
    nominal, times, amplification = growth(machine, start, np.linspace(0.0, UNTIL, 60))
    physical = machine_of(machine, scales)
    back = physical.parameters
    for name, value in machine.as_dict().items():
        assert getattr(back, name) == pytest.approx(value, rel=8 * EPSILON, abs=1e-300)
    again = simulate(physical, start, UNTIL, max_events=EVENTS)
    assume(len(nominal.segment_starts) == len(again.segment_starts))
    size = 10.0 + machine.radius_ratio
    error = np.abs(states(again, times) - states(nominal, times)).max(initial=0.0)
    assert error <= 400 * EPSILON * size * amplification
