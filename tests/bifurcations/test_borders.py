"""Where the word of an orbit changes: the neighbouring orbit, and what simulated motions do on the other side."""

from functools import cache, reduce

import numpy as np
import pytest

from carom.base.outcome import Outcome
from carom.bifurcations import Bifurcation, OrbitBranch, continue_orbit, switch
from carom.bifurcations.word_equations import BORDERS
from carom.models import jeffcott
from carom.motions import State, simulate
from carom.orbits import Orbit, find_orbits, impact_map, orbit_near
from carom.orbits.shooting import ShootingStart
from tests.bifurcations.test_words import doubled, located
from tests.machines import PAPER

pytestmark = pytest.mark.jit_only


@cache
def three_impacts() -> OrbitBranch:
    """The branch of orbits with one impact more that ends where the doubled orbit grazes."""
    return switch(located("grazing", 0.08267), (0.079, 0.088))


@cache
def stopped() -> Bifurcation:
    """B1,d of a small rotor, where friction begins to stop the slip."""
    orbit = find_orbits(PAPER.replace(radius_ratio=1.0))["B1,d"]
    (point,) = [each for each in continue_orbit(orbit, "radius_ratio", (0.5, 1.2)).special if each.kind == "slip-stop"]
    return point


def test_the_orbit_on_the_border_solves_the_equations_of_both_words():
    point = located("grazing", 0.08267)
    word, start = BORDERS["grazing"](point.orbit)
    assert (len(word), len(start.durations)) == (3, 3)
    assert start.durations.sum() == pytest.approx(point.orbit.period, abs=1e-12)
    more = orbit_near(point.orbit.rotor, word, start)
    assert more is not None
    # At a grazing impact the speed is the root of the error of its height.
    assert abs(more.margins.approach) < 1e-5
    back, again = BORDERS["vanishing-impact"](more)
    assert back == point.orbit.word
    assert again.durations.sum() == pytest.approx(point.orbit.period, abs=1e-5)


def test_the_branch_with_one_impact_more_ends_at_the_grazing():
    point, branch = located("grazing", 0.08267), three_impacts()
    (end,) = [each for each in branch.special if each.kind == "vanishing-impact"]
    assert end.value == pytest.approx(point.value, abs=1e-12)
    assert not [each for each in branch.special if each.kind == "grazing" and abs(each.value - end.value) < 1e-7]
    real = branch.values[branch.admissible]
    assert real.min() > point.value
    assert not branch.stable[branch.admissible & (branch.values < 0.0828)].any()
    # It is a motion: the simulation makes the same three impacts.
    orbit = branch.orbits[int(np.flatnonzero(branch.admissible)[0])]
    motion = simulate(orbit.rotor, orbit.departure, 1.001 * orbit.period)
    assert np.abs(motion.contacts.time - np.cumsum(orbit.durations)).max() < 1e-7


def test_fresh_motions_beyond_the_jump_do_not_return_to_the_orbit():
    """Other distances and starts than those of the examination, all of them close to the border."""
    point, rng = located("grazing", 0.08267), np.random.default_rng(8)
    for distance in (7e-6, 1.5e-5, 9e-5):
        before = point.orbit.departure
        for side, stays in ((1, True), (-1, False)):
            rotor = jeffcott(PAPER.replace(gamma=point.value + side * distance))
            start = State(before.position, before.velocity * (1.0 + 1e-6 * rng.normal()))
            motion = simulate(rotor, start, settle=True, patience=20_000)
            assert motion.outcome is Outcome.BOUNCING
            assert (motion.multiplicity == 2) is stays


def test_where_friction_stops_the_slip_the_motion_goes_on_continuously():
    point = stopped()
    branch = switch(point, (0.5, 1.2))
    assert str(branch.word) == "impact0"
    assert branch.admissible[branch.values < point.value - 1e-6].all()
    # There it is what the simulation does, and it attracts.
    orbit = branch.orbits[0]
    assert orbit.stable
    motion = simulate(orbit.rotor, State(orbit.position, orbit.departure.velocity * 1.001), settle=True)
    assert (motion.outcome, motion.multiplicity) == (Outcome.BOUNCING, 1)
    assert np.abs(np.abs(motion.contacts.radial_speed[-3:]) - orbit.radial_speed).max() < 1e-7


def test_slip_stop_of_a_single_impact_orbit_is_that_of_the_closed_form():
    orbit = find_orbits(PAPER.replace(radius_ratio=1.0))["B1,d"]
    (known,) = [each for each in continue_orbit(orbit, "radius_ratio", (0.5, 1.2)).special if each.kind == "slip-stop"]
    assert stopped().value == pytest.approx(known.value, abs=1e-11)


# ------------------------------------------------------------------------- special points of three impacts


@cache
def resonant() -> OrbitBranch:
    """A stable orbit of three impacts, between a period doubling and a Neimark–Sacker bifurcation."""
    found = find_orbits(PAPER.replace(gamma=0.09), impacts=3)
    (orbit,) = [each for each in found if each.stable and each.impacts == 3]
    return continue_orbit(orbit, "gamma", (0.086, 0.094))


def product(orbit: Orbit) -> np.ndarray:
    """Derivative of the return map by the impact map of each impact, which knows nothing of segments."""
    maps = [impact_map(orbit.rotor, section).jacobian for section in orbit.sections]
    whole: np.ndarray = reduce(lambda after, before: before @ after, maps, np.eye(3))
    return whole


def test_period_doubling_and_neimark_sacker_by_another_derivative():
    kinds = {point.kind: point for point in resonant().special}
    assert set(kinds) == {"period-doubling", "neimark-sacker"}
    assert kinds["period-doubling"].value == pytest.approx(0.0877104718, abs=1e-9)
    assert kinds["neimark-sacker"].value == pytest.approx(0.0916730903, abs=1e-9)
    values = np.linalg.eigvals(product(kinds["period-doubling"].orbit))
    assert np.abs(values + 1.0).min() < 1e-8
    values = np.linalg.eigvals(product(kinds["neimark-sacker"].orbit))
    (pair,) = [value for value in values if value.imag > 1e-6]
    assert abs(pair) == pytest.approx(1.0, abs=1e-9)
    for orbit in resonant().orbits[::4]:
        mine, theirs = (np.sort_complex(each) for each in (orbit.multipliers.values, np.linalg.eigvals(product(orbit))))
        assert np.abs(mine - theirs).max() < 1e-10 * max(1.0, np.abs(theirs).max())


def test_the_orbit_attracts_between_these_points_and_repels_outside():
    for gamma, attracts in ((0.0875, False), (0.0879, True), (0.0915, True), (0.0919, False)):
        (start,) = resonant().starts_at(gamma)
        orbit = orbit_near(PAPER.replace(gamma=gamma), resonant().word, ShootingStart(*start))
        assert orbit is not None
        assert orbit.admissible
        assert orbit.stable is attracts
        before = orbit.departure
        motion = simulate(orbit.rotor, State(before.position, before.velocity * (1.0 + 1e-5)), 120 * orbit.period)
        speeds = motion.contacts.radial_speed
        errors = np.abs(speeds - np.resize(orbit.impact_speeds[[1, 2, 0]], len(speeds)))
        assert bool(errors[330:360].max() < 0.3 * errors[:30].max()) is attracts
        if not attracts:
            assert errors[200:].max() > 3.0 * errors[:30].max()


def test_the_doubled_branch_of_three_impacts_is_found():
    (point,) = [each for each in resonant().special if each.kind == "period-doubling"]
    branch = switch(point, (0.0865, 0.089))
    assert len(branch.word) == 6
    assert "period-halving" in branch.stops
    assert len(doubled().word) == 2


# ------------------------------------------------------------------------------------------- grazing of strong losses

INELASTIC = PAPER.replace(omega=0.2813, rho=0.2732, mu=0.0773, d=0.0854, radius_ratio=4.16)
"""It loses nearly all speed at an impact, and its orbits of one impact graze without a jump."""


@cache
def grazing_of(gamma: float, along: str, low: float, high: float) -> Bifurcation:
    (orbit,) = [each for each in find_orbits(INELASTIC.replace(gamma=gamma)) if each.admissible and each.stable]
    (point,) = [
        each for each in continue_orbit(orbit, along, (low, high)).special if each.kind == "grazing" and each.admissible
    ]
    return point


def test_motions_beyond_the_grazing_stay_irregular_and_part_from_each_other():
    """Other distances than those of the examination; how motions part is seen without any derivative."""
    point, rng = grazing_of(0.0652, "gamma", 0.06, 0.07), np.random.default_rng(5)
    above = orbit_near(jeffcott(INELASTIC.replace(gamma=point.value + 1e-7)), point.orbit.word, point.orbit.start)
    side = -1 if above is not None and above.admissible else 1
    for distance in (1e-7, 6e-7, 1.7e-6):
        rotor = jeffcott(INELASTIC.replace(gamma=point.value + side * distance))
        before, push, speeds = point.orbit.departure, 1.0 + 1e-6 * rng.uniform(), []
        for pushed in (push, push * (1.0 + 1e-10)):
            motion = simulate(rotor, State(before.position, before.velocity * pushed), settle=True, patience=4000)
            assert (motion.outcome, motion.multiplicity) == (Outcome.BOUNCING, 0)
            speeds.append(motion.contacts.radial_speed[:4000])
        size = np.ptp(speeds[0][2000:])
        assert np.abs(speeds[0] - speeds[1])[:3].max() < 1e-6 * size
        assert np.abs(speeds[0] - speeds[1])[2000:].max() > 0.1 * size
