"""Limits of the magnetic bearings of flexible machines, against a general integrator with a controller of its own that clips."""

import dataclasses

import numpy as np
import pytest
from flexible_machines import symmetric
from limited_reference import clipped, follow

import carom as cm
from carom.base.outcome import InputError
from carom.motions import State, energy_ledger
from carom.parameters import Gravity
from carom.rotors import PID, FlexibleRotor, MagneticBearing, ProportionalDamping
from carom.rotors.equations import loops_of

P, INTEGRAL, D, T = 9000.0, 3e5, 10.0, 1e-4
KI, KS, BANDWIDTH = 50.0, -1e5, 3e4
UNTIL = 0.06


def machine(**limits):
    """On two bearings with an integrator, a filtered derivative and, if a bandwidth is given, an amplifier each."""
    bearings = [MagneticBearing(node, KI, KS, PID(P, INTEGRAL, D, T), **limits) for node in (1, 2)]
    at = symmetric(bearings=bearings, gravity=Gravity())
    # Without damping of the shaft its highest whirls would grow.
    return dataclasses.replace(at, rotor=FlexibleRotor(at.rotor.sections, [], ProportionalDamping(10.0, 3e-6)))


def reference(reduced, start, angle, limits):
    """Displacements at the planes, m, and integrators after a time; the start is that of the vectors, in SI units."""
    at, v = reduced.machine, reduced.vectors
    loops = loops_of(at)
    pulls = loops.bearings @ reduced.basis.shapes
    planes = loops.touchdowns @ reduced.basis.shapes
    given = reduced.equations
    spring, loss = given.unlevitated[1][:v, :v], given.unlevitated[0][:v, :v] - 1j * at.speed * given.gyroscopic[:v, :v]
    weight = np.zeros(v, complex)
    weight[0] = -1j * Gravity().acceleration * np.sqrt(at.rotor.mass)
    wall, amplified = at.touchdowns[0].bearing, limits.get("amplifier_bandwidth")
    most = {name: limits.get(name) or np.inf for name in ("current_limit", "slew_rate_limit", "force_limit")}

    def rates(_time, state):
        z, w, integrals, filtered, currents = np.split(state, [v, 2 * v, 2 * v + 2, 2 * v + 4])
        seen = pulls @ z
        asked = P * seen + INTEGRAL * integrals + D * (seen - filtered) / T
        given = np.array([clipped(each, most["current_limit"], angle) for each in asked])
        rate = np.zeros(2, complex)
        if amplified:
            rate = np.array([clipped(BANDWIDTH * each, most["slew_rate_limit"], angle) for each in given - currents])
            given = currents
        given = np.array([clipped(each, most["force_limit"] / KI, angle) for each in given])
        forces = -KI * given - KS * seen
        touching, at_wall = planes @ z, np.zeros(2, complex)
        for plane, place in enumerate(touching):
            depth = abs(place) - at.clearance
            if depth > 0.0:
                at_wall[plane] = -wall.stiffness * depth * place / abs(place)
        push = weight + forces @ pulls + at_wall @ planes
        return np.concatenate([w, push - spring @ z - loss @ w, seen, (seen - filtered) / T, rate])

    whole = np.concatenate([*start, np.zeros(6)])
    final, _ = follow(rates, whole, UNTIL, longest=2e-5)
    return planes @ final[:v], final[2 * v : 2 * v + 2]


@pytest.mark.parametrize(
    "limits",
    [
        {"current_limit": 0.8, "axis_angle": np.pi / 4},
        {"force_limit": 50.0, "current_limit": 3.0},
        {"current_limit": 1.2, "slew_rate_limit": 1500.0, "amplifier_bandwidth": BANDWIDTH},
        {"force_limit": 45.0, "slew_rate_limit": 2500.0, "amplifier_bandwidth": BANDWIDTH},
    ],
)
def test_motions_at_the_limits_are_those_of_a_general_integrator(limits):
    reduced = machine(**limits).with_modes(2)
    model, scales = reduced.model, reduced.scales
    vectors, coordinates = reduced.vectors, len(model.system.rest)
    speed = np.zeros(vectors, complex)
    speed[:2] = 0.2 + 0.1j, 0.15j  # kick and tilt, in m/s √kg
    position, velocity = np.zeros((2, coordinates), complex)
    velocity[:vectors] = speed / (scales.velocity * np.sqrt(scales.mass))

    motion = cm.simulate(model, State(position, velocity), UNTIL * scales.speed)
    ends = [motion.seen_at(plane).position([motion.time], "fixed")[0] * scales.length for plane in (0, 1)]
    places, _ = reference(reduced, (np.zeros(vectors), speed), limits.get("axis_angle", 0.0), limits)

    assert {2, 3} & set(motion.segment_limits.ravel().tolist())
    # Relative to a clearance of 0.2 mm; the integrator passes over the kinks at walls and limits without stopping.
    assert np.array(ends) / scales.length == pytest.approx(places / scales.length, abs=1e-8)


def test_integrators_wind_up_and_the_energy_ledger_closes():
    reduced = machine(current_limit=0.3).with_modes(2)
    velocity = np.zeros(len(reduced.model.system.rest), complex)
    velocity[0] = 0.4
    motion = cm.simulate(reduced.model, State(np.zeros_like(velocity), velocity), 20.0)

    ledger = energy_ledger(motion)

    assert np.abs(ledger.limits).max() > 1e-3
    assert ledger.imbalance < 1e-11


def test_a_limit_that_is_never_met_changes_nothing():
    free, held = (machine(**limits).with_modes(2).model for limits in ({}, {"current_limit": 1e4}))
    velocity = np.zeros(len(free.system.rest), complex)
    velocity[0] = 0.4

    linear, limited = (cm.simulate(each, State(np.zeros_like(velocity), velocity), 20.0) for each in (free, held))

    assert not limited.segment_limits.any()
    # The kernels are others, and may fuse other products and sums.
    assert limited.segment_amplitudes == pytest.approx(linear.segment_amplitudes, abs=1e-12)


def test_what_cannot_be_limited_is_refused():
    with pytest.raises(InputError, match=r"slew_rate_limit = 100.*: none without amplifier_bandwidth"):
        MagneticBearing(1, KI, KS, PID(P), slew_rate_limit=100.0)
    with pytest.raises(InputError, match="current_limit"):
        MagneticBearing(1, KI, KS, PID(P), current_limit="3 N")
