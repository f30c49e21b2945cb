"""Derivatives of the equations of shooting by parameters, against differences and in closed form."""

import numpy as np
import pytest

from carom.models import Rotor, jeffcott
from carom.orbits.shooting import ShootingStart, by_parameter, links_of
from carom.orbits.word import Kind, Word
from carom.parameters import DIMENSIONLESS_FIELDS, Scales
from tests.compilation import sized
from tests.core.test_segments import FLIGHTS, arbitrary, rotor_of
from tests.machines import PAPER


def differences(rotor: Rotor, word: Word, start: ShootingStart, name: str) -> np.ndarray:
    """Two central differences, extrapolated to a step of zero (Richardson): the error falls with its fourth power."""
    value, found = rotor.value(name), []
    for step in (2e-4 * (abs(value) or 1.0), 1e-4 * (abs(value) or 1.0)):
        ends = [links_of(rotor.replace(**{name: value + side}), word, start).residual for side in (step, -step)]
        found.append((ends[0] - ends[1]) / (2.0 * step))
    slopes: np.ndarray = (4.0 * found[1] - found[0]) / 3.0
    return slopes


def check(rotor: Rotor, names: list[str], rng: np.random.Generator) -> None:
    word = Word.of(*FLIGHTS)
    start = arbitrary(rotor, word, rng)
    # Flights of up to six units of time: their propagator is doubled several times.
    start = start._replace(durations=5.0 * start.durations)
    for name in names:
        exact = by_parameter(rotor, word, start, name)
        # Steps of 1e-4 leave rounding errors of 1e-12, and 1e-16 of fifth derivatives: those of sixty radians are 1e7 times the first.
        assert np.abs(differences(rotor, word, start, name) - exact).max() < 1e-9 * (np.abs(exact).max() + 1.0)


@pytest.mark.parametrize(("gamma", "omega"), [(0.1, 0.76), (1.6, 0.8), (1.6 + 1e-9, 0.8), (40.0, 2.0), (-0.05, 0.8)])
def test_every_number_of_the_planar_rotor(gamma, omega):
    """Underdamped, critically damped and next to it, overdamped, and excited."""
    rotor = jeffcott(PAPER.replace(gamma=gamma, omega=omega, radius_ratio=1.5))
    for seed in range(sized(4, 1)):
        check(rotor, list(DIMENSIONLESS_FIELDS), np.random.default_rng(seed))


def test_every_physical_parameter():
    scales = Scales(mass=70.0, clearance=4e-4, speed=300.0)
    rotor = jeffcott(PAPER.replace(scales=scales, radius_ratio=1.5))
    check(rotor, [name for name in rotor.varied if name not in DIMENSIONLESS_FIELDS], np.random.default_rng(5))


def test_the_work_does_not_grow_with_stiffness():
    """A decay that is over at once: the derivative by the phase is that of the rotor at rest, turned by a right angle."""
    rotor = jeffcott(PAPER.replace(gamma=1e3, omega=40.0))
    word, at_rest = Word.of(Kind.IMPACT_FORWARD), rotor.equilibrium
    start = ShootingStart(np.array([[1.0 + 0j, 0.0]]), np.array([50.0]))
    exact = by_parameter(rotor, word, start, "phi")
    # Fifteen doublings lose four digits of a displacement of 2e-4.
    assert exact[:4] == pytest.approx([(1j * at_rest).real, 0.0, (1j * at_rest).imag, 0.0], abs=1e-16)


def test_a_flight_without_end_has_no_derivatives():
    rotor, word = rotor_of(2, 1, 1), Word.of(Kind.IMPACT_FORWARD)
    start = arbitrary(rotor, word, np.random.default_rng(1))
    for duration in (np.inf, np.nan):
        exact = by_parameter(rotor, word, start._replace(durations=np.array([duration])), "gamma")
        assert np.isnan(exact).all()
