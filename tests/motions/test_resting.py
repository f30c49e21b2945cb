"""How heavy rotors stay on their touchdown bearing: they lie there, rock, or go round.

Of a rotor that slides, and on which nothing acts but its weight ``g``, the angle ``α`` from the bottom obeys
``α̈ = −g sin α − μ (g cos α + α̇²)``.  With ``u = α̇²`` this is linear, ``u' = −2g (sin α + μ cos α) − 2μ u``, and
``(u − A cos α − B sin α) e^{2μα}`` stays the same.
"""

import cmath
import math

import numpy as np
import pytest

import carom as cm
from carom.base.outcome import Outcome, Phase
from carom.core.settling import memory
from carom.motions.settling import lies

pytestmark = pytest.mark.jit_only

HEAVY = cm.load("examples/dropped-rotor.toml", ["eccentricity=0"])
FRICTION = HEAVY.machine.friction
PULL = 9.81 / (0.25e-3 * (300.0 * math.pi) ** 2)


def rocking(motion, times):
    """Angle from the bottom, and its rate, in the fixed frame."""
    place, rate = motion.at_plane(times)
    return np.angle(1j * motion.position(times, "fixed")), (place.conjugate() * rate).imag + 1.0


def kept(angle, rate):
    """What stays the same while it slides."""
    cosine = 2.0 * PULL * (1.0 - 2.0 * FRICTION**2) / (1.0 + 4.0 * FRICTION**2)
    sine = -6.0 * FRICTION * PULL / (1.0 + 4.0 * FRICTION**2)
    return (rate**2 - cosine * np.cos(angle) - sine * np.sin(angle)) * np.exp(2.0 * FRICTION * angle)


def leaning(away=0.0):
    """The state at rest in the fixed frame, next to where friction carries the weight on the slope."""
    place = -1j * cmath.exp(1j * (away - math.atan(FRICTION)))
    return cm.State(place, -1j * place)


def test_the_end_of_a_drop_rocks_about_the_friction_angle():
    motion = cm.simulate(HEAVY.replace(restitution=0.1), cm.drop())
    assert motion.outcome is Outcome.AT_REST
    begins = motion.lasting_contacts[-1].start
    angles, rates = rocking(motion, np.linspace(begins, motion.time, 4000))
    constant = kept(angles, rates)
    assert np.ptp(constant) < 1e-8 * np.abs(constant).max()
    assert angles.min() < -math.atan(FRICTION) < angles.max()
    # Friction that does not change its sense takes nothing: it goes on to the end.
    assert np.ptp(angles[-500:]) == pytest.approx(np.ptp(angles[:500]), rel=1e-2)


def test_a_spinning_rotor_at_rest_leans_at_the_friction_angle():
    motion = cm.simulate(HEAVY, cm.drop(leaning()))
    assert motion.outcome is Outcome.AT_REST
    angles, rates = rocking(motion, np.linspace(0.0, motion.time, 500))
    assert angles == pytest.approx(np.full(500, -math.atan(FRICTION)), abs=1e-9)
    assert rates == pytest.approx(np.zeros(500), abs=1e-9)


def test_small_rocking_has_the_frequency_of_a_pendulum_on_its_slope():
    motion = cm.simulate(HEAVY, cm.drop(leaning(1e-3)), until=400.0)
    times = np.linspace(0.0, 400.0, 40_001)
    angles, _ = rocking(motion, times)
    swing = angles + math.atan(FRICTION)
    ends = np.flatnonzero((swing[:-1] < 0.0) & (swing[1:] >= 0.0))
    crossings = times[ends] - swing[ends] * (times[1] - times[0]) / (swing[ends + 1] - swing[ends])
    expected = math.sqrt(PULL * math.sqrt(1.0 + FRICTION**2))
    # The next term is of the order of the amplitude squared.
    assert 2.0 * math.pi / np.diff(crossings) == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize("gravity", [9.81, 0.01, 1e-5])
@pytest.mark.parametrize("radius", ["5 mm", "20 mm", "100 mm"])
def test_rolling_under_any_weight_is_rolling(gravity, radius):
    """It never repeats: the weight turns meanwhile."""
    case = HEAVY.replace(damping=100.0, eccentricity="2 um", rotor_radius=radius, gravity=gravity)
    start = cm.State(1.0 + 0j, -1j * (case.parameters.radius_ratio + 1.0))
    for machine in (case, case.replace(gravity=0)):
        assert cm.simulate(machine, start).outcome is Outcome.ROLLING
    ending = cm.settle(case, cm.State(np.array([start.position]), np.array([start.velocity])))
    assert ending.outcomes.tolist() == [Outcome.ROLLING]


def test_whirl_that_goes_round_does_not_lie():
    """Free of its levitation a rotor lies where it leans; set going fast enough along the wall it does not."""
    rotor, _ = cm.drop(cm.State(0.0)).stages(HEAVY)
    place, contact = leaning().position, np.array([Phase.FORWARD_SLIP])
    for rate, expected in ((-1.0, True), (-1.05, True), (-3.0, False)):
        assert (
            lies(rotor, rotor.system.amplitudes(place, 1j * rate * place), contact, memory(rotor.system.modes))
            is expected
        )


def test_a_rub_that_keeps_in_step_with_the_shaft_is_forward_rub():
    """An unbalance far above the weight presses the rotor against the wall ahead of it; the weight only rocks it there."""
    rotor, start = cm.drop(cm.State(0.3 + 0.1j)).stages(HEAVY.replace(eccentricity="0.1 mm"))
    motion = cm.simulate(rotor, start)
    assert motion.outcome is Outcome.FORWARD_RUB
    last = np.linspace(motion.time - 50.0, motion.time, 300)
    assert np.ptp(np.unwrap(np.angle(motion.position(last)))) < 1.0
    assert np.ptp(np.unwrap(np.angle(motion.position(last, "fixed")))) > 48.0
    ending = cm.settle(rotor, cm.State(np.array([start.position]), np.array([start.velocity])))
    assert ending.outcomes.tolist() == [Outcome.FORWARD_RUB]


def test_steady_whirl_is_known_earlier_and_ends_the_same(monkeypatch):
    """Of random backward whirls: where the means of turns and radii stay, 1,024 turns lead to the same end."""
    random = np.random.default_rng(5)
    angles, speeds = 2.0 * np.pi * random.random(12), random.uniform(1.0, 80.0, 12)
    positions = np.exp(1j * angles)
    starts = positions, -1j * positions * speeds
    early = cm.settle(HEAVY, cm.State(*starts))
    monkeypatch.setattr("carom.motions.settling.STEADY", -1.0)
    late = cm.settle(HEAVY, cm.State(*starts))
    assert np.array_equal(early.outcomes, late.outcomes)
    assert (early.times <= late.times).all()
    assert (early.times < late.times).any()
