"""Scales and dimensionless parameters."""

import math

import pytest
from refusals import error_of

from carom.parameters import Parameters, Scales

NUMBERS = {"gamma": 0.1, "omega": 0.76, "rho": 3 / 7, "phi": 0.21, "mu": 0.15, "d": 0.95, "radius_ratio": 400 / 7}


def test_scales_are_products_of_mass_clearance_and_speed():
    scales = Scales(mass=50, clearance=0.7e-3, speed=184.2)

    assert scales.length == 0.7e-3
    assert scales.time == 1 / 184.2
    assert scales.velocity == pytest.approx(0.12894, rel=1e-15)
    assert scales.acceleration == pytest.approx(23.750748, rel=1e-15)
    assert scales.force == pytest.approx(1187.5374, rel=1e-15)
    assert scales.impulse == pytest.approx(6.447, rel=1e-15)
    assert scales.energy == pytest.approx(0.83127618, rel=1e-15)
    assert scales.power == pytest.approx(153.121072356, rel=1e-15)
    assert scales.damping == pytest.approx(9210, rel=1e-15)
    assert scales.stiffness == pytest.approx(1696482, rel=1e-15)


@pytest.mark.parametrize("name", ["mass", "clearance", "speed"])
@pytest.mark.parametrize("value", [0, -1, math.nan, math.inf, True, "1", None, 1e300])
def test_scales_are_positive_numbers(name, value):
    error = error_of(lambda: Scales(**{"mass": 1.0, "clearance": 1.0, "speed": 1.0, name: value}))

    assert error.field == name
    assert "> 0" in error.allowed


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize(
    "value",
    [math.nan, math.inf, -math.inf, True, "0.1", None, [0.1], 1e300, -1e300, pytest.param(10**400, id="googol")],
)
def test_parameters_are_finite_numbers_of_moderate_size(name, value):
    error = error_of(lambda: Parameters(**{**NUMBERS, name: value}))

    assert error.field == name
    assert error.allowed.startswith("must be a")


@pytest.mark.parametrize(
    ("name", "value"),
    [("omega", 0), ("omega", -0.76), ("rho", -0.1), ("mu", -0.1), ("d", -0.1), ("d", 1.01), ("radius_ratio", 0)],
)
def test_parameters_keep_their_range(name, value):
    assert error_of(lambda: Parameters(**{**NUMBERS, name: value})).field == name


def test_damping_may_be_negative_behind_the_door():
    assert Parameters(**{**NUMBERS, "gamma": -0.497}).gamma == -0.497
