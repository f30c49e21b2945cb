"""Curves in two parameters and the points on them where two bifurcations meet."""

import numpy as np
import pytest
from machines import PAPER

from carom import find_orbits
from carom.bifurcations import KINDS, Bifurcation, Curve, Plane, continue_curve, continue_orbit
from carom.closed_forms import PeriodCondition, find_equilibria
from carom.models import jeffcott

PLANE = Plane("gamma", "omega", (0.01, 0.4), (0.6, 1.0))


@pytest.fixture(scope="module")
def curves() -> dict[str, Curve]:
    branch = continue_orbit(find_orbits(jeffcott(PAPER))["B1,d"], "gamma", (0.02, 0.3))
    found = {point.kind: continue_curve(point, PLANE) for point in branch.special if point.kind in KINDS}
    found["boundary-equilibrium"] = continue_curve(
        Bifurcation.near("boundary-equilibrium", PAPER.replace(gamma=0.0725)), PLANE
    )
    found["rub-fold"] = continue_curve(Bifurcation.near("rub-fold", PAPER.replace(gamma=0.37)), PLANE)
    return found


def test_all_curves_are_there_and_end_at_the_edge(curves):
    assert set(curves) == {"fold", "period-doubling", "grazing", "boundary-equilibrium", "rub-fold"}
    for curve in curves.values():
        (low_x, low_y), (high_x, high_y) = np.transpose([PLANE.first_range, PLANE.second_range])
        for x, y in curve.points[[0, -1]]:
            assert min(abs(x - low_x), abs(x - high_x), abs(y - low_y), abs(y - high_y)) < 1e-9
        assert set(curve.stops) == {"edge of the plane"}
        assert curve.steps.max() < 0.16


def test_equilibrium_curves_in_closed_form(curves):
    x, y = curves["boundary-equilibrium"].points.T
    assert x**2 + (1.0 - y**2) ** 2 == pytest.approx(PAPER.rho**2, abs=1e-12)
    x, y = curves["rub-fold"].points.T
    assert x + PAPER.mu * (1.0 - y**2) == pytest.approx(PAPER.rho * np.sqrt(1.0 + PAPER.mu**2), abs=1e-12)
    for gamma, omega in curves["rub-fold"].points[1:-1:3]:
        counts = [len(find_equilibria(jeffcott(PAPER.replace(gamma=gamma + s, omega=omega)))) for s in (-1e-9, 1e-9)]
        assert counts == [3, 1]


def test_fold_meets_the_boundary_equilibrium(curves):
    (point,) = [point for point in curves["fold"].codimension2 if point.kind == "fold + boundary-equilibrium"]
    assert (point.kinds, point.resonance) == (("fold", "boundary-equilibrium"), "")
    assert point.value == pytest.approx((0.1779723, 0.7811076), abs=5e-8)
    rotor = jeffcott(PAPER.replace(gamma=point.value[0], omega=point.value[1]))
    assert abs(rotor.equilibrium) == pytest.approx(1.0, abs=1e-11)
    condition = PeriodCondition.of(rotor.system)
    assert condition.value(np.array([point.period])) == pytest.approx(0.0, abs=1e-11)
    assert condition.slope(np.array([point.period])) == pytest.approx(0.0, abs=1e-10)


def test_non_smooth_hopf_curve_turns_back_where_the_two_cycles_meet():
    """It lies on the curve of the boundary equilibrium, as far as F₁ has roots; there the short period becomes the long."""
    branch = continue_orbit(find_orbits(jeffcott(PAPER))["B1,a"], "gamma", (0.02, 0.17))
    point = next(point for point in branch.special if point.kind == "non-smooth-hopf")
    curve = continue_curve(point, PLANE)
    for (x, y), period in zip(curve.points, curve.periods, strict=True):
        rotor = jeffcott(PAPER.replace(gamma=x, omega=y))
        assert abs(rotor.equilibrium) == pytest.approx(1.0, abs=1e-10)
        roots = PeriodCondition.of(rotor.system).roots(20.0).periods
        assert np.abs(roots - period).min() < 1e-7
    (meeting,) = [point for point in curve.codimension2 if point.kind == "non-smooth-hopf + fold"]
    assert meeting.value == pytest.approx((0.1779723, 0.7811076), abs=5e-8)
    assert curve.points[:, 0].max() <= meeting.value[0] + 1e-6
    assert curve.periods.min() < meeting.period < curve.periods.max()
