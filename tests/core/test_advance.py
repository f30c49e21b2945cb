"""The loop of a motion: what ends it, that it can be interrupted, and what it does on the wall."""

import math

import numpy as np
import pytest
from flights import parameters, task_from_state
from flint import acb, arb
from machines import PAPER
from reference import first_crossing, jeffcott_flight, unit

from carom.base.outcome import Outcome
from carom.core.advance import CHATTER_HEIGHT, advance
from carom.core.event_log import EventLog
from carom.core.layout import rotor_record, rub_workspace, workspace
from carom.core.phases import AWAY, FLIGHT
from carom.core.settling import memory
from carom.core.table import flight_table
from carom.models import jeffcott
from carom.motions import State, simulate
from carom.parameters import Parameters


class Run:
    """A motion advanced by direct calls of the kernel."""

    def __init__(self, arrays, table, amplitudes, contact=AWAY, stop_at_landing=False):
        self.arrays, self.table = arrays, table
        self.amplitudes = np.array(amplitudes, complex)
        self.time, self.contact = 0.0, np.full(len(arrays.rows), contact)
        self.recollection = memory(len(amplitudes), stop_at_landing=stop_at_landing)
        self.times, self.planes, self.before, self.after = [], [], [], []

    def go(self, until, size=1000):
        """Advance to a time or until as many events are logged."""
        modes = len(self.amplitudes)
        log = EventLog.empty(size, modes, len(self.contact))
        outcome, time, count = advance(
            self.arrays,
            self.table,
            self.amplitudes,
            until - self.time,
            self.contact,
            log,
            self.recollection,
            workspace(modes),
            rub_workspace(modes, len(self.contact)),
        )
        self.times += list(self.time + log.times[:count])
        self.planes += list(log.stations[:count])
        self.before += list(log.before[:count])
        self.after += list(log.after[:count])
        self.time += time
        return Outcome(outcome)


def paper_run(**changes):
    """The machine of the source paper, from a start inside."""
    rotor = jeffcott(PAPER.replace(**changes))
    return rotor, Run(rotor.system.arrays, rotor.system.table, rotor.system.amplitudes(0.3 + 0.1j, 0.9 - 0.4j))


def wall_run(machine, angle, radial_speed, angular_speed, stop_at_landing=True):
    """A start on the wall."""
    rotor = jeffcott(machine)
    normal = np.exp(1j * angle)
    amplitudes = rotor.system.amplitudes(normal, complex(radial_speed, angular_speed) * normal)
    return rotor, Run(
        rotor.system.arrays, rotor.system.table, amplitudes, contact=FLIGHT, stop_at_landing=stop_at_landing
    )


def test_a_flight_that_meets_nothing_ends_at_its_time():
    rotor = jeffcott(parameters(0.3, 1.3))
    start = rotor.system.amplitudes(rotor.equilibrium + 0.1, 0.05j)
    run = Run(rotor.system.arrays, rotor.system.table, start)
    assert run.go(12.5) is Outcome.TIME_REACHED
    assert run.time == 12.5
    assert run.times == []
    assert run.contact.tolist() == [AWAY]
    assert np.allclose(run.amplitudes, rotor.system.fly(start, np.array(12.5)), rtol=0, atol=1e-14)


@pytest.mark.parametrize("size", [1, 3, 7])
def test_an_interrupted_motion_goes_on_as_if_it_were_not(size):
    """Bit for bit: a flight does not know what time it is."""
    _, whole = paper_run()
    assert whole.go(1e9, size=40) is Outcome.EVENT_LIMIT
    _, parts = paper_run()
    while len(parts.times) < 40:
        assert parts.go(1e9, size=min(size, 40 - len(parts.times))) is Outcome.EVENT_LIMIT
    assert np.array_equal(parts.amplitudes, whole.amplitudes)
    assert np.array_equal(parts.before, whole.before)
    assert np.array_equal(parts.after, whole.after)
    assert np.allclose(parts.times, whole.times, rtol=1e-14, atol=0)
    assert np.array_equal(parts.contact, whole.contact)


def test_a_full_log_ends_at_its_last_event():
    rotor, run = paper_run()
    assert run.go(1e9, size=3) is Outcome.EVENT_LIMIT
    assert run.time == run.times[-1]
    assert np.array_equal(run.amplitudes, run.after[-1])
    assert abs(rotor.system.state(run.amplitudes)[0]) == pytest.approx(1.0, abs=1e-15)


def test_outward_speed_on_the_wall_strikes_at_once():
    rotor, run = wall_run(PAPER, 0.7, 0.4, -1.1)
    run.go(5.0, size=1)
    assert run.times == [0.0]
    position, velocity = rotor.system.state(run.after[0])
    local = np.conj(position) * velocity
    assert local.real == pytest.approx(-0.95 * 0.4, abs=1e-15)
    assert local.imag == pytest.approx(-1.1 - 0.15 * 1.95 * 0.4, abs=1e-14)


def test_inward_speed_on_the_wall_flies():
    _, run = wall_run(PAPER, 0.7, -0.4, -1.1)
    run.go(5.0, size=1)
    assert run.times[0] > 0.0


def pressed_state(machine):
    """Angle and angular speed with a large normal force."""
    angle, angular_speed = machine.phi, 0.5
    push = machine.rho * math.cos(angle - machine.phi) + (1.0 + angular_speed) ** 2 - machine.omega**2
    return angle, angular_speed, push


@pytest.mark.parametrize("restitution", [0.0, 0.3, 0.9])
def test_chatter_ends_in_the_exact_state(restitution):
    """The same bounces one by one, with 57 digits: time, angle and speeds where the kernel stops."""
    machine = PAPER.replace(d=restitution)
    angle, angular_speed, push = pressed_state(machine)
    rotor, run = wall_run(machine, angle, 1e-3, angular_speed)
    assert run.go(10.0) is Outcome.CHATTER
    position, velocity = (complex(part) for part in rotor.system.state(run.amplitudes))
    local = position.conjugate() * velocity
    assert abs(position) == pytest.approx(1.0, abs=1e-15)
    assert -local.real + 1e-16 >= 0.0
    assert local.real**2 <= 2.0 * 1.1 * push * CHATTER_HEIGHT
    time, exact_position, exact_velocity = bounce(machine, unit(angle), acb(1e-3, angular_speed), len(run.times))
    # A rebound that falls by d each time is known to the same relative error throughout, so errors add up, no more.
    assert run.time == pytest.approx(time, abs=1e-13)
    assert abs(position - exact_position) <= 1e-13
    assert abs(velocity - exact_velocity) <= 1e-13


def bounce(machine, normal, local, impacts):
    """Follow bounces of a machine that slips forward all the time."""
    time = arb(0)
    for left in range(impacts - 1, -1, -1):
        impulse = (1 + acb(machine.d)).real * local.real
        local = acb(-arb(machine.d) * local.real, local.imag - machine.mu * impulse)
        if left:
            flight = jeffcott_flight(machine.gamma, machine.omega, machine.rho, machine.phi, normal, local * normal)
            crossing = first_crossing(flight, 10.0, float(local.real))
            position, velocity, _ = flight.state(crossing.exact_time)
            normal = (position / acb(abs(position))).mid()
            local = (velocity * normal.conjugate()).mid()
            time += crossing.exact_time
    return float(time), complex(normal), complex(local * normal)


def test_without_restitution_a_pressed_rotor_stays_at_its_first_impact():
    machine = PAPER.replace(d=0.0)
    angle, angular_speed, _ = pressed_state(machine)
    _, run = wall_run(machine, angle, 0.8, angular_speed)
    assert run.go(5.0) is Outcome.CHATTER
    assert run.times == [0.0]
    assert run.time == 0.0


def test_without_restitution_a_pulled_rotor_lifts_off():
    """Without outward push an impact that takes all radial speed is followed by flight."""
    machine = PAPER.replace(d=0.0)
    rotor, run = wall_run(machine, machine.phi + math.pi, 0.8, -0.9)
    assert run.go(0.05) is Outcome.TIME_REACHED
    assert run.times == [0.0]
    assert abs(rotor.system.state(run.amplitudes)[0]) < 1.0


def test_at_rest_on_the_wall():
    """Pressed on it stays, pulled off it leaves."""
    angle, angular_speed, push = pressed_state(PAPER)
    assert push > 0.0
    _, run = wall_run(PAPER, angle, 0.0, angular_speed)
    assert run.go(5.0) is Outcome.CHATTER
    assert (run.time, run.times) == (0.0, [])
    rotor, run = wall_run(PAPER, PAPER.phi + math.pi, 0.0, 0.0)
    assert run.go(0.05) is Outcome.TIME_REACHED
    assert abs(rotor.system.state(run.amplitudes)[0]) < 1.0


def test_full_restitution_never_chatters():
    machine = PAPER.replace(d=1.0, mu=0.0)
    angle, angular_speed, _ = pressed_state(machine)
    rotor, run = wall_run(machine, angle, 1e-3, angular_speed)
    assert run.go(1.0, size=5000) is Outcome.TIME_REACHED
    # The bounces keep their speed but for the slow change of the push along the way.
    speeds = [np.real(np.conj(p) * v) for p, v in (rotor.system.state(before) for before in run.before)]
    assert len(speeds) > 100
    assert 0.5e-3 < min(speeds) <= max(speeds) < 2e-3


def test_a_pass_that_touches_to_rounding_is_grazing():
    """Flown back from a point of the wall where the path is tangential, with 57 digits."""
    machine = parameters(0.1, 0.76)
    rotor = jeffcott(machine)
    normal = unit(machine.phi + 2.5)
    tangential = jeffcott_flight(0.1, 0.76, machine.rho, machine.phi, normal, acb(0, -0.6) * normal)
    assert tangential.level(0.0)[2] < 0
    position, velocity, _ = tangential.state(-0.7)
    task = task_from_state(rotor, complex(position), complex(velocity))
    run = Run(rotor.system.arrays, rotor.system.table, task.amplitudes)
    assert run.go(5.0) is Outcome.GRAZING
    # The peak is flat: a height of rounding is a time of its root.
    assert run.time == pytest.approx(0.7, abs=1e-6)
    assert abs(rotor.system.state(run.amplitudes)[0]) == pytest.approx(1.0, abs=1e-13)
    for excess, outcome in ((1e-12, Outcome.EVENT_LIMIT), (-1e-12, Outcome.TIME_REACHED)):
        shifted = (1 + acb(excess)) * normal
        flight = jeffcott_flight(0.1, 0.76, machine.rho, machine.phi, shifted, acb(0, -0.6) * normal)
        position, velocity, _ = flight.state(-0.7)
        run = Run(
            rotor.system.arrays, rotor.system.table, rotor.system.amplitudes(complex(position), complex(velocity))
        )
        assert run.go(0.75, size=1) is outcome


def two_planes(scale, gap=0.0, machine=PAPER):
    """A planar rotor seen at two planes, the second with its own clearance and centre."""
    rotor = jeffcott(machine)
    row = rotor.system.arrays.rows[0]
    offset = rotor.system.arrays.offsets[0]
    return rotor, rotor_record(
        exponents=rotor.system.arrays.exponents,
        driven=np.array([False, True]),
        offsets=np.array([offset, scale * offset + gap]),
        rows=np.array([row, scale * row]),
        columns=np.array([[1.0, 1.0 / scale], [0.0, 0.0]], complex),
        friction=np.array([0.15, 0.15]),
        restitution=np.array([0.95, 0.95]),
        surface_speed=np.array([51.0, 51.0]),
    )


@pytest.mark.parametrize(("scale", "touched"), [(0.9, 0), (1.1, 1)])
def test_the_tighter_of_two_planes_is_met(scale, touched):
    rotor, arrays = two_planes(scale)
    table = flight_table(arrays.exponents, arrays.driven.astype(bool))
    run = Run(arrays, table, rotor.system.amplitudes(0.3 + 0.1j, 0.9 - 0.4j))
    run.go(1e9, size=20)
    assert run.planes == [touched] * 20
    single = rotor_record(
        exponents=arrays.exponents,
        driven=np.array([False, True]),
        offsets=arrays.offsets[[touched]],
        rows=arrays.rows[[touched]],
        columns=arrays.columns[:, [touched]],
        friction=arrays.friction[[touched]],
        restitution=arrays.restitution[[touched]],
        surface_speed=arrays.surface_speed[[touched]],
    )
    alone = Run(single, table, rotor.system.amplitudes(0.3 + 0.1j, 0.9 - 0.4j))
    alone.go(1e9, size=20)
    # Blocks of flight are cut alike, so only the horizons differ, and those not at all.
    assert np.allclose(run.times, alone.times, rtol=1e-12, atol=0)


def test_both_planes_are_met_where_their_bearings_are_apart():
    rotor, arrays = two_planes(1.0, gap=0.3, machine=PAPER.replace(rho=0.05))
    table = flight_table(arrays.exponents, arrays.driven.astype(bool))
    run = Run(arrays, table, rotor.system.amplitudes(-0.2 + 0.1j, 3.0 - 2.0j))
    run.go(1e9, size=60)
    assert set(run.planes) == {0, 1}
    for plane, before in zip(run.planes, run.before, strict=True):
        position = arrays.offsets + arrays.rows @ before
        assert abs(position[plane]) == pytest.approx(1.0, abs=1e-14)
        assert np.abs(position).max() <= 1.0 + 1e-12


def test_contact_beside_the_boundary_equilibrium():
    """With the equilibrium all but on the wall the normal force is a difference of near equals.

    Lift-off once fell back on that rounding error, time and again, without getting on.
    """
    machine = Parameters(
        gamma=0.0011078312170798854,
        omega=1.4120532845121747,
        rho=0.9941751290904262,
        phi=0.33488960764044645,
        mu=0.032660362544531925,
        d=0.04025852730447932,
        radius_ratio=97.80942336761889,
    )
    starts = [
        State(0.9163296395083007 + 0.40042476416748707j, -0.0012196532228065673 + 0.004081022802782584j),
        State(0.676514358561373 + 0.7364294417391892j, 0.1034046048297292 - 0.1430322322663489j),
    ]
    for start in starts:
        assert simulate(jeffcott(machine), start, 200.0).outcome is Outcome.TIME_REACHED
