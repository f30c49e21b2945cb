"""Starts, kicks and times from text."""

import math
import re
from pathlib import Path

import pytest
from machines import SCALES
from refusals import assert_refused

from carom import State, kick, load
from carom.base.outcome import InputError
from carom.cli import main
from carom.cli.starts import check_exact, read_one, read_positive, read_range, read_time, read_value, with_requirement
from carom.disturbances import BladeLoss, Single
from carom.disturbances.single import read_single
from carom.models import axis, jeffcott
from carom.parameters import Parameters, Requirement, Shock


def read_kick(text, scales):
    return read_one("--kick", text, scales)


def read_start(text, scales):
    """The state of a start of the machine whose scales are known."""
    return read_one("--start", text, scales).stages(
        jeffcott(Parameters(0.15, 0.76, 0.3, 0.21, 0.15, 0.95, 57.0, scales))
    )[1]


def read_blade_loss(text, scales):
    return read_single(BladeLoss, text, scales, "--blade-loss")


def test_plain_starts_and_times_are_dimensionless_with_and_without_scales():
    for scales in (SCALES, None):
        assert read_start("0.5, -0.25,1e-3,-2", scales) == State(0.5 - 0.25j, 1e-3 - 2j)
        assert read_time("500", scales) == 500.0


def test_plain_disturbances_are_dimensionless_without_scales():
    assert read_kick("0.4", None) == kick(0.4)
    assert read_kick("0.4,0.2", None) == kick(0.4, 0.2)
    assert read_kick("1,2", None) == kick(1.0, 2.0)
    assert read_blade_loss("0.4,0.2", None) == Single(BladeLoss(0.4), (0.2,))
    for node in ("3", "node 3"):
        assert read_blade_loss(f"0.4,0.2,{node}", None) == Single(BladeLoss(0.4, 3), (0.2,))
    assert read_positive("--peak", "3", "acceleration", None) == 3.0


@pytest.mark.parametrize(
    ("read", "text", "advice"),
    [
        (read_kick, "60", "such as '50 mm/s'; this has no unit: write 60 mm/s or 60 m/s"),
        (read_kick, "50 mm/s,30", "such as '30 deg'; this has no unit: write 30 deg or 30 rad"),
        (read_kick, "0,06", "such as '50 mm/s,30 deg'; decimals take a point, not a comma: write 0.06 with its unit"),
        (read_kick, "1,500 mm/s", "a comma may mark decimals or thousands: write 1.500 mm/s or 1 500 mm/s"),
        (read_kick, "60,30", "decimals take a point, not a comma: write 60.30 with its unit"),
        (read_blade_loss, "0.4", "this has no unit: write 0.4 g mm or 0.4 kg m"),
        (read_blade_loss, "0.1 mm,30", "this has no unit: write 30 deg or 30 rad"),
        (lambda text, scales: read_positive("--peak", text, "acceleration", scales), "20", "write 20 g or 20 m/s^2"),
        (lambda text, scales: read_positive("--duration", text, "time", scales), "5", "write 5 ms or 5 s"),
    ],
)
def test_bare_numbers_are_refused_where_units_are_known_with_what_to_write(read, text, advice):
    with pytest.raises(InputError) as caught:
        read(text, SCALES)

    assert str(caught.value).endswith(advice)
    assert "\n" not in str(caught.value)


def test_a_decimal_comma_is_no_kick_of_zero_without_scales_either():
    with pytest.raises(InputError, match=r"--kick = 0,06: must be SPEED .* write 0\.06$"):
        read_kick("0,06", None)


def test_an_angle_of_zero_needs_no_unit():
    assert read_kick("50 mm/s,0", SCALES) == kick(0.05 / SCALES.velocity, 0.0)


@pytest.mark.parametrize(
    ("name", "text", "advice"),
    [
        (
            "speed",
            "500",
            "--from = 500: speed must be an angular speed in rad/s, .*; this has no unit: write 500 rpm or 500 rad/s",
        ),
        ("damping", "1e3", "this has no unit: write 1e3 N s/m"),
        ("unbalance_phase", "3", "this has no unit: write 3 rad"),
    ],
)
def test_values_of_physical_parameters_need_their_unit(name, text, advice):
    parameters = Parameters(0.15, 0.76, 0.3, 0.21, 0.15, 0.95, 57.0, SCALES)
    with pytest.raises(InputError, match=advice):
        read_value("--from", text, axis(parameters, name))
    for exact in (text, f"double {text}"):
        with pytest.raises(InputError, match="this has no unit"):
            check_exact("--from", exact, name)


@pytest.mark.parametrize(("name", "number"), [("friction", 0.2), ("gamma", 0.2), ("phi", 0.2), ("radius_ratio", 0.2)])
def test_values_without_dimension_need_no_unit(name, number):
    parameters = Parameters(0.15, 0.76, 0.3, 0.21, 0.15, 0.95, 57.0, SCALES)

    assert read_value("--from", "0.2", axis(parameters, name)) == number
    check_exact("--from", "0.2", name)


def test_units_may_be_mixed():
    state = read_start("0.35 mm,0.5,0,2 cm/s", SCALES)

    assert state.position == pytest.approx(0.5 + 0.5j, rel=1e-15)
    assert state.velocity == pytest.approx(0.02j / (0.7e-3 * 184.2), rel=1e-15)


def test_angles_need_no_scales():
    assert read_kick("0.4,90 deg", None).values[1] == pytest.approx(math.pi / 2, rel=1e-15)


def test_time_in_seconds():
    assert read_time("2 s", SCALES) == pytest.approx(2 * 184.2, rel=1e-15)
    assert read_time("1 min", SCALES) == pytest.approx(60 * 184.2, rel=1e-15)


def test_start_on_the_wall_is_allowed_and_beyond_it_is_not():
    assert abs(read_start("0.6,0.8,0,0", None).position) == pytest.approx(1.0, rel=1e-15)
    with pytest.raises(InputError, match="start") as caught:
        read_start("0.6,0.81,0,0", None)
    assert caught.value.field == "start"


@pytest.mark.parametrize("option", ["--until", "--longest-period"])
def test_error_names_the_option(option):
    with pytest.raises(InputError) as caught:
        read_time("soon", SCALES, option)
    assert caught.value.field == option


def test_a_range_may_be_given_in_either_order():
    parameters = Parameters(0.15, 0.76, 0.3, 0.21, 0.15, 0.95, 57.0, SCALES)
    damping = axis(parameters, "damping")

    assert read_range("--x", "4000 N s/m, 500 N s/m", damping) == (500.0, 4000.0)
    assert read_range("--x", "500 N s/m,4 kN s/m", damping) == (500.0, 4000.0)
    assert read_range("--x", "1,400 N s/m,12,500 N s/m", damping) == (1400.0, 12500.0)
    with pytest.raises(
        InputError, match=r"--x = 1 m: damping must be a damping in N s/m, .*; 'm' is not a unit of damping"
    ):
        read_range("--x", "1 m,2", damping)


@pytest.mark.parametrize("ends", [("0.1", "0.4"), ("0.4", "0.1")])
def test_from_may_be_above_to(monkeypatch, dimensionless, ends):
    given = []

    def stop(parameters, name, interval, **_):
        given.append((name, interval))
        raise InputError("stop", None, "here")

    monkeypatch.setattr("carom.bifurcations.find_bifurcations", stop)
    main(["bifurcations", dimensionless, "--along", "gamma", "--from", ends[0], "--to", ends[1]])

    assert given == [("gamma", (0.1, 0.4))]


def test_options_state_what_must_be_survived_in_place_of_the_file(tmp_path):
    path = tmp_path / "machine.toml"
    text = Path("examples/keogh-cole.toml").read_text(encoding="utf-8")
    path.write_text(f'{text}\n[survive]\nkick = "100 mm/s"\nshock = "50 m/s^2"\n', encoding="utf-8")
    case = load(path)
    assert with_requirement(case, kick=None, shock=None, blade_loss=None) == case
    given = with_requirement(case, kick="0.2 m/s", shock=None, blade_loss="2000 g mm")
    assert given.requirement == Requirement(0.2, Shock(50.0, 0.011), 0.002, "option")
    assert given.parameters == case.parameters


@pytest.mark.parametrize(
    ("option", "text", "words"),
    [
        ("kick", "60", "--kick = 60: must be a velocity in m/s"),
        ("blade_loss", "50 kg m", "--blade-loss = 50.0: gives a change of the eccentricity of 1428.57 clearances"),
    ],
)
def test_bad_requirements_name_the_option(option, text, words):
    assert_refused(lambda: with_requirement(load("examples/keogh-cole.toml"), **{option: text}), re.escape(words))
