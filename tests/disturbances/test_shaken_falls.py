"""Falls while the base moves: closed forms, shocks that are sampled finely, and DOP853 with impacts."""

import cmath

import numpy as np
import pytest
from limited_reference import follow, struck

import carom as cm
from carom.base.outcome import InputError
from carom.disturbances import BaseRecord, Single
from carom.models import rotor_of

RECORD = BaseRecord(
    (0.0, 0.3, 0.5, 0.9, 1.4), x=(0.1, 0.3, -0.2, 0.1, 0.0), y=(0.0, -0.1, 0.3, 0.2, 0.1)
).scaled(0.3)  # fmt: skip
AS_IT_IS = Single(RECORD, (RECORD.peak, 0.0))


@pytest.mark.parametrize("path", ["tests/machines/gravity.toml", "tests/machines/race.toml"])
def test_weight_and_record_make_a_fall_of_third_order(path):
    machine, rotor = cm.load(path), rotor_of(cm.load(path))
    moved, start = cm.drop(base=AS_IT_IS).apply(machine)
    parts = cm.simulate(moved, start, until=1.5).parts
    assert not any(len(part.contacts) for part in parts)
    falling = parts[-1].rotor
    steps, values = np.diff(RECORD.times), RECORD.accelerations
    place, speed = 0j, 0j
    for step, low, high in zip(steps, values[:-1], values[1:], strict=True):
        place += speed * step + (2.0 * low + high) * step**2 / 6.0
        speed += (low + high) * step / 2.0
    time, unbalance = RECORD.times[-1], complex(rotor.matrices.forcing[0] / rotor.matrices.mass[0, 0])
    begun, rate = start.position, start.velocity + 1j * start.position
    expected = begun + (rate + 1j * unbalance) * time + falling.acting.weight[0] * time**2 / 2.0 - place
    expected += unbalance * (1.0 - cmath.exp(1j * time))
    assert parts[3].final.position * cmath.exp(1j * time) == pytest.approx(expected, abs=1e-13)


@pytest.mark.parametrize(
    "path",
    [
        "tests/machines/gravity.toml",
        "tests/machines/mount.toml",
        pytest.param("examples/tum-flexible-rotor.toml", marks=pytest.mark.deep),
    ],
)
def test_a_record_shakes_a_fall_as_the_shock_that_it_samples(path):
    machine, times, peak = cm.load(path), np.linspace(0.0, 2.0, 201), 0.1
    values = peak * np.sin(0.5 * np.pi * times) * np.exp(0.4j)
    record = BaseRecord(tuple(times), tuple(values.real), tuple(values.imag))
    given = Single(record, (peak, 0.0)), Single(cm.BaseShock(peak, 2.0), (peak, 0.4))
    found = [cm.simulate(machine, cm.drop(base=base), until=3.0).earlier[-1].final for base in given]
    # Straight lines between samples leave h²/12 of the curvature.
    assert found[0].position == pytest.approx(found[1].position, abs=3e-5 * peak)


def test_impacts_of_a_shaken_fall_are_those_of_dop853():
    machine = cm.load("tests/machines/gravity.toml")
    record = BaseRecord((0.0, 4.0, 9.0, 15.0), x=(0.0, 0.02, -0.02, 0.0), y=(0.0, 0.05, 0.03, -0.02))
    moved, start = cm.drop(base=Single(record, (record.peak, 0.0))).apply(machine)
    *parts, last = cm.simulate(moved, start, until=15.5).parts
    falling, numbers = last.rotor, machine.parameters
    unbalance, weight = falling.matrices.forcing[0] / falling.matrices.mass[0, 0], complex(falling.acting.weight[0])

    def rebound(_, state):
        speed = struck(*state, numbers.d, numbers.mu, numbers.radius_ratio)
        return np.array([state[0] / abs(state[0]), speed])

    state, impacts = np.array([start.position, start.velocity + 1j * start.position]), 0
    for begins, ends in zip(record.times[:-1], record.times[1:], strict=True):

        def rates(time, state, begins=begins):
            base = np.interp(begins + time, record.times, record.accelerations)
            return np.array([state[1], unbalance * cmath.exp(1j * (begins + time)) + weight - base])

        wall = {"ends": lambda _, state: abs(state[0]) - 1.0, "after": rebound, "longest": 0.5}
        state, found = follow(rates, state, ends - begins, **wall)
        impacts += len(found)
    turn = cmath.exp(-15.0j)
    assert impacts == sum(len(part.contacts) for part in parts) >= 1
    assert parts[-1].final.position == pytest.approx(state[0] * turn, abs=1e-8)
    assert parts[-1].final.velocity == pytest.approx((state[1] - 1j * state[0]) * turn, abs=1e-8)


def test_what_cannot_be_shaken_says_why():
    machine = cm.load("tests/machines/gravity.toml")
    with pytest.raises(InputError, match="left out beside levitation that is regained"):
        cm.drop(regained_after=3.0, base=AS_IT_IS).apply(machine)
    with pytest.raises(InputError, match="isotropic supports in a drop"):
        cm.drop(base=AS_IT_IS).apply(cm.load("tests/machines/flexible-support.toml"))
    assert (
        "from then on Base motion record"
        in cm.drop(base=AS_IT_IS).echo_at(rotor_of(machine), *cm.drop(base=AS_IT_IS).apply(machine), None).words
    )
