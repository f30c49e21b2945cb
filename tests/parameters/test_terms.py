"""Terms that stand for numbers of a machine: the same machine in every bit, whatever it is given by."""

import math
import tomllib

import mpmath
import numpy as np
import pytest
from machines import REAL
from refusals import error_of

from carom.parameters import HELPER_FIELDS, MACHINE_FIELDS, TERM_FIELDS, Machine, field_to_vary
from carom.parameters.quantities import read_decimal
from carom.parameters.terms import ENTRIES

PLAIN = {name: getattr(REAL, name) for name in MACHINE_FIELDS}
BEARING = {"magnetic_bearings": 2, "force_current_factor": "70 N/A", "negative_stiffness": "210 N/mm"}


def machine(without=(), **entries):
    without = (without,) if isinstance(without, str) else without
    return Machine(**{name: value for name, value in PLAIN.items() if name not in without}, **entries)


# ------------------------------------------------------------------------------------------ one machine, given in many ways


# ------------------------------------------------------------------------------------------ factors of 2 and 2 pi


@pytest.mark.parametrize("name", ["speed", "natural_frequency", "rated_speed"])
@pytest.mark.parametrize("unit", ["1/s", "s^-1", "1/min", "min^-1", "1/ms"])
def test_a_number_a_second_that_may_be_turns_or_radians_is_refused(name, unit):
    error = error_of(lambda: read_decimal(ENTRIES[name], f"50 {unit}"))

    assert f"{unit!r} leaves open whether turns or radians are counted" in error.allowed


def test_the_whirl_of_a_machine_given_by_frequency_and_ratio_has_that_frequency_and_ratio():
    found = machine(("stiffness", "damping"), natural_frequency="22 Hz", damping_ratio="5 %")

    poles = np.roots([found.mass, found.damping, found.stiffness])
    assert float(abs(poles[0])) / (2 * math.pi) == pytest.approx(22, rel=1e-14)
    assert float(-poles[0].real / abs(poles[0])) == pytest.approx(0.05, rel=1e-14)


def test_the_gains_of_a_magnetic_bearing_move_the_poles_of_its_closed_loop():
    count, ki, ks, gain, derivative, mass = 2, 70.0, 2.1e5, 1.1e4, 8.0, 50.0
    found = machine(("stiffness", "damping"), **{**BEARING, "proportional_gain": gain, "derivative_gain": derivative})

    # m z'' = n (ki i + ks z),  i = -(P z + D z'), written as it stands
    loop = mpmath.matrix([[0, 1], [count * (-ki * gain + ks) / mass, -count * ki * derivative / mass]])
    expected = sorted(mpmath.eig(loop)[0], key=lambda pole: pole.imag)
    poles = sorted(np.roots([found.mass, found.damping, found.stiffness]), key=lambda pole: pole.imag)
    assert all(abs(one - other) < 1e-10 * abs(one) for one, other in zip(poles, expected, strict=True))


# ------------------------------------------------------------------------------------------ what may be combined


@pytest.mark.parametrize(
    ("entries", "start"),
    [
        ({"unbalance": "3 g mm"}, "unbalance = 3 g mm: sets eccentricity, which is set too; give one of the two"),
        ({"damping_ratio": 0.1}, "damping_ratio = 0.1: sets damping, which is set too"),
        ({**BEARING, "derivative_gain": 10}, "derivative_gain = 10: sets damping, which is set too"),
        ({"rated_speed": "3 Hz"}, "rated_speed = 3 Hz: has no effect without balance_grade"),
        ({"magnetic_bearings": 2}, "magnetic_bearings = 2: has no effect without force_current_factor or force_limit"),
        ({"negative_stiffness": 2}, "negative_stiffness = 2: has no effect without force_current_factor"),
        (
            {**BEARING, "current_limit": "3 A", "negative_stiffness": None},
            "current_limit = 3 A: needs negative_stiffness too",
        ),
    ],
)
def test_entries_that_could_disagree_or_change_nothing_are_named(entries, start):
    assert str(error_of(lambda: machine((), **entries))).startswith(start)


@pytest.mark.parametrize(
    ("without", "entries", "start"),
    [
        ("damping", {"derivative_gain": 10}, "derivative_gain = 10: needs force_current_factor too, which must be"),
        (
            "stiffness",
            {**BEARING, "proportional_gain": "2000 A/m"},
            "proportional_gain = 2000 A/m: gives stiffness = magnetic_bearings (force_current_factor proportional_gain",
        ),
        ("eccentricity", {"unbalance": "50 kg m"}, "unbalance = 50 kg m: gives eccentricity = 1 m, which gives rho"),
        ("eccentricity", {"balance_grade": "g 2.5"}, "balance_grade = g 2.5: must be a balance grade in mm/s"),
        ("eccentricity", {"balance_grade": "G 2.5 mm/s"}, "balance_grade = G 2.5 mm/s: must be a balance grade"),
        ("eccentricity", {"unbalance": "15 g/mm"}, "unbalance = 15 g/mm: must be an unbalance in kg m"),
        ("eccentricity", {}, "eccentricity = nothing given: missing in [machine]; must be a length"),
    ],
)
def test_terms_that_make_no_machine_are_named_as_they_were_written(without, entries, start):
    assert str(error_of(lambda: machine(without, **entries))).startswith(start)


def test_a_gain_too_small_says_which_is_enough():
    error = error_of(lambda: machine("stiffness", **BEARING, proportional_gain="3000 A/m"))

    assert error.allowed.endswith("the gain must be above negative_stiffness/force_current_factor = 3000 A/m")
    assert machine("stiffness", **BEARING, proportional_gain="3001 A/m").stiffness == 140.0


def test_a_term_to_vary_names_the_parameter_it_stands_for():
    error = error_of(lambda: field_to_vary("proportional_gain"))

    assert str(error).startswith(
        "proportional_gain is no parameter here: it stands for stiffness = magnetic_bearings ("
    )
    assert error.allowed.endswith("; use stiffness here")
    unbalance = error_of(lambda: Machine(**PLAIN).parameters.replace(unbalance="3 g mm"))
    assert str(unbalance) == "unbalance = 3 g mm: it stands for eccentricity = unbalance/mass; use eccentricity here"
    assert field_to_vary("stiffness") is MACHINE_FIELDS["stiffness"]
    assert "did you mean stiffness?" in error_of(lambda: field_to_vary("stifness")).allowed


def test_every_entry_of_a_machine_is_described():
    assert ENTRIES.keys() == MACHINE_FIELDS.keys() | TERM_FIELDS.keys() | HELPER_FIELDS.keys()
    for name, field in ENTRIES.items():
        example = tomllib.loads(f"x = {field.example}")["x"]
        assert field.contains(float(read_decimal(field, example))), name
