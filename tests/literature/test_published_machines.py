"""Machines of published work, entered in their own units, against numbers that the sources print."""

import math
from pathlib import Path

import pytest

from carom.closed_forms.equilibria import find_equilibria
from carom.models import Jeffcott
from carom.parameters import ENTRIES, Machine, load, read_quantity

EXAMPLES = Path(__file__).parents[2] / "examples"


def test_the_machine_of_keogh_and_cole_has_the_printed_numbers_in_other_terms_too():
    """Section 2 of the source paper: m = 50 kg, k = 9.8e5 N/m, omega = 0.76, rho = 3/7."""
    printed = load(EXAMPLES / "keogh-cole.toml")
    rest = {
        "mass": "50 kg",
        "speed": "184.2 rad/s",
        "unbalance_phase": "0.21 rad",
        "friction": 0.15,
        "restitution": 0.95,
    }
    rewritten = Machine(
        **rest,
        natural_frequency="140 rad/s",
        damping_ratio="10 %",
        unbalance="15 kg mm",
        rotor_diameter="80 mm",
        diametral_clearance="1.4 mm",
    )

    assert rewritten == printed.machine
    assert round(printed.parameters.omega, 2) == 0.76
    assert printed.parameters.rho == 3 / 7


def test_the_test_rig_of_munich_has_nearly_the_natural_frequency_that_was_measured():
    """Abschaetzung_ML_k.m: m = 3.2740 kg, 52.013 Hz measured with P = 5000 A/m, k = (2 pi 52.013 Hz)^2 m/2 for a bearing."""
    machine = load(EXAMPLES / "tum-test-rig.toml").machine
    found = math.sqrt(machine.stiffness / machine.mass) / (2 * math.pi)

    # Two bearings of ki P + kx = 50 N/A 5000 A/m - 1e5 N/m = 1.5e5 N/m; ki D = 250 N s/m.
    assert (machine.stiffness, machine.damping) == (3e5, 500.0)
    assert found == pytest.approx(48.177, abs=5e-4)
    # The model has no integral gain and a rigid shaft, and ki and kx are given with one digit.
    assert found == pytest.approx(52.013, rel=0.08)
    measured = machine.replace(natural_frequency="52.013 Hz")
    assert measured.stiffness / 2 == pytest.approx((52.013 * 2 * 3.141592653589793) ** 2 * 3.2740 / 2, rel=1e-13)
    assert measured.damping == machine.damping


def test_the_test_rig_levitates_within_its_limit_of_current():
    case = load(EXAMPLES / "tum-test-rig.toml")
    levitation = find_equilibria(Jeffcott(case.parameters)).members[0]
    machine, gains = case.machine, case.machine.controller_gains

    current = abs(gains["proportional_gain"] + 1j * machine.speed * gains["derivative_gain"]) * (
        levitation.radius * machine.clearance
    )

    assert levitation.status == "admissible"
    assert current < 0.1 * machine.current_limit


def test_weight_and_unbalance_printed_in_two_systems_of_units_agree():
    """An asymmetric rotor "(19N; 4.3 lb)" with a rotating unbalance of "(43 µm.N; 6100 µin.oz)", at up to 50,000 rpm.

    "Dynamic characteristics of a high-speed rotor with radial and axial foil-bearing supports", J. Lubrication Technology
    103 (1981) 361, abstract.  The unbalance is printed as weight times length.
    """
    gravity = 9.80665
    weight = read_quantity(ENTRIES["mass"], "4.3 lb") * gravity
    unbalance = read_quantity(ENTRIES["unbalance"], "6100 µoz in") * gravity

    assert round(weight) == 19
    assert round(unbalance * 1e6) == 43
    assert read_quantity(ENTRIES["unbalance"], "6100 µoz-in") * gravity == unbalance
    assert read_quantity(ENTRIES["speed"], "50,000 rpm") == pytest.approx(50000 * math.tau / 60, rel=1e-15)
