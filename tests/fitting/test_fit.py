"""Fits of a planar rotor through impacts, to records by a general integrator."""

import numpy as np
import pytest
from touch_records import CLEARANCE, SPEED, struck

import carom as cm
from carom.base.outcome import InputError
from carom.fitting import Channel, Record, fit
from carom.fitting.stretches import Observed, derivative
from carom.models import rotor_of

MACHINE = cm.load("examples/spindle.toml")
NAMES = ["friction", "restitution", "damping", "stiffness", "eccentricity"]
WIDE = 3e-3
KICK = 0.35 * np.exp(1j)
TRUE = {"friction": 0.17, "restitution": 0.75, "damping": 300.0, "stiffness": 4.2e5, "eccentricity": 2e-6}
AXES = (Channel.read("x [m]"), Channel.read("y [m]"))


def record(values=TRUE, noise=0.01, kick=KICK, seconds=0.04, offset=(3e-6, -2e-6), **others):
    """A record with noise, relative to the clearance, and offsets of the sensors."""
    times, places, impacts = struck(values, kick, seconds, 20_000, phase=0.7, **others)
    random = np.random.default_rng(5)
    seen = np.column_stack([places.real, places.imag]) + noise * CLEARANCE * random.standard_normal((len(times), 2))
    return Record("by a general integrator", times, seen + offset, AXES), len(impacts)


@pytest.fixture(scope="module")
def fitted():
    measured, impacts = record()
    return fit(MACHINE, measured, NAMES, progress=False), impacts


def test_fitted_values_are_those_of_the_record_within_their_intervals(fitted):
    found, impacts = fitted
    for name, true in TRUE.items():
        assert abs(np.log(found[name].value / true)) < 3.5 * found[name].error
        assert found[name].error < 0.05
    assert found.contacts == impacts
    assert found.is_good_enough
    assert found.noise == pytest.approx(0.01 * CLEARANCE, rel=0.1)
    assert found.offsets == pytest.approx([3e-6, -2e-6], abs=5e-7)
    assert found.angle % (2 * np.pi) + MACHINE.parameters.phi == pytest.approx(0.7, abs=0.1)


def test_a_rotor_whose_weight_is_left_out_is_determined_not_to_be_good_enough():
    found = fit(MACHINE, record(gravity=300.0, noise=0.003)[0], NAMES, starts=1, progress=False)
    assert not found.is_good_enough
    assert any("does not explain the record" in each for each in found.sentences)


def test_friction_is_not_determined_by_a_record_without_contact():
    found = fit(MACHINE, record(kick=0.05 + 0j)[0], ["friction", "damping"], starts=1, progress=False)
    assert not found["friction"].is_determined
    assert found["damping"].is_determined
    assert "This record does not determine friction." in found.sentences


def observed(**changes):
    measured, _ = record(noise=0.0)
    return Observed(rotor_of(MACHINE.replace(**changes)), measured, 0.0, (CLEARANCE, SPEED))


@pytest.mark.parametrize("name", ["friction", "restitution", "damping", "eccentricity"])
def test_derivatives_through_impacts_are_those_of_wide_differences(name):
    """Through two impacts, against differences of sixth order of the end over longer steps: samples may lie between impacts then."""
    begin, value = np.array([0.0, 0.0, 0.3, 0.5]), rotor_of(MACHINE).value(name)

    def along(step):
        return observed(**{name: value * (1.0 + step)}).follow(begin, 0, 160)

    start = along(0.0)
    assert start.contacts >= 2
    weights, wide = {1: 0.75, 2: -0.15, 3: 1.0 / 60.0}, WIDE
    expected = sum(w * (along(k * wide).end - along(-k * wide).end) for k, w in weights.items()) / wide
    found = derivative(along, start.events)[-4:]
    assert found == pytest.approx(expected, rel=1e-6, abs=1e-6 * np.abs(expected).max())


def test_the_phase_of_the_unbalance_needs_a_keyphasor():
    with pytest.raises(InputError, match="without one the angle of the shaft is fitted"):
        fit(MACHINE, record()[0], ["unbalance_phase"], progress=False)


def test_a_rotor_with_more_coordinates_than_sensors_show_is_refused_in_a_line():
    with pytest.raises(InputError, match="coordinates: up to 6 of them"):
        fit(cm.load("examples/tum-flexible-rotor.toml"), record()[0], ["friction"], progress=False)
