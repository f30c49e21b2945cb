"""Special points of steady motions along one parameter."""

import math

import numpy as np
import pytest
from drawn_legends import legend_words
from machines import PAPER

from carom.base.outcome import InputError
from carom.bifurcations import Diagram, continue_curve
from carom.bifurcations.planes import Plane
from carom.bifurcations.steady import FEWER, equilibrium_branches, levitation_along, rolling_branch, steady_points
from carom.models import Rigid, Touchdown, axis, from_matrices, jeffcott


def test_at_resonance_points_are_found_through_zero_damping():
    """There levitation has no bound: at ω = 1 it is outside the wall for ``|γ| < ρ``."""
    machine = PAPER.replace(omega=1.0)
    points = steady_points(machine, axis(machine, "gamma"), (-0.5, 0.5))

    walls = [point.value for point in points if point.kind == "boundary-equilibrium"]
    assert walls == pytest.approx([-machine.rho, machine.rho], rel=1e-12)
    folds = [point.value for point in points if point.kind == "rub-fold"]
    assert folds == pytest.approx(
        [-machine.rho * math.hypot(1.0, 0.15), machine.rho * math.hypot(1.0, 0.15)], rel=1e-12
    )


def test_a_rub_goes_on_as_the_same_branch_where_its_normal_force_changes_sign():
    rotor = jeffcott(PAPER)
    _, stable, saddle = equilibrium_branches(rotor, axis(rotor, "omega"), (0.4, 1.4))
    for branch in (stable, saddle):
        force = branch.normal_force[np.isfinite(branch.normal_force)]
        assert force.min() < 0.0 < force.max()
        assert np.abs(np.diff(force)).max() < 0.05


def test_a_narrow_stretch_without_levitation_is_found_between_values_with_it():
    """At resonance the whirl ``f/|ω² − 1 + iγ|`` is larger than the clearance where ``(ω² − 1)² < f² − γ²``."""
    force, damping = 0.02, 0.01
    end = Touchdown([1.0], Rigid(0.9), friction=0.1, surface_speed=20.0)
    rotor = from_matrices(
        mass=[[1.0]], damping=[[damping]], stiffness=[[0.5]], forcing=[force], touchdowns=[end], translation=[1.0]
    )
    interval = 0.3, 2.0
    branch, points = levitation_along(rotor, axis(rotor, "omega"), interval)
    width = math.sqrt(force**2 - damping**2)
    grid = np.linspace(*interval, FEWER)
    assert (np.abs(grid**2 - 1.0) > width).all()
    # The bisection ends within 1e-9 of a step of the search.
    assert [point.value for point in points] == pytest.approx(
        [math.sqrt(1.0 - width), math.sqrt(1.0 + width)], rel=1e-8
    )
    assert [point.detail for point in points] == ["above: it reaches the wall", "below: it reaches the wall"]
    assert {(point.kind, point.motion) for point in points} == {("levitation-lost", "contact-free")}
    assert set(grid) < set(branch.values)
    assert (branch.admissible == (np.abs(branch.values**2 - 1.0) > width)).mean() > 0.9  # but for rounding at the roots
    assert "levitation-lost" in repr(points[0])
    rubs, rolls = (
        equilibrium_branches(rotor, axis(rotor, "omega"), interval)[1:],
        rolling_branch(rotor, axis(rotor, "omega"), interval),
    )
    diagram = Diagram(rotor, axis(rotor, "omega"), interval, (branch, *rubs), rolls, (), (), None, tuple(points))
    assert "levitation is lost" in legend_words(diagram.plot())
    with pytest.raises(InputError, match="kind = levitation-lost"):
        continue_curve(points[0], Plane("omega", "gamma", (0.3, 2.0), (0.0, 0.1)))
