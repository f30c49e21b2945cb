"""A symmetric rotor on two equal bearings, kicked through its centre, moves as the planar rotor: it does not tilt."""

import numpy as np
import pytest
from compilation import sized
from linear_rotors import touchdowns

import carom
from carom.base.outcome import Outcome
from carom.models import Rotor, from_matrices, jeffcott
from carom.parameters import Parameters

pytestmark = pytest.mark.jit_only

PAPER = Parameters(gamma=0.1, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=50.0)


def on_two_bearings(machine: Parameters, arm: float, inertia: float) -> Rotor:
    """The planar rotor with a moment of inertia, on bearings at both ends that share its stiffness and damping."""
    ends = np.array([[1.0, arm], [1.0, -arm]])
    return from_matrices(
        mass=np.diag([1.0, inertia]),
        damping=0.5 * machine.gamma * ends.T @ ends,
        stiffness=0.5 * machine.omega**2 * ends.T @ ends,
        gyroscopic=np.diag([0.0, 0.1 * inertia]),
        forcing=np.array([machine.rho * np.exp(1j * machine.phi), 0.0]),
        touchdowns=touchdowns(
            ends, np.full(2, machine.mu), np.full(2, machine.d), np.full(2, machine.radius_ratio + 1.0)
        ),
        translation=np.array([1.0, 0.0]),
    )


@pytest.mark.parametrize(("arm", "inertia"), [(1.0, 0.4), (0.5, 0.3), (2.0, 0.5), (1.0, 3.0)])
def test_it_does_not_tilt(arm, inertia):
    """Each plane takes half of every impulse, at the same times, as long as the tilt that rounding starts stays small."""
    random = np.random.default_rng(17)
    compared = 0
    for _ in range(sized(6, 2, 100)):
        machine = PAPER.replace(
            mu=float(random.choice([0.0, 0.15, 0.6])),
            d=float(random.choice([0.0, 0.7, 0.95])),
            gamma=float(random.uniform(0.08, 0.3)),
        )
        kick = carom.kick(float(random.uniform(0.7, 3.0)), angle=float(random.uniform(-np.pi, np.pi)))
        symmetric = carom.simulate(on_two_bearings(machine, arm, inertia), kick, 60.0)
        planar = carom.simulate(jeffcott(machine), kick, 60.0)
        tilts = np.abs(symmetric.rotor.system.state(symmetric.event_amplitudes)[0][:, 1])
        upright = symmetric.segment_starts[1:][tilts > 1e-13].min(initial=60.0)
        log = planar.contacts
        count = int(np.searchsorted(log.time, 0.999 * upright))
        for plane in range(2):
            seen = symmetric.seen_at(plane).contacts
            # Each impact multiplies a difference, which rounding starts, by up to ten.
            assert np.allclose(seen.time[:count], log.time[:count], rtol=1e-8)
            assert np.allclose(2.0 * seen.normal_impulse[:count], log.normal_impulse[:count], rtol=1e-8, atol=1e-10)
            assert np.allclose(2.0 * seen.friction_impulse[:count], log.friction_impulse[:count], rtol=1e-8, atol=1e-10)
            assert not seen.by_poisson.any()
        compared += count
    assert compared >= sized(30, 10, 500)


@pytest.mark.parametrize("arm", [0.5, 1.0])
def test_it_ends_as_the_planar_rotor(arm):
    """One after another, the impacts of this kick tilted the rotor, which came back where the planar one rolls to ruin."""
    kick = carom.kick(4.0, angle=2.0)
    assert carom.simulate(jeffcott(PAPER), kick).outcome is Outcome.ROLLING
    assert carom.simulate(on_two_bearings(PAPER, arm, 0.3), kick).outcome is Outcome.ROLLING
