"""What the figures show, by routes of their own."""

import math

import numpy as np
import pytest
from machines import PAPER
from scipy.optimize import minimize_scalar

from carom import find_equilibria, find_orbits
from carom.bifurcations import motions_at
from carom.models import jeffcott


def test_motions_of_figure_2(found):
    levitation, grazing, small = found.motions
    assert [motion.panel for motion in found.motions] == ["a", "b", "c"]
    assert levitation.orbit is None
    assert find_equilibria(levitation.rotor)[0].status == "admissible"
    assert (grazing.orbit.name, small.orbit.name) == ("B1,d", "B1,a")
    assert grazing.orbit.admissible
    assert small.orbit.admissible
    # Near grazing: the free maximum of the radius is within 3 % of the wall.
    radius = np.abs(grazing.orbit.path(np.linspace(0.0, grazing.orbit.period, 2001)[:-1]))
    tops = radius[1:-1][(radius[1:-1] > radius[:-2]) & (radius[1:-1] > radius[2:])]
    assert 0.97 < tops.max() < 1.0


def test_birth_of_figure_3(found):
    below, at, above = found.periods.births
    assert [orbit.admissible for orbit in below.orbits] == [False, False]
    assert [orbit.admissible for orbit in above.orbits] == [True, True]
    assert at.orbits == ()
    assert abs(below.rotor.equilibrium) > 1.0 > abs(above.rotor.equilibrium)
    assert abs(at.rotor.equilibrium) == pytest.approx(1.0, abs=1e-14)


def test_branches_of_figure_4(found):
    for branch in (found.pair.slow, found.pair.fast):
        assert branch.stops == ("parameter limit", "parameter limit")
        for place in range(0, len(branch), 25):
            orbits = find_orbits(jeffcott(PAPER.replace(gamma=branch.values[place])), 30.0)
            orbit = orbits[branch.names[place]]
            assert branch.radial_speed[place] == pytest.approx(orbit.radial_speed, abs=1e-9)
            assert branch.angular_speed[place] == pytest.approx(orbit.angular_speed, abs=1e-8)
            assert branch.stable[place] == orbit.stable
            assert branch.admissible[place] == orbit.admissible
    assert set(found.pair.negative.names) == {"B1,a", "B1,c"}


def test_local_theory_of_figure_4(found):
    """The overlays touch the exact branches: slopes by central differences, improved once."""
    birth = found.pair.hopf.gamma

    def orbit(gamma, period):
        near = find_orbits(jeffcott(PAPER.replace(gamma=gamma)))
        return min(near, key=lambda orbit: abs(orbit.period - period) + abs(orbit.radial_speed))

    def slope(cycle, name, step):
        ends = [getattr(orbit(birth + side * step, cycle.period), name) for side in (-1, 1)]
        return (ends[1] - ends[0]) / (2.0 * step)

    assert len(found.pair.hopf.cycles) == 2
    for cycle in found.pair.hopf.cycles:
        for name, value in (("radial_speed", cycle.radial_slope), ("angular_speed", cycle.angular_slope)):
            exact = (4.0 * slope(cycle, name, 1e-4) - slope(cycle, name, 2e-4)) / 3.0
            assert value == pytest.approx(exact, abs=1e-8)


def test_extrema_of_figure_5(found):
    """Against a search for extrema of the path, which knows no derivative."""
    for branch, lines in ((found.pair.slow, found.radii.slow), (found.pair.fast, found.radii.fast)):
        for place in range(5, len(branch), 40):
            orbit = branch.orbits[place]
            times = np.linspace(0.0, orbit.period, 1500)
            radii = np.abs(orbit.path(times))[:-1]
            tops = np.flatnonzero((radii[1:-1] > radii[:-2]) & (radii[1:-1] > radii[2:])) + 1
            dips = np.flatnonzero((radii[1:-1] < radii[:-2]) & (radii[1:-1] < radii[2:])) + 1
            expected = sorted([*radii[tops], *radii[dips]])
            shown = sorted(float(line.radii[line.places == place][0]) for line in lines if place in line.places)
            np.testing.assert_allclose(shown, expected, atol=1e-4)


def test_grazing_line_reaches_the_wall(found):
    grazing = found.pair.special("grazing", "d")
    there = [line for line in found.radii.fast if line.places[0] <= grazing.place <= line.places[-1]]
    assert any(np.interp(grazing.place, line.places, line.radii) == pytest.approx(1.0, abs=1e-3) for line in there)
    time = minimize_scalar(
        lambda time: -abs(grazing.orbit.path(np.array([time]))[0]),
        bounds=(0.2, 3.0),
        method="bounded",
        options={"xatol": 1e-9},
    )
    assert -time.fun == pytest.approx(1.0, abs=1e-9)


def test_regions_of_figure_6(found):
    """Each name of the source paper stands where the text puts it, and each part where its motions are."""
    fold, boundary = found.plane.curve("fold"), found.plane.curve("boundary-equilibrium")
    for region in found.plane.regions:
        gamma, omega = region.point
        assert region.motions == motions_at(PAPER.replace(gamma=gamma, omega=omega))
        assert region.motions.source_region == region.source
        left_of_fold = gamma < np.interp(omega, fold.points[:, 1], fold.points[:, 0])
        levitates = gamma > math.sqrt(max(PAPER.rho**2 - (1.0 - omega**2) ** 2, 0.0))
        assert {"R1": (True, False), "R2": (False, False), "R3": (False, True), "R4": (True, True)}[region.source] == (
            left_of_fold,
            levitates,
        )
    parts = {region.part: region.motions for region in found.plane.regions}
    assert parts["R3.1"].rub
    assert not parts["R3.2"].rub
    assert (parts["R1.1"].stable_orbits, parts["R1.2"].stable_orbits) == (1, 0)
    assert (parts["R4.1"].orbits, parts["R4.3"].orbits) == (4, 3)
    exact = np.sqrt(PAPER.rho**2 - (1.0 - boundary.points[:, 1] ** 2) ** 2)
    np.testing.assert_allclose(boundary.points[:, 0], exact, rtol=1e-10)
