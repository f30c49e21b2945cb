"""Where lasting contact begins: on orbits without rebound, and on periodic motions that chatter."""

from __future__ import annotations

import numpy as np
import pytest
from compilation import sized
from machines import PAPER
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

from carom import find_orbits, simulate
from carom.bifurcations import (
    Bifurcation,
    OrbitBranch,
    Plane,
    continue_curve,
    continue_orbit,
    find_bifurcations,
    switch,
)
from carom.bifurcations.neighbours import NEIGHBOURS
from carom.models import jeffcott
from carom.motions import State
from carom.orbits import lift_off_of, rubbing_orbits
from carom.orbits.rubbing import lift_off_state
from carom.outcome import InputError, Phase

DEAD = PAPER.replace(omega=0.76, rho=0.1, mu=0.3, d=0.0)
"""Impacts without rebound."""
CHATTERING = PAPER.replace(omega=0.334, rho=0.416, d=0.49, gamma=0.18, mu=0.287)
"""Bounces that chatter into a stretch of sliding twice a turn or so."""


def next_lift_off(rotor, whirl, angle):
    """Angle and time of the next lift-off of a simulated motion that begins with one; ``None`` if there is none."""
    motion = simulate(rotor, lift_off_state(rotor, whirl, angle), 8.0 * np.pi)
    flying = motion.segment_phases[:, 0] == Phase.FLIGHT
    lifts = np.flatnonzero(~flying[:-1] & flying[1:]) + 1
    lifts = lifts[motion.segment_starts[lifts] > 1e-6]
    if not len(lifts):
        return None
    position, velocity = rotor.system.state(motion.segment_amplitudes[lifts[0]])
    if ((np.conj(position) * velocity).imag > -1.0) != (whirl > 0):
        return None
    x = np.angle(position) - rotor.parameters.phi
    return angle + (x - angle + np.pi) % (2.0 * np.pi) - np.pi, motion.segment_starts[lifts[0]]


def touches_for_a_while(orbit) -> bool:
    """Whether a simulated period of an orbit holds lasting contact."""
    motion = simulate(orbit.rotor, orbit.departure, 0.9 * orbit.period)
    return bool((motion.segment_phases != Phase.FLIGHT).any())


@pytest.fixture(scope="module")
def onset():
    orbits = find_orbits(jeffcott(DEAD.replace(gamma=0.03)))
    for orbit in orbits:
        branch = continue_orbit(orbit, "gamma", (0.01, 0.1))
        found = [point for point in branch.special if point.kind == "contact-onset" and point.admissible]
        if found:
            return found[0]
    raise AssertionError("no onset of lasting contact")


@pytest.mark.jit_only
def test_without_rebound_the_simulation_begins_to_stay_on_the_wall(onset):
    answers = []
    for shift in (-1e-9, 1e-9):
        orbits = find_orbits(jeffcott(DEAD.replace(gamma=onset.value + shift)))
        (orbit,) = [orbit for orbit in orbits if abs(orbit.radial_speed - onset.radial_speed) < 1e-5]
        answers.append((touches_for_a_while(orbit), "stay on the wall" in orbit.reason))
    assert sorted(answers) == [(False, False), (True, True)]


@pytest.mark.deep
def test_without_rebound_the_motions_with_lasting_contact_end_at_the_same_value(onset):
    """A second route: not one formula of the orbits, but branches of orbits with lasting contact."""
    ends = []
    for shift in (-0.001, 0.001):
        for orbit in rubbing_orbits(DEAD.replace(gamma=onset.value + shift), samples=360):
            branch = continue_orbit(orbit, "gamma", (0.01, 0.1))
            ends += [(point.value, point.period) for point in branch.special if point.kind == "contact-onset"]
    assert min(abs(value - onset.value) for value, _ in ends) < 1e-7
    assert min(abs(period - onset.period) for _, period in ends) < 1e-6


@pytest.mark.jit_only
def test_curve_of_the_onset_without_rebound(onset):
    plane = Plane("gamma", "rho", (0.01, 0.1), (0.08, 0.12))
    curve = continue_curve(onset, plane)
    assert set(curve.stops) == {"edge of the plane"}
    for (x, y), speed in list(zip(curve.points, curve.radial_speeds, strict=True))[1:-1]:
        answers = set()
        for shift in (-1e-9, 1e-9):
            orbits = find_orbits(jeffcott(DEAD.replace(gamma=x + shift, rho=y)))
            (orbit,) = [orbit for orbit in orbits if abs(orbit.radial_speed - speed) < 1e-5]
            answers.add("stay on the wall" in orbit.reason)
        assert answers == {False, True}


@pytest.fixture(scope="module")
def chatter() -> OrbitBranch:
    (orbit,) = rubbing_orbits(CHATTERING)
    return continue_orbit(orbit, "gamma", (0.02, 0.4))


def special(branch, kind) -> Bifurcation:
    """The only special point of a kind."""
    (point,) = [each for each in branch.special if each.kind == kind]
    return point


@pytest.mark.jit_only
def test_motion_with_lasting_contact_repeats_in_simulation():
    (orbit,) = rubbing_orbits(CHATTERING)
    assert str(orbit.word) == "lift land slide+"
    motion = orbit.trajectory(1.0 + 1e-9)
    assert (motion.segment_phases != Phase.FLIGHT).any()
    assert abs(motion.final.position - motion.start.position) < 1e-7
    assert abs(motion.final.velocity - motion.start.velocity) < 1e-7
    # It repels: a change of the angle grows by the multiplier from lift-off to lift-off.
    rotor = jeffcott(CHATTERING)
    here = lift_off_of(orbit)
    moved, time = next_lift_off(rotor, here.whirl, here.angle + 1e-5)
    assert (moved - here.angle) / 1e-5 == pytest.approx(orbit.multipliers.values[0].real, rel=1e-3)
    assert time == pytest.approx(orbit.period, abs=1e-4)
    assert not orbit.stable


@pytest.mark.jit_only
def test_lasting_contact_begins_where_the_chatter_is_only_just_complete(chatter):
    """Within 1e-7 the fixed point of the simulated map from lift-off to lift-off ceases to be."""
    assert chatter.stops == ("contact-onset", "permanent-contact")
    assert "none finite" in repr(chatter)  # it has no radial speeds of impacts
    point = special(chatter, "contact-onset")
    assert point.admissible
    # To the accuracy of a search with simulations of the map from lift-off to lift-off.
    assert point.value == pytest.approx(0.145891831519, abs=1e-10)
    lift = lift_off_of(point.orbit)
    fixed = []
    for shift in (-1e-7, 1e-7):
        rotor = jeffcott(CHATTERING.replace(gamma=point.value + shift))
        angles = lift.angle + np.linspace(-4e-6, 4e-6, 41)
        found = [next_lift_off(rotor, lift.whirl, angle) for angle in angles]
        alike = [entry is not None and abs(entry[1] - point.period) < 0.05 for entry in found]
        moves = np.array(
            [entry[0] - x if same else np.nan for entry, x, same in zip(found, angles, alike, strict=True)]
        )
        fixed.append(int((moves[:-1] * moves[1:] < 0.0).sum()))
    assert fixed == [0, 1]


def least_force_of_steady_whirl(gamma: float, mu: float = CHATTERING.mu) -> float:
    """Least normal force of sliding backward whirl that repeats every turn, from a general ODE solver.

    ``W(x)`` with ``W = 1 + θ̇`` solves ``(W − 1) dW/dx = −γW − ρ sin x − μN``; the whirl repels in time, in which the angle
    falls, so it attracts in the direction of growing angle.
    """
    rho, omega = CHATTERING.rho, CHATTERING.omega

    def force(angle, whirl):
        return rho * np.cos(angle) + whirl**2 - omega**2

    def rate(angle, whirl):
        return (-gamma * whirl - rho * np.sin(angle) - mu * force(angle, whirl)) / (whirl - 1.0)

    whirl = -0.7
    for _ in range(30):
        turn = solve_ivp(rate, (0.0, 2.0 * np.pi), [whirl], method="DOP853", rtol=1e-12, atol=1e-13, dense_output=True)
        whirl = turn.y[0, -1]
    least = minimize_scalar(
        lambda angle: force(angle, turn.sol(angle)[0]), bounds=(2.5, 3.4), method="bounded", options={"xatol": 1e-9}
    )
    return float(least.fun)


@pytest.mark.jit_only
def test_contact_becomes_permanent_where_a_steady_whirl_is_only_just_pressed_on(chatter):
    point = special(chatter, "permanent-contact")
    assert str(point.orbit.word) == "slide+"
    assert least_force_of_steady_whirl(point.value - 1e-9) < 0.0 < least_force_of_steady_whirl(point.value + 1e-9)


@pytest.mark.jit_only
def test_beyond_permanent_contact_the_whirl_does_not_leave_the_wall(chatter):
    point = special(chatter, "permanent-contact")
    branch = switch(point, (0.23, 0.26))
    assert str(branch.word) == "slide+"
    above, below = branch.values > point.value + 1e-9, branch.values < point.value - 1e-9
    assert branch.admissible[above].all()
    assert not branch.admissible[below].any()
    assert above.any()
    assert below.any()
    # It repels: one period of a simulation from the orbit itself stays on the wall, and comes back.
    for shift, stays in ((1e-4, True), (-1e-4, False)):
        (start,) = branch.starts_at(point.value + shift)
        rotor = jeffcott(CHATTERING.replace(gamma=point.value + shift))
        position, velocity = start.nodes[0]
        position /= abs(position)
        turning = (np.conj(position) * velocity).imag
        motion = simulate(rotor, State(position, 1j * turning * position), start.durations[0])
        flying = motion.segment_phases[:, 0] == Phase.FLIGHT
        aloft = float(np.diff(np.append(motion.segment_starts, motion.time))[flying].sum())
        assert (aloft == 0.0) if stays else (aloft > 0.01)
        if stays:
            assert abs(motion.final.position - position) < 1e-9


@pytest.mark.jit_only
def test_beyond_the_onset_the_chatter_becomes_many_impacts(chatter):
    point = special(chatter, "contact-onset")
    branch = switch(point, (point.value * (1.0 - 2e-5), point.value * (1.0 + 2e-5)))
    assert branch.word.flies
    assert branch.impacts > 10
    real = branch.admissible
    assert real.any()
    assert branch.values[real].max() < point.value
    for orbit in [each for each, there in zip(branch.orbits, real, strict=True) if there][:: sized(9, 9, 3)]:
        # The same motion goes on: its period is continuous.
        assert orbit.period == pytest.approx(point.period, abs=1e-3)
        # It is what the simulation does: so many impacts a period, without lasting contact.
        motion = simulate(orbit.rotor, orbit.departure, 1.0001 * orbit.period)
        assert (motion.segment_phases == Phase.FLIGHT).all()
        assert int(motion.is_impact.sum()) == branch.impacts
    # The multiplier passes through that of the onset; where an impact vanishes it grows without bound.
    leaders = branch.multipliers[real, 0].real
    onset = point.orbit.multipliers.values[0].real
    assert leaders.min() < onset < leaders.max()
    assert leaders.min() == pytest.approx(onset, rel=0.04)  # the first step of the branch lies beside the onset
    kinds = {each.kind: each for each in branch.special}
    assert list(kinds) == ["vanishing-impact", "period-doubling", "grazing"]
    # Those beside the doubling are motions: impacts of 1e-7 arrive at a time that rounding shifts by 1e-9.
    assert all(each.admissible for each in branch.special)
    assert real[(kinds["vanishing-impact"].value < branch.values) & (branch.values < kinds["grazing"].value)].all()
    # The next impact appears where the last flight touches the wall 1e-3 after its beginning.
    assert branch.values[real].max() < kinds["grazing"].value < point.value
    assert len(NEIGHBOURS["grazing"](kinds["grazing"].orbit)[0]) == branch.impacts + 1


@pytest.mark.jit_only
def test_contact_shrinks_towards_the_onset(chatter):
    lifts = [lift_off_of(orbit) for orbit in chatter.orbits]
    assert lifts[0].contact_time < 1e-5 < 0.01 < lifts[len(chatter) // 2].contact_time
    forces = [lift.landing_force for lift in lifts]
    assert max(forces) > 1.0
    assert forces[0] < 1e-5 * max(forces)


@pytest.mark.jit_only
def test_onsets_are_among_the_points_of_a_diagram(chatter):
    found = find_bifurcations(CHATTERING, "gamma", (0.1, 0.3), lasting=True)
    expected = {point.kind: point.value for point in chatter.special}
    for kind in ("contact-onset", "permanent-contact"):
        points = [point for point in found.points if point.kind == kind]
        assert min(abs(point.value - expected[kind]) for point in points) < 1e-9
        assert all(point.motion == "rubbing" for point in points)
        plane = Plane("gamma", "mu", (0.1, 0.3), (0.285, 0.289))
        nearest = min(points, key=lambda point: abs(point.value - expected[point.kind]))
        assert continue_curve(nearest, plane).kind == kind


@pytest.mark.jit_only
def test_inputs_that_cannot_be_used():
    (orbit,) = rubbing_orbits(CHATTERING)
    with pytest.raises(InputError, match="interval that holds"):
        continue_orbit(orbit, "gamma", (0.3, 0.4))


@pytest.mark.parametrize("names", [("gamma", "mu"), pytest.param(("d", "gamma"), marks=pytest.mark.deep)])
@pytest.mark.jit_only
def test_curves_of_both_onsets(chatter, names):
    ranges = {"gamma": (0.02, 0.4), "mu": (0.25, 0.32), "d": (0.4, 0.6)}
    plane = Plane(*names, *(ranges[name] for name in names))
    for point in chatter.special:
        curve = continue_curve(point, plane)
        assert curve.kind == point.kind
        assert set(curve.stops) == {"edge of the plane"}
        for x, y in curve.points[1 : -1 : sized(81, 81, 7)]:
            at = CHATTERING.replace(**{names[0]: x, names[1]: y})
            if point.kind == "permanent-contact":
                assert abs(least_force_of_steady_whirl(at.gamma, at.mu)) < 1e-7
            else:
                # From a branch along another parameter the same onset is found.
                (orbit,) = rubbing_orbits(at.replace(gamma=at.gamma + 0.01))
                again = continue_orbit(orbit, "gamma", (at.gamma - 0.01, at.gamma + 0.02))
                values = [found.value for found in again.special if found.kind == "contact-onset"]
                assert values == pytest.approx([at.gamma], abs=1e-6)


@pytest.mark.jit_only
def test_curves_need_an_onset_on_the_plane(chatter):
    point = chatter.special[0]
    with pytest.raises(InputError, match="a point of the plane"):
        continue_curve(point, Plane("mu", "d", (0.1, 0.2), (0.4, 0.6)))
