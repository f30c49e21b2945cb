"""Sequences of impacts, one by one, against general-purpose integrators with a terminal event at the wall.

Differences may be as large as the errors of the flights make them through the derivatives of the bounces that follow;
the comparison goes on for as long as that is less than LARGEST.
"""

import cmath
import math

import numpy as np
import pytest
from compilation import sized
from machines import PAPER, random_parameters

from carom.base.outcome import Outcome
from carom.models import jeffcott
from carom.motions import State, simulate
from carom.parameters import Parameters

from .bouncing import HeyokaFlights, bounces, error_bounds

LARGEST = 1e-6
"""Errors up to which their growth is a matter of first derivatives."""

PRESSED = {"rho": 2.2, "phi": 0.4}
SMALL = {"radius_ratio": 0.05, "mu": 1.2}

CASES = {
    # machine, position, velocity, until, impacts to be compared at least
    "source paper": (PAPER, 0.3 + 0.1j, 0.9 - 0.4j, 60.0, 10),
    "source paper, more damping": (PAPER.replace(gamma=0.15), -0.5 + 0.2j, 0.3 + 1.1j, 60.0, 10),
    "weak damping": (PAPER.replace(gamma=0.02), 0.1 + 0j, 1.4 + 0.2j, 40.0, 10),
    "overdamped, pressed to the wall": (PAPER.replace(gamma=2.5, omega=1.0, rho=4.0, d=0.8), 0.1j, 3.0 + 1j, 30.0, 8),
    "strongly overdamped": (PAPER.replace(gamma=6.0, omega=0.4, rho=9.0, d=0.9), -0.4 + 0j, 9.0 + 2j, 30.0, 8),
    "critical damping": (PAPER.replace(gamma=1.25, omega=0.625, **PRESSED, d=0.7), 0.2 + 0j, 2.0 + 1j, 30.0, 8),
    "critical damping, contact-free rest inside": (
        PAPER.replace(gamma=1.5, omega=0.75, rho=0.9, d=1.0),
        0.2 + 0j,
        40.0 + 5j,
        30.0,
        3,
    ),
    "next to critical damping": (
        PAPER.replace(gamma=1.25 * (1 + 1e-9), omega=0.625, **PRESSED, d=0.7),
        0.2 + 0j,
        2.0 + 1j,
        30.0,
        8,
    ),
    "impacts that stop the slip": (PAPER.replace(gamma=0.05, **SMALL), 0.2 - 0.3j, 1.5 + 1j, 40.0, 8),
    "backward slip": (PAPER.replace(radius_ratio=0.3, mu=0.1), 0.9 + 0j, 1.0 - 6j, 40.0, 8),
    "no friction, no loss": (PAPER.replace(gamma=0.01, mu=0.0, d=1.0), 0.5 + 0j, 0.9j, 40.0, 8),
}


@pytest.fixture(scope="module")
def peer_of():
    pytest.importorskip("heyoka", reason="heyoka is not installed (it has no package for this platform)")
    return HeyokaFlights


def compare(parameters: Parameters, position: complex, velocity: complex, until: float, peer) -> dict[str, float]:
    """Assert that all impacts agree to the bounds of the errors; tell how many there were and of what kind."""
    rotor = jeffcott(parameters)
    motion = simulate(rotor, State(position, velocity), until, stop_at_chatter=True, max_events=60)
    log = motion.contacts
    found, last = bounces(peer, parameters, position, velocity, until, len(log) + 1)
    bounds = error_bounds(rotor, peer, (position, velocity), found[: len(log)])
    too_large = (bounds > LARGEST).any(axis=1)
    decided = int(np.argmax(too_large)) if too_large.any() else len(bounds)
    if decided == len(bounds) and motion.outcome is Outcome.TIME_REACHED:
        assert len(found) == len(log)
        assert not last.hit
    assert len(found) >= min(decided, len(log))
    positions = np.array([impact.position for impact in found[:decided]])
    local = positions.conjugate() * np.array([impact.velocity for impact in found[:decided]])
    ours = np.stack([log.angle, log.radial_speed, log.angular_speed, log.time], axis=1)[:decided]
    theirs = [np.angle(positions), local.real, local.imag, [impact.time for impact in found[:decided]]]
    differences = np.abs(ours - np.transpose(theirs))
    differences[:, 0] = np.minimum(differences[:, 0], 2.0 * math.pi - differences[:, 0])
    assert (differences <= bounds[:decided]).all(), (differences / bounds[:decided]).max(axis=1)
    return {
        "decided": decided,
        "impacts": len(log),
        "stopped": int(log.sticks[:decided].sum()),
        "backward": int((log.slip_before[:decided] < 0.0).sum()),
        "share": float((differences / bounds[:decided]).max(initial=0.0)),
    }


@pytest.mark.parametrize("name", CASES)
def test_impacts_come_as_the_integrator_says(peer_of, name):
    parameters, position, velocity, until, least = CASES[name]
    tally = compare(parameters, position, velocity, until, peer_of(parameters))
    assert tally["decided"] >= least, tally
    assert tally["stopped"] or "stop" not in name
    assert tally["backward"] or "backward" not in name


@pytest.mark.jit_only
def test_impacts_of_random_machines_come_as_heyoka_says():
    pytest.importorskip("heyoka", reason="heyoka is not installed (it has no package for this platform)")
    random = np.random.default_rng(21)
    total = dict.fromkeys(("decided", "stopped", "backward"), 0)
    count = sized(100, 100, 300)
    for _ in range(count):
        parameters = random_parameters(random)
        position = cmath.rect(0.95 * math.sqrt(random.random()), random.uniform(-math.pi, math.pi))
        velocity = cmath.rect(10 ** random.uniform(-1.0, 1.0), random.uniform(-math.pi, math.pi))
        tally = compare(parameters, position, velocity, 40.0, HeyokaFlights(parameters))
        for kind in total:
            total[kind] += tally[kind]
    assert 3 * total["decided"] > 10 * count, total
    assert 3 * total["stopped"] > count, total
    assert total["backward"] > 0.1 * count, total
