"""Lasting contact: Taylor series, transitions and lift-off against other integrators with more digits."""

import cmath
import math
from functools import partial

import mpmath
import numpy as np
import pytest
from compilation import sized
from machines import PAPER, fly, random_parameters
from scipy.integrate import solve_ivp

from carom.base.outcome import Phase
from carom.core.contact_series import rub_series
from carom.core.flow import acceleration, displacement, fly_all, velocity
from carom.core.layout import ORDER, rotor_record, rub_workspace
from carom.core.rounding import push_rounding, speed_rounding
from carom.core.rub import (
    first_transition,
    lift_off,
    next_phase,
    rest_on_wall,
    turn_ahead,
    wall_push,
)
from carom.core.taylor import STEP_FRACTION, first_fall, series_step, sum_series
from carom.models import jeffcott
from carom.parameters import Parameters

FLIGHT, FORWARD, BACKWARD, ROLLING = Phase.FLIGHT, Phase.FORWARD_SLIP, Phase.BACKWARD_SLIP, Phase.ROLLING
SIGN = {FORWARD: 1, BACKWARD: -1}
SLENDER = PAPER.replace(radius_ratio=1.2)


def on_wall(parameters, angle, rate):
    """Amplitudes of a state that moves along the wall."""
    position = cmath.rect(1.0, angle)
    amplitudes = jeffcott(parameters).system.amplitudes(position, 1j * rate * position)
    return np.array(amplitudes)


def series_of(parameters, angle, rate, phase):
    rotor = jeffcott(parameters).system.arrays
    work = rub_workspace(2)
    rub_series(rotor, np.array([phase]), on_wall(parameters, angle, rate), work)
    return rotor, work


def polar(rotor, amplitudes):
    """Angle, rate, distance from the wall and radial speed."""
    position, speed = displacement(rotor, 0, amplitudes), velocity(rotor, 0, amplitudes)
    local = position.conjugate() * speed
    return cmath.phase(position), local.imag, abs(position) - 1.0, local.real


def push_of(parameters, angle, rate):
    """Normal force, from Newton's law across the wall."""
    return parameters.rho * math.cos(angle - parameters.phi) + (1 + rate) ** 2 - parameters.omega**2


def pull_of(parameters, angle, rate):
    """Acceleration along the wall without friction."""
    return -parameters.gamma * (1 + rate) - parameters.rho * math.sin(angle - parameters.phi)


class ExactSlide:
    """Sliding with 40 digits in the angle and its rate: power series of order 40 from the recurrence of sine and cosine."""

    ORDER = 40

    def __init__(self, parameters: Parameters, angle: float, rate: float, sign: int) -> None:
        self.numbers = {name: mpmath.mpf(getattr(parameters, name)) for name in ("gamma", "omega", "rho", "phi", "mu")}
        self.sign = sign
        self.starts, self.pieces = [mpmath.mpf(0)], [self._expand(mpmath.mpf(angle), mpmath.mpf(rate))]

    def push(self, x, w):
        """Normal force."""
        rho, phi, omega = (self.numbers[name] for name in ("rho", "phi", "omega"))
        return rho * mpmath.cos(x - phi) + (1 + w) ** 2 - omega**2

    def _expand(self, angle, rate):
        gamma, omega, rho, phi, mu = (self.numbers[name] for name in ("gamma", "omega", "rho", "phi", "mu"))
        x, w = [angle], [rate]
        sine, cosine = [mpmath.sin(angle - phi)], [mpmath.cos(angle - phi)]
        for k in range(self.ORDER):
            square = sum(w[j] * w[k - j] for j in range(k + 1))
            push = rho * cosine[k] + square + 2 * w[k] + (1 - omega**2 if k == 0 else 0)
            spin = w[k] + (1 if k == 0 else 0)
            sine.append(sum(cosine[j] * w[k - j] for j in range(k + 1)) / (k + 1))
            cosine.append(-sum(sine[j] * w[k - j] for j in range(k + 1)) / (k + 1))
            x.append(w[k] / (k + 1))
            w.append((-gamma * spin - rho * sine[k] - self.sign * mu * push) / (k + 1))
        return x, w, mpmath.mpf(0.25) / (1 + abs(rate))

    def state(self, time):
        """Angle and rate at a time; the series of this order leave nothing at 25 digits on their steps."""
        while time > self.starts[-1] + self.pieces[-1][2]:
            step = self.pieces[-1][2]
            ends = [_sum(series, step) for series in self.pieces[-1][:2]]
            self.starts.append(self.starts[-1] + step)
            self.pieces.append(self._expand(*ends))
        place = max(0, sum(start <= time for start in self.starts) - 1)
        return [_sum(series, time - self.starts[place]) for series in self.pieces[place][:2]]

    def error(self, time: float, angle: float, rate: float) -> float:
        """Distance of a state from the exact one."""
        x, w = self.state(mpmath.mpf(time))
        return float(abs(mpmath.expj(x) - mpmath.expj(mpmath.mpf(angle))) + abs(w - mpmath.mpf(rate)) / (1 + abs(w)))


def _sum(series, time):
    total = mpmath.mpf(0)
    for coefficient in reversed(series):
        total = total * time + coefficient
    return total


def test_the_exact_slide_solves_its_equation():
    """The reference itself: against an integrator, and the halving of its steps."""
    parameters, angle, rate = SLENDER, 0.3, 2.5

    def motion(_, state):
        x, w = state
        return [w, pull_of(parameters, x, w) - parameters.mu * push_of(parameters, x, w)]

    expected = solve_ivp(motion, (0.0, 3.0), [angle, rate], "DOP853", rtol=1e-13, atol=1e-13).y[:, -1]
    with mpmath.workdps(40):
        slide = ExactSlide(parameters, angle, rate, 1)
        half = ExactSlide(parameters, angle, rate, 1)
        half.pieces[0] = (*half.pieces[0][:2], half.pieces[0][2] / 2)
        assert [float(value) for value in slide.state(3)] == pytest.approx(expected, abs=1e-10)
        assert max(abs(a - b) for a, b in zip(slide.state(3), half.state(3), strict=True)) < mpmath.mpf(10) ** -25


SLIDES = [
    (PAPER, 0.6, 0.1, FORWARD),
    (PAPER, 2.5, -7.0, FORWARD),
    (PAPER, -1.0, -80.0, BACKWARD),
    (SLENDER, 0.3, 2.5, FORWARD),
    (SLENDER.replace(mu=0.6, gamma=1.7), -2.0, -4.0, BACKWARD),
    (SLENDER.replace(mu=0.0, gamma=0.0, omega=0.3), 1.4, -2.7, BACKWARD),
]


# ------------------------------------------------------------------------------------------------- Taylor series


@pytest.mark.parametrize(("parameters", "angle", "rate", "phase"), SLIDES)
def test_a_step_of_sliding_is_exact_to_rounding(parameters, angle, rate, phase):
    rotor, work = series_of(parameters, angle, rate, phase)
    step = series_step(work)
    moved = np.empty(2, complex)
    with mpmath.workdps(40):
        exact = ExactSlide(parameters, angle, rate, SIGN[phase])
        for share in (0.25, 0.5, 1.0):
            sum_series(work, share * step, moved)
            x, w, penetration, radial = polar(rotor, moved)
            assert exact.error(share * step, x, w) < 4e-15
            assert abs(penetration) < 4e-15
            assert abs(radial) < 4e-15 * (1 + abs(w))


@pytest.mark.parametrize(("parameters", "angle", "rate", "phase"), SLIDES)
def test_coefficients_up_to_the_order(parameters, angle, rate, phase):
    _, work = series_of(parameters, angle, rate, phase)
    step = series_step(work)
    with mpmath.workdps(40):
        rates = ExactSlide(parameters, angle, rate, SIGN[phase]).pieces[0][1]
        position = [mpmath.expj(mpmath.mpf(angle))]
        for k in range(ORDER):
            position.append(1j * sum(rates[j] * position[k - j] for j in range(k + 1)) / (k + 1))
    # The circle round the start on which the terms of the series are of one size.
    radius = step / STEP_FRACTION
    for k in range(ORDER + 1):
        assert abs(work.position[0, k] - complex(position[k])) * radius**k < 1e-12 * (1.0 + abs(rate))


@pytest.mark.parametrize(("parameters", "angle", "rate", "phase"), SLIDES)
def test_order_of_the_series(parameters, angle, rate, phase):
    """The error grows with the 21st power of the step, from below rounding at the step that is taken."""
    rotor, work = series_of(parameters, angle, rate, phase)
    step = series_step(work)
    moved = np.empty(2, complex)
    points = []
    with mpmath.workdps(40):
        exact = ExactSlide(parameters, angle, rate, SIGN[phase])
        for factor in 1.1 ** np.arange(45):
            sum_series(work, factor * step, moved)
            x, w, _, _ = polar(rotor, moved)
            error = exact.error(factor * step, x, w)
            if error > 1e-6:
                break
            if error > 1e-12:
                points.append((math.log(factor), math.log(error)))
    assert len(points) >= 4
    slope, intercept = np.polyfit(*np.array(points).T, 1)
    assert slope == pytest.approx(ORDER + 1, abs=1.4)  # between 19.6 and 21.9: the error passes zero between
    assert math.exp(intercept) < 1e-15


def test_rolling_is_a_rotation():
    for parameters, angle in ((PAPER, 0.4), (SLENDER, -2.0), (SLENDER.replace(radius_ratio=0.02), 3.0)):
        surface_speed = parameters.radius_ratio + 1.0
        rotor, work = series_of(parameters, angle, -surface_speed, ROLLING)
        step = series_step(work)
        moved = np.empty(2, complex)
        for time in np.linspace(0.0, step, 7):
            sum_series(work, time, moved)
            expected = cmath.rect(1.0, angle - surface_speed * time)
            assert abs(displacement(rotor, 0, moved) - expected) < 4e-15
            assert abs(velocity(rotor, 0, moved) + 1j * surface_speed * expected) < 4e-15 * (1.0 + surface_speed)


def test_series_hold_push_slip_and_grip():
    random = np.random.default_rng(3)
    for _ in range(100):
        parameters = random_parameters(random)
        angle, rate = random.uniform(-3, 3), random.normal() * 4.0
        surface_speed = parameters.radius_ratio + 1.0
        phase = FORWARD if surface_speed + rate > 0 else BACKWARD
        rotor, work = series_of(parameters, angle, rate, phase)
        step = series_step(work)
        powers = (0.7 * step) ** np.arange(ORDER + 1)
        moved = np.empty(2, complex)
        sum_series(work, 0.7 * step, moved)
        x, w, _, _ = polar(rotor, moved)
        noise = 1e3 * push_rounding(rotor, 0, moved)
        push = push_of(parameters, x, w)
        assert work.push[0] @ powers == pytest.approx(push, abs=noise)
        assert work.slip[0] @ powers == pytest.approx(surface_speed + w, abs=1e3 * speed_rounding(rotor, 0, moved))
        assert work.grip[0] @ powers == pytest.approx(-SIGN[phase] * parameters.mu * push, abs=noise)


def test_flight_is_a_series_without_force():
    random = np.random.default_rng(4)
    for _ in range(30):
        parameters = random_parameters(random)
        angle, rate = random.uniform(-3, 3), random.normal()
        rotor, work = series_of(parameters, angle, rate, FLIGHT)
        step = series_step(work)
        moved = np.empty(2, complex)
        sum_series(work, step, moved)
        start = cmath.rect(1.0, angle)
        position, speed = fly(parameters, start, 1j * rate * start, step)
        spread = push_rounding(rotor, 0, moved) + speed_rounding(rotor, 0, moved)
        assert displacement(rotor, 0, moved) == pytest.approx(position, abs=spread)
        assert velocity(rotor, 0, moved) == pytest.approx(speed, abs=spread)


# --------------------------------------------------------------------------------------------------- transitions


def next_event(parameters, angle, rate, phase):
    """Walk to the end of a phase: its time, what follows, whether slip stops, and the amplitudes there."""
    rotor = jeffcott(parameters).system.arrays
    amplitudes, work, time = on_wall(parameters, angle, rate), rub_workspace(2), 0.0
    for _ in range(200):
        rub_series(rotor, np.array([phase]), amplitudes, work)
        step = series_step(work)
        duration, following, slip_stops = first_transition(rotor, 0, phase, step, work)
        sum_series(work, duration, amplitudes)
        rest_on_wall(rotor, 0, amplitudes, phase == ROLLING)
        time += duration
        if duration < step:
            return time, following, slip_stops, amplitudes
    raise AssertionError("the phase does not end")


@pytest.mark.parametrize(
    ("parameters", "angle", "rate", "phase", "following"),
    [
        (PAPER.replace(gamma=0.2), 1.2, -0.3, FORWARD, FLIGHT),
        (SLENDER.replace(gamma=0.4), 0.4, 1.6, FORWARD, FLIGHT),
        (SLENDER.replace(mu=0.3), 0.2, -3.4, BACKWARD, None),
        (SLENDER.replace(gamma=0.9, mu=0.05), 0.0, -6.0, BACKWARD, None),
        (SLENDER.replace(radius_ratio=4.0, gamma=0.01), 0.5, -3.5, FORWARD, None),
    ],
)
def test_sliding_ends_where_push_or_slip_vanishes(parameters, angle, rate, phase, following):
    """Against the root of the exact motion, to 1e-12."""
    rotor = jeffcott(parameters).system.arrays
    time, found, slip_stops, amplitudes = next_event(parameters, angle, rate, phase)
    surface_speed = parameters.radius_ratio + 1.0
    assert slip_stops == (following is None)
    with mpmath.workdps(30):
        exact = ExactSlide(parameters, angle, rate, SIGN[phase])
        if following is None:
            root = mpmath.findroot(lambda t: surface_speed + exact.state(t)[1], time)
        else:
            assert found == following
            root = mpmath.findroot(lambda t: exact.push(*exact.state(t)), time)
        assert abs(float(root - mpmath.mpf(time))) < 1e-12
        # Nothing changes earlier: both margins are positive on a fine grid before it.
        for share in np.linspace(0.01, 0.99, 25):
            x, w = exact.state(mpmath.mpf(share * time))
            assert exact.push(x, w) > 0
            assert SIGN[phase] * (surface_speed + w) > 0
    x, w, penetration, radial = polar(rotor, amplitudes)
    assert abs(penetration) < 1e-15
    assert abs(radial) < 1e-14


def test_rolling_ends_where_its_friction_leaves_the_cone():
    """Rolling is a rotation, so the margins are known functions of time; both sides of the cone are met."""
    sides = set()
    random = np.random.default_rng(11)
    for _ in range(200):
        parameters = random_parameters(random, mu=float(random.uniform(0.05, 1.0)), radius_ratio=random.uniform(1, 4))
        surface_speed, angle = parameters.radius_ratio + 1.0, random.uniform(-3, 3)

        turn = np.linspace(0.0, 2 * math.pi / surface_speed, 20_001)
        x = angle - surface_speed * turn - parameters.phi
        push = parameters.rho * np.cos(x) + (surface_speed - 1) ** 2 - parameters.omega**2
        inside = parameters.mu * push - np.abs(parameters.gamma * (surface_speed - 1) - parameters.rho * np.sin(x))
        if inside[0] < 0.05 or inside.min() > -0.05:
            continue
        leaves = turn[np.argmax(inside < 0.0)]
        time, following, slip_stops, amplitudes = next_event(parameters, angle, -surface_speed, ROLLING)
        side = 1 if following == FORWARD else -1
        sides.add(side)
        assert not slip_stops
        assert abs(time - leaves) <= turn[1]
        with mpmath.workdps(30):
            room = partial(_room, parameters, angle, surface_speed, side)
            exact = mpmath.findroot(room, time)
            slope = abs(mpmath.diff(room, exact))
            noise = push_rounding(jeffcott(parameters).system.arrays, 0, amplitudes)
            assert abs(float(exact - mpmath.mpf(time))) < 1e-12 + noise / slope
    assert sides == {1, -1}


def _room(parameters, angle, surface_speed, side, time):
    """Friction that is left over on one side of the cone while it rolls."""
    x = mpmath.mpf(angle) - mpmath.mpf(surface_speed) * time - mpmath.mpf(parameters.phi)
    spin = mpmath.mpf(surface_speed) - 1
    push = parameters.rho * mpmath.cos(x) + spin**2 - mpmath.mpf(parameters.omega) ** 2
    pull = parameters.gamma * spin - parameters.rho * mpmath.sin(x)
    return parameters.mu * push - side * pull


@pytest.mark.parametrize("mu", [0.0, 1e-9, 0.4])
def test_slip_decides_what_goes_on(mu):
    for slip in (1e-6, 0.3, 50.0):
        for sign, phase in ((1, FORWARD), (-1, BACKWARD)):
            parameters = SLENDER.replace(mu=mu, radius_ratio=30.0)
            amplitudes = on_wall(parameters, 0.7, -31.0 + sign * slip)
            for before in Phase:
                assert (
                    next_phase(jeffcott(parameters).system.arrays, np.array([before]), 0, amplitudes, rub_workspace(2))
                    == phase
                )


def test_without_slip_the_cone_decides():
    """It rolls within the cone and on its edge, and else slips to the side it is pulled to."""
    random = np.random.default_rng(8)
    for _ in range(300):
        parameters = random_parameters(random, mu=0.0, radius_ratio=float(random.uniform(2.0, 9.0)))
        surface_speed, angle = parameters.radius_ratio + 1.0, float(random.uniform(-3, 3))
        push, pull = push_of(parameters, angle, -surface_speed), pull_of(parameters, angle, -surface_speed)
        if push < 1e-3 or not 1e-3 < abs(pull) < push:
            continue
        slips = FORWARD if pull > 0 else BACKWARD
        for factor, expected in ((0.5, slips), (1 - 1e-6, slips), (1.0, ROLLING), (1 + 1e-6, ROLLING), (3.0, ROLLING)):
            rotor = jeffcott(parameters.replace(mu=factor * abs(pull) / push)).system.arrays
            amplitudes = on_wall(parameters, angle, -surface_speed)
            assert next_phase(rotor, np.array([slips]), 0, amplitudes, rub_workspace(2)) == expected


def test_without_friction_slip_goes_on_to_the_other_side():
    parameters = SLENDER.replace(mu=0.0, gamma=0.0, rho=0.0)
    rotor, amplitudes = jeffcott(parameters).system.arrays, on_wall(parameters, 0.3, -2.2)
    assert next_phase(rotor, np.array([FORWARD]), 0, amplitudes, rub_workspace(2)) == BACKWARD
    assert next_phase(rotor, np.array([BACKWARD]), 0, amplitudes, rub_workspace(2)) == FORWARD
    pulled = parameters.replace(gamma=0.5)
    assert (
        next_phase(jeffcott(pulled).system.arrays, np.array([FORWARD]), 0, on_wall(pulled, 0.3, -2.2), rub_workspace(2))
        == FORWARD
    )


def test_slip_that_starts_at_zero_goes_on():
    """After rolling the slip starts as t² does, after a reversal as t does: neither ends what it starts."""
    parameters = SLENDER.replace(gamma=0.05)
    surface_speed = parameters.radius_ratio + 1.0
    time, following, _, amplitudes = next_event(parameters, 0.4, -surface_speed, ROLLING)
    rotor, work = jeffcott(parameters).system.arrays, rub_workspace(2)
    assert time > 0.0
    assert following == FORWARD
    rub_series(rotor, np.array([following]), amplitudes, work)
    assert abs(work.slip[0, 0]) < 1e-14
    assert abs(work.slip[0, 1]) < 1e-12
    assert work.slip[0, 2] > 1e-3
    step = series_step(work)
    assert first_transition(rotor, 0, following, step, work)[0] == step


# -------------------------------------------------------------------------------------------- margins and turns


def test_margins_fall_where_they_say():
    """Random polynomials: above minus the rounding error all the way to a zero after which they fall below it."""
    random = np.random.default_rng(17)
    falls = 0
    for trial in range(2000):
        margin = random.normal(size=ORDER + 1) * 0.8 ** np.arange(ORDER + 1)
        if trial % 3 == 1:
            margin[0] = 0.0
        if trial % 3 == 2:
            margin[:2] = 0.0
        rounding = 1e-13
        time = first_fall(margin, 1.0, rounding)
        if margin[0] < -rounding:
            assert time == 0.0
            continue
        grid = np.linspace(0.0, time, 2001)
        values = np.polynomial.polynomial.polyval(grid, margin)
        assert values.min() > -2 * rounding
        if time < 1.0:
            falls += 1
            assert abs(values[-1]) < 4 * rounding or time == 0.0
            # It falls, and not only by rounding.
            later = np.linspace(time, 1.0, 4001)
            ahead = np.polynomial.polynomial.polyval(later, margin)
            below, above = np.argmax(ahead < -rounding), np.argmax(ahead > 2 * rounding)
            assert ahead.min() < -rounding
            assert above == 0 or below < above
    assert 500 < falls < 1900


@pytest.mark.parametrize("depth", [1e-9, 1e-5])
def test_narrow_dips_are_not_stepped_over(depth):
    margin = np.zeros(ORDER + 1)
    margin[:3] = 0.3**2 - depth, -0.6, 1.0
    assert first_fall(margin, 1.0, 1e-14) == pytest.approx(0.3 - math.sqrt(depth), abs=1e-9)
    margin[0] = 0.3**2 + depth
    assert first_fall(margin, 1.0, 1e-14) == 1.0


def test_margins_that_vanish_do_not_fall():
    assert first_fall(np.zeros(ORDER + 1), 0.5, 1e-14) == 0.5
    assert first_fall(np.full(ORDER + 1, 1e-17), 0.5, 1e-14) == 0.5
    assert first_fall(np.full(ORDER + 1, -1.0), 0.5, 1e-14) == 0.0


def test_turns_are_found_to_rounding():
    parameters = SLENDER
    surface_speed = parameters.radius_ratio + 1.0
    _, work = series_of(parameters, 0.4, -surface_speed, ROLLING)
    step = series_step(work)
    ahead = 0.6 * step
    time = turn_ahead(0, cmath.rect(1.0, 0.4 - surface_speed * ahead), -1.0, step, work)
    assert time == pytest.approx(ahead, abs=1e-15)
    assert turn_ahead(0, cmath.rect(1.0, 0.4 - surface_speed * 1.5 * step), -1.0, step, work) == step


# ---------------------------------------------------------------------------------------------------- lift-off


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


# ------------------------------------------------------------------------------------------------- any rotor


class CoupledRotor:
    """Two coupled complex coordinates ``q̈ = −Dq̇ − Kq + f + bF`` with contact at ``y = w·q``: four modes, one plane."""

    def __init__(self, seed: int, friction: float, surface_speed: float) -> None:
        random = np.random.default_rng(seed)

        def noise(size):
            return random.normal(size=size) + 1j * random.normal(size=size)

        self.damping = 0.2 * np.eye(2) + 2j * np.eye(2) + 0.1 * noise((2, 2))
        self.stiffness = np.diag([-0.4, 3.0]) + 0.3 * noise((2, 2))
        self.load = 0.5 * noise(2)
        self.row = np.array([1.0, 0.4 + 0.1j])
        self.column = np.array([0.8, 0.3 - 0.2j])
        self.column = self.column / (self.row @ self.column)
        self.friction, self.surface_speed = friction, surface_speed
        rest = np.linalg.solve(self.stiffness, self.load)
        matrix = np.block([[np.zeros((2, 2)), np.eye(2)], [-self.stiffness, -self.damping]])
        exponents, vectors = np.linalg.eig(matrix)
        self.rest, self.inverse = rest, np.linalg.inv(vectors)
        self.arrays = rotor_record(
            exponents=exponents,
            driven=np.zeros(4, bool),
            offsets=np.array([self.row @ rest]),
            rows=(self.row @ vectors[:2])[None],
            columns=self.inverse @ np.concatenate([np.zeros(2), self.column])[:, None],
            friction=np.array([friction]),
            restitution=np.array([0.5]),
            surface_speed=np.array([surface_speed]),
        )

    def start(self, angle: float, rate: float) -> np.ndarray:
        """A state on the wall with given rate along it."""
        position = cmath.rect(1.0, angle)
        first = np.array([position - self.row[1] * (0.2 - 0.1j), 0.2 - 0.1j])
        speed = np.array([1j * rate * position - self.row[1] * (-0.1 + 0.3j), -0.1 + 0.3j])
        return np.concatenate([first, speed])

    def amplitudes(self, state: np.ndarray) -> np.ndarray:
        return self.inverse @ (state - np.concatenate([self.rest, np.zeros(2)]))

    def push(self, state: np.ndarray) -> float:
        position, speed = self.row @ state[:2], self.row @ state[2:]
        free = self.row @ (self.load - self.stiffness @ state[:2] - self.damping @ state[2:])
        return float((position.conjugate() * free).real + abs(speed) ** 2)

    def motion(self, _: float, state: np.ndarray, sign: int) -> np.ndarray:
        """Equations of index 1: the multiplier is the force that keeps ``d²|y|²/dt²`` zero."""
        free = self.load - self.stiffness @ state[:2] - self.damping @ state[2:]
        position = self.row @ state[:2]
        if sign == 0:
            force = -(self.surface_speed**2) * position - self.row @ free
        else:
            force = -complex(1.0, sign * self.friction) * self.push(state) * position
        return np.concatenate([state[2:], free + self.column * force])


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("phase", [FORWARD, BACKWARD, ROLLING])
def test_a_rotor_of_four_modes_stays_on_the_wall(seed, phase):
    sign = {**SIGN, ROLLING: 0}[phase]
    rotor = CoupledRotor(seed, friction=0.2, surface_speed=3.0)
    state = rotor.start(0.3, {FORWARD: 2.5, BACKWARD: -7.0, ROLLING: -3.0}[phase])
    amplitudes, work, time = rotor.amplitudes(state), rub_workspace(4), 0.0
    for _ in range(12):
        rub_series(rotor.arrays, np.array([phase]), amplitudes, work)
        step = series_step(work)
        push = work.push[0] @ step ** np.arange(ORDER + 1)
        sum_series(work, step, amplitudes)
        rest_on_wall(rotor.arrays, 0, amplitudes, phase == ROLLING)
        time += step
    expected = solve_ivp(rotor.motion, (0.0, time), state, "DOP853", args=(sign,), rtol=1e-13, atol=1e-13).y[:, -1]
    position, speed = displacement(rotor.arrays, 0, amplitudes), velocity(rotor.arrays, 0, amplitudes)
    assert abs(abs(position) - 1.0) < 4e-15
    assert abs((position.conjugate() * speed).real) < 1e-14
    assert position == pytest.approx(rotor.row @ expected[:2], abs=1e-10)
    assert speed == pytest.approx(rotor.row @ expected[2:], abs=1e-9)
    assert np.abs(amplitudes - rotor.amplitudes(expected)).max() < 1e-9
    assert push == pytest.approx(rotor.push(expected), abs=1e-9)
