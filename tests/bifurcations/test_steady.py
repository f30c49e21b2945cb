"""Special points of steady motions along one parameter."""

import math

import numpy as np
import pytest
from drawn_legends import legend_words
from machines import PAPER

from carom.base.outcome import InputError
from carom.bifurcations import Diagram, continue_curve, find_bifurcations
from carom.bifurcations.planes import Plane
from carom.bifurcations.steady import LOOKED, equilibrium_branches, levitation_along, rolling_branch, steady_points
from carom.models import Rigid, Touchdown, axis, from_matrices, jeffcott


def test_at_resonance_points_are_found_through_zero_damping():
    """There levitation has no bound: at ω = 1 it is outside the wall for ``|γ| < ρ``."""
    machine = PAPER.replace(omega=1.0)
    points = steady_points(machine, axis(machine, "gamma"), (-0.5, 0.5))

    found = {
        kind: [each.value for each in points if each.kind == kind] for kind in ("boundary-equilibrium", "rub-fold")
    }
    assert found["boundary-equilibrium"] == pytest.approx([-machine.rho, machine.rho], rel=1e-12)
    fold = machine.rho * math.hypot(1.0, 0.15)
    assert found["rub-fold"] == pytest.approx([-fold, fold], rel=1e-12)


def test_a_rub_goes_on_as_the_same_branch_where_its_normal_force_changes_sign():
    rotor = jeffcott(PAPER)
    _, stable, saddle = equilibrium_branches(rotor, axis(rotor, "omega"), (0.4, 1.4))
    for branch in (stable, saddle):
        force = branch.normal_force[np.isfinite(branch.normal_force)]
        assert force.min() < 0.0 < force.max()
        assert np.abs(np.diff(force)).max() < 0.05


@pytest.mark.parametrize(("rho", "real"), [(0.37, True), (0.45, False)])
def test_levitation_of_the_planar_rotor_is_lost_without_damping(rho, real):
    """Its exponents are ``−γ/2 ± …``; with levitation inside the wall a free vibration of period ``2π/(1 + ω)`` touches it there."""
    diagram = find_bifurcations(PAPER.replace(rho=rho), "gamma", (-0.031, 0.017))
    lost, *vanishing = [point for point in diagram.points if abs(point.value) < 1e-6]
    assert (lost.kind, lost.value, lost.admissible) == ("levitation-lost", 0.0, real)
    assert (lost.motion, lost.detail) == ("contact-free", "below: a vibration grows")
    assert [(each.kind, each.value, each.admissible) for each in vanishing] == [("vanishing-impact", 0.0, True)] * real
    assert [each.period for each in vanishing] == pytest.approx([math.tau / (1.0 + PAPER.omega)] * real, rel=1e-5)
    curve = continue_curve(lost, Plane("omega", "gamma", (0.6, 0.8), (-0.1, 0.1)))
    assert (not curve.points[:, 1].any(), set(curve.stops)) == (True, {"edge of the plane"})


def test_a_narrow_stretch_without_levitation_is_found_between_values_with_it():
    """At resonance the whirl ``f/|ω² − 1 + iγ|`` is larger than the clearance where ``(ω² − 1)² < f² − γ²``."""
    force, damping, interval = 0.004, 0.002, (0.3, 2.0)
    rotor = _springs(force, damping, 0.5)
    branch, points = levitation_along(rotor, axis(rotor, "omega"), interval)
    width, grid = math.sqrt(force**2 - damping**2), np.linspace(*interval, LOOKED)
    assert (np.abs(grid**2 - 1.0) > width).all()
    # The bisection ends within 1e-9 of a step of the search.
    ends = [math.sqrt(1.0 - width), math.sqrt(1.0 + width)]
    assert [point.value for point in points] == pytest.approx(ends, rel=1e-8)
    assert [point.detail for point in points] == ["above: it reaches the wall", "below: it reaches the wall"]
    assert {(point.kind, point.motion) for point in points} == {("levitation-lost", "contact-free")}
    assert set(grid) < set(branch.values)
    assert (branch.admissible == (np.abs(branch.values**2 - 1.0) > width)).mean() > 0.9  # but for rounding at the roots
    assert "levitation-lost" in repr(points[0])
    others = equilibrium_branches(rotor, axis(rotor, "omega"), interval)[1:]
    rolls = rolling_branch(rotor, axis(rotor, "omega"), interval)
    diagram = Diagram(rotor, axis(rotor, "omega"), interval, (branch, *others), rolls, (), (), None, tuple(points))
    assert "levitation is lost" in legend_words(diagram.plot())
    with pytest.raises(InputError, match="kind = levitation-lost"):
        continue_curve(points[0], Plane("omega", "gamma", (0.3, 2.0), (0.0, 0.1)))


def test_a_narrow_stretch_with_levitation_is_found_between_values_without_it():
    """Between the resonances of two springs, whose whirls are ``0.3/|kω²/0.38325 − 1|``."""
    rotor, interval = _springs(0.3, 0.0002, 0.5, 0.2665), (0.8, 1.35)
    branch, points = levitation_along(rotor, axis(rotor, "omega"), interval)
    assert not branch.admissible[np.isin(branch.values, np.linspace(*interval, LOOKED))].any()
    ends = np.sqrt(0.38325 * np.array([1.3 / 0.5, 0.7 / 0.2665]))
    assert [point.value for point in points] == pytest.approx(ends, rel=1e-6)


def _springs(force, damping, *stiffness):
    """Equal masses, each on a spring in a bearing of its own."""
    mass, along = np.eye(len(stiffness)), np.ones(len(stiffness))
    ends = [Touchdown(row, Rigid(0.9), friction=0.1, surface_speed=20.0) for row in mass]
    held = {"mass": mass, "damping": damping * mass, "stiffness": np.diag(stiffness), "forcing": force * along}
    return from_matrices(**held, touchdowns=ends, translation=along)
