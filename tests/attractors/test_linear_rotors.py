"""Attractors of any linear rotor: the planar one by its matrices, several rubs at rest, several planes."""

import numpy as np
import pytest
from linear_rotors import random_rotor, tilting, touchdowns
from machines import PAPER

import carom
from carom.attractors import DisturbanceSet
from carom.base.outcome import Outcome
from carom.models import from_matrices
from carom.motions.starts import State

pytestmark = pytest.mark.jit_only


def beside(one):
    """The planar rotor by its matrices, with another coordinate that it does not feel."""
    return from_matrices(
        mass=np.eye(2),
        damping=np.diag([one.gamma, 0.3]),
        stiffness=np.diag([one.omega**2, 0.7]),
        forcing=[one.rho * np.exp(1j * one.phi), 0.3],
        touchdowns=touchdowns([[1.0, 0.0]], [one.mu], [one.d], [one.radius_ratio + 1.0]),
        translation=[1.0, 0.0],
    )


def test_the_same_attractors_as_of_the_planar_rotor():
    one, count = PAPER.replace(gamma=0.1), 36
    planar = carom.find_attractors(one, count=count)
    general = carom.find_attractors(beside(one), count=count)
    assert len(general.disturbances) == count
    assert [start.start.kind for start in general.disturbances] == [start.start.kind for start in planar.disturbances]

    def kinds(found):
        return {(member.name.outcome, member.name.multiplicity): member for member in found}

    assert kinds(general).keys() == kinds(planar).keys()
    for kind, member in kinds(general).items():
        other = kinds(planar)[kind]
        # The planar rotor's motions end where proofs say: irregular ones may end either way.
        assert abs(member.count - other.count) <= 2
        assert member.whirl == other.whirl
        # Rolling has been followed for a turn, in which its force is not yet the largest in closed form.
        tolerance = 1e-2 if kind[0] is Outcome.ROLLING else 1e-6
        assert member.largest_force == pytest.approx(other.largest_force, rel=tolerance)
        assert member.largest_impulse == pytest.approx(other.largest_impulse, rel=1e-6)
        assert (member.period is None) == (other.period is None)
        assert member.period is None or member.period == pytest.approx(other.period, rel=1e-8)
    assert "recurrence of the state" in general.argument
    assert "recurrence of the state" not in planar.argument


def test_rubs_at_rest_in_different_places_are_different_attractors():
    model = random_rotor(117, n=2, planes=2, unbalance=1.5, damping=0.3)
    found = carom.find_attractors(model, DisturbanceSet(24, fastest=1.0))
    rubs = [member for member in found if member.name.outcome is Outcome.FORWARD_RUB and not member.name.drifting]
    stable = [at for at in carom.find_equilibria(model) if at.planes and at.stable and at.status == "admissible"]
    assert [at.planes for at in stable] == [(0,), (1,)]
    assert {member.name for member in rubs} == {"synchronous rub", "synchronous rub (2)"}
    for member in rubs:
        (at,) = (at for at in stable if np.abs(np.atleast_1d(at.position - member.state.position)).max() < 1e-6)
        assert member.largest_force == pytest.approx(at.normal_force, rel=1e-6)


def test_a_rotor_with_two_planes_is_followed_from_kicks_and_from_motions_next_to_known_ones():
    model = tilting(damping=0.15 * np.eye(2), restitution=0.6).model
    found = carom.find_attractors(model, DisturbanceSet(24, fastest=1.5))
    assert {ending.start.kind for ending in found.endings} >= {"kick", "start", "whirl"}
    assert sum(member.count for member in found) == 24
    kicked = [ending for ending in found.endings if ending.start.kind == "kick" and not ending.recovered]
    smallest = min((abs(ending.start.state.velocity[0]) for ending in kicked), default=None)
    assert found.smallest_unrecovered_kick == pytest.approx(smallest)
    for member in found:
        assert np.shape(member.state.position) == (2,)
        assert member.settled == member.name.outcome.settled
    hit = next(ending for ending in found.endings if ending.impacts)
    assert hit.hardest_impulse > 0.0


def test_an_impact_at_one_plane_while_another_rubs_is_an_orbit_of_the_flow():
    rotor, random = random_rotor(571, n=2, planes=2), np.random.default_rng(571)
    position, velocity = (random.normal(size=2) + 1j * random.normal(size=2) for _ in range(2))
    found = carom.find_attractors(rotor, [State(0.2 * position, velocity)], known=False)
    (member,) = found
    assert (member.name, member.orbit.stable) == ("1-impact bouncing with rub", True)
    assert member.orbit.period == pytest.approx(member.period, rel=1e-7)
    motion = carom.simulate(rotor, member.state, 1.5 * member.period)
    positions, _ = motion.at(np.array([0.25, 0.25 + member.period]))
    assert positions[1] == pytest.approx(positions[0], abs=1e-6)  # far above the 1e-8 to which it recurred
