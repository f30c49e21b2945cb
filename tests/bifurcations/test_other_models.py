"""Diagrams of other models than the planar rotor: their equilibria, and the orbits that a search finds."""

from pathlib import Path

import numpy as np
import pytest
from linear_rotors import as_matrices, single

import carom as cm
from carom.motions.starts import State

pytestmark = pytest.mark.jit_only


def test_a_diagram_shows_equilibria(monkeypatch):
    monkeypatch.setattr("carom.bifurcations.steady.SAMPLES", 5)
    monkeypatch.setattr("carom.bifurcations.followed.VALUES", 2)
    monkeypatch.setattr("carom.bifurcations.followed.GUESSES", 20)
    rotor = single().model
    diagram = cm.find_bifurcations(rotor, "friction", (0.1, 0.2))
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


def test_rolling_that_closes_from_any_angle_is_no_branch(monkeypatch):
    """125 clearances of radius roll 126 times round in a turn: Newton's method finds such a motion at every angle and at every speed."""
    monkeypatch.setattr("carom.bifurcations.followed.PLACES", (0.5,))
    machine = cm.load(Path(__file__).parents[1] / "machines" / "gravity.toml")
    found = cm.find_bifurcations(machine, "speed", ("32400 rpm", "36000 rpm"))
    assert found.several
    for branch in found.several:
        assert (len(branch), branch.stops, branch.special) == (1, ("one of a continuum",) * 2, ())
        (orbit,) = branch.orbits
        begun = orbit.start.position * np.exp(0.3j), orbit.start.velocity * np.exp(0.3j)
        turned = cm.simulate(orbit.rotor, State(*begun, time=orbit.start.time), orbit.period, settle=False)
        assert abs(turned.final.position - begun[0]) < 1e-9
