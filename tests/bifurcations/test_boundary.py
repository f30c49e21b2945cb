"""Classification of boundary equilibria, against the equilibria and orbits on both sides and against simulation."""

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from machines import PAPER

from carom import State, find_equilibria, find_orbits, simulate
from carom.base.outcome import Outcome
from carom.bifurcations import boundary_equilibria
from carom.closed_forms import PeriodCondition
from carom.models import jeffcott
from carom.parameters import Parameters

machines = st.builds(
    Parameters,
    gamma=st.floats(0.05, 1.0),
    omega=st.floats(0.3, 1.7),
    rho=st.floats(0.05, 1.0),
    phi=st.floats(-3.0, 3.0),
    mu=st.floats(0.0, 0.6),
    d=st.floats(0.3, 0.95),
    radius_ratio=st.just(50.0),
)


def at_gap(boundary, gap):
    """Rotor whose contact-free equilibrium is that far inside the wall, along the gain that was varied."""
    step = 1e-7 * boundary.value
    gap_rate = (gap_of(boundary, boundary.value + step) - gap_of(boundary, boundary.value - step)) / (2.0 * step)
    return rotor_at(boundary, boundary.value + gap / gap_rate)


def rotor_at(boundary, value):
    return jeffcott(boundary.parameters.replace(**{boundary.gain: value}))


def gap_of(boundary, value):
    return 1.0 - abs(rotor_at(boundary, value).equilibrium)


@settings(max_examples=60, deadline=None)
@given(parameters=machines, gain=st.sampled_from(["gamma", "omega"]))
def test_equilibria_on_both_sides_are_as_classified(parameters, gain):
    for boundary in boundary_equilibria(jeffcott(parameters), gain):
        at = boundary.parameters
        assume(abs(1.0 / boundary.force_rate) > 0.05 and at.gamma > 0.05)
        # Where the gain only touches the boundary, a gap is not proportional to a change of the gain.
        assume(abs(1.0 - at.omega) > 0.05 and at.omega > 0.05)
        for gap in (1e-6, -1e-6):
            rotor = at_gap(boundary, gap)
            levitation, *rubs = find_equilibria(rotor)
            exact = 1.0 - abs(rotor.equilibrium)
            small = min(rubs, key=lambda rub: abs(rub.normal_force))

            assert exact == pytest.approx(gap, rel=1e-2)
            assert (levitation.status == "admissible") == (gap > 0.0)
            assert small.normal_force == pytest.approx(boundary.force_rate * exact, rel=1e-3)
            if boundary.kind == "persistence":
                assert (small.status == "admissible") == small.stable == (gap < 0.0)
            else:
                assert boundary.kind == "non-smooth fold"
                assert (small.status == "admissible") == (gap > 0.0)
                assert not small.stable


@pytest.mark.jit_only
@settings(max_examples=25, deadline=None)
@given(parameters=machines)
def test_side_of_small_orbits_follows_from_the_linearised_condition(parameters):
    for boundary in boundary_equilibria(jeffcott(parameters.replace(gamma=0.3 * parameters.gamma)), "omega"):
        condition = PeriodCondition.of(jeffcott(boundary.parameters).system)
        for orbit in boundary.orbits:
            lever = condition.factor * complex(condition.a12(orbit.period))
            gap = 1.0 if orbit.levitating_side else -1.0

            assert orbit.levitating_side == (lever.real < 0.0)
            assert (orbit.name[-1] in "ab") == orbit.levitating_side
            assert orbit.speed_rate == pytest.approx(-gap / lever.real, rel=1e-9)


def test_source_machine_loses_levitation_in_a_non_smooth_fold_with_two_unstable_cycles():
    (boundary,) = boundary_equilibria(jeffcott(PAPER))

    assert boundary.value == pytest.approx(0.0724686787, abs=5e-11)
    assert boundary.levitates == "above"
    assert boundary.kind == "non-smooth fold"
    found = [(orbit.name, orbit.levitating_side, orbit.admissible, orbit.stable) for orbit in boundary.orbits]
    assert found == [("B1,a", True, True, False), ("B1,b", True, True, False)]
    assert boundary.complete
    assert "B1,a (unstable), B1,b (unstable)" in boundary.words


@pytest.mark.jit_only
def test_persistence_with_a_stable_cycle_above_the_critical_speed_ratio():
    below, above = boundary_equilibria(jeffcott(PAPER), "omega")

    assert (below.kind, below.levitates) == ("non-smooth fold", "below")
    assert (above.kind, above.levitates) == ("persistence", "above")
    stable = [orbit for orbit in above.orbits if orbit.stable]
    assert [orbit.name for orbit in stable] == ["B1,d"]
    assert not stable[0].levitating_side
    # The rotor really goes over: from the boundary equilibrium to the small rub or the small orbit.
    rotor = at_gap(above, -1e-3)
    rub = next(rub for rub in find_equilibria(rotor)[1:] if rub.stable)
    resting = simulate(rotor, State(rub.position * (1.0 - 1e-9)), 1e5, settle=True)
    bouncing = simulate(rotor, find_orbits(rotor)["B1,d"].departure, 1e5, settle=True)
    assert resting.outcome is Outcome.FORWARD_RUB
    assert rub.normal_force < 1e-3
    assert (bouncing.outcome, bouncing.multiplicity) == (Outcome.BOUNCING, 1)
    assert bouncing.contacts.radial_speed[-1] == pytest.approx(1e-3 * stable[0].speed_rate, rel=2e-2)
