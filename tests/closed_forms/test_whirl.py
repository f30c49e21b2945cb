"""Closed forms of backward whirl, against simulated motions and against the source machine."""

import cmath
import math

import numpy as np
import pytest
from compilation import sized
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from machines import PAPER

from carom.base.outcome import Outcome, Phase
from carom.closed_forms import fading_speed, find_equilibria, rolling, runaway_speed
from carom.closed_forms.whirl import hastening_speed
from carom.models import jeffcott
from carom.motions import State, settle, simulate
from carom.parameters import Parameters

damped = st.builds(
    Parameters,
    gamma=st.one_of(st.just(1e-6), st.floats(1e-3, 2.0)),
    omega=st.floats(0.2, 2.0),
    rho=st.floats(0.0, 2.0),
    phi=st.floats(-3.0, 3.0),
    mu=st.floats(0.05, 0.8),
    d=st.floats(0.0, 0.95),
    radius_ratio=st.floats(2.0, 60.0),
)


def on_wall(angle: float, whirl: float) -> State:
    """On the wall at an angle, with the whirl speed 1 + θ' of the fixed frame."""
    position = complex(math.cos(angle), math.sin(angle))
    return State(position, 1j * (whirl - 1.0) * position)


def whirl_speeds(motion, count=400):
    position, velocity = motion.at(np.linspace(0.0, motion.time, count))
    return 1.0 + (position.conj() * velocity).imag / np.abs(position) ** 2


# ------------------------------------------------------------------------------------------------ runaway


@pytest.mark.jit_only
@settings(max_examples=60, deadline=None)
@given(parameters=damped, angle=st.floats(-3.2, 3.2), backward=st.booleans())
def test_without_friction_negative_damping_hastens_whirl_for_ever(parameters, angle, backward):
    rotor = jeffcott(parameters.replace(gamma=-max(parameters.gamma, 0.05), mu=0.0))
    start = on_wall(angle, 1.001 * hastening_speed(rotor) * (-1.0 if backward else 1.0))

    # As long as it is affordable to follow it: the speed grows like e^{|γ|t}.
    motion = simulate(rotor, start, 3.0 / abs(rotor.parameters.gamma))

    assert motion.outcome is Outcome.TIME_REACHED
    # Beyond the speed of rolling the slip is backward; the contact goes on.
    assert [0.0, *(each.end for each in motion.lasting_contacts)] == [
        *(each.start for each in motion.lasting_contacts),
        motion.time,
    ]
    assert (np.diff(np.abs(whirl_speeds(motion))) > 0.0).all()
    # That it is proven ends it at once.
    ending = settle(rotor, State([start.position], [start.velocity]), max_events=2)
    assert ending.outcomes[0] == (Outcome.BACKWARD_WHIRL if backward else Outcome.FORWARD_RUB)
    assert ending.times[0] == 0.0


@pytest.mark.jit_only
@settings(max_examples=60, deadline=None)
@given(parameters=damped, angle=st.floats(-3.2, 3.2), share=st.floats(0.001, 0.999))
def test_whirl_beyond_the_certain_speed_gains_speed_until_it_rolls(parameters, angle, share):
    rotor = jeffcott(parameters)
    runaway = runaway_speed(rotor)
    assume(runaway.certain * 1.001 < runaway.rolling_speed)
    speed = runaway.certain + share * (runaway.rolling_speed - runaway.certain)

    motion = simulate(rotor, on_wall(angle, -speed), 1e4, settle=True)

    assert motion.outcome is Outcome.ROLLING
    slides = [contact for contact in motion.lasting_contacts if contact.phase is not Phase.ROLLING]
    assert {contact.phase for contact in slides} <= {Phase.FORWARD_SLIP}
    assert not motion.is_impact.any()
    speeds = -whirl_speeds(motion)
    assert (np.diff(speeds) > -1e-9 * speeds[:-1]).all()


@pytest.mark.jit_only
@settings(max_examples=40, deadline=None)
@given(parameters=damped, angle=st.floats(-3.2, 3.2))
def test_rotor_faster_than_rolling_slows_to_it_where_rolling_holds(parameters, angle):
    rotor = jeffcott(parameters)
    assume(runaway_speed(rotor).reaches_rolling)

    motion = simulate(rotor, on_wall(angle, -1.3 * parameters.radius_ratio), 1e4, settle=True)

    assert motion.outcome is Outcome.ROLLING
    assert motion.segment_phases[1, 0] == Phase.BACKWARD_SLIP


def test_bound_is_reached_at_the_worst_angle():
    # At sin x + μ cos x = −√(1 + μ²) the whirl at the certain speed neither gains nor loses.
    rotor = jeffcott(PAPER)
    worst = PAPER.phi + math.atan2(-1.0, -PAPER.mu)
    speed = runaway_speed(rotor).certain

    def gain(angle, whirl_speed):
        motion = simulate(rotor, on_wall(angle, -whirl_speed), 1e-5)
        return -(whirl_speeds(motion, 2)[1] + whirl_speed) / 1e-5

    assert abs(gain(worst, speed)) < 1e-4
    assert gain(worst, 0.99 * speed) < -1e-3
    assert gain(worst + math.pi, 0.99 * speed) > 0.1


def test_average_threshold_is_the_simulated_one_without_unbalance():
    rotor = jeffcott(PAPER.replace(rho=0.0, gamma=0.3))
    threshold = runaway_speed(rotor).average

    outcomes = [
        simulate(rotor, on_wall(0.0, -factor * threshold), 1e4, settle=True).outcome for factor in (0.999, 1.001)
    ]

    assert outcomes == [Outcome.LEVITATED, Outcome.ROLLING]
    assert runaway_speed(rotor).certain == pytest.approx(threshold, rel=1e-15)


# ------------------------------------------------------------------------------------------------ rolling


@pytest.mark.jit_only
@settings(max_examples=60, deadline=None)
@given(parameters=damped, angle=st.floats(-3.2, 3.2))
def test_forces_of_rolling(parameters, angle):
    rotor = jeffcott(parameters)
    roll = rolling(rotor)
    assume(roll.holds)

    motion = simulate(rotor, on_wall(angle, -roll.speed), 2.0 * roll.period)

    assert {contact.phase for contact in motion.lasting_contacts} == {Phase.ROLLING}
    normal, friction = motion.forces(np.linspace(0.0, motion.time, 2001))
    # 1000 samples a turn miss extremes by at most ρ(π/1000)²/2; forces are differences of terms of the size of s².
    rounding = 1e-11 * roll.speed**2
    missed = parameters.rho * 5e-6 + rounding
    assert normal.min() == pytest.approx(roll.least_force, abs=missed)
    assert normal.max() == pytest.approx(roll.largest_force, abs=missed)
    assert np.abs(friction).max() == pytest.approx(roll.largest_friction, abs=missed)
    assert (np.abs(friction) - roll.needed_friction * normal).max() <= rounding


@pytest.mark.parametrize(("factor", "rolls_on"), [(0.9999, True), (1.0001, False)])
def test_rolling_ends_at_the_largest_damping(factor, rolls_on):
    parameters = PAPER.replace(radius_ratio=5.0, rho=1.0, gamma=0.3)
    limit = rolling(jeffcott(parameters)).largest_damping
    rotor = jeffcott(parameters.replace(gamma=factor * limit))

    motion = simulate(rotor, on_wall(0.0, -5.0), 2.0 * rolling(rotor).period)

    phases = {contact.phase for contact in motion.lasting_contacts}
    assert phases == ({Phase.ROLLING} if rolls_on else {Phase.ROLLING, Phase.FORWARD_SLIP})
    assert rolling(rotor).holds == rolls_on


@pytest.mark.jit_only
def test_interrupted_rolling_lives_between_the_limits_only():
    parameters = PAPER.replace(radius_ratio=5.0, rho=1.0)
    roll = rolling(jeffcott(parameters))
    lasting = {}
    for share in (0.1, 1.001):
        gamma = roll.largest_damping + share * (roll.damping_bound - roll.largest_damping)
        motion = simulate(jeffcott(parameters.replace(gamma=gamma)), on_wall(0.0, -5.0), 1e3)
        lasting[share] = {contact.phase for contact in motion.lasting_contacts if contact.end > 990.0}

    assert lasting[0.1] == {Phase.ROLLING, Phase.FORWARD_SLIP}
    assert Phase.ROLLING not in lasting[1.001]


@pytest.mark.jit_only
def test_no_backward_whirl_repeats_beyond_the_bound_of_damping():
    """Random rotors, small ones that could lose contact while they roll among them, from all speeds of backward whirl."""
    random = np.random.default_rng(11)
    kept = 0
    for case in range(40):
        speed, omega, mu = random.uniform(0.3, 6.0), random.uniform(0.1, 1.2), random.uniform(0.05, 0.8)
        machine = PAPER.replace(
            omega=omega, mu=mu, rho=random.uniform(0.0, 2.0), d=random.uniform(0.0, 0.9), radius_ratio=speed
        )
        bound = rolling(jeffcott(machine)).damping_bound
        places = np.exp(1j * random.uniform(0.0, 2.0 * math.pi, 50))
        whirl = -random.uniform(0.0, 2.0 * speed, 50)
        for factor in (0.3, 1.001):
            rotor = jeffcott(machine.replace(gamma=max(factor * bound, 0.02)))
            outcomes = settle(rotor, State(places, 1j * (whirl - 1.0) * places), until=2e3).outcomes
            held = np.isin(outcomes, (Outcome.ROLLING, Outcome.BACKWARD_WHIRL)).sum()
            kept += held if factor < 1.0 else 0
            assert factor < 1.0 or held == 0, (case, machine)
    assert kept > 100


@pytest.mark.jit_only
def test_sliding_forward_goes_over_to_the_rub_or_leaves_the_wall():
    """Whatever repeats while it slides forward is the synchronous rub (``docs/theory/lasting-contact.md``)."""
    random = np.random.default_rng(12)
    slid = 0
    for _ in range(150):
        machine = PAPER.replace(
            gamma=random.uniform(0.01, 1.0),
            omega=random.uniform(0.0, 0.9),
            rho=random.uniform(0.2, 1.5),
            mu=random.uniform(0.0, 0.8),
        )
        rotor = jeffcott(machine)
        motion = simulate(rotor, on_wall(random.uniform(-3.0, 3.0), random.uniform(0.0, 3.0)), 3e3)
        last = motion.lasting_contacts[-1] if motion.lasting_contacts else None
        if last is None or last.phase is not Phase.FORWARD_SLIP or last.start > 500.0 or last.end < motion.time:
            continue
        slid += 1
        assert abs(motion.final.velocity) < 1e-6
        assert min(abs(motion.final.position - entry.position) for entry in find_equilibria(rotor)) < 1e-6
    assert slid > 40


NEARLY_ELASTIC = Parameters(
    gamma=0.05071695, omega=0.77359473, rho=0.20472252, phi=1.08396837, mu=0.34598246, d=0.9999, radius_ratio=99.134234
)


def drawn(random: np.random.Generator) -> Parameters:
    """A machine with all kinds of walls, whose rolling need not last."""
    return Parameters(
        gamma=random.choice([0.0, 10.0 ** random.uniform(-4.0, 0.0)]),
        omega=10.0 ** random.uniform(-0.7, 0.5),
        rho=10.0 ** random.uniform(-3.0, 0.0),
        phi=random.uniform(-3.0, 3.0),
        mu=random.uniform(0.0, 1.0),
        d=random.choice([1.0, 1.0 - 10.0 ** random.uniform(-5.0, 0.0), random.uniform()]),
        radius_ratio=10.0 ** random.uniform(0.1, 2.5),
    )


@pytest.mark.parametrize("seed", range(sized(8, 1, 60)))
def test_bounces_up_to_the_fading_speed_stop_their_slip_and_fade(seed):
    random, tried = np.random.default_rng(seed), 0
    while tried < sized(8, 1):
        parameters = drawn(random)
        fastest = fading_speed(parameters)
        if not fastest:
            continue
        tried += 1
        for speed in (fastest, fastest * 10.0 ** random.uniform(-3.0, 0.0)):
            wall = cmath.exp(1j * random.uniform(-3.0, 3.0))
            start = State(wall, complex(-speed, -1.0 - parameters.radius_ratio) * wall)
            motion = simulate(jeffcott(parameters), start, 1e4, max_events=sized(300, 50))
            log = motion.log_of(motion.is_impact)
            event_amplitudes = log.radial_speed[log.radial_speed > 1e-6]  # far above rounding
            slip = log.angular_speed[: len(event_amplitudes)] + 1.0 + parameters.radius_ratio
            assert (np.abs(slip) <= parameters.mu * (1.0 + parameters.d) * event_amplitudes).all()
            # The bounds are strict; 1e-10 is a rounding error of speeds of 1 + θ̇ of some hundreds.
            assert (np.diff(parameters.d * event_amplitudes, prepend=speed) < 1e-10 * speed).all()


def test_where_nothing_is_proven():
    assert fading_speed(PAPER) > 0.0
    assert fading_speed(PAPER.replace(mu=0.0)) == 0.0
    assert fading_speed(PAPER.replace(gamma=-0.01)) == 0.0
    slow = PAPER.replace(radius_ratio=1.0)  # rolls off the wall
    assert not rolling(slow).holds
    assert fading_speed(slow) == 0.0
    # An elastic wall takes nothing: damping has to outweigh the unbalance.
    elastic = NEARLY_ELASTIC.replace(d=1.0)
    assert fading_speed(elastic) > 1.0
    assert fading_speed(elastic.replace(gamma=1e-4)) == 0.0
    assert fading_speed(elastic.replace(gamma=1e-4, rho=1e-4)) > 1.0
    assert fading_speed(NEARLY_ELASTIC.replace(gamma=1e-4)) > 0.0


def test_bounces_of_an_elastic_wall_fade_at_the_rate_of_the_damping():
    """Averaged over a turn ``v̇ = −γ(1/3 + 2s²/(3N)) v`` with ``N = s² − ω²``, to the order of the height of a bounce."""
    at = NEARLY_ELASTIC.replace(d=1.0)
    start = State(1.0, complex(-0.1, -1.0 - at.radius_ratio))
    motion = simulate(jeffcott(at), start, sized(200, 2) / 100.0)
    log = motion.log_of(motion.is_impact)
    push = at.radius_ratio**2 - at.omega**2
    rate = at.gamma * (1.0 / 3.0 + 2.0 * at.radius_ratio**2 / (3.0 * push))
    assert np.log(0.1 / log.radial_speed[-1]) / log.time[-1] == pytest.approx(rate, rel=0.02)
