"""Machine files, settings, cases and zones."""

import math
import warnings

import pytest
from hypothesis import given
from hypothesis import strategies as st
from machines import PAPER as PARAMETERS
from machines import REAL as MACHINE

from carom.base.outcome import CaromWarning, InputError
from carom.loading import load
from carom.parameters import Case, Scales, Zones

REAL = "examples/keogh-cole.toml"
PAPER = "examples/source-paper.toml"
ENTRIES = {
    "mass": '"50 kg"',
    "damping": '"1400 N s/m"',
    "stiffness": '"9.8e5 N/m"',
    "eccentricity": '"0.3 mm"',
    "clearance": '"0.7 mm"',
    "rotor_radius": '"40 mm"',
    "speed": '"184.2 rad/s"',
    "unbalance_phase": '"0.21 rad"',
    "friction": "0.15",
    "restitution": "0.95",
}
NUMBERS = PARAMETERS.as_dict()


def text_of(table, entries):
    return f"[{table}]\n" + "".join(f"{name} = {value}\n" for name, value in entries.items())


@pytest.fixture
def write(tmp_path):
    """Write the content of a machine file and return its path."""

    def write(content):
        path = tmp_path / "rotor.toml"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write


def error_of(path, *settings):
    """The input error of loading; its message is one line and names its parts."""
    with pytest.raises(InputError) as caught:
        load(path, settings)
    error = caught.value
    assert "\n" not in str(error)
    assert str(error).startswith(f"{error.field} = ")
    return error


# ------------------------------------------------------------------------------------------ examples


def test_the_real_machine_is_the_one_of_keogh_and_cole():
    case = load(REAL)

    assert case.name == "keogh-cole"
    assert case.machine == MACHINE
    assert case.machine == load(str(REAL)).machine
    assert case.parameters == case.machine.parameters
    assert case.parameters.scales == Scales(50, 0.7e-3, 184.2)
    assert case.zones == Zones()


def test_the_paper_case_is_dimensionless():
    case = load(PAPER)

    assert case.parameters.as_dict() == NUMBERS
    assert case.parameters.scales is None
    assert case.machine is None


# ------------------------------------------------------------------------------------------ round trip of files


@given(
    damping=st.one_of(st.just(0.0), st.floats(1e-6, 1e5)),
    stiffness=st.floats(1e2, 1e9),
    eccentricity=st.one_of(st.just(0.0), st.floats(1e-12, 1e-2)),
    speed=st.floats(100, 300),
    unbalance_phase=st.floats(-1e6, 1e6),
    restitution=st.floats(0, 1),
)
def test_a_machine_written_to_a_file_is_read_back_in_every_bit(tmp_path_factory, **values):
    machine = load(REAL).machine.replace(**values)
    path = tmp_path_factory.mktemp("round", numbered=True) / "machine.toml"
    path.write_text(machine.to_toml(), encoding="utf-8")

    assert load(path).machine == machine


def test_si_numbers_and_text_with_units_are_the_same_machine(write):
    plain = {**dict.fromkeys(ENTRIES), **{name: getattr(load(REAL).machine, name) for name in ENTRIES}}

    assert load(write(text_of("machine", plain))).machine == load(REAL).machine


@pytest.mark.parametrize(
    ("changes", "settings", "shown"),
    [
        (
            {"clearance": "0.25", "rotor_radius": '"55 mm"'},
            (),
            "clearance = 0.25, rotor_radius = 55 mm: a rotor radius of 0.22",
        ),
        ({}, ["clearance=8.1 mm"], "clearance = 8.1 mm, rotor_radius = 40 mm: a rotor radius of 4.94 clearances"),
        ({}, ["radius_ratio=4.9"], None),
        ({}, ["clearance=8 mm"], None),
        ({"clearance": "0.25"}, ["clearance=0.25 mm"], None),
    ],
)
def test_a_clearance_that_leaves_no_shaft_brings_a_warning(write, changes, settings, shown):
    path = write(text_of("machine", ENTRIES | changes))

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        load(path, settings)

    assert [entry.category for entry in caught] == [CaromWarning] * (shown is not None)
    assert all(str(entry.message).startswith(shown) for entry in caught)


# ------------------------------------------------------------------------------------------ entries


def test_a_physical_name_in_a_dimensionless_table_suggests_its_partner(write):
    error = error_of(write(text_of("dimensionless", {**NUMBERS, "friction": "0.1"})))

    assert "did you mean mu?" in error.allowed


# ------------------------------------------------------------------------------------------ files


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        ("", "it is empty"),
        ("[zones]\nlimits = [0.1, 0.2, 0.3]\n", "holds none"),
        (text_of("machine", ENTRIES) + text_of("dimensionless", NUMBERS), "holds more"),
        ("[machine]\n\nmass = \n", "line 3"),
        ("[machine]\nmass = 50\nmass = 51\n", "the same key is given twice"),
        ("[machine]\nmass = 50\n[machine]\n", "line 3"),
        (b"[machine]\nmass = '\xff'\n", "UTF-8; line 2 is not"),
        (text_of("machine", ENTRIES).encode("utf-16"), "UTF-8; line 1 is not"),
        (b"\x00\x01\x02", "valid TOML"),
        ("[machine]\nmass = " + "1" * 5000, "a number in it has thousands of digits"),
        (b"# " + b"x" * 2_000_000, "in less than 1000000 bytes"),
    ],
)
def test_content_that_is_no_machine_file(write, content, reason):
    path = write(content)

    error = error_of(path)

    assert error.field == "machine file"
    assert error.value == str(path)
    assert reason in error.allowed


# ------------------------------------------------------------------------------------------ zones


@pytest.mark.parametrize(
    ("radius", "zone"),
    [(0, "A"), (0.3, "A"), (math.nextafter(0.3, 1), "B"), (0.4, "B"), (0.45, "C"), (0.5, "C"), (0.51, "D"), (1.0, "D")],
)
def test_zones_follow_the_standard(radius, zone):
    assert Zones().zone(radius) == zone


def test_zone_limits_are_read_from_the_file(write):
    case = load(write(text_of("machine", ENTRIES) + "[zones]\nlimits = [0.2, 0.5, 1]\n"))

    assert case == Case("rotor", case.machine.parameters, load(REAL).machine, Zones((0.2, 0.5, 1.0)))
    assert case.zones.zone(0.25) == "B"


@pytest.mark.parametrize(
    ("limits", "as_shown"),
    [
        *[("[0.3, 0.4]", "[0.3, 0.4]"), ("[0.3, 0.4, 0.5, 0.6]", "[0.3"), ("0.3", "0.3"), ("[0.4, 0.3, 0.5]", "[0.4")],
        *[("[0.3, 0.4, 1.5]", "[0.3"), ("[0, 0.4, 0.5]", "[0"), ("[nan, 0.4, 0.5]", "[nan"), ("[-1, 0.4, 0.5]", "[-1")],
        *[('["0.3", 0.4, 0.5]', "['0.3'"), ("[true, 0.4, 0.5]", "[True"), ('"A"', "A"), ("[0.3, 0.3, 0.5]", "[0.3")],
    ],
)
def test_zone_limits_that_make_no_zones_are_named(write, limits, as_shown):
    error = error_of(write(text_of("machine", ENTRIES) + f"[zones]\nlimits = {limits}\n"))

    assert error.field == "limits"
    assert error.value.startswith(as_shown)
    assert "three numbers that increase" in error.allowed


# ------------------------------------------------------------------------------------------ exact text, and the way back


def test_numbers_keep_their_text_to_the_end(write):
    case = load(
        write(
            "[dimensionless]\ngamma = 0.10\nomega = 7.6e-1\nrho = '0.43'\nphi = 0\nmu = 1_0e-1\nd = 0.95\nradius_ratio = 57"
        )
    )
    assert [getattr(case.written[name], "text", case.written[name]) for name in case.written] == [
        "0.10", "7.6e-1", "0.43", 0, "10e-1", "0.95", 57,
    ]  # fmt: skip
    assert case.replace(gamma="1e-1").written["gamma"] == "1e-1"
    real = load("examples/tum-test-rig.toml", ["damping=2000 N s/m"])
    assert real.written["damping"] == "2000 N s/m"
    assert real.written["clearance"] == real.machine.clearance  # it follows from a diameter
