"""Text with units becomes SI numbers; names that do not exist get a suggestion."""

import decimal
import subprocess
import sys
from dataclasses import replace

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusals import ALLOWED, error_of

from carom.base.outcome import InputError
from carom.parameters import DIMENSIONLESS_FIELDS, MACHINE_FIELDS, quantities, read_quantity, unknown_name
from carom.parameters.formats import format_entry
from carom.parameters.quantities import COMMON_UNITS, read_decimal, read_exact, without_separators
from carom.parameters.terms import ENTRIES, SETTABLE

# ------------------------------------------------------------------------------------------ units


@pytest.mark.parametrize(
    ("field", "text", "number"),
    [
        ("mass", "50kg", 50.0),
        ("mass", "+5.e1 kg", 50.0),
        ("damping", "1400 N*s/m", 1400.0),
        ("damping", "1400 Ns/m", 1400.0),
        ("damping", "1.4 kN s m^-1", 1400.0),
        ("damping", "0 N s/m", 0.0),
        ("stiffness", "980000 kg*m^2*m**-2/s^2", 9.8e5),
        ("clearance", "1 thou", 0.0000254),
        ("clearance", "1 mil", 0.0000254),
        ("eccentricity", "2.5 mils", 0.0000635),
        ("speed", "1759 U/min", float(1759 * mpmath.mpf(2) * mpmath.mp.pi / 60)),
        ("restitution", 1, 1.0),
        ("restitution", np.float64(0.5), 0.5),
        ("unbalance_phase", "-0.21 rad", -0.21),
    ],
)
def test_text_with_a_unit_is_its_si_number(field, text, number):
    read = read_quantity(MACHINE_FIELDS[field], text)

    assert type(read) is float
    assert read == number


@pytest.mark.parametrize(
    ("field", "text"),
    [
        ("mass", "3 m"),
        ("mass", "20 degC"),
        ("mass", "3 dB"),
        ("damping", "1400 N s/(m rad)"),
        ("eccentricity", "0.3 mm/rev"),
        ("speed", "30 Bq"),
        ("unbalance_phase", "12 %"),
        ("unbalance_phase", "12 sr"),
        ("friction", "20 degC"),
    ],
)
def test_wrong_dimension_names_unit_and_what_is_allowed(field, text):
    error = error_of(lambda: read_quantity(MACHINE_FIELDS[field], text))

    assert str(error).startswith(f"{field} = {text}: {ALLOWED[field]}")
    assert repr(text.split(maxsplit=1)[1]) in error.allowed


@pytest.mark.parametrize(
    "text",
    [
        *(
            "5 foo",
            "5 m**9**9**9",
            "5 m^9^9",
            "5 m^(9^9)",
            "5 (m",
            "5 m)",
            "5 ()",
            "5 m/",
            "5 /m",
            "5 kg + 3 kg",
            "5 kg;",
        ),
        *("5 5", "5 kg 5", "5 __import__('os')", "0,7 kg", "1_000 kg", "5 \x1b[31mkg", "5 k\u0000g", "5 KG", "0x10 kg"),
        *("5 " + "m " * 1000, "5 " + "(" * 50, "5 " + "9" * 50, "5 lambda x: x", "5 kg\n\nkg kg"),
    ],
)
def test_unreadable_units_are_refused_at_once(text):
    error = error_of(lambda: read_quantity(MACHINE_FIELDS["mass"], text))

    assert error.field == "mass"
    assert ALLOWED["mass"] in error.allowed
    assert str(error).isprintable()


def fields_of_errors(text):
    """Read a text as every field: the numbers are allowed ones, and the errors name these fields."""
    for field in ENTRIES.values():
        try:
            number = read_quantity(field, text)
        except InputError as error:
            yield field.name, error.field
        else:
            assert field.contains(number)


@given(st.one_of(st.text(max_size=80), st.text("0123456789 ,.'’Ggm/HzrAN-_", max_size=30)))
def test_no_text_brings_anything_but_a_number_or_an_input_error(text):
    for candidate in (text, f"5 {text}"):
        assert all(named == field for field, named in fields_of_errors(candidate))


@given(st.lists(st.sampled_from(["m", "kg", "s", "N", "rad", "*", "/", "^", "**", "(", ")", " ", "1", "2", "-"])))
def test_no_combination_of_units_brings_anything_but_a_number_or_an_input_error(parts):
    assert all(named == field for field, named in fields_of_errors("0.5 " + "".join(parts)))


def test_a_number_without_a_unit_is_in_the_si_unit_in_quotes_or_not():
    for value in (50, "50", " 5e1 ", "50 kg"):
        assert read_quantity(MACHINE_FIELDS["mass"], value) == 50.0
    error = error_of(lambda: read_quantity(MACHINE_FIELDS["mass"], "50 m"))

    assert "(a number without a unit is in kg)" in error.allowed


def test_common_units_are_converted_as_pint_converts_them():
    with decimal.localcontext(quantities._DIGITS):
        by_pint = {unit: quantities._roots_by_pint(unit) for unit in COMMON_UNITS}

    assert by_pint == COMMON_UNITS


def test_units_of_all_fields_are_common():
    fields = [*MACHINE_FIELDS.values(), *DIMENSIONLESS_FIELDS.values()]

    assert {field.unit for field in fields} <= COMMON_UNITS.keys()


def test_pint_is_loaded_by_the_first_uncommon_unit_only():
    code = """if True:
        import sys
        from carom.parameters import Machine
        values = dict(mass=50, damping=1400, stiffness=9.8e5, eccentricity=0.3e-3, clearance=0.7e-3, rotor_radius=0.04,
                      speed=184.2, unbalance_phase=0.21, friction=0.15, restitution=0.95)
        machine = Machine(**values)
        machine.replace(gamma=0.1)
        print("pint" in sys.modules, "numpy" in sys.modules, "numba" in sys.modules)
        print(Machine(**{**values, "mass": "50 kg", "clearance": "0.7 mm"}) == machine, "pint" in sys.modules)
        print(Machine(**{**values, "mass": "50 kilogram"}) == machine, "pint" in sys.modules)
    """
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)

    assert done.stdout.split() == ["False", "False", "False", "True", "False", "True", "True"]


# ------------------------------------------------------------------------------------------ thousands


@pytest.mark.parametrize("gap", [" ", "\u00a0", "\u2009", "\u202f", "\u2007", "'", "’"])
def test_thousands_may_be_separated(gap):
    for text, number in [
        (f"12{gap}000", "12000"),
        (f"1{gap}234{gap}567.5 rpm", "1234567.5 rpm"),
        (f"-1{gap}000", "-1000"),
    ]:
        assert without_separators(text) == number


@pytest.mark.parametrize(
    ("name", "text", "number"),
    [
        *[("damping", "50,540 N s/m", 50540.0), ("stiffness", "2,495,000 N/m", 2495000.0)],
        *[("proportional_gain", "20,000 A/m", 20000.0), ("force_limit", "1,500 N", 1500.0)],
        *[("mass", "1,234,567 kg", 1234567.0), ("clearance", "1,234.5 mm", 1.2345), ("damping", "50,540.5", 50540.5)],
    ],
)
def test_commas_separate_thousands_where_no_other_reading_is_left(name, text, number):
    assert read_quantity(ENTRIES[name], text) == number
    assert float(read_exact(ENTRIES[name], text).rational) == number


@pytest.mark.parametrize("value", [1234.0, 50540.0, 98765.4, 2495000.0, 9.8e6, 2.5e9, 7e-7])
@pytest.mark.parametrize("name", ["damping", "stiffness", "speed", "proportional_gain"])
def test_what_carom_writes_can_be_read(name, value):
    text = format_entry(name, value, 8)

    assert "," in text or "×" in text
    assert read_quantity(replace(ENTRIES[name], lowest=0.0, highest=1e30), text) == pytest.approx(
        value, rel=1e-5
    )  # six digits before a power of ten


@pytest.mark.parametrize(
    ("name", "text", "advice"),
    [
        ("speed", "12,000 rad/s", "a comma may mark decimals or thousands: write 12.000 rad/s or 12 000 rad/s"),
        ("damping", "50,540", "a comma may mark decimals or thousands: write 50.540 or 50 540"),
        ("speed", "12,0000 rpm", "decimals take a point, not a comma: write 12.0000 rpm"),
        ("speed", "1,5 rpm", "decimals take a point, not a comma: write 1.5 rpm"),
        ("mass", "1 234,5 kg", "decimals take a point, not a comma: write 1234.5 kg"),
        ("friction", ",15", "decimals take a point, not a comma: write 0.15"),
        ("balance_grade", "G 2,5", "decimals take a point, not a comma: write 2.5"),
        ("mass", "1.234,5 kg", "decimals take a point, and spaces separate thousands: 12 345.6"),
        ("mass", "1,234,56 kg", "decimals take a point, and spaces separate thousands: 12 345.6"),
    ],
)
def test_any_other_comma_is_refused(name, text, advice):
    for read in (read_decimal, read_exact):
        error = error_of(lambda read=read: read(ENTRIES[name], text))

        assert error.allowed.endswith(advice) or text.startswith("G")
        assert "\n" not in str(error)


# ------------------------------------------------------------------------------------------ names


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        *[
            ("dampin", "damping"),
            ("Damping", "damping"),
            ("rotor-radius", "rotor_radius"),
            ("restituton", "restitution"),
        ],
        *[("c", "damping"), ("e_c", "eccentricity"), ("Ω", "speed"), ("gamma", "damping")],
    ],
)
def test_unknown_names_suggest_the_nearest(written, meant):
    error = unknown_name(written, 3, MACHINE_FIELDS, "[machine]")

    assert error.field == written
    assert f"did you mean {meant}?" in error.allowed


@pytest.mark.parametrize(
    "written", ["contact-damping", "integral_gain", "polar_inertia", "mount_mass", "bearing_force"]
)
def test_no_name_is_suggested_that_means_something_else(written):
    error = unknown_name(written, 3, SETTABLE, "[machine]")

    assert "did you mean" not in error.allowed
    assert error.allowed.startswith("unknown name in [machine]; allowed: gamma, omega")
