"""Disturbances in the engineer's terms give the states that mechanics says."""

import math

import numpy as np
import pytest
from machines import PAPER, SCALES, rest_position
from refusals import assert_refused

import carom
from carom.base.outcome import InputError
from carom.disturbances import AnyState, BaseShock, ContactRelease, Grid, KickPlane, Sample, StateSlice, VelocityKick

MACHINE = PAPER.replace(scales=SCALES)
QUIET = PAPER.replace(rho=0.2)
GROUNDED = PAPER.replace(gamma=0.05)
"""Its equilibrium lies outside the wall."""


@pytest.fixture
def rotor():
    return carom.models.jeffcott(QUIET)


@pytest.mark.parametrize(
    ("given", "plain"),
    [
        (Grid(VelocityKick(0.5), np.array([2, 3])), Grid(VelocityKick(0.5), (2, 3))),
        (Grid(VelocityKick(0.5), (np.int64(2), np.int64(3))), Grid(VelocityKick(0.5), (2, 3))),
        (Sample(VelocityKick(0.5), np.int64(6), np.int64(1)), Sample(VelocityKick(0.5), 6, 1)),
    ],
    ids=["array", "numbers", "sample"],
)
def test_whole_numbers_of_numpy_are_taken(given, plain):
    assert given == plain
    assert hash(given) == hash(plain)
    assert carom.map_basins(PAPER, given).dataset.attrs == carom.map_basins(PAPER, plain).dataset.attrs


def test_kicks_are_those_of_simulate(rotor):
    starts = VelocityKick(1.0).starts(rotor, np.array([0.3, 0.7]), np.array([0.2, 4.0]))
    for place, (speed, angle) in enumerate([(0.3, 0.2), (0.7, 4.0)]):
        state = carom.kick(speed, angle).stages(rotor)[1]
        assert starts.positions[place] == pytest.approx(state.position, abs=1e-15)
        assert starts.velocities[place] == pytest.approx(state.velocity, abs=1e-15)
    assert starts.exists.all()
    assert not starts.ended.any()


def test_nothing_can_be_kicked_out_of_levitation_where_there_is_none():
    grounded = carom.models.jeffcott(GROUNDED)
    assert abs(rest_position(GROUNDED)) > 1.0
    for model in (VelocityKick(), KickPlane(), BaseShock(1.0, 0.5)):
        assert not Grid(model, (3, 3)).starts(grounded).exists.any()


@pytest.mark.parametrize(("motion", "whirl"), [("fixed", 0.0), ("rotating", 1.0), ("rolling", -400 / 7)])
def test_a_release_moves_along_the_wall(rotor, motion, whirl):
    angles = np.linspace(0.0, 6.0, 7)
    starts = ContactRelease(motion).starts(rotor, angles)
    assert np.abs(starts.positions) == pytest.approx(np.ones(7), abs=1e-15)
    local = starts.positions.conj() * starts.velocities
    assert local.real == pytest.approx(np.zeros(7), abs=1e-13)
    assert local.imag + 1.0 == pytest.approx(np.full(7, whirl), abs=1e-13)
    slip = QUIET.radius_ratio + 1.0 + local.imag
    assert (np.abs(slip) < 1e-12).all() == (motion == "rolling")


def test_states_are_even_over_both_discs():
    sample = Sample(AnyState(1.5), 20_000, seed=4)
    starts = sample.starts(carom.models.jeffcott(QUIET))
    for values, radius in ((starts.positions, 1.0), (starts.velocities + 1j * starts.positions, 1.5)):
        assert np.abs(values).max() <= radius
        # A quarter of the area lies within half the radius; five standard errors.
        share = (np.abs(values) < radius / 2).mean()
        assert share == pytest.approx(0.25, abs=5 * math.sqrt(0.25 * 0.75 / 20_000))
        assert abs(values.mean()) < 5 * radius / math.sqrt(2 * 20_000)


@pytest.mark.parametrize("model", [VelocityKick(2.0), BaseShock(2.0, 1.0)])
def test_cells_of_a_disc_weigh_by_their_area(model):
    size, direction = model.coordinates
    rings = np.diff(math.pi * size.edges(7) ** 2)
    assert (size.edges(7)[0], size.edges(7)[-1]) == (0.0, 2.0)
    assert np.diff(size.edges(7)) == pytest.approx(np.full(7, 2.0 / 7))
    weights = Grid(model, (7, 5)).weights()
    assert weights == pytest.approx(np.repeat(rings[:, None] / rings.mean(), 5, axis=1))
    assert weights.mean() == pytest.approx(1.0)
    assert (direction.weights(5) == 1.0).all()


def test_no_kick_by_components_is_larger_than_the_largest(rotor):
    grid = Grid(KickPlane(0.5), (30, 30))
    starts = grid.starts(rotor)
    sizes = np.abs(starts.velocities)
    np.testing.assert_array_equal(starts.exists, sizes <= 0.5)
    # The cells whose middles lie in the disc have its share of the square, to the width of a cell.
    assert starts.exists.mean() == pytest.approx(math.pi / 4.0, abs=1.0 / 30)
    assert Sample(KickPlane(0.5), 500, seed=1).starts(rotor).exists.all()


def test_text_with_a_unit_goes_through_the_scales():
    shock = BaseShock.of(MACHINE, "20 g", "3 ms")
    assert shock.peak * SCALES.acceleration == pytest.approx(20.0 * 9.80665)
    assert shock.duration * SCALES.time == pytest.approx(3e-3)
    assert VelocityKick.of(MACHINE, "50 mm/s").fastest * SCALES.velocity == pytest.approx(0.05)
    assert VelocityKick.of(PAPER, 0.5) == VelocityKick(0.5)
    assert ContactRelease.of(PAPER) == ContactRelease()


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: VelocityKick("50 mm/s"), r"fastest = 50 mm/s: a number; text .* VelocityKick.of\(machine"),
        (lambda: VelocityKick.of(PAPER, "50 mm/s"), "fastest = 50 mm/s: must be a number without a unit"),
        (lambda: VelocityKick.of(MACHINE, "50 mm"), "fastest = 50 mm: must be a velocity"),
        (lambda: VelocityKick.of(MACHINE, "-50 mm/s"), "fastest = -.*: a size, above 0"),
        (lambda: VelocityKick.of(MACHINE, 1.0, 2.0), "sizes = .*: at most 1: fastest"),
        (lambda: VelocityKick.of(1.0, "50 mm/s"), "machine = 1.0"),
    ],
)
def test_bad_sizes_are_one_line(make, message):
    assert_refused(make, message)


def test_rescaling_keeps_what_happens_in_si():
    other = carom.parameters.Scales(mass=80.0, clearance=0.3e-3, speed=400.0)
    different = MACHINE.replace(scales=other)
    shock = BaseShock.of(MACHINE, "20 g", "3 ms")
    again = shock.rescaled(SCALES, other)
    expected = BaseShock.of(different, "20 g", "3 ms")
    assert (again.peak, again.duration) == pytest.approx((expected.peak, expected.duration))
    slice_ = StateSlice(0.1 + 0.2j).rescaled(SCALES, other)
    assert slice_.velocity * other.velocity == pytest.approx((0.1 + 0.2j) * SCALES.velocity)
    assert shock.rescaled(None, None) is shock


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: VelocityKick(-1.0), "fastest"),
        (lambda: VelocityKick(math.nan), "fastest"),
        (lambda: BaseShock(1.0, 0.0), "duration"),
        (lambda: BaseShock(1.0, 1.1e4), "duration"),
        (lambda: BaseShock(math.inf, 1.0), "peak"),
        (lambda: ContactRelease("sideways"), "motion"),
        (lambda: StateSlice(complex(math.inf, 0.0)), "velocity"),
        (lambda: Grid(VelocityKick(), (3,)), "grid"),
        (lambda: Grid(VelocityKick(), (3, 0)), "grid"),
        (lambda: Sample(VelocityKick(), 0), "count"),
        (lambda: Sample(VelocityKick(), 5, seed=-1), "seed"),
    ],
)
def test_what_makes_no_sense_is_refused(make, field):
    with pytest.raises(InputError) as problem:
        make()
    assert problem.value.field == field


def test_the_last_bit_does_not_depend_on_company(rotor):
    """Starts of a part of a sample are those of the whole: chunks of a sweep give the same bits."""
    model = AnyState()
    values = Sample(model, 37, seed=9).values()
    whole = model.starts(rotor, *values)
    for first in range(37):
        part = model.starts(rotor, *(value[first : first + 3] for value in values))
        np.testing.assert_array_equal(part.positions, whole.positions[first : first + 3])
        np.testing.assert_array_equal(part.velocities, whole.velocities[first : first + 3])
