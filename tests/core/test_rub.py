"""Lasting contact: Taylor series, transitions and lift-off against other integrators with more digits."""

import cmath
import math
from functools import partial

import mpmath
import numpy as np
import pytest
from machines import PAPER, fly, random_parameters
from scipy.integrate import solve_ivp
from sliding import (
    BACKWARD,
    FLIGHT,
    FORWARD,
    ROLLING,
    SIGN,
    SLENDER,
    ExactSlide,
    next_event,
    on_wall,
    polar,
    pull_of,
    push_of,
    series_of,
)

from carom.base.outcome import Phase
from carom.core.contact_series import rub_series
from carom.core.flow import displacement, velocity
from carom.core.layout import ORDER, rub_workspace
from carom.core.rounding import push_rounding, speed_rounding
from carom.core.rub import first_transition, next_phase, turn_ahead
from carom.core.taylor import STEP_FRACTION, first_fall, series_step, sum_series
from carom.models import jeffcott


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
