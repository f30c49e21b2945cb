"""For which damping and stiffness single-impact orbits exist: the search against known numbers and independent counts."""

import numpy as np
import pytest

from carom.orbits import single_impact_orbits
from carom.parameters import Parameters
from carom.periods import PeriodCondition
from carom.rotors import jeffcott
from carom.study.folds import deepest_dip, single_impact_range

SOURCE = Parameters(gamma=0.1, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=400 / 7)


def root_count(parameters):
    return len(PeriodCondition(jeffcott(parameters)).roots().periods)


def test_fold_of_the_source_machine():
    found = single_impact_range(SOURCE, "gamma")

    (threshold,) = found.thresholds
    assert threshold.edge.value == pytest.approx(0.1780277257, abs=5e-11)
    assert threshold.edge.period == pytest.approx(1.6408221, abs=5e-7)
    assert (threshold.edge.kind, threshold.exists, threshold.edge.certified) == ("fold", "below", True)


def test_fold_is_a_double_root():
    (threshold,) = single_impact_range(SOURCE, "gamma").thresholds
    condition = PeriodCondition(jeffcott(SOURCE.replace(gamma=threshold.edge.value)))
    period = np.array([threshold.edge.period])

    # F1 to its rounding; F1' has the accuracy to which a minimum can be found.
    assert abs(condition.value(period)[0]) < 1e-14
    assert abs(condition.slope(period)[0]) < 1e-7
    assert condition.slope(period * 0.999)[0] < 0.0 < condition.slope(period * 1.001)[0]


def test_fold_at_the_codimension_2_point_of_the_source_paper():
    (threshold,) = single_impact_range(SOURCE.replace(omega=0.7811076), "gamma").thresholds

    # Printed to seven digits.
    assert threshold.edge.value == pytest.approx(0.1779723, abs=5e-8)


def test_folds_along_both_gains_are_the_same_curve():
    parameters = SOURCE.replace(gamma=0.1779)
    folds = single_impact_range(parameters, "omega").thresholds

    assert len(folds) >= 1
    for fold in folds:
        (same,) = single_impact_range(parameters.replace(omega=fold.edge.value), "gamma").thresholds
        # Along omega the fold is nearly a fold of the curve itself: its place is softer than its damping.
        assert same.edge.value == pytest.approx(0.1779, abs=1e-12)


@pytest.mark.parametrize("gain", ["gamma", "omega"])
@pytest.mark.parametrize("parameters", [SOURCE, SOURCE.replace(gamma=0.1779), SOURCE.replace(omega=0.4, gamma=0.3)])
def test_range_agrees_with_proven_counts(parameters, gain):
    found = single_impact_range(parameters, gain)

    for value in np.geomspace(found.searched.low.value, found.searched.high.value, 23):
        edges = [threshold.edge.value for threshold in found.thresholds]
        if all(abs(value / edge - 1.0) > 1e-6 for edge in edges):
            assert found.exists_at(value) == (root_count(parameters.replace(**{gain: value})) > 0)


def test_soft_rotor_bounces_at_any_damping_searched():
    found = single_impact_range(SOURCE.replace(omega=0.3), "gamma")

    assert found.thresholds == ()
    assert [(span.low.value, span.high.value) for span in found.spans] == [
        (found.searched.low.value, found.searched.high.value)
    ]


@pytest.mark.parametrize("restitution", [1.0, 1.0 - 1e-9, 0.9999])
def test_nearly_elastic_impacts_have_roots_at_very_short_periods(restitution):
    parameters = SOURCE.replace(d=restitution)
    (threshold,) = single_impact_range(parameters, "gamma").thresholds

    assert threshold.edge.certified
    assert threshold.edge.kind == ("vanishing-period" if restitution == 1.0 else "fold")
    assert threshold.edge.period < 0.3
    for factor, exists in ((0.9999, True), (1.0001, False)):
        assert (root_count(parameters.replace(gamma=factor * threshold.edge.value)) > 0) == exists


def test_no_search_along_stiffness_without_damping():
    assert single_impact_range(SOURCE.replace(gamma=0.0), "omega") is None
    assert single_impact_range(SOURCE.replace(gamma=-0.1), "omega") is None


def test_no_search_where_the_condition_oscillates_too_often():
    assert single_impact_range(SOURCE.replace(gamma=1e-5), "omega") is None


def test_progress_grows_to_one():
    shares = []
    single_impact_range(SOURCE, "gamma", shares.append)

    assert shares == sorted(shares)
    assert shares[-1] == 1.0


@pytest.mark.parametrize("gamma", [0.05, 0.1, 0.17, 0.18])
def test_dip_is_the_lowest_minimum_of_many_samples(gamma):
    parameters = SOURCE.replace(gamma=gamma)
    condition = PeriodCondition(jeffcott(parameters))
    period, depth = deepest_dip(parameters)

    values = condition.value(np.linspace(0.0, condition.longest_period(), 20_001))
    minima = values[1:-1][(values[1:-1] < values[:-2]) & (values[1:-1] < values[2:])]
    assert minima.min() - 1e-5 < depth <= minima.min() + 1e-15
    assert abs(condition.value(np.array([period]))[0] - depth) < 1e-15
    assert deepest_dip(parameters, sign_only=True)[1] * depth > 0.0


def test_no_dip_where_the_condition_never_falls_below_its_start():
    assert deepest_dip(SOURCE.replace(gamma=0.5)) == (np.inf, np.inf)


@pytest.mark.parametrize("gain", ["gamma", "omega"])
def test_a_balanced_rotor_has_no_orbit_along_either_gain(gain):
    """``F₁`` does not know the unbalance and has roots all the same; no orbit belongs to them."""
    balanced = single_impact_range(SOURCE.replace(rho=0.0), gain)
    unbalanced = single_impact_range(SOURCE, gain)
    assert unbalanced.spans
    assert balanced.spans == ()
    assert balanced.searched == unbalanced.searched
    assert len(single_impact_orbits(jeffcott(SOURCE.replace(rho=0.0)))) == 0
