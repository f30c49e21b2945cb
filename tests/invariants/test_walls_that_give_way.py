"""Compliant walls: nothing prefers a direction, and stiff ones are the rigid wall."""

import cmath
import math

import numpy as np
import pytest
from linear_rotors import planar_rotor

import carom as cm
from carom.models import HuntCrossley, KelvinVoigt, Rigid, Touchdown, from_matrices
from carom.parameters.restitution import damping_ratio_of


def planar(law, phase=0.21, friction=0.15):
    """The planar rotor of the paper with a wall of a law and an unbalance of a phase."""
    return planar_rotor(
        0.1, 0.76**2, 3.0 / 7.0 * cmath.exp(1j * phase), [Touchdown([1.0], law, friction, 1.0 + 400.0 / 7.0)]
    )


def tilting(law, phase=0.2):
    """A rotor that tilts, with two planes that both touch."""
    return from_matrices(
        mass=np.diag([1.0, 0.4]),
        damping=np.diag([0.1, 0.05]),
        stiffness=[[0.6, 0.05], [0.05, 0.3]],
        gyroscopic=np.diag([0.0, 0.3]),
        forcing=np.array([0.4, 0.1]) * cmath.exp(1j * phase),
        touchdowns=[Touchdown([1.0, 0.8], law, 0.2, 4.0), Touchdown([1.0, -0.7], law, 0.3, 5.0)],
    )


def changes(motion):
    """Phases of all planes where one of them changes, and when: where steps end between is a matter of rounding."""
    changed = np.flatnonzero((np.diff(motion.segment_phases, axis=0) != 0).any(axis=1)) + 1
    return motion.segment_phases[changed], motion.segment_starts[changed]


@pytest.mark.parametrize("law", [KelvinVoigt(1e5, 30.0), HuntCrossley(1e5, 0.2, 1.5)], ids=str)
@pytest.mark.parametrize("angle", [0.7, math.pi, -2.3])
def test_a_turned_motion_is_the_motion_turned(law, angle):
    turn = cmath.exp(1j * angle)
    position, velocity = 0.2 + 0.1j, 1.2 - 0.3j
    first = cm.simulate(planar(law), cm.State(position, velocity), 8.0)
    other = cm.simulate(planar(law, 0.21 + angle), cm.State(position * turn, velocity * turn), 8.0)
    assert len(first.lasting_contacts) > 2
    phases, starts = changes(first)
    assert np.array_equal(changes(other)[0], phases)
    np.testing.assert_allclose(changes(other)[1], starts, rtol=0.0, atol=1e-11)
    assert abs(other.final.position - turn * first.final.position) < 1e-11
    assert abs(other.final.velocity - turn * first.final.velocity) < 1e-10


@pytest.mark.parametrize("law", [KelvinVoigt(1e4, 30.0), HuntCrossley(1e4, 0.2, 1.5)], ids=str)
def test_a_turned_motion_of_two_planes(law):
    turn = cmath.exp(2.1j)
    position, velocity = np.array([0.3, 0.2j]), np.array([1.5 + 0.4j, 1.0 - 2.0j])
    first = cm.simulate(tilting(law), cm.State(position, velocity), 5.0)
    other = cm.simulate(tilting(law, 0.2 + 2.1), cm.State(position * turn, velocity * turn), 5.0)
    assert min(len(first.seen_at(plane).lasting_contacts) for plane in (0, 1)) > 1
    assert np.array_equal(changes(other)[0], changes(first)[0])
    np.testing.assert_allclose(other.final.position, turn * first.final.position, rtol=0.0, atol=1e-11)
    np.testing.assert_allclose(other.final.velocity, turn * first.final.velocity, rtol=0.0, atol=1e-9)


def test_the_distance_to_the_rigid_motion_falls_with_the_root_of_the_stiffness():
    """A contact takes a time of π/√κ, and so late the motion is; after seven impacts."""
    restitution, start = 0.95, cm.State(0.2 + 0.1j, 1.2 - 0.3j)
    rigid = cm.simulate(planar(Rigid(restitution)), start, 60.0)
    until = float(rigid.contacts.time[6:8].mean())
    expected = cm.simulate(planar(Rigid(restitution)), start, until).final
    ratio, distances, stiffnesses = damping_ratio_of(restitution), [], 10.0 ** np.arange(4.0, 11.0)
    for stiffness in stiffnesses:
        law = KelvinVoigt(stiffness, 2.0 * ratio * math.sqrt(stiffness))
        motion = cm.simulate(planar(law), start, until)
        entries = (motion.segment_phases[:-1, 0] == 0) & (motion.segment_phases[1:, 0] > 0)
        assert entries.sum() == 7
        distances.append(
            abs(motion.final.position - expected.position) + abs(motion.final.velocity - expected.velocity)
        )
    slopes = np.diff(np.log(distances)) / np.diff(np.log(stiffnesses))
    assert slopes[2:] == pytest.approx(np.full(len(slopes) - 2, -0.5), abs=0.02)
