"""Energy ledger: every energy is booked, through ten thousand contacts and through each kind of contact."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from compilation import sized

import carom
from carom.motions.ledger import energy_ledger


def _rotor(gamma: float) -> carom.models.Jeffcott:
    return carom.models.Jeffcott(
        carom.parameters.Parameters(gamma=gamma, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=400 / 7)
    )


@pytest.mark.jit_only
def test_energy_closes_over_ten_thousand_impacts():
    motion = carom.simulate(_rotor(0.0834), carom.State(0.3 + 0j, 0.4j), until=3e4)
    assert len(motion.contacts) > 10_000
    assert energy_ledger(motion).imbalance < 1e-9


@pytest.mark.parametrize(
    ("gamma", "start", "phases"),
    [
        (0.2, carom.State(0.2 + 0.1j, 0.5 + 0.3j), {carom.outcome.Phase.FORWARD_SLIP}),
        pytest.param(
            0.07,
            carom.State(0.2 + 0.1j, 0.3j),
            {carom.outcome.Phase.FORWARD_SLIP, carom.outcome.Phase.ROLLING},
            marks=pytest.mark.jit_only,
        ),
        (0.4, carom.State(0.2 + 0.1j, 0.5 + 0.3j), set()),
    ],
)
def test_energy_closes_through_chatter_sliding_and_rolling(gamma, start, phases):
    motion = carom.simulate(_rotor(gamma), start, until=sized(400, 138), settle=True)
    assert {contact.phase for contact in motion.lasting_contacts} >= phases
    ledger = energy_ledger(motion)
    assert ledger.imbalance < 1e-9
    assert np.diff(ledger.impacts).max() <= 0.0
    assert ledger.times[0] == 0.0
    assert ledger.times[-1] == motion.time


def test_a_missing_account_would_show():
    motion = carom.simulate(_rotor(0.2), carom.State(0.2 + 0.1j, 0.5 + 0.3j), until=30.0)
    ledger = energy_ledger(motion)
    without_drive = np.abs(ledger.energy - ledger.energy[0] - ledger.supplied + ledger.drive).max()
    assert without_drive > 1e-2 * np.abs(ledger.drive).max()


def test_a_rotor_at_rest_has_nothing_to_account_for():
    centred = carom.parameters.Parameters(gamma=0.1, omega=0.76, rho=0.0, phi=0.0, mu=0.15, d=0.95, radius_ratio=57.0)
    ledger = energy_ledger(carom.simulate(carom.models.Jeffcott(centred), carom.State(0j, 0j), until=10.0))
    assert not ledger.energy.any()
    assert ledger.imbalance == 0.0


def test_energies_in_joules():
    scales = carom.parameters.Scales(mass=50.0, clearance=0.7e-3, speed=184.2)
    ledger = energy_ledger(carom.simulate(_rotor(0.2), carom.State(0.2 + 0.1j, 0.5 + 0.3j), until=30.0))
    table, plain = replace(ledger, scales=scales).to_dataset(), ledger.to_dataset()
    assert {name: table[name].attrs["units"] for name in table} == dict.fromkeys(
        ("kinetic", "spring", "unbalance", "damping", "impacts", "friction", "drive"), "J"
    )
    assert table["times"].attrs["units"] == "s"
    joules = 50.0 * (0.7e-3 * 184.2) ** 2
    assert np.allclose(table["friction"], joules * ledger.friction, rtol=1e-14, atol=0)
    assert np.array_equal(plain["drive"], ledger.drive)
    assert plain["drive"].attrs["units"] == "m c_r^2 Omega^2"
