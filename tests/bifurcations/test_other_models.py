"""Diagrams of other models than the planar rotor: their equilibria, the orbits that a search finds, and where disturbances settle."""

from __future__ import annotations

import dataclasses
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
from linear_rotors import as_matrices, single, tilting

import carom as cm
from carom.attractors import MotionName
from carom.base.outcome import Outcome
from carom.bifurcations import sample_attractors
from carom.bifurcations.samples import _impacts
from carom.disturbances import Grid, VelocityKick
from carom.motions.simulation import simulate
from carom.motions.starts import State

RANGE = (0.2, 0.5)


@pytest.mark.jit_only
def test_attractors_along_a_parameter_are_those_of_each_model():
    rotor, kicks = tilting().model, Grid(VelocityKick(fastest=1.2), (2, 2))
    samples = sample_attractors(rotor, "gamma", RANGE, kicks, values=1)
    expected = cm.find_attractors(rotor.replace(gamma=RANGE[0]), kicks)
    found = {sample.name: (sample.count, sample.known) for sample in samples}
    assert {sample.value for sample in samples} == {RANGE[0]}
    assert {each.name: (each.count, each.known) for each in expected if each.settled}.items() <= found.items()


@pytest.mark.jit_only
def test_radial_speeds_are_those_of_the_plane_where_it_bounces():
    alone = single().model
    nearer = [
        dataclasses.replace(each, plane=[0.3 * number for number in each.plane]) for each in alone.equations.touchdowns
    ]
    beside = alone.replace(touchdowns=[*nearer, *alone.equations.touchdowns])
    start = [complex(part[0]) for part in beside.system.kicked(np.array(0.9))]
    struck = simulate(beside, State(*start), 60.0)
    assert struck.is_impact.any()
    assert 0 not in struck.event_planes[struck.is_impact]
    bouncing = SimpleNamespace(name=MotionName(Outcome.BOUNCING, 1), state=State(*start))
    assert _impacts(beside, bouncing).size == 1


@pytest.mark.jit_only
def test_a_diagram_shows_equilibria_and_where_disturbances_settle(monkeypatch):
    monkeypatch.setattr("carom.bifurcations.diagrams.sample_attractors", partial(sample_attractors, values=2))
    monkeypatch.setattr("carom.bifurcations.steady.SAMPLES", 5)
    monkeypatch.setattr("carom.bifurcations.followed.VALUES", 2)
    monkeypatch.setattr("carom.bifurcations.followed.GUESSES", 20)
    rotor = single().model
    diagram = cm.find_bifurcations(rotor, "friction", (0.1, 0.2), attractors=3)
    assert {sample.value for sample in diagram.attractors} >= {0.1, 0.2}
    assert diagram.rolling.values.size == 0
    for branch in diagram.equilibria:
        for value, force, admissible in zip(branch.values, branch.normal_force, branch.admissible, strict=True):
            at = [
                e
                for e in cm.find_equilibria(rotor.replace(friction=value))
                if (e.kind == "rub") == ("rub" in branch.kind)
            ]
            rubs = [e for e in at if branch.kind == "contact-free" or e.stable == (branch.kind == "stable rub")]
            there = [e.normal_force for e in rubs if (e.status == "admissible") == admissible]
            assert (force == max(there)) if rubs else np.isnan(force)
    diagram.plot()


@pytest.mark.jit_only
def test_a_diagram_of_matrices_has_the_branches_and_points_of_the_same_planar_rotor(monkeypatch):
    monkeypatch.setattr("carom.bifurcations.followed.VALUES", 3)
    monkeypatch.setattr("carom.bifurcations.followed.GUESSES", 150)
    numbers = {"gamma": 0.1, "omega": 0.76, "rho": 3 / 7, "phi": 0.21, "mu": 0.15, "d": 0.95, "radius_ratio": 400 / 7}
    planar = cm.models.jeffcott(cm.parameters.Parameters(**numbers))
    exact = cm.find_bifurcations(planar, "gamma", (0.08, 0.2))
    found = cm.find_bifurcations(as_matrices(planar), "gamma", (0.08, 0.2))
    assert found.search.guesses > 0
    assert exact.search is None
    assert {branch.impacts for branch in found.orbits} == {1}
    # The closed form names one point for two orbits that meet; each branch of a search has it.
    located = {(point.kind, point.value) for point in exact.points if point.motion == "orbit" and point.admissible}
    shared = {at for at in located if at[0] in ("fold", "period-doubling", "grazing")}
    assert {kind for kind, _ in shared} >= {"fold", "period-doubling"}
    for kind, value in shared:
        assert min(abs(each.value - value) for each in found.points if each.kind == kind) < 1e-9
    found.plot()
