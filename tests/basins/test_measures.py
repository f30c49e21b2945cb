"""Shares, integrity and basin entropy, where the answer is known."""

from __future__ import annotations

import math

import numpy as np
import pytest
from machines import PAPER
from scipy.ndimage import distance_transform_edt

import carom
from carom.basins import basin_entropy, integrity, map_basins
from carom.basins.entropy import entropies
from carom.basins.integrity_measures import _distances, safe_size
from carom.disturbances import AnyState, ContactRelease, Grid, KickPlane, Sample, StateSlice, VelocityKick
from carom.outcome import InputError

MACHINE = PAPER.replace(gamma=0.15, rho=0.3)


def test_distances_are_exact():
    barred = np.random.default_rng(5).random((70, 83)) < 0.02
    x, y = np.linspace(-1.0, 2.0, 70), np.linspace(0.0, 3.0, 83)
    expected = distance_transform_edt(~barred, sampling=(x[1] - x[0], y[1] - y[0]))
    np.testing.assert_allclose(_distances(barred, x, y), expected, atol=1e-12)


def test_nothing_barred_is_infinitely_far():
    assert np.isinf(_distances(np.zeros((4, 5), bool), np.arange(4.0), np.arange(5.0))).all()


def test_the_safe_size_is_the_last_one_tried_before_the_first_loss():
    size = VelocityKick(2.0).coordinates[0]
    lost = np.zeros((4, 6), bool)
    assert safe_size(size, lost) == 2.0
    lost[2, 3] = True
    assert safe_size(size, lost) == pytest.approx(0.75)
    lost[0, 0] = True
    assert safe_size(size, lost) == 0.0


@pytest.mark.jit_only
def test_integrity_of_kicks_agrees_between_pictures():
    """By size and direction, and in the plane, the ball about levitation is the same to the width of the cells."""
    rotor = carom.models.jeffcott(MACHINE)
    rings = integrity(map_basins(rotor, Grid(VelocityKick(1.0), (80, 90))))
    plane = integrity(map_basins(rotor, Grid(KickPlane(1.0), (80, 80))))
    smallest = carom.basins.smallest_loss(rotor, VelocityKick(1.0))
    assert rings.local == pytest.approx(smallest.size, abs=1.5 / 80)
    assert plane.local == pytest.approx(smallest.size, abs=3.0 / 80)
    assert plane.largest >= plane.local - 2.0 / 80
    assert math.isnan(rings.largest)


@pytest.mark.jit_only
def test_integrity_of_positions_and_samples():
    rotor = carom.models.jeffcott(MACHINE)
    # Levitation moves in the room, and only the slice at its velocity contains it.
    found = integrity(map_basins(rotor, Grid(StateSlice(1j * rotor.equilibrium), (60, 60))))
    assert 0.0 < found.local <= 1.0 - abs(rotor.equilibrium)
    assert found.largest >= found.local - 1.0 / 60
    # Apart by less than a cell of the grid, with which a sample of 2,000 has nearly its spacing.
    drawn = integrity(map_basins(rotor, Sample(KickPlane(1.0), 2000)))
    assert drawn.local == pytest.approx(
        integrity(map_basins(rotor, Grid(KickPlane(1.0), (60, 60)))).local, abs=1.0 / 30.0
    )
    for plan in (Grid(ContactRelease(), (8,)), Sample(AnyState(), 8)):
        with pytest.raises(InputError, match="levitation"):
            integrity(map_basins(rotor, plan))


def test_entropy_of_one_colour_is_zero():
    found = entropies(np.zeros((20, 20), int))
    assert (found.whole, found.boxes, found.mixed) == (0.0, 16, 0)
    assert math.isnan(found.boundary)
    assert not found.fractal


def test_entropy_of_a_straight_boundary():
    """Boxes cut in the ratio 2 to 3 have −Σ p ln p of these shares."""
    labels = np.zeros((20, 20), int)
    labels[12:] = 1
    found = entropies(labels)
    cut = -(0.4 * math.log(0.4) + 0.6 * math.log(0.6))
    assert (found.side, found.boxes, found.mixed) == (5, 16, 4)
    assert found.boundary == pytest.approx(cut)
    assert found.whole == pytest.approx(cut / 4.0)
    assert not found.fractal


def test_entropy_weighs_cells_by_area():
    """Two of five rings of each box are of another kind; the boxes and the rings farther out count for more."""
    labels, weights = np.zeros((10, 10), int), np.repeat(np.arange(1.0, 20.0, 2.0)[:, None], 10, axis=1)
    labels[[3, 4, 9]] = 1
    parts = [((1 + 3 + 5) / 25.0, 25.0), ((11 + 13 + 15 + 17) / 75.0, 75.0)]
    mixed = [-(p * math.log(p) + (1 - p) * math.log(1 - p)) for p, _ in parts]
    found = entropies(labels, weights)
    assert found.whole == found.boundary == pytest.approx(0.25 * mixed[0] + 0.75 * mixed[1])
    assert entropies(np.zeros((10, 10), int), weights).whole == 0.0


def test_entropy_of_thorough_mixing():
    """Every box of a random picture of three colours tends to ln 3, so its boundary is above ln 2."""
    labels = np.random.default_rng(1).integers(0, 3, (400, 400))
    found = entropies(labels, side=20)
    assert found.boundary == pytest.approx(math.log(3.0), abs=0.01)
    assert found.fractal


def test_boxes_without_starts_are_left_out():
    labels = np.zeros((10, 10), int)
    labels[:5, :5] = -1
    assert entropies(labels).boxes == 3
    assert entropies(np.full((5, 5), -1)).boxes == 0


def test_entropy_needs_room_for_a_box():
    with pytest.raises(InputError, match="side"):
        entropies(np.zeros((3, 30), int))
    with pytest.raises(InputError, match="side"):
        entropies(np.zeros((30, 30), int), side=1)


@pytest.mark.jit_only
def test_entropy_is_for_grids():
    rotor = carom.models.jeffcott(MACHINE)
    with pytest.raises(InputError, match="sample"):
        basin_entropy(map_basins(rotor, Sample(VelocityKick(1.0), 10)))
    found = basin_entropy(map_basins(rotor, Grid(VelocityKick(1.0), (20, 20))))
    assert 0.0 < found.whole < found.boundary < math.log(3.0)
