"""Settings `name=value` on top of a machine file."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from carom.base.outcome import InputError
from carom.loading import load

REAL = "examples/keogh-cole.toml"
PAPER = "examples/source-paper.toml"


def error_of(path, *settings):
    """The input error of loading; each line of its message names its parts."""
    with pytest.raises(InputError) as caught:
        load(path, settings)
    error = caught.value
    for line, one in zip(str(error).split("\n"), error.errors, strict=True):
        assert line.startswith(f"{one.field} = ")
    return error


@pytest.mark.parametrize("path", [REAL, PAPER])
@given(gamma=st.floats(1e-6, 100), omega=st.floats(1e-2, 100), rho=st.floats(0, 100), radius_ratio=st.floats(1e-2, 1e6))
def test_settings_are_exact_and_the_machine_follows(path, gamma, omega, rho, radius_ratio):
    numbers = {"gamma": gamma, "omega": omega, "rho": rho if rho > 1e-20 else 0.0, "radius_ratio": radius_ratio}

    case = load(path, [f"{name}={number!r}" for name, number in numbers.items()])

    followed = (case.machine or case).parameters.as_dict()
    for name, number in numbers.items():
        assert getattr(case.parameters, name) == number
        assert abs(followed[name] - number) <= math.ulp(number)


def test_physical_settings_change_what_depends_on_them():
    case = load(REAL, ["speed=1500 rpm", "damping = 2000 N s/m", "friction=0.2", "mass=60"])

    expected = load(REAL).machine.replace(speed="1500 rpm", damping=2000, friction=0.2, mass=60)
    assert case.machine == expected
    assert case.parameters == expected.parameters
    assert case.parameters.mu == 0.2


@pytest.mark.parametrize("path", [REAL, PAPER])
@pytest.mark.parametrize(
    ("settings", "start"),
    [
        (["gamma"], "--set = gamma: must be name=value"),
        (["=0.1"], "--set = =0.1: must be name=value"),
        (["gamma="], "gamma = '': must be a number"),
        (["gamma=nan"], "gamma = nan: must be a number"),
        (["gamma=1e400"], "gamma = 1e400: must be a number"),
        (["gamma=0.1=0.2"], "gamma = 0.1=0.2: must be a number"),
        (["gamma=0.1 kg"], "gamma = 0.1 kg: must be a number"),
        (["omega=0"], "omega = 0: must be a number, > 0"),
        (["d=2"], "d = 2: must be a number, 0 to 1"),
        (["gama=0.1"], "gama = 0.1: unknown name in a machine or its parameters; did you mean gamma?"),
        (["gamma=0.1", "gamma=0.2"], "gamma = 0.2: is set twice"),
        (["damping=3 N s/m", "gamma=0.1"], "gamma = 0.1: sets damping, which is set too"),
        (["omega=1", "gamma=0"], "gamma = 0"),
    ],
)
def test_nonsense_settings_are_named(path, settings, start):
    assert str(error_of(path, *settings)).startswith(start)
