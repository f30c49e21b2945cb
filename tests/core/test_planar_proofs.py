"""Ends of the planar rotor that are proven before they are reached; the tests of absorption are in ``test_settling``."""

import numpy as np
import pytest
from compilation import COMPILED, sized
from machines import PAPER

from carom.base.outcome import Outcome
from carom.core.planar_proofs import _farthest, stays_inside
from carom.models import jeffcott
from carom.motions import State, settle, simulate


def drawn_weakly_damped(random):
    """A rotor whose modes turn nearly in a ratio of whole numbers, and amplitudes that reach just beyond its wall together."""
    gamma = float(10 ** random.uniform(-9.0, -3.0))
    omega = float(random.choice([2.0, 1.5, 3.0, 2.5, 4.0 / 3.0, 5.0 / 3.0]) + random.choice([0.0, 1e-9, 1e-6, 1e-4]))
    unbalance = float(random.uniform(0.1, 0.7)) * (omega**2 - 1.0)
    rotor = jeffcott(PAPER.replace(gamma=gamma, omega=omega, rho=unbalance))
    room = 1.0 - abs(rotor.equilibrium)
    reach = room * float(random.uniform(0.9, 1.3))
    share, turns = float(random.random()), np.exp(2j * np.pi * random.random(2))
    lower, upper = rotor.system.exponents
    driven, driving = reach * share * turns[0], reach * (1.0 - share) * turns[1]
    return rotor, np.array([driving * (lower - upper), driven + driving])


def test_what_is_proven_to_stay_inside_does():
    """At thousands of times until the moduli alone suffice, by the two exponentials themselves."""
    random = np.random.default_rng(7)
    proven = beyond = 0
    for _ in range(sized(200, 4, 6000)):
        rotor, amplitudes = drawn_weakly_damped(random)
        lower, upper = rotor.system.exponents
        driving = amplitudes[0] / (lower - upper)
        driven = amplitudes[1] - driving
        room = 1.0 - abs(rotor.equilibrium)
        lasts = max(np.log((abs(driving) + abs(driven)) / room), 0.0) / -upper.real
        # Dense over some turns, and anywhere until the end.
        times = np.concatenate([np.linspace(0.0, 100.0, 4000), random.random(4000) * lasts])
        radius = np.abs(rotor.equilibrium + driving * np.exp(lower * times) + driven * np.exp(upper * times)).max()
        if stays_inside(rotor.system.arrays, amplitudes):
            proven += 1
            beyond += lasts > 0.0
            assert radius < 1.0
    if COMPILED:
        assert proven > 30
        assert beyond > 2


def test_without_damping_or_with_modes_that_decay_apart_nothing_is_proven():
    for machine in (PAPER.replace(gamma=0.0, omega=2.0), PAPER.replace(gamma=5.0, omega=0.5)):
        assert not stays_inside(jeffcott(machine).system.arrays, np.array([0.001 + 0j, 0.001j]))


def test_a_flight_that_reaches_the_wall_is_looked_at_no_farther():
    """Most flights that are asked about have just left the wall: the first sample is enough."""
    path = 0.1j, 0.9 + 0j, 0.05 + 0j, 0.3, -2.2, 200.0, 0.01
    assert _farthest(*path, np.inf) > 1.03
    assert _farthest(*path, 0.95) == pytest.approx(abs(0.1j + 0.95), abs=1e-12)


@pytest.mark.jit_only
def test_a_strongly_damped_flight_is_known_to_levitate_as_soon_as_it_does():
    """Its slow mode takes 26,000 of 1/Ω to decay, two million blocks of flight, but it is free of contact within a turn."""
    rotor = jeffcott(PAPER.replace(gamma=482.8, omega=0.135, rho=12.05, mu=0.2, d=0.0))
    angles = 2j * np.pi * np.arange(24) / 24
    ends = settle(rotor, State(np.full(24, rotor.equilibrium), 6000.0 * np.exp(angles)))
    assert ends.recovered.all()
    assert (ends.impacts > 0).all()
    assert ends.times.max() < 100.0


@pytest.mark.jit_only
@pytest.mark.parametrize("omega", [2.0, 1.7317, 2.001])
@pytest.mark.parametrize("gamma", [2e-5, 1e-6, 1e-8])
def test_hardly_damped_motions_settle_alike_both_ways(gamma, omega):
    rotor = jeffcott(PAPER.replace(gamma=gamma, omega=omega, rho=0.0857, d=0.7))
    random = np.random.default_rng(1)
    points = np.sqrt(random.random((2, 8))) * np.exp(2j * np.pi * random.random((2, 8)))
    together = settle(rotor, State(points[0], 2.0 * points[1]))
    for place in range(8):
        alone = simulate(rotor, State(points[0, place], 2.0 * points[1, place]), settle=True)
        assert alone.outcome is Outcome.LEVITATED
        assert together.outcomes[place] == Outcome.LEVITATED
