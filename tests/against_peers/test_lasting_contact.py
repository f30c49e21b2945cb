"""Sliding, rolling and the transitions between them, against general-purpose integrators with events."""

import numpy as np
import pytest
from compilation import sized
from machines import PAPER

from carom.base.outcome import Phase
from carom.models import jeffcott
from carom.motions import State, Trajectory, simulate
from carom.parameters import Parameters

from .constrained_motion import (
    HeyokaIntegrator,
    Segment,
    contact_phases,
    friction,
    push,
    random_contact,
)

FORWARD, BACKWARD, ROLLING = Phase.FORWARD_SLIP, Phase.BACKWARD_SLIP, Phase.ROLLING

DAMPED = PAPER.replace(gamma=0.2)
SLENDER = PAPER.replace(radius_ratio=1.2)

CASES = {
    # machine, angle, rate, until, kinds of contact in their order
    "forward drift into the synchronous rub": (DAMPED, 0.6, 0.1, 40.0, [FORWARD]),
    "forward slip slows down and lifts off": (DAMPED, 1.2, -0.3, 40.0, [FORWARD]),
    "runaway into backward whirl, then rolling": (PAPER.replace(gamma=0.05), 0.5, -6.0, 8.0, [FORWARD, ROLLING]),
    "backward slip stopped into rolling": (DAMPED, 2.0, -90.0, 2.0, [BACKWARD, ROLLING]),
    "backward slip through zero into forward slip": (
        SLENDER.replace(gamma=0.9, mu=0.05),
        0.0,
        -6.0,
        8.0,
        [BACKWARD, FORWARD],
    ),
    "rolling breaks away into slip": (SLENDER, 0.4, -2.2, 6.0, [ROLLING, FORWARD]),
}


@pytest.fixture(scope="module")
def integrator():
    pytest.importorskip("heyoka", reason="heyoka is not installed (it has no package for this platform)")
    return HeyokaIntegrator()


def on_wall(parameters: Parameters, angle: float, rate: float, until: float) -> Trajectory:
    position = np.exp(1j * angle)
    return simulate(jeffcott(parameters), State(position, 1j * rate * position), until)


def assert_same(trajectory: Trajectory, segments: list[Segment], precision: float) -> None:
    """Same contacts, same times of transition; same states and forces in between."""
    parameters = trajectory.rotor.parameters
    contacts = trajectory.lasting_contacts[: len(segments)]
    assert [contact.phase for contact in contacts] == [segment.phase for segment in segments]
    for contact, segment in zip(contacts, segments, strict=True):
        fastest = 1.0 + np.abs(segment.rates).max()
        assert contact.start == pytest.approx(segment.times[0], abs=precision)
        assert contact.end == pytest.approx(segment.times[-1], abs=precision)
        inner = slice(1, -1)
        times, angles, rates = segment.times[inner], segment.angles[inner], segment.rates[inner]
        position, velocity = trajectory.at(times)
        np.testing.assert_allclose(position, np.exp(1j * angles), rtol=0, atol=precision * fastest)
        np.testing.assert_allclose(velocity, 1j * rates * np.exp(1j * angles), rtol=0, atol=precision * fastest**2)
        normal, grip = trajectory.forces(times)
        np.testing.assert_allclose(normal, push(parameters, angles, rates), rtol=0, atol=2 * precision * fastest**2)
        expected = friction(parameters, segment.phase, angles, rates)
        np.testing.assert_allclose(grip, expected, rtol=0, atol=2 * precision * fastest**2)


@pytest.mark.parametrize("name", CASES)
def test_contact_goes_as_the_integrator_says(integrator, name):
    parameters, angle, rate, until, kinds = CASES[name]
    segments = contact_phases(integrator, parameters, angle, rate, until)
    assert [segment.phase for segment in segments] == kinds
    assert_same(on_wall(parameters, angle, rate, until), segments, integrator.precision)


@pytest.mark.jit_only
def test_random_contacts_go_as_heyoka_says():
    pytest.importorskip("heyoka", reason="heyoka is not installed (it has no package for this platform)")
    integrator, random = HeyokaIntegrator(), np.random.default_rng(7)
    segment_count, count = 0, sized(150, 150, 500)
    for _ in range(count):
        parameters, angle, rate = random_contact(random)
        segments = contact_phases(integrator, parameters, angle, rate, 12.0)
        assert_same(on_wall(parameters, angle, rate, 12.0), segments, integrator.precision)
        segment_count += len(segments)
    assert segment_count > 2 * count
