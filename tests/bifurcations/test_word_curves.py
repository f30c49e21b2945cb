"""Curves of special points of orbits of any word in two parameters: against the closed form, and against each other."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from carom import simulate
from carom.bifurcations import Bifurcation, Curve, Plane, continue_curve, continue_orbit, switch
from carom.models import jeffcott
from carom.motions import State
from carom.orbits import find_orbits, orbit_of_motion
from carom.orbits.orbit import Orbit, orbit_near
from carom.orbits.shooting import Start
from carom.outcome import InputError
from tests.bifurcations.test_words import located
from tests.machines import PAPER

pytestmark = pytest.mark.jit_only
PLANE = Plane("gamma", "omega", (0.05, 0.2), (0.74, 0.78))


@pytest.mark.parametrize(
    ("kind", "gamma", "interval"),
    [("grazing", 0.1, (0.06, 0.11)), ("period-doubling", 0.1, (0.06, 0.11)), ("fold", 0.17, (0.165, 0.19))],
)
def test_curves_of_a_single_impact_orbit_are_those_of_the_closed_form(kind, gamma, interval):
    known = find_orbits(PAPER.replace(gamma=gamma))["B1,d"]
    # The same orbit, of which it is not known that the closed form has it.
    orbit = orbit_near(known.rotor, known.word, Start(known.nodes, known.durations))
    assert isinstance(orbit, Orbit)
    (point,) = [each for each in continue_orbit(orbit, "gamma", interval).special if each.kind == kind]
    curve = continue_curve(point, PLANE)
    assert curve.stops == ("edge of the plane", "edge of the plane")
    assert curve.subject == "P1,1"
    for (x, y), period, speed in list(zip(curve.points, curve.periods, curve.radial_speeds, strict=True))[::2]:
        at = Bifurcation.near(kind, PAPER.replace(gamma=float(x), omega=float(y)), float(period), float(speed))
        low, high = (y, y + 1e-3) if y < 0.77 else (y - 1e-3, y)
        closed = continue_curve(at, Plane("gamma", "omega", (0.05, 0.2), (float(low), float(high))))
        nearest = int(np.argmin(np.abs(closed.points[:, 1] - y)))
        assert closed.points[nearest, 0] == pytest.approx(x, abs=1e-9)
        assert closed.periods[nearest] == pytest.approx(period, abs=1e-7)


@cache
def of_two_impacts(kind: str) -> Curve:
    return continue_curve(located(kind, 0.08267), PLANE)


def test_fold_and_grazing_of_two_impacts_meet_in_one_point():
    """Up to there the stable orbit grazes first; beyond it folds, as a motion of the machine."""
    (first,) = of_two_impacts("fold").codimension2
    (second,) = of_two_impacts("grazing").codimension2
    assert (first.kind, second.kind) == ("fold + grazing", "grazing + fold")
    assert first.value == pytest.approx(second.value, abs=1e-10)
    assert first.value == pytest.approx((0.0826188930, 0.7626285012), abs=1e-9)
    for curve in (of_two_impacts("fold"), of_two_impacts("grazing")):
        assert curve.subject == "P2,1"
        assert curve.stops == ("edge of the plane", "edge of the plane")
    folds = of_two_impacts("fold")
    assert (folds.admissible == (folds.points[:, 1] > first.value[1])).all()


@pytest.mark.parametrize("kind", ["fold", "grazing"])
def test_points_of_a_curve_are_found_again_along_one_parameter(kind):
    curve = of_two_impacts(kind)
    single = find_orbits(PAPER)["B1,d"]
    for x, y in curve.points[[1, -2]]:
        at = find_orbits(PAPER.replace(omega=float(y)))[single.name]
        branch = continue_orbit(at, "gamma", (0.075, 0.11))
        (doubling,) = [each for each in branch.special if each.kind == "period-doubling"]
        values = [each.value for each in switch(doubling, (0.08, 0.087)).special if each.kind == kind]
        assert np.abs(np.array(values) - x).min() < 1e-8


def test_a_curve_ends_where_both_halves_of_the_period_become_equal():
    """It came back over itself from there, with the two impacts exchanged, and listed what it passes twice."""
    machine = PAPER.replace(
        gamma=0.06899982980689087,
        omega=1.2779660134098125,
        rho=0.9574077702761065,
        mu=0.1443825101327086,
        d=0.8631643332470018,
    )
    start = State(0.742594968245957 + 0.6697407805530331j, 1.7180056690412444 - 0.7328015507403582j)
    orbit = orbit_of_motion(simulate(machine, start, settle=True))
    (point,) = [each for each in continue_orbit(orbit, "gamma", (0.05, 0.08)).special if each.kind == "grazing"]
    curve = continue_curve(point, Plane("gamma", "omega", (0.03, 0.1), (1.2, 1.4)))
    assert curve.stops[1] == "period-halving"
    places = np.array([each.value for each in curve.codimension2])
    apart = np.abs(places[:, None] - places).max(axis=2)
    assert apart[~np.eye(len(places), dtype=bool)].min() > 1e-3
    (end,) = [each for each in curve.codimension2 if each.kind == "grazing + period-doubling"]
    assert end.admissible
    # The closed form has an orbit of half the period there that grazes and has the multiplier −1.
    halved = find_orbits(machine.replace(gamma=end.value[0], omega=end.value[1]))["B1,d"]
    assert 2.0 * halved.period == pytest.approx(end.period, rel=1e-8)
    assert np.abs(halved.multipliers.values + 1.0).min() < 1e-6
    assert abs(halved.margins.radius) < 1e-8


def test_a_neimark_sacker_curve_passes_resonances():
    from tests.bifurcations.test_borders import resonant

    (point,) = [each for each in resonant().special if each.kind == "neimark-sacker"]
    curve = continue_curve(point, Plane("gamma", "omega", (0.07, 0.12), (0.755, 0.765)))
    assert len(curve.points) > 4
    rotor = jeffcott(PAPER.replace(gamma=float(curve.points[2, 0]), omega=float(curve.points[2, 1])))
    assert point.shot is not None
    found = continue_orbit(point.orbit, "omega", (0.755, 0.765))
    assert found.values.min() < rotor.parameters.omega < found.values.max()
    for each in curve.codimension2:
        assert each.resonance or "neimark-sacker" in each.kinds


def test_what_cannot_be_followed_is_refused():
    with pytest.raises(InputError, match="point of the plane"):
        continue_curve(located("grazing", 0.08267), Plane("gamma", "omega", (0.1, 0.2), (0.74, 0.78)))
