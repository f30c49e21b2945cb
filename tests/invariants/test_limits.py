"""Limits of the parameters, in each of which theory says what must happen.

Everywhere ``U`` is the position in the co-rotating frame, ``Z = Ue^{it}`` that in the fixed one, ``W = 1 + θ̇`` the whirl
speed in the fixed frame and ``x = θ − φ``.
"""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
from compilation import sized
from machines import PAPER
from scipy.special import ellipj, ellipk

from carom.ledger import energy_ledger
from carom.outcome import Outcome, Phase
from carom.parameters import Parameters
from carom.rotors import jeffcott
from carom.trajectories import State, Trajectory, simulate

EPSILON = 2.0**-52
LONG = sized(10_000, 60)
"""Thousands of impacts, if the compiler is on."""
MANY = sized(40, 3)
EVENTS = sized(20_000, 20)
START = State(0.3 + 0.1j, 0.9 - 0.4j)


def starts(seed: int, count: int = MANY):
    """Starts spread over the clearance, at up to three clearances per ``1/Ω``."""
    random = np.random.default_rng(seed)
    for _ in range(count):
        turns = np.exp(2j * math.pi * random.random(2))
        yield State(complex(math.sqrt(random.random()) * turns[0]), complex(3.0 * random.random() * turns[1]))


def on_wall(angle: float, whirl: float, radial: float = 0.0) -> State:
    """On the wall at an angle, with the whirl speed ``W`` and an outward speed."""
    position = cmath.rect(1.0, angle)
    return State(position, complex(radial, whirl - 1.0) * position)


def segment_states(motion: Trajectory) -> tuple[np.ndarray, np.ndarray]:
    """States at the start of each segment."""
    return motion.rotor.state(motion.segment_amplitudes)


def jacobi_integral(parameters: Parameters, position: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """``J = |U̇|²/2 + (ω² − 1)|U|²/2 − ρ Re(Ūe^{iφ})``.

    Multiplying ``Ü + (γ + 2i)U̇ + (ω² − 1 + iγ)U = ρe^{iφ}`` by the conjugate of ``U̇`` and taking real parts, the term
    ``2i|U̇|²`` drops out, so ``J' = −γ Re(Ū̇(U̇ + iU))``: without damping ``J`` stays.  In an impact only ``|U̇|²`` changes.
    """
    pull = (position.conj() * cmath.exp(1j * parameters.phi)).real
    return (
        0.5 * np.abs(velocity) ** 2 + 0.5 * (parameters.omega**2 - 1.0) * np.abs(position) ** 2 - parameters.rho * pull
    )


def angular_momentum(position: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """``Im(Z̄Ż) = Im(Ū(U̇ + iU))`` about the centre of the bearing in the fixed frame."""
    return (position.conj() * (velocity + 1j * position)).imag


# ------------------------------------------------------------------------------------------------ d → 1: elastic

IDEAL = PAPER.replace(gamma=0.0, mu=0.0, d=1.0)


@pytest.mark.parametrize("omega", [0.3, 0.76, 1.7])
def test_an_ideal_rotor_keeps_its_jacobi_integral(omega):
    """With ``d = 1`` and ``μ = 0`` an impact turns ``ṙ`` round and leaves ``θ̇``, so ``|U̇|`` stays and ``J`` with it."""
    parameters = IDEAL.replace(omega=omega)
    motion = simulate(jeffcott(parameters), State(0.3 + 0.1j, 1.8 - 0.8j), LONG)
    impacts = len(motion.contacts)
    assert impacts > 0.1 * LONG
    integral = jacobi_integral(parameters, *segment_states(motion))
    # The rounding errors of an impact are some spacings of the energies.
    assert np.abs(integral - integral[0]).max() < 8 * EPSILON * impacts * (1.0 + abs(integral[0]))


def test_an_ideal_balanced_rotor_keeps_energy_and_angular_momentum():
    """Without unbalance the bearing's force points to its centre in the fixed frame, in flight and in impacts."""
    parameters = IDEAL.replace(rho=0.0)
    motion = simulate(jeffcott(parameters), State(0.3 + 0.1j, 1.4j), LONG)
    impacts = len(motion.contacts)
    position, velocity = segment_states(motion)
    energy = 0.5 * np.abs(velocity + 1j * position) ** 2 + 0.5 * parameters.omega**2 * np.abs(position) ** 2
    momentum = angular_momentum(position, velocity)
    assert impacts > 0.1 * LONG
    assert np.abs(energy / energy[0] - 1.0).max() < 8 * EPSILON * impacts
    assert np.abs(momentum / momentum[0] - 1.0).max() < 8 * EPSILON * impacts
    # So all impacts are alike: ṙ² = 2E − ω² − L².
    radial = math.sqrt(2.0 * energy[0] - parameters.omega**2 - momentum[0] ** 2)
    assert np.allclose(motion.contacts.radial_speed, radial, rtol=1e-9, atol=0)


@pytest.mark.parametrize("loss", [1e-2, 1e-4, 1e-6])
def test_nearly_elastic_impacts_cost_what_they_must(loss):
    """Without damping and friction ``J`` falls by ``(1 − d²)ṙ²/2`` in each impact, and nowhere else."""
    parameters = IDEAL.replace(d=1.0 - loss)
    motion = simulate(jeffcott(parameters), START, 0.1 * LONG)
    integral = jacobi_integral(parameters, *segment_states(motion))
    lost = np.zeros(len(integral))
    lost[1:][motion.is_impact] = 0.5 * (1.0 - parameters.d**2) * motion.contacts.radial_speed**2
    # Sliding costs nothing without friction, and a landing the energy of bounces lower than 1e-13.
    assert len(motion.contacts) > 0.01 * LONG
    assert np.abs(integral + np.cumsum(lost) - integral[0]).max() < 8 * EPSILON * len(integral) + 1e-13


def test_elastic_contact_takes_no_energy_along_the_normal():
    """With ``d = 1`` all work of contact is that of friction, its impulse times the mean slip; without friction none."""
    for mu in (0.0, 0.15):
        for start in starts(1, 5):
            log = simulate(jeffcott(PAPER.replace(d=1.0, mu=mu)), start, 100.0, max_events=EVENTS).contacts
            assert len(log) > 3
            friction = 0.5 * log.tangential_impulse * (log.slip_before + log.slip_after)
            speed = 1.0 + log.radial_speed + np.abs(log.angular_speed)
            assert np.all(np.abs(log.contact_work - friction) <= 8 * EPSILON * speed**2)
            limited = np.minimum(mu * log.normal_impulse, np.abs(log.slip_before))
            assert np.all(np.abs(np.abs(log.tangential_impulse) - limited) <= 8 * EPSILON * speed)


@pytest.mark.parametrize("gamma", [0.0, 0.1, 0.3])
def test_elastic_impacts_do_not_accumulate(gamma):
    """Bounces under a push ``N`` last ``2ṙ/N``, the next ``d`` times as long: with ``d = 1`` they do not come to an end.

    Not even in backward whirl, where ``N`` grows to ``s²`` and there are thousands of them in a turn.
    """
    for start in starts(2, 10):
        motion = simulate(jeffcott(PAPER.replace(gamma=gamma, d=1.0)), start, 500.0, max_events=EVENTS)
        assert motion.lasting_contacts == ()
        assert not motion.is_landing.any()


# ------------------------------------------------------------------------------------------------ d = 0: plastic


def test_a_plastic_impact_ends_on_the_wall_or_leaves_it_along_the_wall():
    """``ṙ⁺ = 0``.  Then ``N = ρ cos x + W² − ω²`` decides at once: pressed the rotor slides, else it flies off."""
    random = np.random.default_rng(3)
    pressed_count = 0
    for _ in range(10 * MANY):
        parameters = PAPER.replace(
            d=0.0, mu=random.uniform(0.0, 0.5), rho=random.uniform(0.0, 1.0), omega=random.uniform(0.5, 1.5)
        )
        start = on_wall(random.uniform(-3.0, 3.0), random.uniform(-2.0, 2.0), random.uniform(0.1, 1.0))
        motion = simulate(jeffcott(parameters), start, 1e-3)
        log = motion.contacts
        whirl = 1.0 + log.angular_speed_after[0]
        push = parameters.rho * math.cos(log.angle[0] - parameters.phi) + whirl**2 - parameters.omega**2
        assert abs(log.radial_speed_after[0]) <= 8 * EPSILON * (1.0 + log.radial_speed[0])
        if abs(push) < 0.01:
            continue  # within 1e-3 the push may change its sign
        pressed_count += push > 0.0
        assert bool(motion.lasting_contacts) == (push > 0.0)
        if push > 0.0:
            (contact,) = motion.lasting_contacts
            assert (contact.start, contact.end) == (0.0, motion.time)
            assert motion.forces(np.array(0.0))[0] == pytest.approx(push, rel=1e-12)
        else:
            assert abs(motion.final.position) == pytest.approx(1.0 + 0.5 * push * 1e-6, abs=1e-8)
    assert 2 * MANY < pressed_count < 8 * MANY


def test_a_plastic_contact_takes_all_energy_along_the_normal():
    log = simulate(jeffcott(PAPER.replace(d=0.0, mu=0.0)), START, 50.0).contacts
    assert len(log) > 0
    assert np.allclose(log.contact_work, -0.5 * log.radial_speed**2, rtol=1e-12, atol=0)


def test_less_and_less_restitution_leads_to_none():
    """What the bounces after a first impact change goes with the third power of ``d``.

    Pressed by ``N`` they bounce off at ``v = dṙ`` at first, to a height ``h = v²/(2N)``, and have the same impulse in all as
    the impact without restitution and the push that follows it.  Only the angle differs, by
    ``8(1 + μ²)W h v/(3N(1 − d³))`` to leading order in ``v``: friction comes at other times, and the normal has turned.
    """
    radial, mu = 0.3, 0.1
    parameters = PAPER.replace(gamma=0.0, mu=mu, rho=0.4, omega=0.5)
    whirl = 1.0 - mu * radial  # after the impact without restitution
    push = parameters.rho + whirl**2 - parameters.omega**2

    def angle(restitution: float) -> float:
        rotor = jeffcott(parameters.replace(d=restitution))
        return cmath.phase(simulate(rotor, on_wall(parameters.phi, 1.0, radial), 0.02).final.position)

    for restitution in (0.03, 0.01):
        speed = restitution * radial
        expected = 4.0 * (1.0 + mu**2) * whirl * speed**3 / (3.0 * push**2 * (1.0 - restitution**3))
        assert angle(restitution) - angle(0.0) == pytest.approx(expected, rel=0.01)


# ------------------------------------------------------------------------------------------------ μ = 0: smooth wall


def test_a_smooth_wall_leaves_the_angular_momentum():
    """Its force points to the centre, so ``Im(Z̄Ż)`` stays in an impact; and no drive feeds in."""
    for start in starts(4, 10):
        motion = simulate(jeffcott(PAPER.replace(mu=0.0)), start, sized(100, 20))
        log = motion.contacts
        assert len(log) > 3
        assert np.all(log.angular_speed_after - log.angular_speed == log.tangential_impulse)
        assert np.all(
            np.abs(log.tangential_impulse) <= 8 * EPSILON * (1.0 + log.radial_speed + np.abs(log.angular_speed))
        )
        assert not log.sticks.any() or np.all(log.slip_before[log.sticks] == 0.0)


@pytest.mark.jit_only
def test_a_smooth_wall_never_stops_the_slip():
    """``W' = −ρ sin x`` whatever the slip ``s + W``: here it swings through zero in every turn, and nothing rolls."""
    parameters = PAPER.replace(gamma=0.0, mu=0.0, omega=0.3, rho=0.6, radius_ratio=1.5)
    motion = simulate(jeffcott(parameters), on_wall(parameters.phi + math.pi, -1.3), 20.0)
    assert len(motion.lasting_contacts) > 10
    assert {contact.phase for contact in motion.lasting_contacts} == {Phase.FORWARD_SLIP, Phase.BACKWARD_SLIP}
    assert not motion.forces(np.linspace(0.0, 20.0, 300))[1].any()
    position, velocity = motion.at(np.array([contact.start for contact in motion.lasting_contacts[1:]]))
    assert np.abs(1.0 + parameters.radius_ratio + (position.conj() * velocity).imag).max() < 1e-13
    assert energy_ledger(motion).drive[-1] == 0.0


def pendulum(rho: float, amplitude: float, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Angle and speed of ``ẍ = −ρ sin x`` from rest at an amplitude: ``sin(x/2) = k cd(√ρ t)``, ``k = sin(amplitude/2)``."""
    k = math.sin(0.5 * amplitude)
    sn, cn, dn, _ = ellipj(math.sqrt(rho) * times, k * k)
    sine = k * cn / dn
    # d(cd u)/du = −(1 − k²) sn/dn².
    rate = -k * (1.0 - k * k) * math.sqrt(rho) * sn / dn**2
    return 2.0 * np.arcsin(sine), 2.0 * rate / np.sqrt(1.0 - sine**2)


@pytest.mark.parametrize("amplitude", [1e-3, 0.5, 1.5])
def test_sliding_on_a_smooth_wall_is_a_pendulum(amplitude):
    """A bead in a turning hoop: without damping and friction ``ẍ = −ρ sin x``, its period ``4K(k)/√ρ``."""
    parameters = PAPER.replace(gamma=0.0, mu=0.0, omega=0.3, rho=0.2)
    period = 4.0 * ellipk(math.sin(0.5 * amplitude) ** 2) / math.sqrt(parameters.rho)
    motion = simulate(jeffcott(parameters), on_wall(parameters.phi + amplitude, 1.0), 3.0 * period)
    assert [contact.phase for contact in motion.lasting_contacts] == [Phase.FORWARD_SLIP]
    times = np.linspace(0.0, motion.time, sized(500, 20))
    position, velocity = motion.at(times)
    angle, speed = pendulum(parameters.rho, amplitude, times)
    assert np.abs(np.angle(position * cmath.exp(-1j * parameters.phi)) - angle).max() < 1e-12
    assert np.abs((position.conj() * velocity).imag - speed).max() < 1e-12
    normal, friction = motion.forces(times)
    expected = parameters.rho * np.cos(angle) + (1.0 + speed) ** 2 - parameters.omega**2
    assert np.abs(normal - expected).max() < 1e-12
    assert not friction.any()
    # It swings for ever, and settles nowhere.
    assert simulate(motion.rotor, motion.start, motion.time, settle=True).outcome is Outcome.TIME_REACHED


@pytest.mark.jit_only
@pytest.mark.parametrize("gamma", [0.1, 1e-2, 1e-3])
def test_a_slide_along_a_smooth_wall_lasts_as_long_as_damping_is_weak(gamma):
    """Without unbalance ``W' = −γW``, and ``N = W² − ω²`` vanishes after ``ln(W₀/ω)/γ``."""
    parameters = PAPER.replace(gamma=gamma, mu=0.0, rho=0.0)
    rotor, start = jeffcott(parameters), on_wall(0.3, 2.5)
    motion = simulate(rotor, start, 1e3 / gamma, settle=True)
    (contact,) = motion.lasting_contacts
    # The whirl is a product of as many factors as there are steps, each with its rounding error.
    steps = len(motion.segment_starts)
    assert contact.end == pytest.approx(math.log(2.5 / parameters.omega) / gamma, rel=4 * EPSILON * steps + 1e-12)
    assert motion.outcome is Outcome.LEVITATED
    assert simulate(rotor, start, 1e3 / gamma, settle=True, max_events=steps // 2).outcome is Outcome.EVENT_LIMIT


# ------------------------------------------------------------------------------------------------ ρ = 0: balanced


@pytest.mark.jit_only
@pytest.mark.parametrize("turn", [0.3, 1.5, -2.9])
def test_of_a_balanced_rotor_results_turn_with_the_start(turn):
    """Nothing in the co-rotating frame has a direction then."""
    rotor = jeffcott(PAPER.replace(rho=0.0, gamma=0.05))
    around = cmath.rect(1.0, turn)
    times = np.linspace(0.0, 12.0, 200)
    for start in starts(5, 10):
        plain = simulate(rotor, start, 12.0)
        turned = simulate(rotor, State(start.position * around, start.velocity * around), 12.0)
        assert turned.segment_phases.tolist() == plain.segment_phases.tolist()
        # Rounding errors grow with the impacts: by a factor of about 1 + 2/ṙ each.
        growth = np.prod(1.0 + 2.0 / np.maximum(plain.contacts.radial_speed, 0.5))
        apart = np.array(plain.at(times)) * around - np.array(turned.at(times))
        assert np.abs(apart[:, away_from_impacts(plain, times)]).max() < 100 * EPSILON * growth


def away_from_impacts(motion: Trajectory, times: np.ndarray) -> np.ndarray:
    """Times not next to an impact, whose own time is rounded."""
    return np.all(np.abs(times[:, None] - motion.segment_starts[None, 1:]) > 1e-6, axis=1)


@pytest.mark.parametrize("gamma", [0.0, 1e-6, 0.1, 1.52, 4.0])
def test_angular_momentum_of_a_balanced_rotor_decays_like_its_damping(gamma):
    """``Z̈ + γŻ + ω²Z = 0`` gives ``(Im Z̄Ż)' = −γ Im Z̄Ż`` in flight, under-, over- and critically damped alike."""
    rotor = jeffcott(PAPER.replace(rho=0.0, gamma=gamma, mu=0.0))
    for start in starts(6, 10):
        motion = simulate(rotor, start, 10.0)
        times = np.linspace(0.0, 10.0, 100)
        momentum = angular_momentum(*motion.at(times))
        # A smooth wall does not change it either, nor does sliding along it: W' = −γW.
        expected = momentum[0] * np.exp(-gamma * times)
        size = 1.0 + abs(start.velocity)
        assert np.abs(momentum - expected).max() < 50 * EPSILON * size * (1 + len(motion.contacts))


def test_a_damped_balanced_rotor_comes_to_rest_in_the_centre():
    rotor = jeffcott(PAPER.replace(rho=0.0, gamma=0.3))
    assert rotor.equilibrium == 0.0
    for start in starts(7, 10):
        assert simulate(rotor, start, 1e4, settle=True).outcome is Outcome.LEVITATED
        assert abs(simulate(rotor, start, 300.0).final.position) < 1e-12


def forward_slide_time(parameters: Parameters, start: float, end: float) -> float:
    """Time of sliding forward from whirl ``start`` down to ``end`` without unbalance.

    ``W' = −γW − μ(W² − ω²) = −μ(W − w₊)(W − w₋)`` with the roots ``w±`` of ``μW² + γW − μω²``, hence
    ``t = ln[(W₀ − w₊)(W − w₋)/((W − w₊)(W₀ − w₋))]/(μ(w₊ − w₋))`` up to the sign both logarithms share.
    """
    gamma, mu = parameters.gamma, parameters.mu
    root = math.sqrt(gamma**2 + 4.0 * mu**2 * parameters.omega**2)
    upper, lower = (-gamma + root) / (2.0 * mu), (-gamma - root) / (2.0 * mu)

    def level(whirl: float) -> float:
        return math.log((whirl - upper) / (whirl - lower))

    return (level(start) - level(end)) / (mu * (upper - lower))


def test_a_balanced_slide_ends_where_the_whirl_is_too_slow_to_press():
    """``N = W² − ω²`` vanishes at ``W = ω``, at a time known in closed form; the rotor lifts off and does not come back."""
    parameters = PAPER.replace(rho=0.0, gamma=0.3)
    rotor = jeffcott(parameters)
    for whirl in (0.8, 1.5, 20.0):
        for angle in (0.0, 2.0):
            motion = simulate(rotor, on_wall(angle, whirl), 1e3, settle=True)
            (contact,) = motion.lasting_contacts
            assert contact.phase is Phase.FORWARD_SLIP
            # Where N goes through zero its rounding error shifts the time by that over N' = 2WW'.
            assert contact.end == pytest.approx(
                forward_slide_time(parameters, whirl, parameters.omega), rel=1e-12, abs=1e-12
            )
            assert motion.outcome is Outcome.LEVITATED
            assert len(motion.contacts) == 0


# ------------------------------------------------------------------------------------------------ γ → 0: undamped


@pytest.mark.jit_only
@pytest.mark.parametrize("mu", [0.0, 0.15, 1.0])
def test_undamped_flight_keeps_the_jacobi_integral(mu):
    """Between impacts, whatever these do."""
    parameters = PAPER.replace(gamma=0.0, mu=mu)
    motion = simulate(jeffcott(parameters), START, 50.0)
    leaving, arriving = segment_states(motion), motion.rotor.state(motion.arrivals)
    flying = motion.segment_phases[:-1] == Phase.FLIGHT
    assert flying.sum() > 5
    before = jacobi_integral(parameters, leaving[0][:-1], leaving[1][:-1])
    after = jacobi_integral(parameters, *arriving)
    size = 1.0 + np.abs(leaving[1][:-1]) ** 2
    assert np.all(np.abs(after - before)[flying] < 64 * EPSILON * size[flying])


@pytest.mark.parametrize("mu", [0.0, 0.15])
def test_little_damping_is_a_little_change(mu):
    """Flights depend analytically on ``γ``, and transversal impacts too: the change of a motion is linear in ``γ``."""
    times = np.array([0.5, 3.0, 7.0])

    def positions(gamma: float) -> np.ndarray:
        motion = simulate(jeffcott(PAPER.replace(gamma=gamma, mu=mu)), START, 8.0)
        assert len(motion.contacts) >= 4
        return motion.position(times)

    undamped = positions(0.0)
    apart = [np.abs(positions(gamma) - undamped) for gamma in (1e-5, 1e-6, 1e-7, 1e-9)]
    assert np.allclose(apart[0] / apart[1], 10.0, rtol=1e-3)
    assert np.allclose(apart[1] / apart[2], 10.0, rtol=1e-4)
    # From below as from above.
    assert np.allclose(positions(-1e-7) - undamped, undamped - positions(1e-7), rtol=1e-4, atol=1e-12)
    assert apart[3].max() < 1e-6


def flight_reach(motion: Trajectory) -> float:
    """Largest radius that the motion can reach on its last flight: the sum of the moduli of its modes."""
    parameters, rotor = motion.rotor.parameters, motion.rotor
    # Without damping and unbalance apart, U − U* = a e^{−i(1−ω)t} + b e^{−i(1+ω)t}.
    offset, speed = motion.final.position - rotor.equilibrium, motion.final.velocity
    slow, fast = -1j * (1.0 - parameters.omega), -1j * (1.0 + parameters.omega)
    first = (speed - fast * offset) / (slow - fast)
    return abs(rotor.equilibrium) + abs(first) + abs(offset - first)


def test_an_undamped_balanced_rotor_ends_grazing():
    """Impacts take energy, flights do not.

    In flight the centre runs through an ellipse of half-axes ``A > B`` about the bearing's.  Each impact that finds
    ``A > 1`` lowers it, so in the end ``A = 1``: the ellipse touches the wall for ever, and no finite precision decides
    whether it strikes.  That is the outcome ``grazing``, and not a fault.
    """
    rotor = jeffcott(PAPER.replace(gamma=0.0, rho=0.0, mu=0.15, omega=1.3, d=0.5))
    for start in (State(0.5, 2.0 + 1.0j), State(0.1j, 1.5), State(-0.4 + 0.2j, -2.0 - 0.3j)):
        motion = simulate(rotor, start, 1e5, settle=True)
        assert motion.outcome is Outcome.GRAZING
        assert len(motion.contacts) > 3
        assert motion.contacts.radial_speed[-1] < 1e-5
        assert flight_reach(motion) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.jit_only
def test_an_undamped_unbalanced_rotor_touches_ever_more_rarely():
    """With unbalance a flight has two frequencies, and comes near its reach only now and then.

    Impacts lower the reach towards 1 and become rarer without end.  Nothing settles: the outcome is ``time-reached``.
    """
    rotor = jeffcott(PAPER.replace(gamma=0.0, omega=math.sqrt(3.6), d=0.3))
    start = State(0.5, 2.0 + 1.0j)
    short, long = (simulate(rotor, start, until, settle=True) for until in (1e2, 1e5))
    for motion in (short, long):
        assert motion.outcome is Outcome.TIME_REACHED
        assert flight_reach(motion) > 1.0
    assert flight_reach(long) - 1.0 < 0.1 * (flight_reach(short) - 1.0)
    waits = np.diff(long.contacts.time)
    assert waits[-1] > 10.0 * np.median(waits)
    assert long.contacts.radial_speed[-1] < 0.1 * np.median(long.contacts.radial_speed)


@pytest.mark.jit_only
@pytest.mark.parametrize("gamma", [1e-3, 1e-5])
@pytest.mark.parametrize("rho", [0.0, 3 / 7])
def test_with_the_least_damping_the_same_motions_settle(gamma, rho):
    """Then the reach falls below 1 for good, within a few times ``1/γ``."""
    rotor = jeffcott(PAPER.replace(gamma=gamma, rho=rho, omega=1.9, d=0.3))
    for start in (State(0.5, 2.0 + 1.0j), State(0.1j, 1.5), State(-0.4 + 0.2j, -2.0 - 0.3j)):
        motion = simulate(rotor, start, 1e3 / gamma, settle=True)
        assert motion.outcome is Outcome.LEVITATED
        assert motion.time < 20.0 / gamma


# ------------------------------------------------------------------------------------------------ s → ∞, s → 0


def test_slip_of_a_huge_rotor_never_reverses():
    """Impacts are then ``U̇⁺ = U̇⁻ − qṙ⁻U`` with ``q = (1 + d)(1 + iμ)``, whatever ``s``."""
    q = (1.0 + PAPER.d) * complex(1.0, PAPER.mu)
    motions = [simulate(jeffcott(PAPER.replace(radius_ratio=ratio)), START, 30.0) for ratio in (1e3, 1e6, 1e9)]
    for motion in motions:
        before, after = motion.rotor.state(motion.arrivals), motion.rotor.state(motion.segment_amplitudes[1:])
        normal = before[0] / np.abs(before[0])
        expected = before[1] - q * (normal.conj() * before[1]).real * normal
        assert len(motion.contacts) > 10
        assert np.abs(after[1] - expected).max() < 1e-14
        assert not motion.contacts.sticks.any()
    assert np.array_equal(motions[0].segment_amplitudes, motions[1].segment_amplitudes)
    assert np.array_equal(motions[0].segment_amplitudes, motions[2].segment_amplitudes)


@pytest.mark.parametrize("ratio", [1e-3, 0.01, 0.1])
def test_a_tiny_rotor_is_held_by_the_wall(ratio):
    """Its surface hardly moves, so an impact that stops the slip leaves ``W = −s``: the centre all but stops along the wall."""
    rotor = jeffcott(PAPER.replace(mu=2.0, radius_ratio=ratio))
    sticking = 0
    for start in starts(8, 10):
        log = simulate(rotor, start, 20.0).contacts
        stuck = log.sticks
        sticking += int(stuck.sum())
        assert np.allclose(1.0 + log.angular_speed_after[stuck], -ratio, rtol=0, atol=1e-14)
        slipping = np.abs(log.slip_before) > 2.0 * (1.0 + PAPER.d) * log.radial_speed
        assert np.array_equal(stuck, ~slipping)
    assert sticking > 20


@pytest.mark.parametrize("ratio", [1e-3, 0.1, 0.3])
@pytest.mark.parametrize("mu", [0.2, 10.0])
def test_a_tiny_rotor_rolls_until_it_slips_or_leaves(ratio, mu):
    """Rolling is ``x = x₀ − (1 + s)t`` with ``N = s² − ω² + ρ cos x`` and the friction force ``F = ρ sin x − γs``.

    It ends where ``N = 0``, or before where ``|F| = μN``.  Starting where the unbalance points it runs towards
    negative ``x``, so the first is ``−F = μN``: ``−ρ sin x + γs = μ(s² − ω² + ρ cos x)``.
    """
    parameters = PAPER.replace(gamma=0.1, omega=0.3, radius_ratio=ratio, mu=mu)
    rho, drop = parameters.rho, ratio**2 - parameters.omega**2
    # ρ(sin x + μ cos x) = γs − μ(s² − ω²), and sin x + μ cos x = √(1 + μ²) sin(x + arctan μ).
    share = (parameters.gamma * ratio - mu * drop) / (rho * math.hypot(1.0, mu))
    end = math.asin(share) - math.atan(mu)
    assert end < 0.0
    motion = simulate(jeffcott(parameters), on_wall(parameters.phi, -ratio), 10.0)
    first = motion.lasting_contacts[0]
    assert first.phase is Phase.ROLLING
    assert first.end == pytest.approx(-end / (1.0 + ratio), rel=1e-12)
    times = np.linspace(0.0, first.end, 50, endpoint=False)
    position, velocity = motion.at(times)
    assert np.abs((position.conj() * velocity).imag + 1.0 + ratio).max() < 1e-14
    normal, friction = motion.forces(times)
    x = -(1.0 + ratio) * times
    assert np.abs(normal - (drop + rho * np.cos(x))).max() < 1e-13
    assert np.abs(friction - (rho * np.sin(x) - parameters.gamma * ratio)).max() < 1e-13
    following = motion.segment_phases[np.flatnonzero(motion.segment_phases != Phase.ROLLING)[-1]]
    assert following != Phase.ROLLING


# ------------------------------------------------------------------------------------------------ μ → ∞: rough wall


@pytest.mark.jit_only
@pytest.mark.parametrize("ratio", [0.5, 5.0])
def test_a_rough_wall_stops_the_slip_in_every_impact(ratio):
    """Every impact with ``μ(1 + d)ṙ > |v|`` does; with ``μ = 10`` all but glancing ones."""
    rotor = jeffcott(PAPER.replace(mu=10.0, radius_ratio=ratio))
    count = 0
    for start in starts(9, 10):
        log = simulate(rotor, start, 20.0).contacts
        steep = 10.0 * (1.0 + PAPER.d) * log.radial_speed > np.abs(log.slip_before)
        count += int(steep.sum())
        assert np.array_equal(log.sticks, steep)
        assert np.abs(log.slip_after[steep]).max(initial=0.0) < 1e-13
        # After the first the rotor keeps near rolling: friction turns the rest of its motion to rolling too.
        assert np.all(np.abs(log.slip_after) <= np.abs(log.slip_before))
    assert count > 20


# ------------------------------------------------------------------------------------------------ strong damping


@pytest.mark.parametrize("gamma", [1.52, 1.52 * (1 + 1e-7), 3.0, 30.0])
def test_an_overdamped_rotor_swings_out_once(gamma):
    """From rest in the centre ``Z = v(e^{−at} − e^{−bt})/(b − a)`` with ``a, b = (γ ∓ √(γ² − 4ω²))/2``.

    It turns back at ``t = ln(b/a)/(b − a)``, where ``|Z| = (v/b)(a/b)^{a/(b−a)}``.  So the speed that just reaches the wall
    is known, and the rotor that does not reach it the first time never does.
    """
    parameters = PAPER.replace(rho=0.0, gamma=gamma)
    rotor = jeffcott(parameters)
    root = math.sqrt(max(gamma**2 - 4.0 * parameters.omega**2, 0.0))
    b = 0.5 * (gamma + root)
    a = parameters.omega**2 / b
    share = math.exp(-1.0) if root == 0.0 else math.exp(-a / root * math.log1p(root / a))
    speed = b / share
    # Z' = v in the fixed frame is U' = v in the co-rotating one, at the centre.
    below, above = (simulate(rotor, State(0j, speed * (1.0 + change)), 1e4, settle=True) for change in (-1e-6, 1e-6))
    assert below.outcome is Outcome.LEVITATED
    assert len(below.contacts) == 0
    assert len(above.contacts) > 0
    turn = math.log1p(root / a) / root if root > 0.0 else 1.0 / b
    # |Z| lies above the wall for a time that goes with the square root of the excess.
    assert above.contacts.time[0] == pytest.approx(turn, rel=0.01)


def test_strong_damping_stops_a_rebound_at_once():
    """After an impact with ``ṙ`` the rotor leaves at ``dṙ``, and where ``γ`` is large gets as far as ``dṙ/γ``."""
    for gamma in (100.0, 1000.0):
        parameters = PAPER.replace(gamma=gamma, omega=0.1, rho=0.0)
        motion = simulate(jeffcott(parameters), on_wall(0.0, 0.0, 1.0), 20.0 / gamma)
        gap = 1.0 - abs(motion.final.position)
        assert gap == pytest.approx(parameters.d / gamma, rel=0.05)
