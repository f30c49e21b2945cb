"""For which damping and stiffness equilibria exist: closed forms against the equilibria themselves."""

import math

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from carom.closed_forms.equilibria import find_equilibria
from carom.models import Jeffcott
from carom.motions.starts import State
from carom.motions.trajectories import simulate
from carom.outcome import Outcome
from carom.parameters import Parameters
from carom.studies.ranges import (
    Edge,
    MotionRange,
    Span,
    common,
    outside,
    steady_range,
)

SOURCE = Parameters(gamma=0.1, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=400 / 7)

planar = st.builds(
    Parameters,
    gamma=st.floats(1e-3, 2.5),
    omega=st.floats(0.05, 2.5),
    rho=st.floats(0.01, 2.5),
    phi=st.just(0.3),
    mu=st.sampled_from([0.0, 0.05, 0.15, 0.5, 2.0]),
    d=st.just(0.9),
    radius_ratio=st.just(40.0),
)


def levitates(parameters):
    return find_equilibria(Jeffcott(parameters))[0].status == "admissible"


def rubs(parameters):
    return any(entry.status == "admissible" for entry in find_equilibria(Jeffcott(parameters))[1:])


EXISTS = {"contact-free": levitates, "rub": rubs}


@pytest.mark.parametrize("motion", EXISTS)
@pytest.mark.parametrize("gain", ["gamma", "omega"])
@settings(max_examples=150)
@given(parameters=planar, value=st.floats(0.02, 2.5))
def test_range_says_where_the_motion_exists(motion, gain, parameters, value):
    exists = EXISTS[motion]
    found = steady_range(parameters, motion, gain)
    edges = [edge.value for span in found.spans for edge in (span.low, span.high)]
    # Nearer to an edge than this the equilibria are decided by rounding.
    assume(all(abs(value - edge) > 1e-9 for edge in edges) and abs(parameters.gamma - parameters.rho) > 1e-9)
    here = parameters.replace(**{gain: value})

    assert found.exists_at(value) == exists(here)


@pytest.mark.parametrize("motion", EXISTS)
@pytest.mark.parametrize("gain", ["gamma", "omega"])
@settings(max_examples=40)
@given(parameters=planar)
def test_every_threshold_is_found_by_bisection_too(motion, gain, parameters):
    exists = EXISTS[motion]
    for threshold in steady_range(parameters, motion, gain).thresholds:
        value = threshold.edge.value
        low, high = 0.999 * value, 1.001 * value
        # Two thresholds closer together than the bracket cannot be told apart by it.
        assume(value > 1e-3)
        there = [exists(parameters.replace(**{gain: end})) for end in (low, high)]
        assume(there[0] != there[1])
        assert there == [threshold.exists == "below", threshold.exists == "above"]
        while high - low > 1e-12 * value:
            middle = 0.5 * (low + high)
            if exists(parameters.replace(**{gain: middle})) == there[0]:
                low = middle
            else:
                high = middle
        # The equilibria count a gap or force below 1e-12 as none; near a tangency that moves a threshold by its root.
        assert 0.5 * (low + high) == pytest.approx(value, rel=3e-6)


def test_thresholds_of_the_source_machine():
    (contact_free,) = steady_range(SOURCE, "contact-free", "gamma").thresholds
    (rub,) = steady_range(SOURCE, "rub", "gamma").thresholds

    assert contact_free.edge.value == pytest.approx(0.0724686787, abs=5e-11)
    assert (contact_free.exists, contact_free.edge.kind) == ("above", "boundary-equilibrium")
    assert rub.edge.value == pytest.approx(0.3700060, abs=5e-8)
    assert (rub.exists, rub.edge.kind) == ("below", "rub-fold")


def test_rub_pushes_at_its_fold_and_not_beyond_the_point_where_the_fold_meets_the_circle():
    # At the fold N = κ − ρμ/√(1+μ²), so the kind of the end changes at κ = ρμ/√(1+μ²).
    kappa = 3 / 7 * 0.15 / math.hypot(1.0, 0.15)
    for factor, kind in ((1.1, "rub-fold"), (0.9, "boundary-equilibrium")):
        parameters = SOURCE.replace(omega=math.sqrt(1.0 - factor * kappa))
        (threshold,) = steady_range(parameters, "rub", "gamma").thresholds
        assert threshold.edge.kind == kind
        below = parameters.replace(gamma=threshold.edge.value * (1.0 - 1e-6))
        forces = [entry.normal_force for entry in find_equilibria(Jeffcott(below))[1:] if entry.status == "admissible"]
        assert len(forces) == (2 if kind == "rub-fold" else 1)


@settings(max_examples=60)
@given(parameters=planar)
def test_where_a_rub_exists_a_stable_one_does(parameters):
    found = [entry for entry in find_equilibria(Jeffcott(parameters))[1:] if entry.status == "admissible"]

    forces = [entry.normal_force for entry in found]
    assume(all(force > 1e-9 for force in forces) and (len(forces) < 2 or abs(forces[0] - forces[1]) > 1e-6))
    assert any(entry.stable for entry in found) == bool(found)


@pytest.mark.parametrize("gain", ["gamma", "omega"])
@pytest.mark.parametrize("factor", [0.999, 1.001])
def test_rotor_rolls_on_exactly_within_its_range(gain, factor):
    parameters = SOURCE.replace(radius_ratio=5.0, gamma=0.3)
    (threshold,) = steady_range(parameters, "rolling", gain).thresholds
    rotor = Jeffcott(parameters.replace(**{gain: factor * threshold.edge.value}))

    motion = simulate(rotor, State(1.0 + 0j, -6j), 2.5)

    rolls_on = {contact.kind for contact in motion.lasting_contacts} == {"roll"}
    assert rolls_on == (factor < 1.0)
    assert threshold.exists == "below"


def test_rolling_is_where_a_rolling_start_settles():
    rotor = Jeffcott(SOURCE)

    assert steady_range(SOURCE, "rolling", "gamma").exists_at(SOURCE.gamma)
    assert simulate(rotor, State(1.0 + 0j, -1j * (400 / 7 + 1)), 100.0, settle=True).outcome is Outcome.ROLLING


@pytest.mark.parametrize("gain", ["gamma", "omega"])
def test_without_friction_nothing_rolls_and_without_unbalance_nothing_rubs(gain):
    assert steady_range(SOURCE.replace(mu=0.0), "rolling", gain).spans == ()
    assert steady_range(SOURCE.replace(rho=0.0), "rub", gain).spans == ()
    assert steady_range(SOURCE.replace(rho=0.0), "contact-free", gain).spans == (Span(Edge(0.0), Edge(math.inf)),)


def spans(*ends):
    return tuple(Span(Edge(low), Edge(high)) for low, high in ends)


def ends(found):
    return [(span.low.value, span.high.value) for span in found]


@pytest.mark.parametrize(
    ("covered", "gaps"),
    [
        ((), [(1, 9)]),
        (((0, 10),), []),
        (((2, 3),), [(1, 2), (3, 9)]),
        (((0, 2), (4, 5), (8, 12)), [(2, 4), (5, 8)]),
        (((1, 9),), []),
        (((10, 11),), [(1, 9)]),
    ],
)
def test_outside(covered, gaps):
    assert ends(outside(spans(*covered), Span(Edge(1.0), Edge(9.0)))) == gaps


def test_common():
    assert ends(common(spans((0, 3), (5, 9)), spans((2, 6), (8, math.inf)))) == [(2, 3), (5, 6), (8, 9)]
    assert common(spans((0, 1)), spans((1, 2))) == ()


def test_search_ends_are_no_thresholds():
    edge = Edge(2.0, "fold", 1.5)
    found = MotionRange("single-impact", "gamma", (Span(Edge(0.1), edge),), Span(Edge(0.1), Edge(8.0)))

    assert [(entry.edge, entry.exists) for entry in found.thresholds] == [(edge, "below")]
    assert found.exists_at(2.0)
    assert not found.exists_at(2.1)
