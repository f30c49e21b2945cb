"""Printed numbers beside ours, against the values of :mod:`literature.test_source_paper` and routes of their own."""

import math
from decimal import Decimal

import numpy as np
import pytest
from machines import PAPER, rest_position
from scipy.optimize import brentq

from carom import find_orbits
from carom.closed_forms.periods import PeriodCondition
from carom.models import jeffcott
from carom.reproductions import mora2014

EXPECTED = {
    "damping γ = c/(mΩ)": (1400.0 / (50.0 * 184.2), 1e-15),
    "stiffness ω = √(k/m)/Ω": (140.0 / 184.2, 1e-15),
    "unbalance ρ = e_c/c_r": (3.0 / 7.0, 1e-15),
    "radius of the rotor R/c_r": (400.0 / 7.0, 1e-13),
    "γ_DIB, where the contact-free equilibrium meets the wall": (0.0724686787, 5e-11),
    "γ_F,1, where the orbits of the first pair meet": (0.1780277257, 5e-11),
    "γ_F⁻, where B1,a and B1,c meet": (-0.49748954, 5e-9),
    "γ_graze, where B1,d grazes": (0.0636105609, 5e-11),
    "γ where r(t) on B1,d gains a maximum and a minimum": (0.0785197, 5e-8),
    "γ above which B1,d is stable": (0.0833814175, 5e-11),
    "N, pairs of periods at γ = 0.1": (1.0, 0.0),
    "most fixed points for N = 1 (“up to 2N”)": (4.0, 0.0),
    "limit cycles created at γ_DIB on the side of levitation": (2.0, 0.0),
    "θ̇ above which slip stays forward for all ṙ < 50": (-400.0 / 7.0 - 1.0 + 0.15 * 1.95 * 50.0, 1e-12),
    "γ where γ_F,1 and γ* coincide": (0.1779723, 5e-8),
    "ω where γ_F,1 and γ* coincide": (0.7811076, 5e-8),
    "regions R1 to R4": (4.0, 0.0),
}
"""Quantity: value, and half a unit of its last digit."""
DIFFERENT = {
    "unbalance ρ = e_c/c_r",
    "most fixed points for N = 1 (“up to 2N”)",
    "θ̇ above which slip stays forward for all ṙ < 50",
}
"""Where the printed number is not ours rounded; each of these rows has a note that says why."""


def computed(found):
    return [row for row in found.numbers if row.kind != "given"]


def test_every_row_has_its_value(found):
    assert {row.quantity for row in computed(found)} == set(EXPECTED)
    for row in computed(found):
        value, error = EXPECTED[row.quantity]
        assert abs(row.value - value) <= 1.001 * error, row


def test_rounded_they_are_what_is_printed(found):
    assert {row.quantity for row in found.numbers if not row.agrees} == DIFFERENT
    assert all(row.note for row in found.numbers if not row.agrees)


def test_agreement_is_about_the_digits_printed():
    def row(printed, value, kind="computed"):
        return mora2014.PrintedNumber("here", "what", kind, printed, "", value)

    assert row("0.178", 0.17849).agrees
    assert not row("0.178", 0.17851).agrees
    assert row("9.8e5", 984000.0).agrees
    assert not row("9.8e5", 986000.0).agrees
    assert not row("2", 1.9, "counted").agrees
    assert row("0.178", 0.17849).difference == pytest.approx(0.00049)


def test_what_is_given_is_used_as_it_is(found):
    given = [row for row in found.numbers if row.kind == "given"]
    assert all(row.difference == 0.0 or math.isclose(row.value, row.printed_value, rel_tol=1e-15) for row in given)
    assert {row.unit for row in given} >= {"kg", "N s/m", "N/m", "m", "rad", "rad/s"}
    assert {motion.gamma for motion in found.motions} == {0.3, 0.065, 0.1}
    assert [function.gamma for function in found.periods.functions] == [0.1, 0.05]
    machine = mora2014.machine_at(PAPER.gamma)
    assert [getattr(machine, name) for name in ("gamma", "omega", "rho", "phi", "mu", "d")] == [
        getattr(PAPER, name) for name in ("gamma", "omega", "rho", "phi", "mu", "d")
    ]
    assert machine.radius_ratio == pytest.approx(PAPER.radius_ratio, rel=1e-15)


def test_every_decimal_of_the_text_is_listed(found):
    """The numbers of captions and text, written down a second time."""
    listed = {Decimal(row.printed) for row in found.numbers}
    text = "0.152 0.76 0.428 57.143 0.072 0.178 -0.497 0.0636 0.0785 0.083 0.0834 0.781 0.3 0.065 0.1 0.05 -40 50 1400"
    assert {Decimal(word) for word in text.split()} <= listed


def test_boundary_by_the_position_of_rest(found):
    (birth,) = {row.value for row in found.numbers if row.quantity.startswith("γ_DIB")}
    assert abs(rest_position(PAPER.replace(gamma=birth))) == pytest.approx(1.0, abs=1e-13)


def test_coalescence_by_counting_orbits():
    """The row of figure 4a from a count alone."""

    def there(gamma):
        return 1.0 if len(find_orbits(jeffcott(PAPER.replace(gamma=gamma)), 1.0)) else -1.0

    value = EXPECTED["γ_F⁻, where B1,a and B1,c meet"][0]
    assert there(value + 1e-7) > 0.0 > there(value - 1e-7)


def test_new_extremum_by_a_touching_derivative(found):
    """Where a maximum and a minimum are born, the rate of the radius touches zero; bisected on its largest value there."""

    def highest_rate(gamma):
        orbit = find_orbits(jeffcott(PAPER.replace(gamma=gamma)))["B1,d"]
        times = np.linspace(0.1, 0.45, 4001) * orbit.period
        return float(np.diff(np.abs(orbit.path(times))).max())

    gamma = brentq(highest_rate, 0.078, 0.079, xtol=1e-9)
    assert gamma == pytest.approx(EXPECTED["γ where r(t) on B1,d gains a maximum and a minimum"][0], abs=2e-7)


def test_folds_of_all_pairs_by_counting_roots(found):
    for pair in found.periods.pairs:
        gamma, period = pair.fold
        counts = [
            np.count_nonzero(
                np.abs(PeriodCondition.of(jeffcott(PAPER.replace(gamma=gamma + s)).system).roots(32.0).periods - period)
                < 0.02
            )
            for s in (-1e-9, 1e-9)
        ]
        assert counts == [2, 0]
