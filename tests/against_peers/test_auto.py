"""Curves of bifurcations against AUTO-07p, which follows the same bifurcations as algebraic problems of its own."""

import numpy as np
import pytest
from machines import PAPER

from carom import find_orbits
from carom.bifurcations import Bifurcation, Plane, continue_curve, continue_orbit, switch
from carom.models import jeffcott

from .auto_equations import follow, why_missing
from .auto_two_impacts import special_points

pytestmark = pytest.mark.skipif(bool(why_missing()), reason=why_missing() or "installed")

LIMITS = (0.65, 0.95)


@pytest.mark.parametrize("kind", ["fold", "period-doubling"])
def test_curve_is_that_of_auto(kind, tmp_path):
    branch = continue_orbit(find_orbits(jeffcott(PAPER))["B1,d"], "gamma", (0.05, 0.2))
    (point,) = [special for special in branch.special if special.kind == kind]
    unknowns = [point.period, point.value] if kind == "fold" else [point.period, point.radial_speed, point.value]
    followed = follow(kind, PAPER, unknowns, LIMITS, tmp_path)
    assert len(followed) > 20
    assert followed[:, 0].min() < 0.66
    assert followed[:, 0].max() > 0.94
    curve = continue_curve(point, Plane("gamma", "omega", (0.01, 0.4), LIMITS))
    order = np.argsort(curve.points[:, 1])
    for omega, *values in followed[:: max(1, len(followed) // 12)]:
        # Ours at exactly this frequency: begin next to it and let the corrector do the rest.
        x, period, speed = (
            np.interp(omega, curve.points[order, 1], column[order])
            for column in (curve.points[:, 0], curve.periods, curve.radial_speeds)
        )
        plane = Plane("gamma", "omega", (0.01, 0.4), (omega, omega + 1e-3))
        at = PAPER.replace(gamma=float(x), omega=omega)
        here = continue_curve(Bifurcation.near(kind, at, float(period), float(speed)), plane)
        nearest = int(np.argmin(np.abs(here.points[:, 1] - omega)))
        assert here.points[nearest, 0] == pytest.approx(values[-1], abs=2e-9)
        assert here.periods[nearest] == pytest.approx(values[0], abs=2e-8)


@pytest.mark.jit_only
def test_branch_of_two_impacts_has_the_folds_and_period_doublings_of_auto(tmp_path):
    branch = continue_orbit(find_orbits(jeffcott(PAPER))["B1,d"], "gamma", (0.075, 0.11))
    (doubling,) = [special for special in branch.special if special.kind == "period-doubling"]
    doubled = switch(doubling, (0.078, 0.09))
    theirs: dict[str, set[float]] = {"fold": set(), "period-doubling": set()}
    # Which folds it reports of those it passes depends on the last bit of its start: it starts wherever the branch passes.
    for number, start in enumerate(doubled.starts_at(0.083)):
        rows = zip(start.nodes, start.durations, strict=True)
        unknowns = [float(x) for (u, v), time in rows for x in (u.real, u.imag, v.real, v.imag, time)]
        folder = tmp_path / str(number)
        folder.mkdir()
        for kind, values in special_points(PAPER.replace(gamma=0.083), unknowns, (0.078, 0.09), folder).items():
            theirs[kind] |= set(values)
    # Its branch turns where the period is halved: a fold of the algebraic equations.
    theirs["fold"] = {value for value in theirs["fold"] if abs(value - doubling.value) > 1e-6}
    for kind, found in theirs.items():
        ours = sorted(special.value for special in doubled.special if special.kind == kind)
        assert len(ours) == 2
        # It prints eleven digits.
        assert all(min(abs(value - other) for other in found) < 2e-11 for value in ours)
        assert all(min(abs(value - other) for value in ours) < 2e-11 for other in found)
