"""Starts, kicks and times from text."""

import math

import pytest

from carom.cli import main
from carom.cli.starts import read_kick, read_range, read_start, read_time
from carom.models import axis
from carom.motions.starts import Kick, State
from carom.outcome import InputError
from carom.parameters import Parameters, Scales

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
