"""Motions of flexible machines whose supports are anisotropic, against a general integrator with forces of its own."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from flexible_machines import symmetric
from limited_reference import clipped, follow

import carom as cm
from carom.base.outcome import Outcome
from carom.disturbances import BladeLoss
from carom.motions import State, energy_ledger
from carom.parameters import Gravity
from carom.rotors import PID, MagneticBearing, Support, Unbalance
from carom.rotors.equations import loops_of

P, D, T = 9000.0, 10.0, 1e-4
KI, KS = 50.0, -1e5
UNTIL = 0.04
SEAL = Support(1, 3e5, 1e5, 4e4, -2e4, 60.0, 5.0, -8.0, 30.0)
SPRING = Support(2, 2e5, 4e5, cxx=20.0, cyy=20.0)


def machine(**limits):
    """On two bearings with a filtered derivative each, and two supports."""
    bearings = [MagneticBearing(node, KI, KS, PID(P, 0.0, D, T), **limits) for node in (1, 2)]
    changes = {"bearings": bearings, "supports": [SEAL, SPRING], "unbalances": [Unbalance(1, 2e-4, 0.3)]}
    return symmetric(gravity=Gravity(), **changes)


REDUCED = machine().with_modes(2)


def reference(reduced, start, until, held=True, bound=np.inf):
    """Displacements at the planes, m, after a time; the start is that of the vectors, in SI units."""
    at, v = reduced.machine, reduced.vectors
    loops = loops_of(at.rotor, at.bearings, at.touchdowns)
    pulls, planes = loops.bearings @ reduced.basis.shapes, loops.touchdowns @ reduced.basis.shapes
    rows = np.array([at.rotor.row_at(each.node) for each in at.supports]) @ reduced.basis.shapes
    spring, spin = np.diag(reduced.basis.frequencies**2), -1j * at.speed * reduced.equations.gyroscopic[:v, :v]
    weight = np.zeros(v, complex)
    weight[0] = -1j * Gravity().acceleration * np.sqrt(at.rotor.mass)
    unbalance = sum(
        each.size * np.exp(1j * each.angle) * (at.rotor.row_at(each.node) @ reduced.basis.shapes)
        for each in at.unbalances
    )
    wall = at.touchdowns[0].bearing

    def rates(time, state):
        z, w, filtered = np.split(state, [v, 2 * v])
        push = weight + at.speed**2 * np.exp(1j * at.speed * time) * unbalance
        asked = P * (pulls @ z) + D * (pulls @ z - filtered) / T
        if held:
            push = push - (KI * np.array([clipped(each, bound) for each in asked]) + KS * (pulls @ z)) @ pulls
        for row, each in zip(rows, at.supports, strict=True):
            place, speed = row @ z, row @ w
            along = each.kxx * place.real + each.kxy * place.imag + each.cxx * speed.real + each.cxy * speed.imag
            across = each.kyx * place.real + each.kyy * place.imag + each.cyx * speed.real + each.cyy * speed.imag
            push = push - (along + 1j * across) * row
        for row in planes:
            depth = abs(row @ z) - at.clearance
            if depth > 0.0:
                push = push - wall.stiffness * depth * (row @ z) / abs(row @ z) * row
        return np.concatenate([w, push - spring @ z - spin @ w, (pulls @ z - filtered) / T])

    final, _ = follow(rates, np.concatenate([*start, np.zeros(2)]), until, longest=2e-5)
    return planes @ final[:v]


def start_of(reduced, speed):
    """The same start as a state of the model, and in SI units."""
    given, count = np.zeros(reduced.vectors, complex), len(reduced.model.system.rest)
    given[:2] = speed
    position, velocity = np.zeros((2, count), complex)
    velocity[: len(given)] = given / (reduced.scales.velocity * np.sqrt(reduced.scales.mass))
    return State(position, velocity), (np.zeros_like(given), given)


def ends_of(motion, scales):
    return np.array([motion.seen_at(plane).position([motion.time], "fixed")[0] for plane in (0, 1)]) * scales.length


@pytest.mark.parametrize("bound", [np.inf, 1.0])
def test_kicks_are_those_of_a_general_integrator(bound):
    reduced = REDUCED if bound == np.inf else machine(current_limit=bound).with_modes(2)
    model, scales = reduced.model, reduced.scales
    start, own = start_of(reduced, (0.4 + 0.1j, 0.2j))

    motion = cm.simulate(model, start, UNTIL * scales.speed)

    assert motion.segment_phases.any()
    assert motion.segment_limits.max(initial=0) > 1 or bound == np.inf
    places = reference(reduced, own, UNTIL, bound=bound)
    # Relative to a clearance of 0.2 mm; the integrator passes over the kinks at walls and limits without stopping.
    assert ends_of(motion, scales) / scales.length == pytest.approx(places / scales.length, abs=1e-8)
    assert energy_ledger(motion).imbalance < 1e-11


def test_supports_hold_on_when_levitation_is_lost():
    left, scales = REDUCED.model.without_levitation(), REDUCED.scales
    start, own = start_of(REDUCED, (0.3 + 0.1j, 0.1j))
    motion = cm.simulate(left, start, UNTIL * scales.speed)
    assert motion.segment_phases.any()
    places = reference(REDUCED, own, UNTIL, held=False)
    assert ends_of(motion, scales) / scales.length == pytest.approx(places / scales.length, abs=1e-8)

    dropped = cm.simulate(REDUCED.model, cm.drop(), "20 ms")
    assert dropped.outcome in (Outcome.TIME_REACHED, Outcome.AT_REST)


@pytest.mark.parametrize("support", [SEAL, Support(1, 2e5, 2e5, cxx=40.0, cyy=40.0)])
def test_a_rotor_dropped_onto_one_support_falls_on(support):
    """It tilts about that without stiffness, driven by its weight, and hardly held by the gyroscopic moment of so thin a shaft."""
    reduced = dataclasses.replace(machine(), supports=[support]).with_modes(2)
    left, scales = reduced.model.without_levitation(), reduced.scales
    assert left.system.rest_radius == np.inf
    start, own = start_of(reduced, (0.05, 0.02j))
    motion = cm.simulate(left, start, 0.01 * scales.speed)
    assert motion.segment_phases.any()
    places = reference(reduced, own, 0.01, held=False)
    # Modes of the tilt nearly coincide, up to 1.6e-3 of the speed: half the digits of their squares are lost.
    assert ends_of(motion, scales) / scales.length == pytest.approx(places / scales.length, abs=1e-6)


@pytest.mark.parametrize("phase", [0.0, 1.1])
def test_before_the_loss_of_a_blade_it_levitates_and_the_frame_turns_with_the_only_unbalance(phase):
    model = REDUCED.model
    after, state = BladeLoss(2.0 * model.value("rho")).apply(model, phase)
    (before,), (changed,) = (each.finite_elements.machine.unbalances for each in (model, after))
    turned = state.time
    start = model.system.states_of(model.system.forced_at(0.0)[None])[0].reshape(2, -1) * np.exp(-1j * turned)
    assert np.array([state.position, state.velocity]) == pytest.approx(start, abs=1e-12)
    assert changed.angle == pytest.approx(before.angle)
    assert changed.size * np.exp(1j * turned) == pytest.approx(before.size + 2.0 * before.size * np.exp(1j * phase))
