"""How a rotor leaves the wall."""

import math

import mpmath
import numpy as np
import pytest
from compilation import sized
from machines import PAPER, fly, random_parameters
from sliding import BACKWARD, FLIGHT, FORWARD, next_event, on_wall, polar, push_of

from carom.core import rub
from carom.core.contact_series import rub_series
from carom.core.flow import acceleration, displacement, fly_all, velocity
from carom.core.layout import rub_workspace
from carom.core.rounding import push_rounding, speed_rounding
from carom.core.rub import lift_off, rest_on_wall, wall_push
from carom.models import jeffcott
from carom.parameters import Parameters


def test_push_and_its_rate():
    """The push against Newton's law, its rate against differences along the flight."""
    random = np.random.default_rng(21)
    for _ in range(100):
        parameters = random_parameters(random)
        angle, rate = random.uniform(-3, 3), random.normal() * 3.0
        rotor = jeffcott(parameters).system.arrays
        amplitudes = on_wall(parameters, angle, rate)
        push, change = wall_push(rotor, 0, amplitudes)
        rounding = push_rounding(rotor, 0, amplitudes)
        assert push == pytest.approx(push_of(parameters, angle, rate), abs=rounding)
        h = 1e-4

        def free_push(amplitudes, rotor=rotor):
            position, speed = displacement(rotor, 0, amplitudes), velocity(rotor, 0, amplitudes)
            return (position.conjugate() * acceleration(rotor, 0, amplitudes)).real + abs(speed) ** 2

        sides = fly_all(rotor, np.array([amplitudes] * 4), h * np.array([-2.0, -1.0, 1.0, 2.0]))
        values = [free_push(side) for side in sides]
        difference = (values[0] - 8 * values[1] + 8 * values[2] - values[3]) / (12 * h)
        scale = (1.0 + abs(rate)) ** 6 * (1.0 + parameters.gamma + parameters.omega) ** 6
        assert change == pytest.approx(difference, abs=1e-15 * scale / h + scale * h**4)


def test_rounding_of_push_and_speed_bounds_what_doubles_lose():
    """The stated rounding errors against the forces of the same amplitudes in many digits."""
    random = np.random.default_rng(22)
    for _ in range(200):
        parameters = random_parameters(random, omega=1.0 + 10 ** random.uniform(-4, -1))
        angle, rate = random.uniform(-3, 3), random.normal() * 10 ** random.uniform(-2, 3)
        rotor = jeffcott(parameters).system.arrays
        amplitudes = on_wall(parameters, angle, rate)
        rest_on_wall(rotor, 0, amplitudes, False)
        _, w, _, radial = polar(rotor, amplitudes)
        assert abs(radial) < speed_rounding(rotor, 0, amplitudes)
        assert abs(w - rate) < speed_rounding(rotor, 0, amplitudes)
        push, _ = wall_push(rotor, 0, amplitudes)
        assert abs(push - push_of(parameters, angle, rate)) < push_rounding(rotor, 0, amplitudes)


def departures(count):
    """States that slid until the push vanished, away from places where its rate does too."""
    random = np.random.default_rng(31)
    found = 0
    while found < count:
        parameters = random_parameters(random, mu=float(random.uniform(0, 1)), gamma=float(random.uniform(0.01, 0.5)))
        angle, rate = random.uniform(-3, 3), random.normal() * 2.0
        surface_speed = parameters.radius_ratio + 1.0
        if push_of(parameters, angle, rate) < 0.01 or abs(surface_speed + rate) < 0.1:
            continue
        time, following, _, amplitudes = _follow_slide(
            parameters, angle, rate, FORWARD if surface_speed + rate > 0 else BACKWARD
        )
        if following != FLIGHT or time > 30.0:
            continue
        found += 1
        yield parameters, amplitudes


def _follow_slide(parameters, angle, rate, phase):
    try:
        return next_event(parameters, angle, rate, phase)
    except AssertionError:
        return math.inf, phase, False, None


def test_lift_off_leaves_as_the_cube_of_time():
    for parameters, amplitudes in departures(sized(20, 5)):
        rotor = jeffcott(parameters).system.arrays
        push, change = wall_push(rotor, 0, amplitudes)
        assert abs(push) < 2 * push_rounding(rotor, 0, amplitudes)
        assert change < 0.0
        start = amplitudes.copy()
        time, returned = lift_off(rotor, np.array([FLIGHT]), amplitudes, 1.0, rub_workspace(2))
        assert time > 0.0
        position, speed = displacement(rotor, 0, start), velocity(rotor, 0, start)
        # It does not come back at once, and where it ends agrees with the flight.
        end, _ = fly(parameters, position, speed, time)
        assert displacement(rotor, 0, amplitudes) == pytest.approx(end, abs=1e-12)
        for share in np.linspace(0.05, 0.95, 10):
            there, _ = fly(parameters, position, speed, share * time)
            assert abs(there) < 1.0 + 1e-14
        assert returned == (abs(abs(end) - 1.0) < 1e-13 and time < 1.0)
        # The cubic law, where the next term of the series is small.
        work = rub_workspace(2)
        rub_series(rotor, np.array([FLIGHT]), start, work)
        early = min(time, 1e-2 * abs(change) / (1.0 + abs(work.push[0, 2])))
        if abs(change) * early**3 > 1e-9:
            there, _ = fly(parameters, position, speed, early)
            assert 1.0 - abs(there) == pytest.approx(-change * early**3 / 6, rel=0.02)


def test_a_short_hop_is_followed_to_its_landing():
    """Where the push turns negative for a moment only, the rotor is back after ``4N'/N''`` and no sooner."""
    parameters = Parameters(gamma=0.02, omega=0.9, rho=0.5, phi=0.0, mu=0.2, d=0.5, radius_ratio=5.0)
    # θ̇ with N = 0 and a rate of N that is small and negative at an angle where N'' is positive.
    for angle in np.linspace(-3.1, 3.1, 200):
        square = parameters.omega**2 - parameters.rho * math.cos(angle)
        if square <= 0.0:
            continue
        for sign in (1, -1):
            rate = -1.0 + sign * math.sqrt(square)
            amplitudes = on_wall(parameters, angle, rate)
            rotor, work = jeffcott(parameters).system.arrays, rub_workspace(2)
            rub_series(rotor, np.array([FLIGHT]), amplitudes, work)
            change, bend = work.push[0, 1], 2 * work.push[0, 2]
            if not (change < -1e-9 and bend > 0.0 and -4 * change / bend < 0.05):
                continue
            start = amplitudes.copy()
            time, returned = lift_off(rotor, np.array([FLIGHT]), amplitudes, 1.0, work)
            assert returned
            assert time == pytest.approx(-4 * change / bend, rel=0.01)
            with mpmath.workdps(40):
                assert time == pytest.approx(_hop(parameters, angle, rate, time), rel=1e-6)
            assert np.abs(amplitudes - start).max() < 1.0
            return
    raise AssertionError("no hop found")


def _hop(parameters, angle, rate, guess):
    """Return time of a hop, from the flight with many digits."""
    from machines import ExactMotion

    motion = ExactMotion(parameters)
    start = mpmath.expj(mpmath.mpf(angle))
    spin = 1j * mpmath.mpf(rate) * start
    return float(mpmath.findroot(lambda t: (abs(motion.fly(start, spin, t)[0]) ** 2 - 1) / t**3, guess))


def test_a_start_without_push_that_is_pressed_on_does_not_leave():
    parameters = PAPER
    angle = parameters.phi - 1.0
    rate = -1.0 + math.sqrt(parameters.omega**2 - parameters.rho * math.cos(1.0))
    amplitudes = on_wall(parameters, angle, rate)
    rotor = jeffcott(parameters).system.arrays
    assert wall_push(rotor, 0, amplitudes)[1] > 0.0
    time, returned = lift_off(rotor, np.array([FLIGHT]), amplitudes, 1.0, rub_workspace(2))
    assert time < 1e-14
    assert returned


def test_lift_off_ends_at_its_horizon_with_the_state_of_the_flight():
    """A rotor that is pulled off the wall from rest on it, followed for less than a step."""
    parameters = PAPER.replace(omega=3.0)
    arrays = jeffcott(parameters).system.arrays
    amplitudes = np.array(jeffcott(parameters).system.amplitudes(1.0 + 0j, 0j))
    assert rub.wall_push(arrays, 0, amplitudes)[0] < -1.0
    expected = fly_all(arrays, amplitudes[None], np.array([1e-3]))[0]
    work = rub_workspace(2)
    # Scratch arrays carry nothing from one call to the next.
    work.first_margin[:] = -1e9
    time, returned = rub.lift_off(arrays, np.array([FLIGHT]), amplitudes, 1e-3, work)
    assert (time, returned) == (1e-3, False)
    assert amplitudes == pytest.approx(expected, abs=1e-14)


def test_a_rotor_leaves_the_wall_where_it_is_pressed_on_by_less_than_the_rounding_of_that_force():
    """At speeds along the wall where the force is next to zero and falls."""
    tried = 0
    for angle in np.arange(0.0, 6.0, 0.5):
        rotor = jeffcott(PAPER.replace(phi=angle))
        turning = math.sqrt(max(PAPER.omega**2 - PAPER.rho * math.cos(angle), 0.0)) - 1.0
        for share, leaves in ((0.8, True), (1.2, False)):
            for _ in range(4):
                amplitudes = np.array(rotor.system.amplitudes(1.0 + 0j, complex(0.0, turning)))
                push, change = rub.wall_push(rotor.system.arrays, 0, amplitudes)
                rounding = push_rounding(rotor.system.arrays, 0, amplitudes)
                turning += (share * rounding - push) / (2.0 * (1.0 + turning) + 1e-300)
            if change > -0.1:
                continue
            assert push == pytest.approx(share * rounding, rel=5e-3)
            time, returned = rub.lift_off(rotor.system.arrays, np.array([FLIGHT]), amplitudes, 1e-3, rub_workspace(2))
            assert (time, returned) == ((1e-3, False) if leaves else (0.0, True))
            tried += 1
    assert tried >= 6


def test_what_an_earlier_call_left_behind_does_not_change_a_lift_off():
    """In a flight to its return, many times as long as the one above."""
    parameters = PAPER.replace(omega=3.0)
    arrays = jeffcott(parameters).system.arrays
    found = []
    for left in (0.0, -1e15):
        amplitudes = np.array(jeffcott(parameters).system.amplitudes(1.0 + 0j, 0j))
        work = rub_workspace(2)
        work.first_margin[:] = left
        found.append((*rub.lift_off(arrays, np.array([FLIGHT]), amplitudes, 10.0, work), amplitudes))
    assert found[0][0] > 0.01
    assert found[0][:2] == found[1][:2]
    assert np.array_equal(found[0][2], found[1][2])
