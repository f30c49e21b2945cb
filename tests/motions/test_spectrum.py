"""Full spectrum: whirls of known order and size, and what a bouncing orbit shows."""

from __future__ import annotations

import numpy as np
import pytest

import carom
from carom.motions.spectrum import full_spectrum


def _rotor(gamma: float) -> carom.models.Rotor:
    return carom.models.jeffcott(
        carom.parameters.Parameters(gamma=gamma, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=400 / 7)
    )


def test_levitation_is_one_line_at_the_shaft_speed():
    rotor = _rotor(0.1)
    motion = carom.simulate(rotor, carom.State(rotor.equilibrium), until=100.0)
    spectrum = full_spectrum(motion)
    line = np.argmax(np.abs(spectrum.amplitudes))
    assert spectrum.orders[line] == pytest.approx(1.0, abs=1e-12)
    assert spectrum.amplitudes[line] == pytest.approx(rotor.equilibrium, abs=1e-12)
    far = np.abs(spectrum.orders - 1.0) > 0.5 * spectrum.resolution
    assert np.abs(spectrum.amplitudes[far]).max() < 1e-12


def test_an_orbit_whirls_at_the_shaft_speed_and_multiples_of_its_impact_rate_beside_it():
    orbit = carom.find_orbits(_rotor(0.1))["B1,d"]
    motion = orbit.trajectory(periods=60)
    spectrum = full_spectrum(motion, highest_order=6.0)
    rate = 2 * np.pi / orbit.period
    sizes = np.abs(spectrum.amplitudes)
    for k in (-2, -1, 0, 1):
        near = np.abs(spectrum.orders - (1.0 + k * rate)) < 0.5 * spectrum.resolution
        between = np.abs(spectrum.orders - (1.0 + (k + 0.5) * rate)) < 0.5 * spectrum.resolution
        assert sizes[near].max() > 30 * sizes[between].max()


def test_too_short_a_motion_is_refused():
    motion = carom.simulate(_rotor(0.1), carom.kick(0.3), until=20.0)
    with pytest.raises(carom.outcome.InputError, match="four shaft turns"):
        full_spectrum(motion)
    with pytest.raises(carom.outcome.InputError, match="samples_per_turn"):
        full_spectrum(carom.simulate(_rotor(0.1), carom.kick(0.3), until=60.0), samples_per_turn=8)
