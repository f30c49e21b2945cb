"""The machine: its fields, its dimensionless parameters and the way back."""

import math
import pickle

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from machines import PAPER, REAL, machine_of
from refusals import ALLOWED, error_of

from carom.parameters import DIMENSIONLESS_FIELDS, MACHINE_FIELDS, PHYSICAL_PARTNER, Machine, Parameters, Scales

SI = {name: getattr(REAL, name) for name in MACHINE_FIELDS}
POSITIVE = ("mass", "stiffness", "clearance", "rotor_radius", "speed")
NOT_NEGATIVE = ("damping", "eccentricity", "friction", "restitution")
NUMBERS = PAPER.as_dict()


def ulps(number, other):
    return abs(number - other) / math.ulp(min(abs(number), abs(other)))


@st.composite
def decimals(draw, lowest, highest, digits=15):
    """Doubles that a person writes with at most so many significant digits, log-uniform in size."""
    number = 10 ** draw(st.floats(math.log10(lowest), math.log10(highest)))
    return float(f"{number:.{draw(st.integers(0, digits - 1))}e}")


@st.composite
def machines(draw, digits=15):
    """Values of a machine, each of at most so many digits, within the ranges of the dimensionless numbers."""

    def some(lowest, highest):
        return draw(decimals(lowest, highest, digits))

    mass, clearance, speed = some(1e-3, 1e5), some(1e-6, 1e-1), some(1e-1, 1e4)
    damping, stiffness = mass * speed, mass * speed**2
    values = {"mass": mass, "clearance": clearance, "speed": speed}
    values["damping"] = draw(st.sampled_from([0.0, some(1e-3 * damping, 1e2 * damping)]))
    values["stiffness"] = some(1e-4 * stiffness, 1e4 * stiffness)
    values["eccentricity"] = draw(st.sampled_from([0.0, some(1e-3 * clearance, 1e2 * clearance)]))
    values["rotor_radius"] = some(1e-1 * clearance, 1e6 * clearance)
    values["unbalance_phase"] = draw(st.floats(-10, 10))
    values["friction"] = draw(st.floats(0, 10))
    values["restitution"] = draw(st.floats(0, 1))
    assume(values["damping"] > 0 or abs(values["stiffness"] / stiffness - 1) > 1e-6)  # not in undamped resonance
    return Machine(**values)


# ------------------------------------------------------------------------------------------ fields


def test_the_machine_of_keogh_and_cole_has_the_printed_parameters():
    parameters = Machine(**SI).parameters

    assert parameters.gamma == pytest.approx(0.152, abs=5e-4)
    assert parameters.omega == pytest.approx(0.76, abs=5e-3)
    assert parameters.rho == 3 / 7
    assert parameters.radius_ratio == pytest.approx(57.143, abs=5e-4)
    assert (parameters.phi, parameters.mu, parameters.d) == (0.21, 0.15, 0.95)
    assert parameters.omega**2 == pytest.approx(9.8e5 / (50 * 184.2**2), rel=1e-15)
    assert parameters.scales == Scales(50, 0.7e-3, 184.2)


@pytest.mark.parametrize("field", [name for name in SI if name != "unbalance_phase"])
def test_a_missing_field_is_named(field):
    error = error_of(lambda: Machine(**{name: value for name, value in SI.items() if name != field}))

    assert error.field == field
    assert error.allowed.startswith(f"missing in [machine]; {ALLOWED[field]}")


@pytest.mark.parametrize("field", SI)
@pytest.mark.parametrize(
    ("value", "as_shown"),
    [
        *[(math.nan, "nan"), (math.inf, "inf"), (-math.inf, "-inf"), ("nan", "nan"), ("-inf", "-inf")],
        *[(1e300, "1e+300"), (-1e300, "-1e+300"), pytest.param(10**400, "1000000", id="googol")],
        *[(True, "true"), (False, "false"), ("", "''"), ("  ", "'"), ("many", "many"), ("1e999 m", "1e999 m")],
        *[([1.0], "[1.0]"), ({"value": 1}, "{'value': 1}"), (None, "None"), (1j, "1j"), (b"1", "b'1'")],
    ],
)
def test_nonsense_is_refused_in_every_field(field, value, as_shown):
    error = error_of(lambda: Machine(**{**SI, field: value}))

    assert str(error).startswith(f"{field} = {as_shown}")
    assert error.allowed.startswith(ALLOWED[field])


@pytest.mark.parametrize("field", POSITIVE)
@pytest.mark.parametrize("value", [0, -0.0, -1, -1e-3, 1e-200])
def test_positive_fields_are_positive(field, value):
    error = error_of(lambda: Machine(**{**SI, field: value}))

    assert str(error).startswith(f"{field} = {value}: {ALLOWED[field]}")


@pytest.mark.parametrize("field", NOT_NEGATIVE)
def test_other_fields_may_be_zero_and_not_negative(field):
    error = error_of(lambda: Machine(**{**SI, field: -1e-3}))

    assert str(error).startswith(f"{field} = -0.001: {ALLOWED[field]}")
    assert getattr(Machine(**{**SI, field: -0.0}), field) == 0.0


@pytest.mark.parametrize(("field", "value"), [("damping", "1e-40 N s/m"), ("eccentricity", 1e-40)])
def test_a_value_too_close_to_zero_says_so(field, value):
    assert error_of(lambda: Machine(**{**SI, field: value})).allowed.endswith("this is too close to 0")


@pytest.mark.parametrize(
    ("field", "text", "number"),
    [
        ("damping", "1e9 N s/m", "gamma"),
        ("stiffness", "1e20 N/m", "omega"),
        ("stiffness", "1e-20 N/m", "omega"),
        ("eccentricity", "5 m", "rho"),
        ("rotor_radius", "1e-8 m", "radius_ratio"),
    ],
)
def test_a_machine_out_of_proportion_names_field_and_dimensionless_number(field, text, number):
    error = error_of(lambda: Machine(**{**SI, field: text}))

    assert str(error).startswith(f"{field} = {text}: gives {number} = ")
    assert DIMENSIONLESS_FIELDS[number].allowed in error.allowed


def test_a_machine_is_a_value():
    machine = Machine(**SI)

    assert machine == Machine(**{**SI, "mass": "50 kg"})
    assert hash(machine) == hash(Machine(**SI))
    assert pickle.loads(pickle.dumps(machine)) == machine
    with pytest.raises(AttributeError, match="frozen"):
        machine.mass = 3.0


# ------------------------------------------------------------------------------------------ round trip


@given(machines())
def test_a_machine_of_fifteen_digits_comes_back_in_every_bit(machine):
    assert machine_of(machine.parameters) == machine


@given(machines(digits=17))
def test_parameters_of_a_machine_come_back_in_every_bit(machine):
    parameters = machine.parameters

    assert machine_of(parameters).parameters == parameters


@given(
    scales=st.builds(Scales, decimals(1e-3, 1e5, 17), decimals(1e-6, 1e-1, 17), decimals(1e-1, 1e4, 17)),
    gamma=st.floats(1e-3, 10),
    omega=st.floats(1e-2, 10),
    rho=st.floats(1e-3, 10),
    radius_ratio=st.floats(0.1, 1e4),
)
def test_parameters_come_back_as_near_as_doubles_allow(scales, gamma, omega, rho, radius_ratio):
    parameters = Parameters(gamma, omega, rho, 0.21, 0.15, 0.95, radius_ratio, scales)

    machine = machine_of(parameters)

    back = machine.parameters
    assert (back.phi, back.mu, back.d, back.scales) == (0.21, 0.15, 0.95, scales)
    for name in ("gamma", "omega", "rho", "radius_ratio"):
        wanted, got = getattr(parameters, name), getattr(back, name)
        assert ulps(wanted, got) <= 1
        if wanted != got:  # then no double near it does better
            value = getattr(machine, PHYSICAL_PARTNER[name])
            for steps in range(-20, 21):
                near = value + steps * math.ulp(value)
                changed = Machine(**{**machine.values, PHYSICAL_PARTNER[name]: near})
                assert getattr(changed.parameters, name) != wanted


# ------------------------------------------------------------------------------------------ replace


@pytest.mark.parametrize(("name", "number"), list({**NUMBERS, "gamma": 0.3, "omega": 1.7, "rho": 0.0}.items()))
def test_a_dimensionless_change_moves_its_partner_alone(name, number):
    machine = Machine(**{**SI, "stiffness": "5600 lbf/in", "rotor_radius": "1.57 inch"})

    changed = machine.replace(**{name: number})

    partner = PHYSICAL_PARTNER[name]
    assert {**changed.values, partner: 0} == {**machine.values, partner: 0}
    assert ulps(getattr(changed.parameters, name) or 1.0, number or 1.0) <= 1


@pytest.mark.parametrize(
    ("changes", "start"),
    [
        ({"gamma": -0.1}, "gamma = -0.1: sets damping to -921.0, which must be a damping in N s/m, >= 0"),
        ({"gamma": 0.1, "damping": 3}, "gamma = 0.1: sets damping, which is set too"),
        ({"gamma": 2000}, "gamma = 2000: must be a number, -1000 to 1000"),
        ({"omega": 1, "gamma": 0}, "gamma = 0: gives damping = 0 N s/m, which gives gamma"),
        ({"damping": 0, "omega": 1}, "damping = 0: gives gamma"),
        ({"gama": 1}, "gama = 1: unknown name in a machine or its parameters; did you mean gamma?"),
    ],
)
def test_a_change_that_cannot_be_made_is_named(changes, start):
    machine = Machine(**SI)

    assert str(error_of(lambda: machine.replace(**changes))).startswith(start)
