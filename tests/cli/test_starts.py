"""Starts, kicks and times from text."""

import math
from pathlib import Path

import pytest

from carom.cli import main
from carom.cli.starts import read_kick, read_range, read_start, read_time, with_requirement
from carom.models import axis
from carom.motions.starts import Kick, State
from carom.outcome import InputError
from carom.parameters import Parameters, Requirement, Scales, Shock, load

SCALES = Scales(mass=50.0, clearance=0.7e-3, speed=184.2)


def test_plain_numbers_are_dimensionless_with_and_without_scales():
    for scales in (SCALES, None):
        assert read_start("0.5, -0.25,1e-3,-2", scales) == State(0.5 - 0.25j, 1e-3 - 2j)
        assert read_kick("0.4", scales) == Kick(0.4)
        assert read_kick("0.4,0.2", scales) == Kick(0.4, 0.2)
        assert read_time("500", scales) == 500.0


def test_units_may_be_mixed():
    state = read_start("0.35 mm,0.5,0,2 cm/s", SCALES)

    assert state.position == pytest.approx(0.5 + 0.5j, rel=1e-15)
    assert state.velocity == pytest.approx(0.02j / (0.7e-3 * 184.2), rel=1e-15)


def test_angles_need_no_scales():
    assert read_kick("0.4,90 deg", None).angle == pytest.approx(math.pi / 2, rel=1e-15)


def test_time_in_seconds():
    assert read_time("2 s", SCALES) == pytest.approx(2 * 184.2, rel=1e-15)
    assert read_time("1 min", SCALES) == pytest.approx(60 * 184.2, rel=1e-15)


def test_start_on_the_wall_is_allowed_and_beyond_it_is_not():
    assert abs(read_start("0.6,0.8,0,0", None).position) == pytest.approx(1.0, rel=1e-15)
    with pytest.raises(InputError, match="--start") as caught:
        read_start("0.6,0.81,0,0", None)
    assert caught.value.field == "--start"
    assert caught.value.value == "0.6,0.81,0,0"


@pytest.mark.parametrize("option", ["--until", "--longest-period"])
def test_error_names_the_option(option):
    with pytest.raises(InputError) as caught:
        read_time("soon", SCALES, option)
    assert caught.value.field == option


def test_a_range_may_be_given_in_either_order():
    parameters = Parameters(0.15, 0.76, 0.3, 0.21, 0.15, 0.95, 57.0, SCALES)
    damping = axis(parameters, "damping")

    assert read_range("--x", "4000 N s/m, 500", damping) == (500.0, 4000.0)
    assert read_range("--x", "500,4 kN s/m", damping) == (500.0, 4000.0)
    with pytest.raises(InputError, match=r"--x = 1 m: damping must be a damping in N s/m, .* is in N s/m\)"):
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
        ("kick", "60", "--kick = 60: must be a velocity above 0 with its unit"),
        ("shock", "5 g, 3", "--shock = 5 g, 3: must be an acceleration above 0 with its unit"),
        ("blade_loss", "1", "--blade-loss = 1: must be an unbalance above 0 with its unit"),
        ("blade_loss", "50 kg m", "--blade-loss = 50.0: gives an eccentricity of 1428.57 clearances"),
    ],
)
def test_bad_requirements_name_the_option(option, text, words):
    with pytest.raises(InputError) as refused:
        with_requirement(load("examples/keogh-cole.toml"), **{option: text})
    assert words in str(refused.value)
