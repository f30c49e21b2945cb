"""For which damping and stiffness single-impact orbits can happen: against the certified orbits at many values."""

import math

import numpy as np
import pytest
from compilation import sized
from machines import random_parameters

from carom.models import Jeffcott
from carom.orbits.single_impact import orbits_within_reach
from carom.parameters import Machine, Parameters, load
from carom.studies.orbit_ranges import single_impact_ranges

SOURCE = Parameters(gamma=0.1, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=400 / 7)
README = load("examples/keogh-cole.toml").machine
SPINDLE = Machine(
    mass=3.2, damping=350.0, stiffness=4e5, eccentricity=0.9947e-6, clearance=0.25e-3, rotor_radius=15e-3,
    speed="24000 rpm", unbalance_phase=0.0, friction=0.2, restitution=0.7,
)  # fmt: skip
COMPRESSOR = Machine(
    mass=4000.0, damping=2.8e5, stiffness=1.2e8, eccentricity=3.98e-6, clearance=0.3e-3, rotor_radius=0.15,
    speed="6000 rpm", unbalance_phase=0.0, friction=0.2, restitution=0.7,
)  # fmt: skip


def orbits_at(parameters, gain, value):
    """Whether any orbit is admissible, and whether any such is stable, by the certified list."""
    orbits = [orbit for orbit in orbits_within_reach(Jeffcott(parameters.replace(**{gain: value}))) if orbit.admissible]
    return bool(orbits), any(orbit.stable for orbit in orbits)


def check(parameters, gain, values):
    """The ranges and the certified orbits agree at these values and on both sides of every end."""
    for found, which in zip(single_impact_ranges(parameters, gain), (0, 1), strict=True):
        edges = np.array([threshold.edge.value for threshold in found.thresholds])
        assert all(threshold.edge.certified for threshold in found.thresholds)
        for value in values:
            if not len(edges) or np.abs(edges / value - 1.0).min() > 1e-7:
                assert found.exists_at(value) == orbits_at(parameters, gain, value)[which], (parameters, gain, value)


def test_no_orbit_of_the_readme_machine_above_the_stiffness_at_which_levitation_returns():
    """All four roots are virtual at 3.0e6 N/m, where roots of ``F₁`` were once taken for motions."""
    found, _ = single_impact_ranges(README.parameters, "omega")
    assert not found.exists_at(math.sqrt(3.0e6 / README.scales.stiffness))
    (end,) = found.thresholds
    # Every orbit shrinks into the levitation that touches the wall there.
    parameters = README.parameters
    touching = math.sqrt(1.0 + math.sqrt(parameters.rho**2 - parameters.gamma**2))
    assert end.edge.value == pytest.approx(touching, rel=1e-12)
    assert (end.edge.kind, end.exists, end.edge.certified) == ("non-smooth-hopf", "below", True)


@pytest.mark.parametrize("machine", [SPINDLE, COMPRESSOR], ids=["spindle", "compressor"])
@pytest.mark.parametrize("gain", ["gamma", "omega"])
def test_machines_whose_roots_are_all_virtual_have_no_orbit_at_any_gain(machine, gain):
    for found in single_impact_ranges(machine.parameters, gain):
        assert found.spans == ()
        assert found.thresholds == ()


def test_fold_and_period_doubling_of_the_source_machine():
    found, stable = single_impact_ranges(SOURCE, "gamma")

    (fold,) = found.thresholds
    assert fold.edge.value == pytest.approx(0.1780277257, abs=5e-11)
    assert fold.edge.period == pytest.approx(1.6408219835, abs=5e-7)
    assert (fold.edge.kind, fold.exists, fold.edge.certified) == ("fold", "below", True)
    doubling, end = stable.thresholds
    assert doubling.edge.value == pytest.approx(0.0833814175, abs=5e-11)
    assert (doubling.edge.kind, doubling.exists, doubling.edge.certified) == ("period-doubling", "above", True)
    assert end.edge.value == pytest.approx(fold.edge.value, rel=1e-14)


def test_folds_along_both_gains_are_the_same_curve():
    parameters = SOURCE.replace(gamma=0.1779)
    folds = [end for end in single_impact_ranges(parameters, "omega")[0].thresholds if end.edge.kind == "fold"]

    assert len(folds) >= 1
    for fold in folds:
        same = single_impact_ranges(parameters.replace(omega=fold.edge.value), "gamma")[0].thresholds
        # Along omega the fold is nearly a fold of the curve itself: its place is softer than its damping.
        assert min(abs(end.edge.value - 0.1779) for end in same) < 1e-12


def test_ranges_agree_with_the_certified_orbits():
    random = np.random.default_rng(3)
    machines = [SOURCE, SOURCE.replace(gamma=0.1779), SOURCE.replace(omega=0.4, gamma=0.3), SOURCE.replace(d=1.0)]
    for parameters in machines[: sized(4, 1, 4)]:
        for gain, low, high in (("gamma", 0.02, 1.0), ("omega", 0.5 * parameters.omega, 2.0 * parameters.omega)):
            check(parameters, gain, np.exp(random.uniform(math.log(low), math.log(high), sized(10, 2, 40))))


@pytest.mark.deep
@pytest.mark.jit_only
def test_ranges_of_random_machines_agree_with_the_certified_orbits():
    random = np.random.default_rng(11)
    for _ in range(100):
        parameters = random_parameters(random, gamma=float(10 ** random.uniform(-1.5, 0.0)))
        for gain in ("gamma", "omega"):
            ranges = single_impact_ranges(parameters, gain)
            if ranges:
                low, high = ranges[0].searched.low.value, ranges[0].searched.high.value
                check(parameters, gain, np.exp(random.uniform(math.log(low), math.log(high), 30)))


@pytest.mark.parametrize("gain", ["gamma", "omega"])
def test_a_balanced_rotor_has_no_orbit_along_either_gain(gain):
    """``F₁`` does not know the unbalance and has roots all the same; no orbit belongs to them."""
    balanced = single_impact_ranges(SOURCE.replace(rho=0.0), gain)
    assert [found.spans for found in balanced] == [(), ()]
    assert [found.motion for found in balanced] == ["single-impact", "stable-single-impact"]


@pytest.mark.parametrize("gamma", [0.0, -0.1, 1e-5])
def test_no_search_along_stiffness_without_damping_or_with_too_many_orbits(gamma):
    assert single_impact_ranges(SOURCE.replace(gamma=gamma), "omega") == ()


def test_progress_grows_to_one():
    shares = []
    single_impact_ranges(SOURCE, "gamma", lambda report: shares.append(report.share))

    assert shares == sorted(shares)
    assert shares[-1] == 1.0
