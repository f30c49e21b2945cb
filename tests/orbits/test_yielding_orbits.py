"""Orbits in walls that give way: read from motions, closed, and judged, against a general integrator of the equations of motion."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment
from yielding_rotors import Yielding, packed, two_planes

import carom as cm
from carom.models import HuntCrossley, KelvinVoigt, Rigid, from_matrices
from carom.models.touchdown import Touchdown
from carom.orbits import Kind, Section, Segment, Word, impact_map, orbit_near, orbit_of_motion
from carom.orbits.shooting import Start
from carom.outcome import InputError

pytestmark = pytest.mark.jit_only
VOIGT = Yielding(KelvinVoigt(1e3, 2.0))
CROSSLEY = Yielding(HuntCrossley(2e3, 0.05, 1.0))
CURVED = Yielding(HuntCrossley(2e4, 0.05, 1.5))
ROTORS = {"voigt": VOIGT, "crossley": CROSSLEY, "curved": CURVED}
STICKING = Yielding(
    HuntCrossley(3492.889136252971, 0.03685571172443193, 1.0),
    gamma=0.176,
    omega=1.2261,
    rho=0.7407,
    mu=0.6,
    surface_speed=1.5,
)
PARTING = Yielding(KelvinVoigt(813.76, 0.9513), gamma=0.16776, omega=0.5981, rho=0.67485, mu=0.3, surface_speed=1.5)


def settled(rotor, velocity=1.0 + 0j):
    motion = cm.simulate(rotor.model, cm.State(0.2 + 0.1j, velocity), settle=True)
    return orbit_of_motion(motion)


@pytest.fixture(scope="module")
def voigt():
    return settled(VOIGT)


@pytest.fixture(scope="module")
def crossley():
    return settled(CROSSLEY)


@pytest.fixture(scope="module")
def curved():
    return settled(CURVED)


def from_flight(orbit):
    """State at the beginning of the only flight."""
    (place,) = np.flatnonzero(orbit.word.kinds == Kind.LIFT)
    return packed(*orbit.nodes[place])


@pytest.mark.parametrize("name", ROTORS)
def test_a_settled_motion_is_closed_to_rounding(name, request):
    orbit, rotor = request.getfixturevalue(name), ROTORS[name]
    assert str(orbit.word) == ("slide+ free lift" if name == "voigt" else "slide+ lift")
    assert orbit.links.size < 1e-13
    assert orbit.admissible
    assert orbit.stable
    assert orbit.impacts == 1
    assert orbit.impact_speeds == pytest.approx([orbit.radial_speed])
    start = from_flight(orbit)
    # From the middle of the flight, the equations of motion lead back after a period.
    middle = rotor.follow(start, 0.5 * orbit.durations[-1])
    end, events = rotor.motion(middle, orbit.period)
    assert [kind for _, kind in events] == (["contact", "free", ""] if name == "voigt" else ["contact", ""])
    assert end == pytest.approx(middle, abs=1e-10)


@pytest.mark.parametrize("name", ROTORS)
def test_multipliers_are_those_of_the_stroboscopic_map(name, request):
    orbit, rotor = request.getfixturevalue(name), ROTORS[name]
    middle = rotor.follow(from_flight(orbit), 0.5 * orbit.durations[-1])
    step, columns = 1e-3, []
    for unit in np.eye(4) * step:
        near, far = (
            np.subtract(
                rotor.motion(middle + k * unit, orbit.period)[0], rotor.motion(middle - k * unit, orbit.period)[0]
            )
            for k in (1, 2)
        )
        columns.append((8.0 * near - far) / (12.0 * step))
    expected = np.append(orbit.multipliers.values, 1.0)  # one of the flow along the orbit
    apart = np.abs(np.linalg.eigvals(np.array(columns).T)[:, None] - expected)
    assert apart[linear_sum_assignment(apart)].max() < 1e-8


@pytest.mark.parametrize(
    ("rotor", "velocity", "word"),
    [
        (STICKING, -0.24555 - 0.77661j, "slide+ roll slide- lift"),
        (PARTING, -0.36263 + 0.20307j, "slide+ roll slide- free lift"),
    ],
    ids=["sticking", "parting"],
)
def test_words_with_rolling_and_backward_slip(rotor, velocity, word):
    orbit = settled(rotor, velocity)
    assert str(orbit.word) == word
    assert orbit.links.size < 1e-13
    assert orbit.admissible
    state = packed(*orbit.nodes[0])
    for kind, time in zip("+0-", orbit.durations[:3], strict=True):
        state = rotor.follow(state, time, kind)
    for time in orbit.durations[3:]:
        state = rotor.follow(state, time)
    assert state == pytest.approx(packed(*orbit.nodes[0]), abs=1e-9)
    # Rolling takes one direction away.
    assert np.abs(orbit.multipliers.values).min() < 1e-9
    assert min(orbit.margins.cone, orbit.margins.approach) > 0.0


def test_its_motion_repeats_it(voigt):
    followed = voigt.trajectory(3.0)
    positions = followed.at_plane(np.linspace(0.0, 2.0 * voigt.period, 50))[0]
    later = followed.at_plane(np.linspace(voigt.period, 3.0 * voigt.period, 50))[0]
    assert np.abs(positions - later).max() < 1e-9
    found = orbit_of_motion(cm.simulate(VOIGT.model, voigt.departure, settle=True))
    assert found.period == pytest.approx(voigt.period, rel=1e-12)


def test_a_wall_that_pulls_is_no_wall(voigt):
    """Without ``free`` the wall would have to hold the rotor until it is out."""
    word = Word.of(Kind.SLIDE_FORWARD, Kind.LIFT)
    start = Start(voigt.nodes[[0, 2]], np.array([voigt.durations[:2].sum(), voigt.durations[2]]))
    orbit = orbit_near(VOIGT.model, word, start)
    assert orbit.links.size < 1e-12
    assert not orbit.admissible
    assert "another way than with lift" in orbit.reason


def test_a_stiff_wall_comes_near_to_a_rigid_one():
    """The distance falls with the square root of the stiffness, as the bounces last as long."""
    restitution, share = 0.95, 0.0164982
    forcing = [VOIGT.rho * np.exp(1j * VOIGT.phi)]
    wall = [Touchdown([1.0], Rigid(restitution), VOIGT.mu, VOIGT.surface_speed)]
    rigid = from_matrices(
        mass=[[1.0]], damping=[[VOIGT.gamma]], stiffness=[[VOIGT.omega**2]], forcing=forcing, touchdowns=wall
    )
    limit = orbit_of_motion(cm.simulate(rigid, cm.State(0.2 + 0.1j, 1.0), settle=True))
    apart = []
    for stiffness in (1e4, 1e6):
        orbit = settled(Yielding(KelvinVoigt(stiffness, 2.0 * share * np.sqrt(stiffness))))
        apart.append([orbit.period - limit.period, orbit.radial_speed - limit.radial_speed])
    ratios = np.array(apart[0]) / np.array(apart[1])
    assert ratios == pytest.approx([10.0, 10.0], rel=0.06)  # 5.4 % of the next order


def test_two_planes_of_which_one_is_rigid():
    model = two_planes(
        Rigid(0.378), KelvinVoigt(6420.0, 1.76), friction=(0.05, 0.3), damping=0.4676, speeds=(1.5, 1.5), unbalance=0.4
    )
    for velocity in (0.5, 1.0, 1.5, 2.0):
        motion = cm.simulate(model, cm.State(np.zeros(2), velocity * np.array([1.0, 0.4j])), settle=True)
        if motion.multiplicity:
            orbit = orbit_of_motion(motion)
            assert str(orbit.word) == "slide+@2 free@2 lift@2"
            assert orbit.links.size < 1e-12
            assert orbit.admissible
            return
    pytest.fail("no motion has settled to bouncing")


@pytest.mark.parametrize(
    ("kinds", "plane", "said"),
    [
        ((Kind.IMPACT_FORWARD,), 0, "gives way"),
        ((Kind.LIFT, Kind.LAND, Kind.SLIDE_FORWARD), 0, "gives way"),
        ((Kind.SLIDE_FORWARD, Kind.LIFT), 1, "rigid"),
        ((Kind.SLIDE_FORWARD, Kind.FREE, Kind.LIFT), 1, "rigid"),
        ((Kind.IMPACT_FORWARD,), 2, "planes from 0 to 1"),
    ],
)
def test_words_that_a_wall_cannot_have_are_refused(kinds, plane, said):
    model, word = two_planes(VOIGT.law, Rigid(0.5)), Word.of(*kinds, plane=plane)
    start = Start(np.ones((len(word), 4), complex), np.ones(len(word)))
    with pytest.raises(InputError, match=said):
        orbit_near(model, word, start)


def test_an_impact_may_lead_to_contact_at_another_plane():
    word = Word((Segment(Kind.IMPACT_FORWARD, 1), Segment(Kind.SLIDE_FORWARD, 0), Segment(Kind.LIFT, 0)))
    assert word.arrives.tolist() == [True, True, False]
    with pytest.raises(InputError, match="word"):
        Word.of(Kind.IMPACT_FORWARD, Kind.SLIDE_FORWARD)


def test_the_impact_map_refuses_a_wall_without_impacts():
    with pytest.raises(InputError, match="gives way"):
        impact_map(VOIGT.model, Section(0.0, 0.5, -1.0))
