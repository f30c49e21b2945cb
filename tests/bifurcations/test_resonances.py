"""Resonances of the multipliers, and the Neimark–Sacker curves that begin there."""

import numpy as np
import pytest
from machines import PAPER

from carom import find_orbits, map_regions
from carom.bifurcations import Plane
from carom.models import jeffcott

PLANE = Plane("rho", "gamma", (0.2, 0.25), (0.15, 0.19))


def multipliers_at(base, plane, point) -> np.ndarray:
    """Of the orbit there, by the general derivative of the impact map and not by the planar closed form."""
    # Both resonances lie on folds: by rounding their own place may be on the side without orbits.
    orbits = find_orbits(jeffcott(plane.at(base, point.value[0], point.value[1] - 1e-13)))
    near = min(orbits, key=lambda o: abs(o.period - point.period) + abs(o.radial_speed - point.radial_speed))
    return near.multipliers.values


def test_a_short_curve_between_two_resonances():
    """The curve lies between two folds, in a sliver that no grid of cells sees."""
    found = map_regions(PAPER, PLANE, grid=3)
    (curve,) = [curve for curve in found.curves if curve.kind == "neimark-sacker"]
    assert curve.stops == ("resonance-1:1", "resonance-1:1")
    assert curve.admissible.all()
    middle = len(curve.points) // 2
    orbits = find_orbits(jeffcott(PLANE.at(PAPER, *curve.points[middle])))
    near = min(orbits, key=lambda orbit: abs(orbit.period - curve.periods[middle]))
    pair = near.multipliers.values[np.abs(near.multipliers.values.imag) > 1e-4]
    assert len(pair) == 2
    assert np.abs(pair) == pytest.approx(1.0, abs=1e-7)
    resonances = [point for point in found.codimension2 if point.resonance == "1:1"]
    assert {point.kinds for point in resonances} == {("resonance-1:1",)}
    assert len(resonances) == 2
    for point in resonances:
        assert np.sort(np.abs(multipliers_at(PAPER, PLANE, point) - 1.0))[:2] == pytest.approx(0.0, abs=1e-3)
