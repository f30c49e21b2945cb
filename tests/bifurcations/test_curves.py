"""Curves in two parameters and the points on them where two bifurcations meet."""

from __future__ import annotations

import numpy as np
import pytest
from machines import PAPER

from carom import find_orbits
from carom.bifurcations import KINDS, Bifurcation, Curve, Plane, continue_curve, continue_orbit
from carom.closed_forms.equilibria import find_equilibria
from carom.closed_forms.periods import PeriodCondition
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


def test_fold_curve_is_where_roots_appear(curves):
    for x, y in curves["fold"].points[1:-1:4]:
        counts = [
            len(PeriodCondition.of(jeffcott(PAPER.replace(gamma=x + shift, omega=y)).system).roots().periods)
            for shift in (-1e-9, 1e-9)
        ]
        assert counts[0] - counts[1] == 2


def test_grazing_curve_by_the_certified_search(curves):
    curve = curves["grazing"]
    for (x, y), period in list(zip(curve.points, curve.periods, strict=True))[1:-1:4]:
        answers = []
        for shift in (-1e-9, 1e-9):
            orbits = find_orbits(jeffcott(PAPER.replace(gamma=x + shift, omega=y)))
            near = [orbit for orbit in orbits if abs(orbit.period - period) < 1e-6]
            answers.append(sorted(orbit.admissible for orbit in near))
        assert answers[0] != answers[1]


def test_period_doubling_curve_by_the_multipliers_of_the_orbits(curves):
    curve = curves["period-doubling"]
    rows = list(zip(curve.points, curve.periods, curve.radial_speeds, strict=True))
    for (x, y), period, speed in rows[1:-1:4]:
        orbits = find_orbits(jeffcott(PAPER.replace(gamma=x, omega=y)))
        near = min(orbits, key=lambda orbit: abs(orbit.period - period) + abs(orbit.radial_speed - speed))
        assert np.abs(near.multipliers.values + 1.0).min() < 1e-7


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


def test_every_pair_of_parameters():
    """Friction and restitution move the fold; unbalance does not, as ``F₁`` does not depend on it."""
    orbit = find_orbits(jeffcott(PAPER))["B1,d"]
    branch = continue_orbit(orbit, "gamma", (0.02, 0.3))
    (fold,) = [point for point in branch.special if point.kind == "fold"]
    at = fold.numbers.parameters
    for name, limits in (("mu", (0.0, 0.4)), ("d", (0.8, 1.0)), ("omega", (0.7, 0.85))):
        curve = continue_curve(fold, Plane("gamma", name, (0.01, 0.6), limits))
        x, y = curve.points[len(curve.points) // 2]
        rotor = jeffcott(at.replace(gamma=x, **{name: y}))
        count = len(PeriodCondition.of(jeffcott(rotor.parameters.replace(gamma=x - 1e-9)).system).roots().periods)
        assert (
            count - len(PeriodCondition.of(jeffcott(rotor.parameters.replace(gamma=x + 1e-9)).system).roots().periods)
            == 2
        )
    flat = continue_curve(fold, Plane("gamma", "rho", (0.01, 0.6), (0.42, 0.6)))
    assert np.ptp(flat.points[:, 0]) < 1e-12
