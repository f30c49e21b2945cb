"""Where motions end: the proof that a rotor levitates, the search for what recurs, and that what has settled stays so."""

import cmath
import math

import numpy as np
import pytest
from compilation import sized
from machines import PAPER, random_parameters

from carom.base.outcome import Outcome
from carom.core.layout import RECURRENCE_RTOL, rotor_record, workspace
from carom.core.settling import approaches_turn, levitates, memory, near_rub, recurs, reset_rub, same_state
from carom.models import Rotor, jeffcott
from carom.motions import State, simulate
from carom.parameters import Parameters

MANY = sized(100, 20, 300)


# ------------------------------------------------------------------------------------------------ levitation


def accepted(rotor: Rotor, amplitudes: np.ndarray) -> bool:
    return bool(levitates(rotor.system.arrays, amplitudes, workspace(len(amplitudes))))


def dense_reach(rotor: Rotor, amplitudes: np.ndarray) -> float:
    """Largest radius of a flight until what is left of it is small, at samples that miss maxima by far less than 1e-3."""
    fastest, slowest = np.abs(rotor.system.exponents).max(), -rotor.system.exponents.real.max()
    times = np.arange(0.0, min(10.0 / slowest, 2e4 / fastest), 0.02 / fastest)
    return float(np.abs(rotor.system.state(rotor.system.fly(amplitudes, times))[0]).max())


def edge_of_acceptance(rotor: Rotor, direction: np.ndarray) -> float:
    """Largest multiple of a disturbance of the contact-free equilibrium that is accepted."""
    low, high = 0.0, 1.0
    while accepted(rotor, high * direction):
        high *= 2.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if accepted(rotor, middle * direction) else (low, middle)
    return low


def levitating_rotors(seed: int, count: int):
    """Rotors with an equilibrium inside the wall, under- and overdamped and nearly critical, and a direction of disturbance."""
    random = np.random.default_rng(seed)
    while count:
        rotor = jeffcott(random_parameters(random))
        if abs(rotor.equilibrium) < 0.99:
            count -= 1
            yield rotor, random.normal(size=2) + 1j * random.normal(size=2)


@pytest.mark.jit_only
def test_what_is_accepted_never_touches():
    """At the very edge of acceptance, so that any slack on the wrong side would show."""
    for rotor, direction in levitating_rotors(1, MANY):
        edge = edge_of_acceptance(rotor, direction)
        for share in (1.0, 0.9, 0.1):
            assert dense_reach(rotor, share * edge * direction) < 1.0
        assert not accepted(rotor, (1.0 + 1e-6) * edge * direction)


def test_whatever_has_died_down_enough_is_accepted():
    for rotor, direction in levitating_rotors(2, MANY):
        gap = 1.0 - abs(rotor.equilibrium)
        # |y − U*| is at most |a| + |b| times the largest of |∫e^{…}|, which is 1/e of the inverse decay or less.
        decay = -rotor.system.exponents.real.max()
        largest = abs(direction[1]) + abs(direction[0]) / (math.e * decay)
        assert accepted(rotor, 0.9 * gap / largest * direction)
        assert accepted(rotor, 0.0 * direction)


@pytest.mark.jit_only
@pytest.mark.parametrize("ratio", [1.0, 2.0, 3.0])
def test_with_little_damping_the_proof_is_nearly_sharp(ratio):
    """Where the frequencies are far from commensurate, their phases have time to meet: what is refused would touch."""
    golden = (0.5 * (1.0 + math.sqrt(5.0))) ** ratio
    omega = (golden - 1.0) / (golden + 1.0)  # so that (1 + ω)/(1 − ω) is that power of the golden ratio
    rotor = jeffcott(PAPER.replace(gamma=1e-4, omega=omega, rho=0.3 * (1.0 - omega**2)))
    random = np.random.default_rng(3)
    for direction in random.normal(size=(10, 2)) + 1j * random.normal(size=(10, 2)):
        edge = edge_of_acceptance(rotor, direction)
        assert dense_reach(rotor, edge * direction) > 0.98


@pytest.mark.jit_only
def test_a_motion_that_comes_back_is_told_in_good_time():
    """Not before the last touch, and as soon as the free flight has lost what the bound takes for granted."""
    rotor = jeffcott(PAPER.replace(gamma=0.4))
    decay = -rotor.system.exponents.real.max()
    for angle in np.linspace(0.0, 6.0, 10):
        motion = simulate(rotor, State(rotor.equilibrium, cmath.rect(1.0, angle)), 1e4, settle=True)
        assert motion.outcome is Outcome.LEVITATED
        last = motion.contacts.time[-1] if len(motion.contacts) else 0.0
        assert last <= motion.time < last + 10.0 / decay
        later = simulate(rotor, motion.final, 50.0 / decay)
        assert len(later.contacts) == 0
        assert later.lasting_contacts == ()
        assert later.final.position == pytest.approx(rotor.equilibrium, abs=1e-6)


def test_without_decay_or_room_nothing_is_accepted():
    still = np.zeros(2, complex)
    assert not accepted(jeffcott(PAPER.replace(gamma=-0.1, rho=0.1)), still)
    assert not accepted(jeffcott(PAPER.replace(gamma=0.01)), still)  # U* outside the wall
    assert accepted(jeffcott(PAPER.replace(gamma=0.0, rho=0.1)), still)  # an undamped one may rest in its equilibrium


def test_every_plane_has_to_have_room():
    arrays = jeffcott(PAPER.replace(rho=0.1, gamma=0.3)).system.arrays
    names = ("offsets", "rows", "friction", "restitution", "surface_speed")
    twice = {name: np.repeat(arrays[name], 2, axis=0) for name in names}
    shared = {"exponents": arrays.exponents, "driven": arrays.driven, "columns": np.repeat(arrays.columns, 2, axis=1)}
    small = np.array([0.1, 0.1], complex)
    for offset, expected in ((0.3, True), (0.9, False)):
        twice["offsets"][1] = offset
        assert bool(levitates(rotor_record(**twice, **shared), small, workspace(2))) is expected


# ------------------------------------------------------------------------------------------------ recurrence


def states(values: np.ndarray) -> np.ndarray:
    """States of two modes, shape (n, 2), from numbers."""
    return np.stack([values, 1j * values + 0.5], axis=1).astype(complex)


def fed(sequence: np.ndarray, patience: int = 1_000_000) -> tuple[int, int]:
    """Feed states to the search: how many it took to settle (0: none), and the period found."""
    recollection = memory(sequence.shape[1], patience=patience)
    for place, state in enumerate(sequence):
        if recurs(recollection, state):
            return place + 1, int(recollection.period)
    return 0, int(recollection.period)


@pytest.mark.parametrize("period", [1, 2, 3, 4, 5, 7, 8, 12, 31, 64, 100])
@pytest.mark.parametrize("transient", [0, 1, 6, 50])
def test_periods_are_found_and_are_the_least(period, transient):
    random = np.random.default_rng([period, transient])
    cycle = random.normal(size=period)
    sequence = np.concatenate([random.normal(size=transient), np.tile(cycle, 20 + 8 * (transient + 10) // period)])
    taken, found = fed(states(sequence))
    assert found == period
    # The reference is renewed at 1, 2, 4, … impacts: it lies on the cycle, and far enough apart, after at most
    # 4(transient + period), and then two periods show it.
    assert 2 * period < taken <= 4 * (transient + period) + 2 * period + 2


@pytest.mark.parametrize("period", [1, 2, 3])
@pytest.mark.parametrize("rate", [0.5, -0.5, 0.99])
def test_a_motion_that_nears_its_cycle_is_periodic_once_it_is_near(period, rate):
    """It has to come within ``RECURRENCE_RTOL`` of itself, so the distance left to the cycle is at most that over its loss."""
    random = np.random.default_rng(period)
    places = np.arange(20_000)
    sequence = np.tile(random.normal(size=period), 20_000)[:20_000] + 0.1 * np.abs(rate) ** places * np.sign(rate) ** (
        places // period
    )
    taken, found = fed(states(sequence))
    assert found in (period, 2 * period)  # with its sign changing, it first recurs after two periods
    size = 1.0 + np.abs(states(sequence)[taken]).sum()
    left = 0.1 * abs(rate) ** (taken - 2 * found)
    assert left < 4.0 * RECURRENCE_RTOL * size / (1.0 - abs(rate))


def test_what_never_recurs_is_given_up_after_the_patience():
    golden = 0.5 * (math.sqrt(5.0) - 1.0)
    turning = np.cos(2.0 * math.pi * golden * np.arange(5000))
    assert fed(states(turning), patience=5000) == (5000, 0)
    assert fed(states(turning), patience=700) == (700, 0)
    logistic = [0.3]
    for _ in range(4999):
        logistic.append(3.99 * logistic[-1] * (1.0 - logistic[-1]))
    assert fed(states(np.array(logistic)), patience=5000) == (5000, 0)


def test_one_return_is_not_enough():
    """A state that comes back once, by chance or on its way through, has to come back again after as many impacts."""
    random = np.random.default_rng(5)
    plain = random.normal(size=400)
    # References are states 0, 1, 3, 7, 15, 31, 63, 127 …
    once, unlike, alike = plain.copy(), plain.copy(), plain.copy()
    once[[31, 38]] = plain[31]
    unlike[[127, 140, 150]] = plain[127]
    alike[[127, 140, 153]] = plain[127]
    assert fed(states(once)) == (0, 0)
    assert fed(states(unlike)) == (0, 0)
    assert fed(states(alike)) == (154, 13)


def test_states_are_the_same_relative_to_their_size():
    state = np.array([3.0 + 4.0j, 1.0j])
    size = 1.0 + 5.0 + 1.0
    for share, same in ((0.99, True), (1.01, False)):
        moved = state + np.array([0.0, share * RECURRENCE_RTOL * size])
        assert bool(same_state(moved, state, RECURRENCE_RTOL)) is same


# ------------------------------------------------------------------------------------------------ along the wall


def test_near_the_rub_in_place_and_speed():
    place = cmath.rect(1.0, 0.7)
    recollection = memory(2, rub_position=place)
    assert near_rub(recollection, place, 0.0)
    assert near_rub(recollection, place * cmath.rect(1.0, 0.4 * RECURRENCE_RTOL), -0.5 * RECURRENCE_RTOL)
    assert not near_rub(recollection, place * cmath.rect(1.0, 0.6 * RECURRENCE_RTOL), -0.5 * RECURRENCE_RTOL)
    assert not near_rub(recollection, place, 1.1 * RECURRENCE_RTOL)
    assert not near_rub(memory(2), place, 0.0)


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_a_turn_is_awaited_in_its_last_quarter(direction):
    recollection = memory(2)
    start, amplitudes = 0.4, np.array([1.0 + 0.0j, 2.0j])
    answers = []
    angles = np.linspace(0.0, 1.99 * math.pi, 203)
    for angle in angles:
        position = cmath.rect(1.0, start + direction * angle)
        answers.append(bool(approaches_turn(recollection, position, amplitudes, direction)))
        amplitudes = amplitudes + 1.0
    expected = angles > 1.5 * math.pi
    assert answers == expected.tolist()
    assert recollection.turn_position == pytest.approx(cmath.rect(1.0, start))
    assert recollection.turn_state.tolist() == [1.0 + 0.0j, 2.0j]
    # Looked for anew, it starts here.
    reset_rub(recollection)
    assert not approaches_turn(recollection, cmath.rect(1.0, 3.0), amplitudes, direction)
    assert recollection.turn_position == pytest.approx(cmath.rect(1.0, 3.0))


def test_swinging_to_and_fro_is_no_turn():
    recollection = memory(2)
    amplitudes = np.zeros(2, complex)
    for angle in 1.4 * np.sin(np.linspace(0.0, 20.0, 400)):
        assert not approaches_turn(recollection, cmath.rect(1.0, angle), amplitudes, 1.0)


# ------------------------------------------------------------------------------------------------ what settles stays


def settled(parameters: Parameters, start: State) -> tuple[Rotor, object]:
    rotor = jeffcott(parameters)
    motion = simulate(rotor, start, 1e5, settle=True)
    assert motion.outcome.settled
    return rotor, motion


@pytest.mark.jit_only
@pytest.mark.parametrize(("gamma", "impacts"), [(0.1, 1), (0.083, 2)])
def test_a_bouncing_rotor_bounces_on(gamma, impacts):
    rotor, motion = settled(PAPER.replace(gamma=gamma), State(0.3 + 0.1j, 0.9 - 0.4j))
    assert (motion.outcome, motion.multiplicity) == (Outcome.BOUNCING, impacts)
    log = simulate(rotor, motion.final, 20_000.0).contacts
    assert len(log) > 5000
    for values in (np.exp(1j * log.angle), log.radial_speed, log.angular_speed):
        assert np.abs(values[impacts:] - values[:-impacts]).max() < 1e-8
        if impacts > 1:
            assert np.abs(values[1:] - values[:-1]).min() > 1e-3


@pytest.mark.jit_only
def test_a_mixed_motion_goes_on_mixing():
    parameters = Parameters(
        gamma=0.0431456484,
        omega=1.25902546543,
        rho=1.31671186334,
        phi=0.0,
        mu=0.427612705,
        d=0.43781982,
        radius_ratio=2.0,
    )
    rotor, motion = settled(parameters, State(0.3, 0.5 + 1.0j))
    assert motion.outcome is Outcome.MIXED
    count = motion.multiplicity
    later = simulate(rotor, motion.final, 1000.0)
    log = later.contacts
    assert len(log) > 20 * count
    assert len(later.lasting_contacts) > 20
    assert np.abs(log.radial_speed[count:] - log.radial_speed[:-count]).max() < 1e-7
    assert np.abs(np.exp(1j * log.angle[count:]) - np.exp(1j * log.angle[:-count])).max() < 1e-7


# ------------------------------------------------------------------------------------------------ what does not settle
