"""For which values of a parameter motions exist: equilibria against themselves, orbits against the certified ones at many values."""

import math

import numpy as np
import pytest
from compilation import sized
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from machines import PAPER

from carom import State, find_equilibria, load, simulate
from carom.closed_forms import rolling
from carom.closed_forms.thresholds import ranges_of
from carom.models import Edge, Span, axis, jeffcott
from carom.orbits import orbits_within_reach
from carom.parameters import Parameters
from carom.studies import MotionRange
from carom.studies.recovery import motion_ranges

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


def steady_range(parameters, motion, gain):
    return MotionRange(motion, gain, ranges_of(motion, parameters, gain))


def levitates(parameters):
    return find_equilibria(jeffcott(parameters))[0].status == "admissible"


def rubs(parameters):
    return any(entry.status == "admissible" for entry in find_equilibria(jeffcott(parameters))[1:])


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
    for edge, side in steady_range(parameters, motion, gain).thresholds:
        value = edge.value
        low, high = 0.999 * value, 1.001 * value
        # Two thresholds closer together than the bracket cannot be distinguished by it.
        assume(value > 1e-3)
        there = [exists(parameters.replace(**{gain: end})) for end in (low, high)]
        assume(there[0] != there[1])
        assert there == [side == "below", side == "above"]
        while high - low > 1e-12 * value:
            middle = 0.5 * (low + high)
            if exists(parameters.replace(**{gain: middle})) == there[0]:
                low = middle
            else:
                high = middle
        # The equilibria count a gap or force below 1e-12 as none; near a tangency that moves a threshold by its root.
        assert 0.5 * (low + high) == pytest.approx(value, rel=3e-6)


@pytest.mark.parametrize("gain", ["gamma", "omega"])
@pytest.mark.parametrize("factor", [0.999, 1.001])
def test_rotor_rolls_on_exactly_within_its_range(gain, factor):
    parameters = PAPER.replace(radius_ratio=5.0, gamma=0.3)
    ((edge, side),) = steady_range(parameters, "rolling", gain).thresholds
    rotor = jeffcott(parameters.replace(**{gain: factor * edge.value}))

    motion = simulate(rotor, State(1.0 + 0j, -6j), 2.5)

    rolls_on = {contact.kind for contact in motion.lasting_contacts} == {"roll"}
    assert rolls_on == (factor < 1.0)
    assert side == "below"


@pytest.mark.parametrize("gain", ["gamma", "omega"])
def test_without_friction_nothing_rolls_and_without_unbalance_nothing_rubs(gain):
    assert steady_range(PAPER.replace(mu=0.0), "rolling", gain).spans == ()
    assert steady_range(PAPER.replace(rho=0.0), "rub", gain).spans == ()
    assert steady_range(PAPER.replace(rho=0.0), "contact-free", gain).spans == (Span(Edge(0.0), Edge(math.inf)),)


# ------------------------------------------------------------------------------------------------ orbits


README = load("examples/keogh-cole.toml").machine


def orbit_ranges(parameters, gain, progress=None):
    """Ranges of all orbits with one impact a period, and of the stable ones."""
    rotor = jeffcott(parameters)
    found = motion_ranges(rotor, axis(rotor, gain), progress)
    return tuple(entry for entry in found if entry.motion.endswith("single-impact"))


def orbits_at(parameters, gain, value):
    """Whether any orbit is admissible, and whether any such is stable, by the certified list."""
    orbits = [orbit for orbit in orbits_within_reach(jeffcott(parameters.replace(**{gain: value}))) if orbit.admissible]
    return bool(orbits), any(orbit.stable for orbit in orbits)


def check(parameters, gain, values):
    """The ranges and the certified orbits agree at these values and on both sides of every end."""
    for found, which in zip(orbit_ranges(parameters, gain), (0, 1), strict=True):
        edges = np.array([edge.value for edge, _ in found.thresholds])
        beside = [edge * (1.0 + side * 1e-6) for edge in edges for side in (-1.0, 1.0)]
        for value in (*values, *beside):
            if not len(edges) or np.abs(edges / value - 1.0).min() > 1e-7:
                assert found.exists_at(value) == orbits_at(parameters, gain, value)[which], (parameters, gain, value)


def test_no_orbit_of_the_readme_machine_above_the_stiffness_at_which_levitation_returns():
    """All four roots are virtual at 3.0e6 N/m, where roots of ``F₁`` were once taken for motions."""
    found, _ = orbit_ranges(README.parameters, "omega")
    assert not found.exists_at(math.sqrt(3.0e6 / README.scales.stiffness))
    ((end, side),) = found.thresholds
    # Every orbit shrinks into the levitation that touches the wall there.
    parameters = README.parameters
    touching = math.sqrt(1.0 + math.sqrt(parameters.rho**2 - parameters.gamma**2))
    assert end.value == pytest.approx(touching, rel=1e-12)
    assert (end.kind, side) == ("non-smooth-hopf", "below")


def test_ranges_agree_with_the_certified_orbits():
    random = np.random.default_rng(3)
    machines = [PAPER, PAPER.replace(gamma=0.1779), PAPER.replace(omega=0.4, gamma=0.3), PAPER.replace(d=1.0)]
    for parameters in machines[: sized(4, 1, 4)]:
        for gain, low, high in (("gamma", 0.02, 1.0), ("omega", 0.5 * parameters.omega, 2.0 * parameters.omega)):
            check(parameters, gain, np.exp(random.uniform(math.log(low), math.log(high), sized(10, 2, 40))))


# ------------------------------------------------------------------------------------------------ any parameter


@pytest.mark.parametrize("name", ["speed", "friction", "clearance", "mass"])
def test_ranges_along_any_parameter_agree_with_the_motions_there(name):
    rotor = jeffcott(README.parameters)
    along = axis(rotor, name)
    found = {entry.motion: entry for entry in motion_ranges(rotor, along)}
    low, high = (edge.value for edge in found["single-impact"].searched)
    for value in np.random.default_rng(5).uniform(low, high, sized(12, 2, 60)):
        there = along.move(rotor, float(value))
        orbits = [orbit for orbit in orbits_within_reach(there) if orbit.admissible]
        expected = {
            "contact-free": levitates(there.parameters),
            "rub": rubs(there.parameters),
            "rolling": rolling(there).holds,
            "single-impact": bool(orbits),
            "stable-single-impact": any(orbit.stable for orbit in orbits),
        }
        assert {motion: entry.exists_at(value) for motion, entry in found.items()} == expected


def test_ends_along_any_parameter_say_what_happens_there():
    rotor = jeffcott(README.parameters)
    found = {entry.motion: entry for entry in motion_ranges(rotor, axis(rotor, "speed"))}
    for edge, _ in found["contact-free"].thresholds:
        there = rotor.replace(speed=edge.value)
        assert (edge.kind, abs(there.equilibrium)) == ("boundary-equilibrium", pytest.approx(1.0, rel=1e-12))
    assert len(found["contact-free"].thresholds) == 2
