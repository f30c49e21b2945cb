"""Attractors and basins of a rotor in a compliant wall, against its orbits and rubs."""

import numpy as np
import pytest

import carom as cm
from carom.attractors import exponents_of
from carom.attractors.settled import settled_motion
from carom.base.outcome import Outcome
from carom.models import KelvinVoigt
from tests.yielding_rotors import Yielding

pytestmark = pytest.mark.jit_only
VOIGT = Yielding(KelvinVoigt(1e3, 2.0))


@pytest.fixture(scope="module")
def found():
    return {str(one.name): one for one in cm.find_attractors(VOIGT.model, count=12)}


def test_bouncing_is_the_orbit_with_its_impulse_and_peak_force(found):
    motion, attractor = cm.simulate(VOIGT.model, cm.State(0.2 + 0.1j, 1.0), settle=True), found["1-impact bouncing"]
    orbit = cm.orbits.orbit_of_motion(motion)
    assert attractor.period == pytest.approx(orbit.period, rel=1e-10)
    assert attractor.orbit.segments == orbit.segments
    assert attractor.largest_impulse == pytest.approx(orbit.impulse, rel=1e-6)
    forces = orbit.trajectory().forces(np.linspace(0.0, orbit.period, 40_001))[0]
    assert attractor.largest_force == pytest.approx(forces.max(), rel=1e-4)
    assert exponents_of(VOIGT.model, attractor).across[0] < 0.0


def test_the_rub_is_that_of_the_closed_form(found):
    attractor = found["synchronous rub"]
    (rub,) = (rub for rub in cm.find_equilibria(VOIGT.model)[1:] if rub.stable)
    assert abs(attractor.state.position - rub.position) < 1e-6
    assert attractor.largest_force == pytest.approx(rub.normal_force, rel=1e-5)
    assert exponents_of(VOIGT.model, attractor).values == pytest.approx(np.sort(rub.eigenvalues.real)[::-1])


def test_rolling_in_the_wall_takes_the_time_of_its_turn():
    # A rotor so thin that its whirl stays less than one clearance deep: deeper ones are not followed.
    rotor = Yielding(KelvinVoigt(1e3, 2.0), surface_speed=10.0)
    (attractor,) = (
        one for one in cm.find_attractors(rotor.model, count=12) if str(one.name) == "rolling backward whirl"
    )
    position, velocity = attractor.state.position, attractor.state.velocity
    turning = (np.conj(position) * velocity).imag / abs(position) ** 2
    after = cm.simulate(rotor.model, attractor.state, attractor.period).final
    # The unbalance makes it uneven, so that a turn takes the period and no multiple of a speed.
    assert after.position == pytest.approx(position, abs=1e-6)
    assert after.velocity == pytest.approx(velocity, abs=1e-5)
    # The contact point is at rest, further out by the depth in the wall.
    assert abs(turning) * abs(position) == pytest.approx(rotor.surface_speed + abs(position) - 1.0, rel=1e-9)


def test_a_whirl_that_never_leaves_the_wall_is_an_orbit():
    rotor = Yielding(KelvinVoigt(964.95, 2.0874), gamma=0.0248, omega=0.797, rho=0.7268, mu=0.15, surface_speed=3.0)
    for velocity in (-1.0j, 0.5 - 1.2j, -0.8 - 0.4j, 1.0 - 2.0j):
        motion = cm.simulate(rotor.model, cm.State(0.2 + 0.1j, velocity), settle=True)
        if motion.outcome is Outcome.BACKWARD_WHIRL:
            end = settled_motion(motion)
            assert sorted(end.orbit.segments.split()) == ["roll", "roll", "slide+", "slide-"]
            assert end.orbit.stable
            return
    pytest.fail("no motion whirls backward")
