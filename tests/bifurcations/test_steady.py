"""Special points of steady motions along one parameter."""

import math

import numpy as np
import pytest
from machines import PAPER

from carom.bifurcations.steady import equilibrium_branches, steady_points
from carom.models import axis, jeffcott


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
