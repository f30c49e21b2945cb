"""Contact with compliant walls: series and steps against the equations in polar coordinates with many digits."""

import cmath
import math

import mpmath
import numpy as np
import pytest
from linear_rotors import planar_rotor
from mpmath import mpc, mpf

from carom.base.outcome import Phase
from carom.core.compliance import next_form, slip_in_wall, stay_in_wall
from carom.core.contact_series import rub_series
from carom.core.flow import displacement, velocity
from carom.core.layout import ORDER, rub_workspace
from carom.core.rub import first_transition, next_phase
from carom.core.taylor import STEP_FRACTION, margin_step, series_step, sum_series
from carom.models import HuntCrossley, KelvinVoigt, Touchdown

FLIGHT, FORWARD, BACKWARD, ROLLING, SEPARATED = Phase
GAMMA, OMEGA, RHO, PHI, FRICTION, RATIO = 0.13, 0.76, 0.43, 0.21, 0.3, 3.0
KELVIN_VOIGT = KelvinVoigt(2e3, 11.0)
LAWS = [KELVIN_VOIGT, *(HuntCrossley(2e3, 0.4, exponent) for exponent in (1.0, 10 / 9, 1.5))]
STARTS = [  # depth, radial speed, angle, turning of the frame's rotor, phase
    (0.02, 0.7, 0.4, -0.3, FORWARD),
    (0.01, -0.4, -2.0, -7.0, BACKWARD),
    (0.03, 0.2, 1.1, None, ROLLING),
    (0.008, -3.1, 2.7, -0.2, SEPARATED),
]
CASES = [*((KELVIN_VOIGT, *start) for start in STARTS), *((LAWS[3], *start) for start in STARTS[::2])]
CASES += [(LAWS[1], *STARTS[1]), (LAWS[2], *STARTS[0])]
IN_CONTACT = [case for case in CASES if case[-1] != SEPARATED]


def rotor_of(law, friction=FRICTION, ratio=RATIO, rows=((1.0,),)):
    """The planar rotor of these parameters with walls of a law."""
    return planar_rotor(
        GAMMA, OMEGA**2, RHO * cmath.exp(1j * PHI), [Touchdown(row, law, friction, ratio + 1.0) for row in rows]
    )


def start_of(depth, radial, angle, turning, phase):
    """Position and velocity; rolling, the contact point of radius ``s + δ`` is at rest."""
    radius = 1.0 + depth
    turning = -RATIO / radius - 1.0 if phase == ROLLING else turning
    normal = cmath.exp(1j * angle)
    return radius * normal, (radial + 1j * radius * turning) * normal


def series_of(law, start, phase):
    system = rotor_of(law).system
    amplitudes, work = np.array(system.amplitudes(*start)), rub_workspace(2)
    rub_series(system.arrays, np.array([phase]), amplitudes, work)
    return system.arrays, amplitudes, work


# ------------------------------------------------------------------------------------------------- the equations


def step_of(rotor, work):
    """The step that is taken: the series of the motion and of the depth are exact to rounding."""
    return next_form(rotor, 0, min(series_step(work), margin_step(work.depth[0])), work)


def push_of(law, depth, rate, power):
    """The force of a law in contact."""
    if isinstance(law, KelvinVoigt):
        return depth * law.stiffness + rate * law.damping
    return power * (rate * law.dissipation + 1) * law.stiffness


class Series:
    """A truncated power series with many digits."""

    def __init__(self, terms):
        self.terms = list(terms)

    def __add__(self, other):
        other = other if isinstance(other, Series) else Series([other] + [0] * (len(self.terms) - 1))
        return Series(a + b for a, b in zip(self.terms, other.terms, strict=True))

    def __mul__(self, other):
        if not isinstance(other, Series):
            return Series(other * a for a in self.terms)
        size = range(len(self.terms))
        return Series(mpmath.fdot(self.terms[: k + 1], other.terms[k::-1]) for k in size)

    def __sub__(self, other):
        return self + other * -1

    def of(self, function):
        """The function of this series, by its derivatives at the first term and powers of the rest."""
        size = len(self.terms)
        derivatives = mpmath.taylor(function, self.terms[0], size - 1)
        rest, total = Series([mpf(0), *self.terms[1:]]), Series([mpf(0)] * size)
        for coefficient in reversed(derivatives):
            total = total * rest + coefficient
        return total


def exact_series(law, start, phase):
    """Coefficients of position, normal force, friction and slip, from one order to the next in polar coordinates."""
    position, velocity = (mpc(complex(each)) for each in start)
    radius = abs(position)
    local = velocity * mpmath.conj(position) / radius
    r, u, a, w = [radius], [local.real], [mpmath.arg(position)], [1 + local.imag / radius]
    exponent = mpf(getattr(law, "exponent", 1.0))
    for k in range(ORDER + 1):
        radial, speed, angle, whirl = (Series(terms) for terms in (r, u, a, w))
        inverse, depth = radial.of(lambda at: 1 / at), radial - 1
        push = push_of(law, depth, speed, depth if exponent == 1 else depth.of(lambda at: at**exponent))
        push = push * (0 if phase == SEPARATED else 1)
        outward = radial * whirl * whirl - speed * GAMMA - radial * mpf(OMEGA) ** 2 - push
        outward += (angle - PHI).of(mpmath.cos) * RHO
        along = radial * whirl * -GAMMA - (angle - PHI).of(mpmath.sin) * RHO
        grip = push * (mpf(FRICTION) * {FORWARD: -1, BACKWARD: 1}.get(phase, 0))
        if phase == ROLLING:  # r W = −s
            turning = speed * inverse * inverse * RATIO
            grip = radial * turning + speed * whirl * 2 - along
        else:
            turning = (along + grip - speed * whirl * 2) * inverse
        slip = radial * whirl + RATIO
        if k == ORDER:
            return radial * angle.of(lambda at: mpmath.expj(at)), push, grip, slip
        for terms, rate in ((r, speed), (u, outward), (a, whirl - 1), (w, turning)):
            terms.append(rate.terms[k] / (k + 1))
    raise AssertionError


class Motion:
    """The motion in polar coordinates with many digits, by extrapolated midpoint steps (Gragg, Bulirsch and Stoer)."""

    COLUMNS = 10

    def __init__(self, law, phase, start):
        position, velocity = (mpc(complex(each)) for each in start)
        radius = abs(position)
        local = velocity * mpmath.conj(position) / radius
        self.law, self.phase, self.time = law, phase, mpf(0)
        self.state = [radius, local.real, mpmath.arg(position), 1 + local.imag / radius]

    def rates(self, state):
        radius, speed, angle, whirl = state
        depth = radius - 1
        power = depth if getattr(self.law, "exponent", 1.0) == 1.0 else depth ** mpf(self.law.exponent)
        push = 0 if self.phase == SEPARATED else push_of(self.law, depth, speed, power)
        along = -GAMMA * radius * whirl - RHO * mpmath.sin(angle - PHI)
        along += mpf(FRICTION) * push * {FORWARD: -1, BACKWARD: 1}.get(self.phase, 0)
        turning = (along - 2 * speed * whirl) / radius if self.phase != ROLLING else RATIO * speed / radius**2
        outward = radius * whirl**2 - GAMMA * speed - mpf(OMEGA) ** 2 * radius + RHO * mpmath.cos(angle - PHI) - push
        return [speed, outward, whirl - 1, turning]

    def goes_on(self, until, longest):
        """Follow it to a time in steps of some length at most; return position and velocity in Cartesian coordinates."""
        pieces = math.ceil((until - self.time) / longest)
        for _ in range(pieces):
            self.state = self._step((until - self.time) / pieces)
        self.time = mpf(until)
        radius, speed, angle, whirl = self.state
        normal = mpmath.expj(angle)
        return complex(radius * normal), complex((speed + mpc(0, 1) * radius * (whirl - 1)) * normal)

    def _step(self, size):
        row = []
        for column in range(self.COLUMNS):
            count = 2 * (column + 1)
            ahead = self._midpoints(size / count, count)
            for before in range(column):
                ratio = mpf(count) / (2 * (column - before))
                ahead, row[before] = (
                    [new + (new - old) / (ratio**2 - 1) for new, old in zip(ahead, row[before], strict=True)],
                    ahead,
                )
            row.append(ahead)
        return row[-1]

    def _midpoints(self, size, count):
        first, second = self.state, [y + size * f for y, f in zip(self.state, self.rates(self.state), strict=True)]
        for _ in range(count - 1):
            rates = self.rates(second)
            first, second = second, [y + 2 * size * f for y, f in zip(first, rates, strict=True)]
        rates = self.rates(second)
        return [(a + b + size * f) / 2 for a, b, f in zip(first, second, rates, strict=True)]


# ------------------------------------------------------------------------------------------------- series


@pytest.mark.parametrize(("law", "depth", "radial", "angle", "turning", "phase"), CASES)
def test_coefficients_up_to_the_order(law, depth, radial, angle, turning, phase):
    start = start_of(depth, radial, angle, turning, phase)
    rotor, _, work = series_of(law, start, phase)
    with mpmath.workdps(30):
        position, push, grip, slip = (np.array(each.terms) for each in exact_series(law, start, phase))
    # The circle round the start on which the terms of the series are of one size, and half of it where they grow first.
    scale = (0.5 * step_of(rotor, work) / STEP_FRACTION) ** np.arange(ORDER + 1)
    assert np.abs((work.position[0] - position.astype(complex)) * scale).max() < 1e-12
    size = np.abs(push.astype(float) * scale).max() + 1.0
    # A rounding error of the radius is relative to the depth in the force.
    rounding = 1e-14 / depth
    if phase != SEPARATED:
        assert np.abs((work.push[0] - push.astype(float)) * scale).max() < rounding * size
        assert np.abs((work.grip[0] - grip.astype(float)) * scale).max() < rounding * size
    assert np.abs((work.slip[0] - slip.astype(float)) * scale).max() < rounding * size


@pytest.mark.parametrize(("law", "depth", "radial", "angle", "turning", "phase"), IN_CONTACT)
def test_error_and_order_of_a_step(law, depth, radial, angle, turning, phase):
    """The error grows with the 21st power of the step, from below rounding at the step that is taken."""
    start = start_of(depth, radial, angle, turning, phase)
    rotor, _, work = series_of(law, start, phase)
    step, moved, points = series_step(work), np.empty(2, complex), []
    with mpmath.workdps(25):
        exact = Motion(law, phase, start)
        for factor in (0.25, 0.5, 1.0, *1.3 ** np.arange(1, 7)):
            sum_series(work, factor * step, moved)
            place, speed = exact.goes_on(factor * step, 0.25 * step)
            error = abs(displacement(rotor, 0, moved) - place) + step * abs(velocity(rotor, 0, moved) - speed)
            if factor <= 1.0:
                assert error < 5e-15
            if error > 1e-5:
                break
            if error > 1e-13:
                points.append((math.log(factor), math.log(error)))
    assert len(points) >= 2
    slope, intercept = np.polyfit(*np.array(points).T, 1)
    assert slope == pytest.approx(ORDER + 1, abs=0.5)  # between 20.6 and 21.2
    assert math.exp(intercept) < 1e-15


@pytest.mark.parametrize("depth", [1e-10, 6e-10])
@pytest.mark.parametrize("exponent", [10 / 9, 1.5])
def test_below_the_onset_the_series_is_that_of_the_parabola(depth, exponent):
    law, start = HuntCrossley(1e9, 0.4, exponent), start_of(depth, 0.3, 0.2, 0.1, FORWARD)
    _, _, work = series_of(law, start, FORWARD)
    step = 1e-10  # over which the depth changes by a third of itself
    powers = (0.7 * step) ** np.arange(ORDER + 1)
    depths, rate = work.depth[0, : ORDER + 1] @ powers, work.rate[0] @ powers
    share, part = 6.0 / (exponent + 1.0) - 2.0, depths / 1e-9
    expected = 1e9 * 1e-9**exponent * (share * part + (1.0 - share) * part**2) * (1.0 + 0.4 * rate)
    # The depth itself has a rounding error of the radius, which both have in common.
    assert work.push[0] @ powers == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_depth_normal_and_slip_are_those_of_the_position(law):
    random = np.random.default_rng(2)
    for _ in range(50):
        phase = random.choice([FORWARD, BACKWARD, ROLLING, SEPARATED])
        start = start_of(10.0 ** random.uniform(-4, -1), random.normal(), random.uniform(-3, 3), random.normal(), phase)
        rotor, amplitudes, work = series_of(law, start, phase)
        powers = (0.8 * step_of(rotor, work)) ** np.arange(ORDER + 1)
        y, speed, normal = (each[0] @ powers for each in (work.position, work.speed, work.normal))
        assert abs(y) == pytest.approx(1.0 + work.depth[0, : ORDER + 1] @ powers, abs=1e-14)
        assert y / abs(y) == pytest.approx(normal, abs=1e-14)
        assert (np.conj(normal) * speed).real == pytest.approx(work.rate[0] @ powers, abs=1e-12)
        slip = RATIO + 1.0 + abs(y) - 1.0 + (np.conj(normal) * speed).imag
        assert work.slip[0] @ powers == pytest.approx(slip, abs=1e-13)
        assert slip_in_wall(rotor, 0, amplitudes) == pytest.approx(work.slip[0, 0], abs=1e-14)
        if phase == ROLLING:
            assert np.abs(work.slip[0] * powers).max() < 1e-13


# ------------------------------------------------------------------------------------------------- ends of phases


def walk(law, start, phase, friction=FRICTION):
    """Walk to the end of a phase: its time, what follows, whether that is undecided, and the amplitudes there."""
    system = rotor_of(law, friction).system
    rotor, amplitudes, work, time = system.arrays, np.array(system.amplitudes(*start)), rub_workspace(2), 0.0
    for _ in range(1000):
        rub_series(rotor, np.array([phase]), amplitudes, work)
        step = step_of(rotor, work)
        duration, following, undecided = first_transition(rotor, 0, phase, step, work)
        sum_series(work, duration, amplitudes)
        time += duration
        if duration < step:
            return time, following, undecided, rotor, amplitudes
    raise AssertionError("the phase does not end")


def pressing(law):
    """What vanishes with the force, of a state."""

    def value(radius, rate):
        return (radius - 1) * law.stiffness + rate * law.damping

    return value


@pytest.mark.parametrize(
    ("law", "start", "phase", "following", "margin"),
    [
        # The dashpot holds back, so the force vanishes first; then the depth, or the force returns.
        (KELVIN_VOIGT, (0.02, -1.0, 0.4, -0.3, FORWARD), FORWARD, SEPARATED, pressing(KELVIN_VOIGT)),
        (KELVIN_VOIGT, (0.008, -3.1, 2.7, -0.2, SEPARATED), SEPARATED, FLIGHT, lambda radius, _: radius - 1),
        (LAWS[1], (0.02, -1.0, 0.4, -0.3, FORWARD), FORWARD, FLIGHT, lambda radius, _: radius - 1),
    ],
    ids=["force", "depth", "both"],
)
def test_contact_ends_where_force_or_depth_vanishes(law, start, phase, following, margin):
    start = start_of(*start)
    time, found, undecided, rotor, amplitudes = walk(law, start, phase)
    assert (found, undecided) == (following, False)
    with mpmath.workdps(25):
        exact = Motion(law, phase, start)
        for share in (0.25, 0.5, 0.75, 1.0):
            place, _ = exact.goes_on(time * share, 1e-3)
            radius, rate = exact.state[:2]
            value = margin(radius, rate)
            assert share == 1.0 or value > 0.0
        # The root is so near that the slope gives it.
        slope = margin(1 + rate, exact.rates(exact.state)[1]) - margin(1, 0)
        assert abs(value / slope) < 1e-13
        assert displacement(rotor, 0, amplitudes) == pytest.approx(place, abs=1e-13)


def test_a_separated_plane_meets_its_wall_again_with_the_force_it_then_has():
    """Pressed out by a fast whirl, it comes back before it has left."""
    law, start = KelvinVoigt(1e4, 30.0), start_of(0.012, -4.05, 0.0, -31.0, SEPARATED)
    time, _, undecided, rotor, amplitudes = walk(law, start, SEPARATED)
    assert undecided
    work = rub_workspace(2)
    assert next_phase(rotor, np.array([SEPARATED]), 0, amplitudes, work) == BACKWARD
    rub_series(rotor, np.array([BACKWARD]), amplitudes, work)
    assert abs(work.push[0, 0]) < 1e-9
    assert work.push[0, 1] > 0.0
    assert time > 0.0


@pytest.mark.parametrize("turning", [-4.9, -3.2])
@pytest.mark.parametrize("law", LAWS, ids=str)
def test_a_slip_stops_in_the_wall_and_what_follows_is_decided_by_the_cone(law, turning):
    start = start_of(0.05, 0.5, 0.3, turning, BACKWARD if turning < -4.0 else FORWARD)
    phase = BACKWARD if turning < -4.0 else FORWARD
    ends = set()
    for friction in (0.02, 0.6):
        system = rotor_of(law, friction).system
        amplitudes = np.array(system.amplitudes(*start))
        slip = slip_in_wall(system.arrays, 0, amplitudes)
        stopped = amplitudes - system.arrays.columns[:, 0] * 1j * slip * cmath.exp(0.3j)
        stay_in_wall(system.arrays, 0, True, False, stopped)
        # A sum of speeds cancels to their rounding.
        assert abs(slip_in_wall(system.arrays, 0, stopped)) < 1e-15 * np.abs(system.arrays.exponents * stopped).sum()
        ends.add(int(next_phase(system.arrays, np.array([phase]), 0, stopped, rub_workspace(2))))
    assert ROLLING in ends


def test_a_step_ends_at_the_onset_of_a_broken_power_and_only_there():
    for law, rate in ((LAWS[2], 0.3), (LAWS[3], -0.3)):
        depth = 0.5e-9 if rate > 0.0 else 1.5e-9
        rotor, _, work = series_of(law, start_of(depth, rate, 0.2, 0.1, FORWARD), FORWARD)
        time = next_form(rotor, 0, 1e-8, work)
        assert time == pytest.approx(0.5e-9 / 0.3, rel=1e-3)
        assert work.depth[0, : ORDER + 1] @ time ** np.arange(ORDER + 1) == pytest.approx(1e-9, rel=1e-3)
    rotor, _, work = series_of(LAWS[1], start_of(0.5e-9, 0.3, 0.2, 0.1, FORWARD), FORWARD)
    assert next_form(rotor, 0, 1e-8, work) == 1e-8


@pytest.mark.parametrize("beyond", [0.0, 3e-5, 7e-5, 2e-4, 8e-4, 2e-3])
@pytest.mark.parametrize("rate", [-0.3, 0.3])
def test_a_step_goes_on_from_wherever_the_one_before_has_ended_near_the_onset(rate, beyond):
    """One that ended by chance just before the onset, on the way out or in, must not stop there for ever."""
    depth = 1e-9 * (1.0 - math.copysign(beyond, rate))
    rotor, _, work = series_of(LAWS[3], start_of(depth, rate, 0.2, 0.1, FORWARD), FORWARD)
    time = next_form(rotor, 0, 1e-8, work)
    assert time > 0.0
    assert time == pytest.approx(1e-9 * beyond / 0.3, abs=1e-13 / 0.3) or time > 1e-9
