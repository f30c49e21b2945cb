"""Levitation regained after a drop, and what the controller does then: against DOP853, and as stages."""

import cmath
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import carom as cm
from carom.base.outcome import InputError
from carom.parameters import Gravity, RecoveryAction, TouchdownBearing
from carom.rotors import PID, MagneticBearing, TouchdownPlane, Unbalance, rigid_rotor

pytestmark = pytest.mark.jit_only

HEAVY = cm.load("examples/dropped-rotor.toml")
G, PRECISE = 9.81, {"method": "DOP853", "rtol": 1e-13, "atol": 1e-15, "dense_output": True}
ACTION = RecoveryAction(
    "all",
    regain_after="9 ms",
    lasts="4 ms",
    gains={"damping": 1800.0, "stiffness": 2.5e5},
    force="30 N",
    phase="70 deg",
    set_point="40 um",
    set_point_angle="30 deg",
)


def test_a_planar_rotor_comes_back_as_another_integrator_says():
    """In SI units in the fixed frame, with one impact before the regain."""
    m, c, k, e, room, omega, radius = 5.0, 900.0, 5e5, 2e-6, 0.25e-3, 300.0 * math.pi, 20e-3
    motion = cm.simulate(HEAVY, cm.drop(recovery=ACTION), "16 ms")
    assert [len(each.contacts) for each in motion.parts] == [1, 0, 0]
    helped = 30.0 * cmath.exp(1j * math.radians(70.0)), 40e-6 * cmath.exp(1j * math.radians(30.0))

    def rates(damping, stiffness, force=0.0, at=0.0):
        def right(t, y):
            pull = (m * e * omega**2 + force) * cmath.exp(1j * omega * t) - 1j * m * G
            return [y[1], (pull - damping * y[1] - stiffness * (y[0] - at)) / m]

        return right

    def wall(t, y):
        return abs(y[0]) - room

    wall.terminal, wall.direction = True, 1.0
    whirl = m * e * omega**2 / (k - m * omega**2 + 1j * c * omega)
    fall = solve_ivp(rates(0.0, 0.0), (0.0, 9e-3), [whirl - 1j * m * G / k, 1j * omega * whirl], events=wall, **PRECISE)
    outward = (place := fall.y[0, -1]) / abs(place)
    normal = (fall.y[1, -1] * outward.conjugate()).real
    after = fall.y[1, -1] - 1.5 * normal * outward * (1.0 + 0.15j)
    assert (after / outward).imag > -radius * omega  # slip does not reverse
    state, parts = [place, after], motion.parts
    for (begin, end), given, part in (
        ((fall.t[-1], 9e-3), (0.0, 0.0), parts[0]),
        ((9e-3, 13e-3), (2.0 * c, 0.5 * k, *helped), parts[1]),
        ((13e-3, 16e-3), (c, k), parts[2]),
    ):
        state = solve_ivp(rates(*given), (begin, end), state, **PRECISE).y[:, -1]
        own = complex(part.final.position) * cmath.exp(1j * end * omega)
        # DOP853 at 1e-13 over 16 ms; the start of the second span is an impact that its events find to 1e-15.
        assert own == pytest.approx(state[0] / room, abs=1e-8)


def four_degrees(speed=800.0):
    bearings = [MagneticBearing(n, 100.0, -1e5, PID(6000.0, 3e5, 8.0, 1e-4)) for n in (1, 3)]
    wall = TouchdownBearing("kelvin-voigt", stiffness=5e6, damping=200.0)
    touchdowns = [TouchdownPlane(n, wall, "20 mm", 0.1) for n in (0, 4)]
    return rigid_rotor(
        mass=12.0,
        polar_inertia=0.05,
        diametral_inertia=0.15,
        stations=STATIONS,
        speed=speed,
        clearance="0.25 mm",
        bearings=bearings,
        touchdowns=touchdowns,
        unbalances=[Unbalance(2, "15 g mm", 0.4)],
        gravity=Gravity(),
    )


STATIONS = [-0.16, -0.12, 0.03, 0.15, 0.19]


def test_a_rotor_with_four_degrees_comes_back_as_another_integrator_says():
    """Gyroscopic, on controllers that integrate, with contact before the regain; in SI units in the fixed frame."""
    mass, polar, diametral, omega, k, c, ki, ks, room = 12.0, 0.05, 0.15, 800.0, 5e6, 200.0, 100.0, -1e5, 0.25e-3
    p, i, d, tf = 6000.0, 3e5, 8.0, 1e-4
    action = RecoveryAction(
        "all",
        regain_after="9 ms",
        lasts="4 ms",
        current="1 A",
        phase=0.7,
        set_point="30 um",
        gains={"proportional": 9000.0},
    )
    machine = four_degrees()
    motion = cm.simulate(machine.model, cm.drop(recovery=action), "16 ms")
    assert len(motion.parts[0].contacts)
    magnets, walls = np.array([STATIONS[1], STATIONS[3]]), np.array([STATIONS[0], STATIONS[4]])

    def right(t, y, ki=0.0, ks=0.0, p=p, current=0.0, at=0.0, touching=(False, False)):
        (z, tilt), (vz, vtilt), sums, lags = y[:2], y[2:4], y[4:6], y[6:8]
        seen = z + magnets * tilt - at
        moving = lags * 0.0
        rate = (seen - lags) / tf
        force = -ki * (p * seen + i * sums + d * rate) - ks * seen + 100.0 * current * np.exp(1j * omega * t)
        places, speeds = z + walls * tilt, vz + walls * vtilt
        radii = np.abs(places)
        normal = k * (radii - room) + c * (places.conj() * speeds).real / radii
        wall = -np.where(touching, normal * (1.0 + 0.1j) * places / radii, 0.0)
        heavy = 15e-6 * omega**2 * np.exp(1j * (omega * t + 0.4))
        weight = -1j * G * mass  # which integrators come to carry
        total = force.sum() * bool(ki) + wall.sum() + heavy + weight
        moment = (magnets * force).sum() * bool(ki) + (walls * wall).sum() + STATIONS[2] * heavy
        held = (seen, rate) if ki else (moving, moving)
        return np.concatenate([[vz, vtilt, total / mass, (moment + 1j * omega * polar * vtilt) / diametral], *held])

    def margins(touching):
        """Of each wall: the rotor reaches it, or it no longer presses."""

        def margin(place):
            def event(t, y):
                at, speed = y[0] + walls[place] * y[1], y[2] + walls[place] * y[3]
                depth = abs(at) - room
                return k * depth + c * (at.conjugate() * speed).real / abs(at) if touching[place] else depth

            event.terminal, event.direction = True, -1.0 if touching[place] else 1.0
            return event

        return [margin(0), margin(1)]

    start = motion.parts[0].start
    system, scales = motion.parts[0].rotor.system, machine.model.scales
    amplitudes = system.amplitudes(start.position, start.velocity, 0.0)
    at, speed = zip(*(system.at_plane(amplitudes, plane) for plane in (0, 1)), strict=True)
    both = np.array([np.array(at), np.array(speed) + 1j * np.array(at)]) * room * np.array([[1.0], [scales.speed]])
    tilts = (both[:, 1] - both[:, 0]) / (walls[1] - walls[0])
    state = np.concatenate([np.column_stack([both[:, 0] - walls[0] * tilts, tilts]).ravel(), np.zeros(4)])
    held = {"ki": ki, "ks": ks}
    ways = [({}, 9e-3), ({"p": 1.5 * p, **held, "current": cmath.exp(1.1j), "at": 30e-6j}, 13e-3)]
    begin, touching = 0.0, np.array([False, False])
    for (given, end), part in zip([*ways, (held, 16e-3)], motion.parts, strict=True):
        while begin < end:
            found = solve_ivp(
                lambda t, y, given=given, touching=touching: right(t, y, touching=touching, **given),
                (begin, end),
                state,
                events=margins(touching),
                **PRECISE,
            )
            begin, state = found.t[-1], found.y[:, -1]
            touching = touching ^ np.array([bool(len(each)) for each in found.t_events])
        for plane in (0, 1):
            own = complex(part.seen_at(plane).end()[0])
            assert own == pytest.approx((state[0] + walls[plane] * state[1]) / room, abs=1e-8)


@pytest.mark.parametrize("machine", [HEAVY, cm.load("examples/touchdown-balls.toml")])
def test_it_comes_back_when_it_has_been_slow_for_a_time(machine):
    """The time begins at the last event, or question, with a faster rotor; the fall is that of a motion without questions."""
    scales = machine.parameters.scales
    quiet = RecoveryAction("quiet", regain_quiet="8 ms", quiet_speed="40 mm/s")
    asked, _ = cm.simulate(machine, cm.drop(recovery=quiet)).parts
    plain = cm.simulate(machine, cm.drop(), asked.time * 1.0001)
    amplitudes = np.concatenate([asked.segment_amplitudes[1:], asked.event_amplitudes])
    place, rate = asked.rotor.system.at_plane(amplitudes, 0)
    fast = np.abs(rate + 1j * place) * scales.velocity > 0.04
    last = np.tile(asked.segment_starts[1:], 2)[fast].max()
    assert asked.outcome.label == "triggered"
    assert (asked.time - last) * scales.time == pytest.approx(8e-3, abs=1e-9)
    times = np.linspace(0.0, asked.time, 50)
    # Where it was asked in contact, steps of contact begin anew: both are right to their tolerance.
    assert asked.position(times) == pytest.approx(plain.position(times), abs=1e-8)


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        ({}, "^regain = nothing given: one of regain_after, regain_speed, regain_quiet"),
        (
            {"regain_after": 1.0, "regain_quiet": 1.0, "quiet_speed": 1.0},
            "^regain = regain_after with regain_quiet: one of",
        ),
        ({"regain_after": 1.0, "force": 1.0}, "^lasts = nothing given: beside an action, which needs it"),
        ({"regain_after": 1.0, "lasts": 1.0}, "^lasts = 1.0: beside an action, which needs it: one of gains"),
        ({"regain_after": 1.0, "quiet_speed": 1.0}, "^quiet_speed = 1.0: beside regain_quiet, which needs it"),
        ({"regain_quiet": 1.0}, "^quiet_speed = nothing given: beside regain_quiet, which needs it"),
        ({"regain_after": 1.0, "lasts": 1.0, "gains": "damping"}, "^gains = damping: a table of parameters"),
        (
            {"regain_after": 1.0, "lasts": 1.0, "force": 1.0, "current": 1.0},
            "^force = 1.0: must be left out beside current",
        ),
    ],
)
def test_what_is_no_recovery(entries, words):
    with pytest.raises(InputError, match=words):
        RecoveryAction("one", **entries)


@pytest.mark.parametrize(
    ("machine", "entries", "words"),
    [
        (HEAVY, {"current": "1 A"}, r"^current = 1: a \[rotor\] with magnetic bearings"),
        (HEAVY, {"gains": {"mass": "6 kg"}}, "^gains = mass: parameters of the levitation alone"),
        (HEAVY, {"gains": {"friction": 0.1}}, "^gains = friction: parameters of the levitation alone"),
        (HEAVY, {"gains": {"damp": 1.0}}, "^damp = "),
        (cm.load("examples/tum-flexible-rotor.toml"), {"gains": {"damping": 2}}, "^damping = "),
    ],
)
def test_what_a_machine_has_not_is_refused(machine, entries, words):
    with pytest.raises(InputError, match=words):
        cm.simulate(machine, cm.drop(recovery=RecoveryAction("one", regain_after="9 ms", lasts="9 ms", **entries)))


def test_the_drive_slows_the_shaft_down_in_steps():
    """Against DOP853 with the same steps of the speed, and near one with a speed that falls evenly; without contact."""
    m, c, k, e, room, omega = 5.0, 900.0, 5e5, 2e-6, 0.25e-3, 300.0 * math.pi
    slow = RecoveryAction("slow", regain_after="3 ms", lasts="40 ms", slow_to="6000 rpm")
    _, *steps, last = cm.simulate(HEAVY, cm.drop(recovery=slow), "50 ms", settle=True).parts
    assert (len(steps), last.outcome.label, last.final.shaft[0]) == (20, "levitated", pytest.approx(2.0 / 3.0))
    whirl = m * e * omega**2 / (k - m * omega**2 + 1j * c * omega)

    def right(t, y, speed, slowing, stiffness, damping):
        now = speed(t)
        pull = m * e * (now**2 + 1j * slowing) * np.exp(1j * y[2]) - 1j * m * G
        return [y[1], (pull - damping * y[1] - stiffness * y[0]) / m, now]

    def follow(state, span, speed, slowing=0.0, held=(k, c)):
        return solve_ivp(right, span, state, args=(speed, slowing, *held), **PRECISE).y[:, -1]

    begun = follow([whirl - 1j * m * G / k, 1j * omega * whirl, 0j], (0.0, 3e-3), lambda t: omega, held=(0.0, 0.0))
    even = follow(begun, (3e-3, 43e-3), lambda t: omega * (1.0 - (t - 3e-3) / 0.12), -omega / 0.12)
    for count, part in enumerate(steps):
        span = 3e-3 + 2e-3 * count, 5e-3 + 2e-3 * count
        begun = follow(begun, span, lambda t, share=(count + 0.5) / 20: omega * (1.0 - share / 3.0))
        assert part.end()[0] == pytest.approx(begun[0] / room, abs=1e-8)
    assert steps[-1].end()[0] == pytest.approx(even[0] / room, abs=5e-4)  # measured 1.6e-4 of a clearance


def test_levitation_is_back_at_a_speed_with_the_gyroscopic_moments_of_it():
    machine = four_degrees()
    back = RecoveryAction("back", regain_speed="799 rad/s")
    motion = cm.simulate(machine.model, cm.drop(recovery=back), "1 s", settle=True)
    speeds = [part.final.shaft[0] * 800.0 for part in motion.parts]
    assert len(speeds) == 21
    assert speeds[-3] > 799.0 >= speeds[-2]
    again = motion.parts[-1].rotor.system
    expected = four_degrees(speed=799.0).model.system.exponents * 799.0 + 799.0j
    # A spin in steps leaves the speed of the last one at its end, and both are rounded by exponents of up to 2e4 1/s.
    for each in (again.exponents + 1j) * 800.0:
        assert np.abs(expected - each).min() < 1e-6


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        ({"regain_speed": "3000 rpm"}, "^polar_inertia = nothing given"),
        (
            {"regain_after": 1.0, "slow_to": "10000 rpm", "lasts": 1.0},
            "^slow_to = .*: below the speed before, 942.478 rad/s",
        ),
    ],
)
def test_speeds_need_a_shaft_that_slows_down(entries, words):
    with pytest.raises(InputError, match=words):
        cm.simulate(HEAVY, cm.drop(recovery=RecoveryAction("one", **entries)))


def test_asking_often_counts_as_events():
    often = RecoveryAction("often", regain_quiet="10 ns", quiet_speed="1e-9 m/s")
    motion = cm.simulate(HEAVY, cm.drop(recovery=often), max_events=500)
    assert (len(motion.parts), motion.outcome.label, len(motion.segment_starts)) == (1, "event-limit", 501)
